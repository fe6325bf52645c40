#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what builds, poses and deformations cost, and fits the model behind `vdb_shell estimate`.

    estimate_model.py measure COMMAND MESHES BUILDS.json       builds of all clean meshes; what is there already is kept
    estimate_model.py measure-poses FOLDER MESHES POSES.json   poses of them; FOLDER is that of a release build with its samples
    estimate_model.py fit BUILDS.json NUMBERS.h PAGE.md        numbers for src/command/, the table of errors for the page
    estimate_model.py fit-poses POSES.json NUMBERS.h PAGE.md   the same
Behind the page may stand which build was measured, if not "release build".

A build is one of a mesh at a resolution, perhaps subdivided, on one thread, with a .vdb written. Seconds are those of the
processor, so other work on the machine disturbs little. Every second one of the clean meshes and two of three scans, as they are, tune
the model; the other half, the third scan and what was subdivided judge it.

A pose is that of a shell twisted by a quarter turn, with a .vdb written; a deformation carries the fog volume "depth" of the shell at rest
into it. Both on one thread."""
import datetime
import itertools
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy

sys.path.append(str(pathlib.Path(__file__).resolve().parent))
from runs import CLEAN_MESHES, replace_tables, table  # noqa: E402

SCANS = ["scans/boot", "scans/hammer", "scans/skull"]
TUNING = [*CLEAN_MESHES[::2], "scans/boot", "scans/skull"]
RESOLUTIONS = [64, 128, 256]
MOST_FACES = 330000
# Kinds of work, by what numbers are called.
WORK = {"": {}, "Speed": {"for": "speed"}, "Thickest": {"method": "thickest"}}
# From so many triangles on growth begins on a coarser surface (--coarse-from).
COARSE_FROM = 5000


def size_of(mesh):
    """Triangles, area, longest side of the box."""
    points, faces = [], []
    for line in mesh.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
            faces += [[corners[0], b, c] for b, c in zip(corners[1:], corners[2:])]
    p, f = numpy.array(points), numpy.array(faces)
    area = 0.5 * numpy.linalg.norm(numpy.cross(p[f[:, 1]] - p[f[:, 0]], p[f[:, 2]] - p[f[:, 0]]), axis=1).sum()
    used = p[numpy.unique(f)]
    return len(faces), float(area), float((used.max(axis=0) - used.min(axis=0)).max())


def variants(faces):
    """Words, and what they are to the model."""
    for resolution in RESOLUTIONS:
        yield {"resolution": resolution}
    for rounds in (1, 2):
        if 1000 <= faces << (2 * rounds) <= MOST_FACES:
            yield {"resolution": 256, "subdivide": rounds}
    for more in WORK.values():
        if more:
            yield from ({"resolution": resolution, **more} for resolution in RESOLUTIONS)
            if 1000 <= faces << 2 <= MOST_FACES:
                yield {"resolution": 256, "subdivide": 1, **more}
        yield {"resolution": 256, "layers": 3, **more}
    yield {"resolution": 256, "side": "both"}


def measured(command, mesh, variant):
    words = [word for key, value in variant.items() for word in (f"--{key}", str(value))]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        child = subprocess.Popen([command, "--threads", "1", "build", "-q", mesh, "-o", folder / "s.vdb", "-o", folder / "s.vtu",
                                  "--report", folder / "s.json", *words], stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode not in (0, 7):
            return {"status": child.returncode}
        report = json.loads((folder / "s.json").read_text())
        return {"status": child.returncode, "seconds": usage.ru_utime + usage.ru_stime,
                "memory": max(stage["peak_memory_bytes"] for stage in report["stages"]),
                "vdb": (folder / "s.vdb").stat().st_size, "vtu": (folder / "s.vtu").stat().st_size, "tets": report["tets"],
                "voxel_size": report["field"]["voxel_size"], "solid": report["volume"]["solid"],
                "outside": report["volume"]["outside"], "points": report["mesh"]["points"]}


def measure(command, meshes, results):
    known = json.loads(results.read_text()) if results.exists() else {}
    for name in CLEAN_MESHES + SCANS:
        mesh = pathlib.Path(meshes) / (name + ".obj")
        faces, area, side = size_of(mesh)
        for variant in variants(faces):
            key = name + json.dumps(variant)
            if key not in known:
                known[key] = {"mesh": name, "faces": faces << (2 * variant.get("subdivide", 0)), "area": area, "box": side,
                              **variant, **measured(command, mesh, variant)}
                results.write_text(json.dumps(known, indent=1))
                print(key, known[key].get("seconds"), flush=True)


def timed(words):
    """Processor seconds and largest memory of a command, which may end with 7: a pose that is not certified throughout."""
    child = subprocess.Popen([*map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode not in (0, 7):
        raise SystemExit(f"{words}: ended with {child.returncode}")
    return {"seconds": usage.ru_utime + usage.ru_stime, "memory": usage.ru_maxrss * 1024}


def posed(build, mesh, variant):
    command = build / "src/vdb_shell"
    options = [word for key, value in variant.items() for word in (f"--{key}", str(value))]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        subprocess.run([command, "build", "-q", mesh, "-o", folder / "r.vdb", "--report", folder / "r.json", *options], check=True)
        subprocess.run([build / "samples/make_motion", mesh, "twist", "3", folder / "frames"], check=True)
        skin = sorted((folder / "frames").glob("*.obj"))[1]
        one = [command, "--threads", "1"]
        pose = timed([*one, "pose", "-q", folder / "r.vdb", skin, "-o", folder / "p.vdb", "--report", folder / "p.json"])
        deform = timed([*one, "deform", "-q", folder / "r.vdb", "--grid", "depth", "--posed", folder / "p.vdb", "-o", folder / "d.vdb",
                        "--report", folder / "d.json"])
        built, report = (json.loads((folder / name).read_text()) for name in ("r.json", "p.json"))
        faces, area, _ = size_of(skin)
        carried = json.loads((folder / "d.json").read_text())["grids"][0]
        common = {"faces": faces, **variant}
        return [{"command": "pose", **common, "area": area, "solid": report["volume"]["solid"], "voxel_size": built["field"]["voxel_size"],
                 "vdb": (folder / "p.vdb").stat().st_size, **pose},
                {"command": "deform", **common, "voxels": carried["active_before"], "vdb": (folder / "d.vdb").stat().st_size, **deform}]


def measure_poses(build, meshes, results):
    known = json.loads(results.read_text()) if results.exists() else {}
    for name in CLEAN_MESHES + SCANS[:1]:
        mesh = pathlib.Path(meshes) / (name + ".obj")
        for variant in ({"resolution": 64}, {"resolution": 128}, {"resolution": 128, "layers": 3}):
            key = name + json.dumps(variant)
            if key not in known:
                known[key] = [{"mesh": name, **run} for run in posed(build, mesh, variant)]
                results.write_text(json.dumps(known, indent=1))
                print(key, *(run["seconds"] for run in known[key]), flush=True)


def features(run):
    """What time, memory and disk are sums of; cost_model.cpp has the same."""
    faces = run["faces"]
    if "voxels" in run:
        return [1, min(faces, COARSE_FROM), max(faces - COARSE_FROM, 0), run["voxels"], 0, faces * (run.get("layers", 1) - 1)]
    return [1, min(faces, COARSE_FROM), max(faces - COARSE_FROM, 0), run["area"] / run["voxel_size"] ** 2,
            run["solid"] / run["voxel_size"] ** 3, faces * (run.get("layers", 1) - 1)]


def least_squares(a, b):
    """With no negative number: the best of all choices of columns."""
    best, numbers = numpy.inf, None
    for chosen in itertools.product([False, True], repeat=a.shape[1]):
        columns = numpy.flatnonzero(chosen)
        if not a[:, columns].any(axis=0).all():
            continue  # what these runs have not says nothing
        x = numpy.linalg.lstsq(a[:, columns], b, rcond=None)[0] if len(columns) else numpy.zeros(0)
        error = ((a[:, columns] @ x - b) ** 2).sum()
        if (x >= 0).all() and error < best:
            best, numbers = error, numpy.zeros(a.shape[1])
            numbers[columns] = x
    return numbers


def fitted(runs, quantity, tuning):
    """Numbers for the least sum of squares of relative errors over the tuning runs; the factor by which each run is
    missed."""
    x, y = numpy.array([features(run) for run in runs], float), numpy.array([run[quantity] for run in runs], float)
    numbers = least_squares((x / y[:, None])[tuning], numpy.ones(tuning.sum()))
    estimate = x @ numbers
    return numbers, numpy.maximum(estimate / y, y / estimate)


HEADER = """// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

// Made by docs/scripts/estimate_model.py, of which every second mesh tuned them; docs/farm.md has
// their errors. On one thread, Debian 12:
{sources}

namespace vdb_shell::command
{{

/// For one; for each triangle up to kCoarseFrom; for each one from there; for each voxel of the
/// surface (area over the square of the voxel size), of deformations for each one of the volume; for
/// each voxel of the solid; for each triangle in each layer after the first.
using CostNumbers = std::array<double, 6>;

inline constexpr double kCoarseFrom = {coarse};
/// Processor seconds, bytes.
{lines}

}} // namespace vdb_shell::command
"""
QUANTITIES = {"seconds": "SecondsNumbers", "memory": "MemoryNumbers", "vdb": "VdbNumbers"}
SOURCE = "// - {}: {} on {}, {}, {} hardware threads ({})"
HEAD = ["what", "meshes", "runs", "median factor", "of 90 %", "largest", "within 1.5, %"]


def processor():
    names = [line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")]
    return names[0] if names else "unknown"


def lines_and_rows(runs, prefix, words, quantities=QUANTITIES):
    """Numbers as the header has them, by name; rows of the table of errors."""
    # Subdivided surfaces judge only: those that come in such sizes are rougher, and growth goes on longer on them.
    tuning = numpy.array([run["mesh"] in TUNING and "subdivide" not in run for run in runs])
    lines, rows = {}, []
    for quantity in quantities:
        name = QUANTITIES[quantity]
        numbers, errors = fitted(runs, quantity, tuning)
        name = f"k{prefix}{name}"
        lines[name] = f"inline constexpr CostNumbers {name}{{{', '.join('%.4g' % number for number in numbers)}}};"
        for kind, chosen in (("tuning", tuning), ("others", ~tuning)):
            e = errors[chosen]
            rows.append([words + quantity, kind, str(len(e)), *("%.2f" % numpy.quantile(e, q) for q in (0.5, 0.9, 1)),
                         "%.0f" % (100 * (e <= 1.5).mean())])
    return lines, rows


def write_numbers(header, made, sources):
    """Replaces what was fitted and leaves the other numbers, and what they were made from, as they are."""
    old = header.read_text()
    lines = {line.split()[3].split("{")[0]: line for line in re.sub(r",\n +", ", ", old).splitlines()
             if line.startswith("inline constexpr CostNumbers")}
    lines.update(made)
    told = {line.split(":")[0]: line for line in re.findall(r"^// - .*$", old, re.M)}
    told.update({line.split(":")[0]: line for line in sources})
    header.write_text(HEADER.format(sources="\n".join(told.values()), coarse=COARSE_FROM, lines="\n".join(lines.values())))


def source(what, count, build):
    return SOURCE.format(what, count, datetime.date.today(), build, os.cpu_count(), processor())


def fit(results, header, page, build):
    # Outward shells are not modelled: they are another kind of work.
    everything = [run for run in json.loads(results.read_text()).values() if "seconds" in run and "side" not in run]
    made, rows = {}, []
    for prefix, more in WORK.items():
        runs = [run for run in everything if all(run.get(key) == more.get(key) for key in ("for", "method"))]
        # A .vdb is as large whatever it took to make.
        lines, errors = lines_and_rows(runs, prefix, f"{prefix.lower()}: " * bool(prefix), ["seconds", "memory"] if prefix else QUANTITIES)
        made.update(lines)
        rows += errors
    write_numbers(header, made, [source("builds", len(everything), build)])
    replace_tables(page, table(HEAD, rows), "estimate")


def fit_poses(results, header, page, build):
    everything = [run for runs in json.loads(results.read_text()).values() for run in runs]
    made, rows, sources = {}, [], []
    for command, prefix in (("pose", "Pose"), ("deform", "Deform")):
        runs = [run for run in everything if run["command"] == command]
        lines, more = lines_and_rows(runs, prefix, command + ": ")
        made.update(lines)
        rows += more
        sources.append(source({"pose": "poses", "deform": "deformations"}[command], len(runs), build))
    write_numbers(header, made, sources)
    replace_tables(page, table(HEAD, rows), "estimate-poses")


if __name__ == "__main__":
    paths = [pathlib.Path(word) for word in sys.argv[2:5]]
    if sys.argv[1].startswith("fit"):
        {"fit": fit, "fit-poses": fit_poses}[sys.argv[1]](*paths, sys.argv[5] if len(sys.argv) > 5 else "release build")
    else:
        {"measure": measure, "measure-poses": measure_poses}[sys.argv[1]](*paths)
