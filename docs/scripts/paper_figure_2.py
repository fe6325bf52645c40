# SPDX-License-Identifier: Apache-2.0
"""The paper's figure 2, from the solids and tests of symmetry_lines.py. Called by paper.py."""
import math

from paper_moved import dot, moved, normals_and_heights, write_moved
from paper_runs import with_tables
from symmetry_lines import TESTS, across, draw, measure, run
from symmetry_shapes import SITUATIONS, write_obj

TILTS, SEEDS = [0.01, 0.03, 0.1, 0.3], range(1, 11)
MOVES = [0.001, 0.01, 0.03, 0.1, 0.3]  # shares of the least height of the triangles around a vertex
PERTURBED = [("cross-over, 20 degrees", 0.9), ("tentacle, 70 degrees", 0.9), ("tentacle, 45 degrees", 0)]  # and rho


def length_of(command, situation, rho, folder, share, tilt, seed):
    """The watched line's length, raw, after moving all vertices (`share`) or tilting all lines (`tilt`)."""
    mesh, flags = folder / "perturbed.obj", ["--method", "raw", "--samples", "0", "--rho", str(rho)]
    write_obj(mesh, situation)
    if share:
        write_moved(mesh, mesh, share, seed)
    if tilt:
        flags += ["--perturb", str(tilt), "--perturb-seed", str(seed)]
    return run(command, mesh, folder, flags)[0].get(situation.watched_vertex(), 0.0)


def turned_degrees(situation, share):
    """The most that moves of the seeds turn the watched vertex's pseudo-normal."""
    points, triangles = situation.mesh()
    vertex = situation.watched_vertex()
    before = normals_and_heights(points, triangles)[0][vertex]
    turns = []
    for seed in SEEDS:
        after = normals_and_heights(moved(points, triangles, share, seed), triangles)[0][vertex]
        turns.append(math.degrees(math.acos(min(1.0, dot(before, after) / math.hypot(*before) / math.hypot(*after)))))
    return max(turns)


def perturbed(command, situation, rho, folder):
    """What random moves of the vertices and tilts of the lines make of one situation: seeds in which the line ends where it ought to."""
    answer = {}
    for kind, values in (("moves", MOVES), ("tilts", TILTS)):
        answer[kind] = {}
        for value in values:
            found = [length_of(command, situation, rho, folder, value * (kind == "moves"), value * (kind == "tilts"), seed) for seed in SEEDS]
            answer[kind][f"{value:g}"] = {"mean": sum(found) / len(found), "least": min(found), "most": max(found), "seeds": len(found),
                                          "gone": sum(length < 1.1 * situation.wanted for length in found)}
            if kind == "moves":
                answer[kind][f"{value:g}"]["turned_degrees"] = turned_degrees(situation, value)
    return answer


def perturbed_table(answer, kind):
    rows = []
    for name, about in answer["perturbed"].items():
        for value, row in about[kind].items():
            rows.append([name, value, f"{row['least']:.2f}", f"{row['mean']:.2f}", f"{row['most']:.2f}", f"{row['gone']} of {row['seeds']}"])
            if kind == "moves":
                rows[-1].append(f"{row['turned_degrees']:.1f}")
    head = ["situation", {"moves": "largest move", "tilts": "largest tilt, radians"}[kind], "least length", "mean", "most", "gone"]
    return head + ["normal turned by at most, degrees"] * (kind == "moves"), rows


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
              "perturbed": {f"{s.name}, rho {rho:g}": perturbed(command, s, rho, folder) for name, rho in PERTURBED for s in SITUATIONS
                            if s.name == name},
              "tentacle_70": rows["2b tentacle, 70 degrees"]["lengths"]["normal"]}
    return with_tables(answer, main=table(answer), move=perturbed_table(answer, "moves"), tilt=perturbed_table(answer, "tilts"))


def table(answer):
    names = [name for name, _ in TESTS]
    head = ["situation", "it ought to end at", *names, "own-sheet: voxels across the sheet", "grown", "certified"]
    rows = [[name, f"{row['wanted']:.3f}", *(f"{row['lengths'][test]:.3f}" for test in names), f"{row['across_voxels']['own-sheet']:+.1f}",
             f"{row['grown']:.3f}", "yes" if row["certified"] else "**no**"] for name, row in answer["situations"].items()]
    return head, rows
