#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what builds cost, and fits the model behind `vdb_shell estimate`.

    estimate_model.py measure COMMAND MESHES RESULTS.json      builds of all clean meshes; what is there already is kept
    estimate_model.py fit RESULTS.json NUMBERS.h PAGE.md       numbers for src/command/, the table of errors for the page

A build is one of a mesh at a resolution, perhaps subdivided, on one thread, with a .vdb written. Seconds are those of the
processor, so other work on the machine disturbs little. Half of the meshes (every second one of the list) tune the
model, the other half and the scans judge it."""
import datetime
import itertools
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy

sys.path.append(str(pathlib.Path(__file__).resolve().parent))
from runs import CLEAN_MESHES, replace_tables, table  # noqa: E402

SCANS = ["scans/boot", "scans/hammer", "scans/skull"]
RESOLUTIONS = [64, 128, 256]
MOST_FACES = 330000
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
    if faces <= 6000:
        yield {"resolution": 256, "method": "thickest"}
    yield {"resolution": 256, "layers": 3}
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


def features(run):
    """What time, memory and disk are sums of; cost_model.cpp has the same."""
    faces = run["faces"]
    return [1, min(faces, COARSE_FROM), max(faces - COARSE_FROM, 0), run["area"] / run["voxel_size"] ** 2,
            run["solid"] / run["voxel_size"] ** 3, faces * (run.get("layers", 1) - 1)]


def least_squares(a, b):
    """With no negative number: the best of all choices of columns."""
    best, numbers = numpy.inf, None
    for chosen in itertools.product([False, True], repeat=a.shape[1]):
        columns = numpy.flatnonzero(chosen)
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

// Made by docs/scripts/estimate_model.py from {count} builds on {date}, of which every second mesh tuned them, on one
// thread of a machine with {threads} hardware threads ({processor}), Debian 12, release build. docs/farm.md has their errors.

namespace vdb_shell::command
{{

/// For one; for each triangle up to {coarse}; for each one from there; for each voxel of the surface
/// (area over the square of the voxel size); for each voxel of the solid; for each triangle in each
/// layer after the first.
using CostNumbers = std::array<double, 6>;

inline constexpr double kCoarseFrom = {coarse};
/// Processor seconds, bytes.
{lines}

}} // namespace vdb_shell::command
"""
QUANTITIES = {"seconds": "kSecondsNumbers", "memory": "kMemoryNumbers", "vdb": "kVdbNumbers"}


def processor():
    names = [line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")]
    return names[0] if names else "unknown"


def fit(results, header, page):
    everything = [run for run in json.loads(results.read_text()).values() if "seconds" in run]
    # Outward shells and --thickest are not modelled: they are another kind of work.
    runs = [run for run in everything if "side" not in run and "method" not in run]
    tuning = numpy.array([run["mesh"] in CLEAN_MESHES[::2] for run in runs])
    lines, rows = [], []
    for quantity, name in QUANTITIES.items():
        numbers, errors = fitted(runs, quantity, tuning)
        lines.append(f"inline constexpr CostNumbers {name}{{{', '.join('%.4g' % number for number in numbers)}}};")
        for kind, chosen in (("tuning", tuning), ("others", ~tuning)):
            e = errors[chosen]
            rows.append([quantity, kind, str(len(e)), *("%.2f" % numpy.quantile(e, q) for q in (0.5, 0.9, 1)),
                         "%.0f" % (100 * (e <= 1.5).mean())])
    header.write_text(HEADER.format(count=len(runs), date=datetime.date.today(), threads=os.cpu_count(), processor=processor(),
                                    coarse=COARSE_FROM, lines="\n".join(lines)))
    replace_tables(page, table(["what", "meshes", "builds", "median factor", "of 90 %", "largest", "within 1.5, %"], rows),
                   "estimate")


if __name__ == "__main__":
    if sys.argv[1] == "measure":
        measure(sys.argv[2], sys.argv[3], pathlib.Path(sys.argv[4]))
    else:
        fit(*map(pathlib.Path, sys.argv[2:5]))
