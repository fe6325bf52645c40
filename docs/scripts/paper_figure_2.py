# SPDX-License-Identifier: Apache-2.0
"""The paper's figure 2, from the solids and tests of symmetry_lines.py. Called by paper.py."""
from paper_runs import with_tables
from symmetry_lines import TESTS, across, draw, measure, run
from symmetry_shapes import SITUATIONS, write_obj


TILTS, SEEDS = [0.01, 0.03, 0.1, 0.3], range(1, 11)


def tilted_tentacles(command, folder):
    """Lengths of the tentacle's line when it is tilted at random, as the paper advises: the share of seeds in which it is gone."""
    situation = next(s for s in SITUATIONS if s.name == "tentacle, 70 degrees")
    mesh = folder / "tentacle.obj"
    write_obj(mesh, situation)
    answer = {}
    for tilt in TILTS:
        lengths = [run(command, mesh, folder, ["--method", "raw", "--samples", "0", "--perturb", str(tilt), "--perturb-seed", str(seed)])[0]
                   .get(situation.watched_vertex(), 0.0) for seed in SEEDS]
        answer[f"{tilt:g}"] = {"mean": sum(lengths) / len(lengths), "least": min(lengths), "most": max(lengths),
                               "gone": sum(length < 1.1 * situation.wanted for length in lengths), "seeds": len(lengths)}
    return answer


def tilt_table(answer):
    rows = [[tilt, f"{about['least']:.2f}", f"{about['mean']:.2f}", f"{about['most']:.2f}", f"{about['gone']} of {about['seeds']}"]
            for tilt, about in answer["tilts"].items()]
    return ["largest tilt, radians", "least length", "mean", "most", "tentacle gone"], rows


def make(command, folder, page_folder):
    results = [(s, measure(command, s, folder)) for s in SITUATIONS]
    draw(results, page_folder / "images" / "figure_2.svg")
    rows = {}
    for s, r in results:
        rows[f"{s.figure} {s.name}"] = {
            "wanted": s.wanted, "exact_rho_0.9": s.exact_end(0.9), "exact_rho_0": s.exact_end(0), "lengths": r["lengths"],
            "across_voxels": {name: across(s, length, r["voxel"]) for name, length in r["lengths"].items()}, "grown": r["grown"],
            "fill": r["fill"], "certified": r["certified"], "several": r["several"]}
    worst = {name: max(rows.values(), key=lambda row: abs(row["across_voxels"][name]))["across_voxels"][name] for name, _ in TESTS}
    answer = {"situations": rows, "worst_across_voxels": worst,
              "certified": sum(row["certified"] for row in rows.values()),
              "count": len(rows),
              "tilts": tilted_tentacles(command, folder), "tentacle_70": rows["2b tentacle, 70 degrees"]["lengths"]["normal"]}
    return with_tables(answer, main=table(answer), tilt=tilt_table(answer))


def table(answer):
    names = [name for name, _ in TESTS]
    head = ["situation", "it ought to end at", *names, "own-sheet: voxels across the sheet", "grown", "certified"]
    rows = [[name, f"{row['wanted']:.3f}", *(f"{row['lengths'][test]:.3f}" for test in names), f"{row['across_voxels']['own-sheet']:+.1f}",
             f"{row['grown']:.3f}", "yes" if row["certified"] else "**no**"] for name, row in answer["situations"].items()]
    return head, rows
