#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures posed shells for docs/measurements/pose.md.

    pose_figures.py BUILD_FOLDER MESH_FOLDER docs/measurements/pose.md [--frames N] [--only NAME ...] [--shells SHELL ...] [--folder FOLDER]

BUILD_FOLDER is that of a release build, with the command and the samples make_motion and pose_frames. Every surface is built with
the defaults, tapered, and for simulation; then it is twisted by half a turn and squashed to half its length, in N frames each, and the sample creature walks in a
hundred. Seconds are those of the processor: of a build the command's, but for the share of the time that reading and writing take; of a
frame those of pose_shell. Beside the page stands the same as JSON. With --only and --shells the other rows stay.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

from runs import replace_tables, table, usage_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Poses were tuned with the first half; the others were only measured.
TUNING = ["creature", "artist/rocker-arm", "paper/knot"]
JUDGING = ["paper/teapot", "paper/jack", "paper/dragon_small_resolution", "paper/bunny_low_resolution", "artist/fandisk",
           "artist/cheburashka", "scans/human_neutral"]
# What `repair` is told where a surface cannot have a shell as it is: this one is open and crosses itself.
REPAIRED = {"scans/human_neutral": ["--cut-crossings"]}

SHELLS = {"untapered": [], "tapered": ["--taper"], "for simulation": ["--for", "simulation"]}


def mesh_of(name, options):
    """The surface, repaired into the folder if it has to be."""
    mesh = ROOT / "samples/meshes/creature.obj" if name == "creature" else options.meshes / f"{name}.obj"
    if name not in REPAIRED:
        return mesh
    repaired = options.folder / mesh.name
    subprocess.run([options.build / "src/vdb_shell", "repair", mesh, *REPAIRED[name], "-o", repaired], check=True,
                   stdout=subprocess.DEVNULL)
    return repaired


def sequence(options, name, motion, frames, kind):
    """The frames' figures, and the seconds of the build."""
    stem = name.split("/")[-1]
    folder = options.folder / f"{stem}-{motion}"
    mesh, shell, report = mesh_of(name, options), options.folder / f"{stem}.vdb", options.folder / f"{stem}.json"
    status, usage = usage_of([options.build / "src/vdb_shell", "build", "-q", mesh, "-o", shell, "--report", report, *SHELLS[kind]])
    if status != 0:
        raise SystemExit(f"{name}: build ended with {status}")
    stages = json.loads(report.read_text())["stages"]
    files = sum(stage["seconds"] for stage in stages if stage["stage"] in ("read", "write"))
    built = (usage.ru_utime + usage.ru_stime) * (1 - files / sum(stage["seconds"] for stage in stages))
    subprocess.run([options.build / "samples/make_motion", mesh, motion, str(frames), folder], check=True)
    lines = subprocess.run([options.build / "samples/pose_frames", shell, *sorted(folder.glob("*.obj"))], check=True,
                           capture_output=True, text=True).stdout
    return {"name": name, "shell": kind, "motion": motion, "triangles": json.loads(report.read_text())["mesh"]["triangles"], "build": built,
            "frames": [json.loads(line) for line in lines.splitlines()]}


def row(result):
    frames = result["frames"]
    embedded = [frame for frame in frames if frame["crossings"] == 0]
    crossing = [frame["certified_tets"] / frame["tets"] for frame in frames if frame["crossings"] > 0]
    seconds = statistics.mean(frame["seconds"] for frame in frames)
    ratios = [frame["jump_ratio"] for frame in frames[1:]]
    tapered = result["shell"] != "untapered"
    # An inverted tet of a tapered shell has up to four points that count as lost; one is enough to know why.
    unasked = [frame for frame in frames
               if (frame["lost"] > 0 and frame["lost_demanded"] == 0 if tapered else frame["lost"] > frame["lost_demanded"])]
    cells = [result["name"].split("/")[-1], *([result["shell"]] if tapered else []), result["motion"],
             "tuning" if result["name"] in TUNING else "judging",
             str(result["triangles"]), f"{sum(frame['certified'] for frame in embedded)} of {len(embedded)}"]
    if tapered:
        cells.append(str(sum(not frame["certified"] and frame["lost_demanded"] > 0 for frame in embedded)))
    return cells + [
        f"{min(crossing):.4f} ({len(crossing)})" if crossing else "",
        str(sum(frame["lost"] > 0 for frame in frames)), str(len(unasked)),
        f"{statistics.mean(frame['distorted'] / frame['tets'] for frame in frames) * 100:.2f}",
        f"{seconds:.2f}", f"{seconds / result['build']:.2f}", f"{statistics.median(frame['jump_99'] for frame in frames[1:]):.2f}",
        f"{statistics.median(ratios):.1f}", f"{max(ratios):.1f}"]


def tables(results):
    start, proof = ["surface"], ["motion", "half", "triangles", "certified, skin embedded"]
    rest = ["least share of tets certified, skin crossing (frames)", "frames with lost pillars", "that the skin does not demand",
            "distorted tets, %", "seconds a frame", "over a build", "jump, 99 %", "jump, median frame", "jump, worst frame"]
    untapered = [row(result) for result in results if result["shell"] == "untapered"]
    tapered = [row(result) for result in results if result["shell"] != "untapered"]
    return [*table(start + proof + rest, untapered), "", "Tapered shells, and those for simulation:", "",
            *table(start + ["shell"] + proof + ["not certified as the skin demands it"] + rest, tapered)]


def order(result):
    return list(SHELLS).index(result["shell"]), (TUNING + JUDGING).index(result["name"]), ["walk", "twist", "squash"].index(result["motion"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("meshes", type=pathlib.Path)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--frames", type=int, default=20)
    parser.add_argument("--only", nargs="+", help="names without their folder")
    parser.add_argument("--shells", nargs="+", choices=SHELLS, default=list(SHELLS))
    parser.add_argument("--folder", type=pathlib.Path, help="for frames and shells; default: a temporary one")
    parser.add_argument("--tables", action="store_true", help="measure nothing, write the tables anew")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        options.folder = options.folder or pathlib.Path(temporary)
        options.folder.mkdir(exist_ok=True)
        page = options.page.with_suffix(".json")
        results = {(old["name"], old["shell"], old["motion"]): old for old in (json.loads(page.read_text()) if page.exists() else [])}
        for name in [] if options.tables else TUNING + JUDGING:
            if options.only and name.split("/")[-1] not in options.only:
                continue
            for kind in options.shells:
                for motion in (["walk"] if name == "creature" else []) + ["twist", "squash"]:
                    result = sequence(options, name, motion, 100 if motion == "walk" else options.frames, kind)
                    results[name, kind, motion] = result
                    print(" | ".join(row(result)), flush=True)
                    # After each, for a run takes an hour.
                    page.write_text(json.dumps(sorted(results.values(), key=order), indent=1) + "\n")
    replace_tables(options.page, tables(sorted(results.values(), key=order)))


if __name__ == "__main__":
    main()
