# SPDX-License-Identifier: Apache-2.0
"""The paper's sentences on its parameters, its cost and the ripple method, in 3D. Called by paper.py."""
import concurrent.futures
import pathlib
import tempfile

from charts import fitted_exponent
from paper_halves import ALL_MESHES, HALVES, JUDGING, by_half, half_of
from paper_moved import write_moved
from paper_runs import build, figures, stage_seconds, with_tables

MESHES = ["paper/teapot", "paper/cow", "paper/bunny_low_resolution", "paper/propella", "paper/knot", *JUDGING[:-1]]
RAW = ["--method", "raw", "--samples", "20000"]
RHOS = [0.0, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99]
RESOLUTIONS = [64, 128, 256, 512, 1024]
SMOOTH = [0, 1, 2, 5, 10]  # at a resolution of 128: the deep field is rebuilt after the flow
TILTS = [0.0, 0.01, 0.03, 0.1, 0.3]
MOVES, MOVE_SEED = [0.0, 0.001, 0.01, 0.03, 0.1, 0.3], 1  # shares of the least height of a vertex' triangles
COST_RUNS = 3
COST_MESHES = {"paper/cow": 3, "judging/hand_closed": 2}  # and how often each is subdivided: about as many triangles in the end
COST_RESOLUTIONS = [64, 96, 128, 192, 256]
RIPPLE_SEEDS = range(1, 21)
SWEEP_WORDS = {"rho": "rho", "resolution": "resolution", "smooth": "steps of flow", "perturb": "largest tilt, radians",
               "move": "largest move", "test": "stop test"}
TESTS = {"bisection": ["--stop-test", "bisection"], "distance": ["--stop-test", "distance"], "normal": ["--stop-test", "normal"]}


def sweeps():
    """Name of the sweep -> [(value, flags)]."""
    return {"rho": [(rho, ["--rho", str(rho)]) for rho in RHOS],
            "resolution": [(n, ["--resolution", str(n)]) for n in RESOLUTIONS],
            "smooth": [(n, ["--resolution", "128", "--smooth", str(n)]) for n in SMOOTH],
            "move": [(share, []) for share in MOVES],
            "perturb": [(tilt, ["--perturb", str(tilt)]) for tilt in TILTS],
            "test": [(name, flags) for name, flags in TESTS.items()]}


def sweep_jobs():
    for sweep, values in sweeps().items():
        for value, flags in values:
            for name in MESHES:
                yield sweep, value, name, flags


def mean(rows):
    """Means over meshes, and the least fill."""
    keys = ("fill", "stuck_percent", "inverted", "twice_percent", "overlapping_pairs")
    count = len(rows)
    return {"meshes": count, "least_fill": min(row["fill"] for row in rows)} | {key: sum(row[key] for row in rows) / count for key in keys}


def swept(command, files, job):
    """The figures of one job of sweep_jobs()."""
    sweep, value, name, flags = job
    with tempfile.TemporaryDirectory() as scratch:
        mesh = files.path(name)
        if sweep == "move" and value:
            mesh = write_moved(mesh, pathlib.Path(scratch) / "moved.obj", value, MOVE_SEED)
        return figures(build(command, mesh, [*RAW, *flags])[0])


def cost(command, files, name, flags):
    """Steps are exact; seconds are the least of some runs on one thread."""
    flags = ["--method", "raw", "--samples", "0", "--field", "dense", *flags]
    reports = [build(command, files.path(name), flags)[0] for _ in range(COST_RUNS)]
    return {"vertices": reports[0]["mesh"]["points"], "steps": reports[0]["lines"]["steps"],
            "field_seconds": min(stage_seconds(report, "level set") for report in reports),
            "step_seconds": min(stage_seconds(report, "line stepping") for report in reports)}


def line_through(points):
    """Least squares y = a x - b: a, b, and the largest distance of a point from the line in percent of its y."""
    count, sx, sy = len(points), sum(x for x, _ in points), sum(y for _, y in points)
    a = (count * sum(x * y for x, y in points) - sx * sy) / (count * sum(x * x for x, _ in points) - sx * sx)
    b = (a * sx - sy) / count
    return a, b, max(abs(a * x - b - y) / y for x, y in points) * 100


def lost_steps(by_n):
    """The steps against N as a line that starts below zero: what each line loses at its end, whatever N is."""
    a, b, off = line_through([(int(n), row["steps"]) for n, row in by_n.items()])
    vertices = next(iter(by_n.values()))["vertices"]
    return {"steps_a_vertex_and_voxel": a / vertices, "lost_a_vertex": b / vertices, "worst_percent": off}


def make_cost(command, files):
    """One after the other, as they are timed. One mesh of each half."""
    answer = {}
    for name, cuts in COST_MESHES.items():
        by_n = {n: cost(command, files, name, ["--resolution", str(n)]) for n in COST_RESOLUTIONS}
        by_v = {cut: cost(command, files, name, ["--resolution", "128", "--subdivide", str(cut)]) for cut in range(cuts + 1)}
        answer[name] = {"half": half_of(name), "by_resolution": by_n, "by_vertices": by_v, "line": lost_steps(by_n)}
        for key in ("steps", "field_seconds", "step_seconds"):
            answer[name][f"{key}_exponent_in_n"] = fitted_exponent([(n, row[key]) for n, row in by_n.items()])
            answer[name][f"{key}_exponent_in_v"] = fitted_exponent([(row["vertices"], row[key]) for row in by_v.values()])
        last = by_n[COST_RESOLUTIONS[-1]]
        answer[name]["field_over_steps"] = last["field_seconds"] / last["step_seconds"]
    return with_tables({"meshes": answer, "runs": COST_RUNS}, main=cost_table(answer))


def ripple(command, files, name):
    """Thin shells, so that each prism has all its tets. Seeds of the ripple method, and the deterministic rule."""
    flags = ["--method", "raw", "--stop-test", "none", "--thickness", "0.001", "--samples", "0", "--resolution", "64"]
    seen, failed, reports = [], 0, []
    for seed in RIPPLE_SEEDS:
        try:
            report, _ = build(command, files.path(name), [*flags, "--split", "ripple", "--ripple-seed", str(seed)])
        except RuntimeError as error:
            if "ripple" not in str(error):
                raise
            failed += 1
            continue
        seen.append(report["prisms"]["ripples"])
        reports.append(report)
    fixed, _ = build(command, files.path(name), flags)
    return {"prisms": fixed["prisms"]["prisms"], "runs": len(RIPPLE_SEEDS), "failed": failed, "ripples_mean": sum(seen) / max(1, len(seen)),
            "ripples_max": max(seen, default=0), "runs_with_ripples": sum(r > 0 for r in seen),
            "conforming": sum(r["conformity"]["conforming"] for r in reports), "fixed_conforming": fixed["conformity"]["conforming"]}


def make(command, files):
    jobs = list(sweep_jobs())
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        done = list(pool.map(lambda job: swept(command, files, job), jobs))
        ripples = dict(zip(ALL_MESHES, pool.map(lambda name: ripple(command, files, name), ALL_MESHES)))
    answer = {"meshes": {name: half_of(name) for name in MESHES}, "sweeps": {}, "ripple": ripples}
    for (sweep, value, name, _), row in zip(jobs, done):
        answer["sweeps"].setdefault(sweep, {}).setdefault(str(value), {})[name] = row
    for values in answer["sweeps"].values():
        for rows in values.values():
            for half, names in by_half(MESHES).items():
                rows[half] = mean([rows[name] for name in names])
    total = [row for row in ripples.values()]
    answer["ripple_total"] = {key: sum(row[key] for row in total) for key in ("runs", "failed", "runs_with_ripples", "conforming")}
    answer["ripple_total"]["ripples_max"] = max(row["ripples_max"] for row in total)
    answer["ripple_total"]["meshes"] = len(total)
    answer["ripple_total"]["fixed_conforming"] = sum(row["fixed_conforming"] for row in total)
    return with_tables(answer, ripple=ripple_table(answer), fills=fill_table(answer, "resolution", "resolution"),
                       **{sweep: sweep_table(answer, sweep, SWEEP_WORDS[sweep]) for sweep in answer["sweeps"]})


def sweep_table(answer, sweep, name):
    """Means of both halves; the meshes one by one are in the file."""
    words = ("fill", "least", "stuck %", "inverted", "overlapping pairs")
    rows = []
    for value, about in answer["sweeps"][sweep].items():
        rows.append([value])
        for half in HALVES:
            row = about[half]
            rows[-1] += [f"{row['fill']:.3f}", f"{row['least_fill']:.3f}", f"{row['stuck_percent']:.0f}", f"{row['inverted']:.0f}",
                         f"{row['overlapping_pairs']:.0f}"]
    return [name] + [f"{half}: {word}" for half in HALVES for word in words], rows


def fill_table(answer, sweep, name):
    head = [name] + [f"{mesh} ({answer['meshes'][mesh]})" for mesh in MESHES]
    return head, [[value] + [f"{about[mesh]['fill']:.3f}" for mesh in MESHES] for value, about in answer["sweeps"][sweep].items()]


def cost_table(answer):
    head = ["mesh", "half", "grows like", "steps", "seconds of stepping", "seconds of the field"]
    rows = []
    for name, about in answer.items():
        for symbol, words in (("n", "N^b, b ="), ("v", "V^b, b =")):
            rows.append([name, about["half"], words] + [f"{about[f'{key}_exponent_in_{symbol}']:.2f}"
                                                        for key in ("steps", "step_seconds", "field_seconds")])
    return head, rows


def ripple_table(answer):
    head = ["mesh", "half", "prisms", "runs", "runs with ripples", "ripples: mean", "most", "conforming", "not settled"]
    rows = [[name, half_of(name), str(r["prisms"]), str(r["runs"]), str(r["runs_with_ripples"]), f"{r['ripples_mean']:.2f}",
             str(r["ripples_max"]), str(r["conforming"]), str(r["failed"])] for name, r in answer["ripple"].items()]
    return head, rows
