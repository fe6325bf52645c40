#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds each clean mesh as it is and in seven disguises, and writes the tables of docs/measurements/robustness.md.

    robustness.py COMMAND MESH_FOLDER docs/measurements/robustness.md [--quick] [--results FILE.json]

COMMAND is the vdb_shell binary. --quick leaves out surfaces of more than 5000 triangles. --results keeps the finished
runs in a file and takes them from there the next time; delete it when the command has changed.
"""
import math
import pathlib
import random
import tempfile

from runs import CLEAN_MESHES, METHODS, Results, arguments, build, replace_tables, table
from triangles import cross, minus, read_obj

FLAGS = ["--resolution", "64", "--samples", "20000"]
QUICK_TRIANGLES = 5000
NOISE_SHARE, NOISE_TRIALS = 0.05, 16


def write_obj(path, points, triangles):
    lines = ["v %.17g %.17g %.17g" % point for point in points]
    lines += ["f %d %d %d" % (a + 1, b + 1, c + 1) for a, b, c in triangles]
    path.write_text("\n".join(lines) + "\n")


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a) if length > 0 else a


def rotated(points, triangles, seed):
    # Four independent normal numbers, made a unit quaternion, give every rotation equal chance.
    source = random.Random(seed)
    w, x, y, z = unit(tuple(source.gauss(0, 1) for _ in range(4)))
    rows = [(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))]
    return [tuple(sum(r * c for r, c in zip(row, point)) for row in rows) for point in points], triangles


def scaled(factor):
    return lambda points, triangles, seed: ([tuple(factor * c for c in point) for point in points], triangles)


def translated(points, triangles, seed):
    extent = [max(axis) - min(axis) for axis in zip(*points)]
    shift = 100 * math.sqrt(sum(e * e for e in extent)) / math.sqrt(3)
    return [tuple(c + shift for c in point) for point in points], triangles


def renumbered(points, triangles, seed):
    source = random.Random(seed)
    order = list(range(len(points)))
    source.shuffle(order)
    moved = [None] * len(points)
    for old, new in enumerate(order):
        moved[new] = points[old]
    turned = []
    for triangle in triangles:
        first = source.randrange(3)
        turned.append(tuple(order[triangle[(first + k) % 3]] for k in range(3)))
    source.shuffle(turned)
    return moved, turned


def subdivided(points, triangles, seed):
    points, middles, finer = list(points), {}, []

    def middle(a, b):
        key = (min(a, b), max(a, b))
        if key not in middles:
            middles[key] = len(points)
            points.append(tuple((x + y) / 2 for x, y in zip(points[a], points[b])))
        return middles[key]

    for a, b, c in triangles:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return points, finer


def vertex_normals(points, triangles):
    sums = [(0.0, 0.0, 0.0)] * len(points)
    for triangle in triangles:
        a, b, c = (points[corner] for corner in triangle)
        normal = cross(minus(b, a), minus(c, a))
        for corner in triangle:
            sums[corner] = tuple(s + n for s, n in zip(sums[corner], normal))
    return [unit(s) for s in sums]


def mean_edge(points, triangles):
    lengths = [math.dist(points[t[k]], points[t[(k + 1) % 3]]) for t in triangles for k in range(3)]
    return sum(lengths) / len(lengths)


def noisy(share):
    def disguise(points, triangles, seed):
        source, amplitude = random.Random(seed), share * mean_edge(points, triangles)
        moved = []
        for point, normal in zip(points, vertex_normals(points, triangles)):
            height = amplitude * source.uniform(-1, 1)
            moved.append(tuple(p + height * n for p, n in zip(point, normal)))
        return moved, triangles
    return disguise


DISGUISES = {"rotated": rotated, "x 0.001": scaled(1e-3), "x 1000": scaled(1e3), "100 diagonals away": translated,
             "renumbered": renumbered, "subdivided": subdivided}
VARIANTS = ["as it is", *DISGUISES, "noise"]


def run_disguise(command, source, name, variant, disguise, method):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "mesh.obj"
        write_obj(path, *disguise(*source, f"{name} {variant}"))
        return build(command, path, [*FLAGS, "--method", method])


def run_noise(command, source, name, method):
    share = NOISE_SHARE
    for _ in range(NOISE_TRIALS):
        run = run_disguise(command, source, name, "noise", noisy(share), method)
        if run["exit"] != 4:
            break
        share /= 2
    return dict(run, noise_share=share)


def run_variant(command, path, name, variant, method):
    if variant == "as it is":
        return build(command, path, [*FLAGS, "--method", method])
    source = read_obj(path)
    if variant == "noise":
        return run_noise(command, source, name, method)
    return run_disguise(command, source, name, variant, DISGUISES[variant], method)


def is_quick(path, variant):
    return len(read_obj(path)[1]) * (4 if variant == "subdivided" else 1) <= QUICK_TRIANGLES


def cell(run):
    if run is None:
        return "not run"
    if run["exit"] == 4:
        return "crosses itself in float32" if crosses_itself(run) else "refused"
    if run["exit"] != 0:
        return f"**FAILED, exit {run['exit']}**"
    flaw = "" if run["certified"] and not run["in_several"] and not run["inverted"] else " **FAILED**"
    # The share stands beside a fill only where the first amplitude was too much.
    noise = f" (at {run['noise_share']:.2g})" if run.get("noise_share", NOISE_SHARE) < NOISE_SHARE else ""
    return f"{run['fill']:.3f}{noise}{flaw}"


def crosses_itself(run):
    return any(word in run["message"] for word in ("self-intersect", "intersect", "cross", "degenerate"))


def summary(runs):
    built = [run for run in runs.values() if run["exit"] == 0]
    refused = [run for run in runs.values() if run["exit"] == 4]
    certified = sum(run["certified"] for run in built)
    points, twice = sum(run["samples"] for run in built), sum(run["in_several"] for run in built)
    return [f"{len(runs)} runs: {len(built)} shells built, {certified} of them certified; {len(refused)} inputs refused "
            f"because the rounded surface is no embedded surface; {len(runs) - len(built) - len(refused)} other "
            f"failures. Of {points} Monte Carlo points {twice} lie in two tets.", ""]


def exceptions(runs):
    lines = []
    for key, run in runs.items():
        if run["exit"] != 0:
            lines.append(f"- {key}: exit {run['exit']}, {run['message']}")
        elif not run["certified"] or run["in_several"]:
            lines.append(f"- {key}: not certified: {run['failed']}; {run['in_several']} points in two tets")
    return ["### Exceptions", "", *(lines or ["None."])]


def pins(runs):
    pinned = [f"{key}: {run['pinned']}" for key, run in runs.items() if run.get("pinned") and "thickest" in key]
    return ["### Pinned vertices, `--method thickest`", "", "; ".join(pinned) or "None.", ""]


def write_page(page, runs):
    lines = summary(runs)
    for method in METHODS:
        rows = [[name] + [cell(runs.get(f"{name}, {variant}, {method}")) for variant in VARIANTS]
                for name in CLEAN_MESHES]
        lines += [f"### Fill, `--method {method}`", "", *table(["mesh", *VARIANTS], rows), ""]
    replace_tables(page, lines + pins(runs) + exceptions(runs))


def main():
    options = arguments(__doc__)
    results = Results(options.results)
    jobs = [(name, variant, method) for name in CLEAN_MESHES for variant in VARIANTS for method in METHODS]
    # Small surfaces first: an interrupted series has then done the most it could.
    quick = {(name, variant): is_quick(options.folder / f"{name}.obj", variant) for name, variant, _ in jobs}
    jobs.sort(key=lambda job: not quick[job[:2]])
    for name, variant, method in jobs:
        key = f"{name}, {variant}, {method}"
        if key in results.runs or (options.quick and not quick[name, variant]):
            continue
        run = run_variant(options.command, options.folder / f"{name}.obj", name, variant, method)
        results.keep(key, run)
        print(f"{key}: {cell(run)}, {run['seconds']:.1f} s", flush=True)
        write_page(options.page, results.runs)
    write_page(options.page, results.runs)


if __name__ == "__main__":
    main()
