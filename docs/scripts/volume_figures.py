#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures volumes that go through posed shells, for docs/measurements/volumes.md.

    volume_figures.py BUILD_FOLDER MESH_FOLDER docs/measurements/volumes.md [--only NAME ...]

BUILD_FOLDER is that of a release build with -DVDB_SHELL_BENCHMARKS=ON. Every surface is built with the defaults and twisted and squashed
by the sample make_motion; the last frame but one of each is measured by volume_probe. Beside the page stands the same as JSON.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

from runs import replace_tables, table
from volume_meshes import JUDGING, TUNING, half, path

FRAMES, MEASURED = 8, 4
# The creature's walk: its elbows are bent most in the middle.
WALK_FRAMES, WALK_MEASURED = 100, (12, 37, 62, 87)  # frames from 0


def measure(options, name, motion, folder, count=FRAMES, frame=MEASURED):
    mesh = path(options.meshes, name)
    command = options.build / "src/vdb_shell"
    shell, posed = folder / "rest.vdb", folder / "posed.vdb"
    frames = folder / "frames"
    subprocess.run([command, "build", "-q", mesh, "-o", shell], check=True)
    subprocess.run([options.build / "samples/make_motion", mesh, motion, str(count), frames], check=True)
    # 7 is a pose that is not certified throughout; it is measured as it is.
    status = subprocess.run([command, "pose", "-q", shell, sorted(frames.glob("*.obj"))[frame], "-o", posed], check=False).returncode
    if status not in (0, 7):
        raise SystemExit(f"{name}: pose ended with {status}")
    text = subprocess.run([options.build / "tests/volume_probe", posed], check=True, capture_output=True, text=True).stdout
    return {"name": name, "motion": motion if count == FRAMES else f"{motion}, frame {frame + 1}", **json.loads(text)}


def rows(results):
    head = ["mesh", "motion", "half", "voxels", "prisms", "linear", "there and back, mean", ".999", "most", "values, mean", "most"]
    points = [[r["name"].split("/")[-1], r["motion"], half(r["name"]), f"{r['voxels']}",
               f"{r['prisms']:.0f}", f"{r['linear_prisms']:.0f}", f"{r['round_trip_mean_voxels']:.1e}", f"{r['round_trip_99.9_voxels']:.1e}",
               f"{r['round_trip_most_voxels']:.1e}", f"{r['volume_there_and_back_mean']:.4f}",
               f"{r['volume_there_and_back_most']:.3f}"] for r in results]
    jumps = [[r["name"].split("/")[-1], r["motion"], f"{r['jump_linear_within_prisms']:.3f}", f"{r['jump_within_prisms']:.3f}",
              f"{r['jump_linear_between_prisms']:.3f}", f"{r['jump_between_prisms']:.3f}", f"{100 * r['mass_change']:+.2f}",
              f"{r['identity_differing_voxels']:.0f}", f"{r['aliasing_unfiltered']:.3f}", f"{r['aliasing']:.3f}"] for r in results]
    speed = [[r["name"].split("/")[-1], r["motion"], f"{r['time_ratio_per_voxel']:.2f}",
              f"{r['queries_in_order_million_per_second']:.2f}",
              f"{r['queries_in_disorder_million_per_second']:.2f}"] for r in results]
    return (["### There and back", "", *table(head, points), "", "### Borders, mass, aliasing", "",
             *table(["mesh", "motion", "jump within prisms, tets", "prisms", "between, tets", "prisms", "mass %", "identity: other voxels",
                     "checkerboard, one sample", "filtered"], jumps), "", "### Time", "",
             *table(["mesh", "motion", "over resampleToMatch, a voxel", "million points a second, in order", "in disorder"], speed)])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("meshes", type=pathlib.Path)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--only", nargs="+", help="names without their folder")
    options = parser.parse_args()
    results = []
    for name in TUNING + JUDGING:
        if options.only and name.split("/")[-1] not in options.only:
            continue
        runs = [("twist", FRAMES, MEASURED), ("squash", FRAMES, MEASURED)]
        if name == "creature":
            runs += [("walk", WALK_FRAMES, frame) for frame in WALK_MEASURED]
        for motion, count, frame in runs:
            with tempfile.TemporaryDirectory() as folder:
                results.append(measure(options, name, motion, pathlib.Path(folder), count, frame))
    if options.only:
        print(json.dumps(results, indent=1))
        return
    options.page.with_suffix(".json").write_text(json.dumps(results, indent=1) + "\n")
    replace_tables(options.page, rows(results))


main()
