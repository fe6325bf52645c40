#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures fill, CPU seconds and quality of the clean meshes, and writes the tables of docs/measurements/thickness.md.

    thickness.py COMMAND MESH_FOLDER docs/measurements/thickness.md [--quick] [--results FILE.json] [--tables NAME ...]

COMMAND is the vdb_shell binary. --quick leaves out the meshes of more than 5000 triangles. --results keeps the
finished runs in a file and takes them from there the next time; delete it when the command has changed. --tables
measures and replaces only those named: methods (with the levers), layers, scale, quality.
"""
from runs import CLEAN_MESHES, METHODS, Results, arguments, build, replace_tables, table

FLAGS = ["--resolution", "128", "--samples", "20000"]
BIG_MESHES = ["paper/knot", "artist/fandisk", "artist/cheburashka", "artist/rocker-arm"]
LEVER_MESHES = ["paper/diku", "paper/lamp", "paper/glass", "paper/cow", "paper/bunny_low_resolution"]
LEVERS = ["--no-free-moves", "--no-soft-contacts", "--no-smooth-directions", "--no-flips", "--no-top-down",
          "--no-grow-lines", "--no-mend-directions"]
STACK_MESHES = ["paper/cow", "paper/lamp", "paper/diku", "paper/teapot", "paper/knot", "artist/fandisk"]
LAYERS = ["--layers", "3", "--layer-grading", "2"]
FACTORS = ["0.9", "0.5"]
QUALITY_MESHES = ["paper/diku", "paper/cow", "paper/lamp", "paper/teapot"]
BOUNDS = ["0", "0.01", "0.02", "0.05", "0.1", "0.2"]


def cells(run):
    if run is None:
        return ["not run", ""]
    if run["exit"] != 0:
        return [f"**FAILED, exit {run['exit']}**", ""]
    flaw = "" if run["certified"] and not run["in_several"] else " **FAILED**"
    return [f"{run['fill']:.3f}{flaw}", f"{run['seconds']:.1f}"]


def method_rows(runs):
    rows = []
    for name in CLEAN_MESHES:
        found = [runs.get(f"{name}, {method}") for method in METHODS]
        triangles = next((str(run["triangles"]) for run in found if run and run["exit"] == 0), "")
        rows.append([name, triangles] + [text for run in found for text in cells(run)])
    return rows


def mean_lines(runs):
    lines = []
    for method in METHODS:
        found = {name: runs.get(f"{name}, {method}") for name in CLEAN_MESHES}
        fills = {name: run["fill"] for name, run in found.items()
                 if name.startswith("paper/") and run and run["exit"] == 0}
        if fills:
            low = min(fills, key=fills.get)
            lines.append(f"`{method}`, {len(fills)} `paper/` meshes: mean fill {sum(fills.values()) / len(fills):.4f}, "
                         f"least {fills[low]:.3f} ({low}).")
    return lines


def lever_rows(runs):
    rows = []
    for lever in ["all on", *LEVERS]:
        found = [runs.get(f"{name}, {lever}") if lever != "all on" else runs.get(f"{name}, thickest")
                 for name in LEVER_MESHES]
        rows.append([f"`{lever}`" if lever.startswith("-") else lever] + [text for run in found for text in cells(run)])
    return rows


def failure(run):
    """None for a certified shell without overlap, else what the cell says instead of figures."""
    if run is None:
        return "not run"
    if run["exit"] != 0:
        return f"**FAILED, exit {run['exit']}**"
    return None if run["certified"] and not run["in_several"] else "**FAILED**"


def layer_rows(runs):
    rows = []
    for name in STACK_MESHES:
        for method in METHODS:
            run, whole = runs.get(f"{name}, {method}, layers"), runs.get(f"{name}, {method}, one layer")
            flaw = failure(run) or failure(whole)
            rows.append([name, method] + ([flaw] + [""] * 6 if flaw else [
                "yes", str(run["tets"]), str(run["uncut"]), str(run["moved"]), f"{whole['min_ratio']:.1e}",
                f"{run['min_ratio']:.1e}", f"{run['seconds'] - whole['seconds']:.1f}"]))
    return rows


def scale_rows(runs):
    rows = []
    for name in STACK_MESHES:
        for method in METHODS:
            whole = runs.get(f"{name}, {method}, one layer")
            row = [name, method, failure(whole) or f"{whole['fill']:.3f}"]
            for factor in FACTORS:
                run = runs.get(f"{name}, {method}, scale {factor}")
                flaw = failure(run)
                row += [flaw, "", ""] if flaw else [
                    f"{run['fill']:.3f}", str(run["shortened"]), f"{run['min_ratio']:.1e}"]
            rows.append(row)
    return rows


def quality_rows(runs):
    rows = []
    for name in QUALITY_MESHES:
        for method in METHODS:
            for bound in BOUNDS:
                run = runs.get(f"{name}, {method}, quality {bound}")
                flaw = failure(run)
                rows.append([name, method, bound] + ([flaw] + [""] * 4 if flaw else [
                    f"{run['fill']:.3f}", f"{run['min_ratio']:.1e}", f"{run['p1_ratio']:.4f}",
                    f"{run['tets_below']} of {run['tets']}", f"{run['seconds']:.1f}"]))
    return rows


def write_methods(page, runs):
    runs = {key: run for key, run in runs.items() if key.count(",") == 1}
    built = [run for run in runs.values() if run["exit"] == 0]
    certified = sum(run["certified"] for run in built)
    head = ["mesh", "triangles"] + [f"{method} {what}" for method in METHODS for what in ("fill", "CPU s")]
    lever_head = ["levers"] + [f"{name.split('/')[1]} {what}" for name in LEVER_MESHES for what in ("fill", "CPU s")]
    replace_tables(page, [
        f"{len(runs)} runs, {len(built)} shells built, {certified} certified.", "", "### Methods", "",
        *table(head, method_rows(runs)), "", *mean_lines(runs), "",
        "### Levers, `--method thickest` with one lever off", "", *table(lever_head, lever_rows(runs))])


def write_layers(page, runs):
    head = ["mesh", "method", "certified", "tets", "uncut pillars", "moved points", "worst mean ratio, 1 layer",
            "3 layers", "CPU s more"]
    replace_tables(page, table(head, layer_rows(runs)), "layers")


def write_scale(page, runs):
    head = ["mesh", "method", "fill at 1"] + [
        f"{what} {factor}" for factor in FACTORS for what in ("fill at", "shortened at", "worst mean ratio at")]
    replace_tables(page, table(head, scale_rows(runs)), "scale")


def write_quality(page, runs):
    head = ["mesh", "method", "Q", "fill", "worst mean ratio", "1 % under", "tets below Q", "CPU s"]
    replace_tables(page, table(head, quality_rows(runs)), "quality")


WRITERS = {"methods": write_methods, "layers": write_layers, "scale": write_scale, "quality": write_quality}


def method_jobs():
    jobs = [(name, method, method, []) for name in CLEAN_MESHES for method in METHODS if name not in BIG_MESHES]
    jobs += [(name, lever, "thickest", [lever]) for name in LEVER_MESHES for lever in LEVERS]
    return jobs + [(name, method, method, []) for name in BIG_MESHES for method in METHODS]


def series(meshes, title, flags):
    return [(name, f"{method}, {title}", method, flags) for name in meshes for method in METHODS]


def jobs_of(tables):
    """The runs that the tables need: mesh, title, method, flags."""
    jobs = method_jobs() if "methods" in tables else []
    if "layers" in tables or "scale" in tables:
        jobs += series(STACK_MESHES, "one layer", [])
    if "layers" in tables:
        jobs += series(STACK_MESHES, "layers", LAYERS)
    if "scale" in tables:
        for factor in FACTORS:
            jobs += series(STACK_MESHES, f"scale {factor}", ["--thickness-scale", factor])
    if "quality" in tables:
        for bound in BOUNDS:
            jobs += series(QUALITY_MESHES, f"quality {bound}", ["--min-quality", bound])
    return jobs


def main():
    options = arguments(__doc__, list(WRITERS))
    results = Results(options.results)
    for name, title, method, extra in jobs_of(options.tables):
        key = f"{name}, {title}"
        if key in results.runs or options.quick and name in BIG_MESHES:
            continue
        run = build(options.command, options.folder / f"{name}.obj", [*FLAGS, "--method", method, *extra])
        results.keep(key, run)
        print(f"{key}: {cells(run)}", flush=True)
    for name in options.tables:
        WRITERS[name](options.page, results.runs)


if __name__ == "__main__":
    main()
