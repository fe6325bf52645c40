#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures distances by tets beside meshToVolume and the deep field, for docs/measurements/distance_fields.md.

    distance_fields.py BUILD_FOLDER MESH_FOLDER docs/measurements/distance_fields.md [--resolution N] [--repeats N] [--only NAME ...]

BUILD_FOLDER is that of a release build with benchmarks (tests/distance_probe). Beside the page stands the same as JSON; meshes that
are there already, with the same resolution, are not run again.
"""
import argparse
import json
import pathlib
import subprocess

from halves import FOLDER, read_halves
from runs import replace_tables, table

LIST = FOLDER / "shape_meshes.txt"
WAYS = {"own_prism": "own prism", "near_prisms": "near prisms", "exact": "exact", "mesh_to_volume": "meshToVolume",
        "deep_field": "deep field"}


def voxels(value):
    return "0" if value == 0 else f"{value:.1g}" if value < 0.01 else f"{value:.2f}"


def ratio(of, over):
    return f"{of['cpu_seconds'] / over['cpu_seconds']:.2f}"


def rows_of(results, half_of):
    fields, frames = [], []
    for name, run in results.items():
        ways, next_frame = run["ways"], run["next_frame"]
        exact, dense, deep = ways["exact"], ways["mesh_to_volume"], ways["deep_field"]
        head = [name.split("/")[-1], half_of[name]]
        fields.append([*head, str(run["triangles"]), f"{run['fill']:.3f}", f"{run['voxels'] / 1e6:.2f}", voxels(run["sampled_error"]),
                       *(f"{voxels(ways[way]['mean_error'])}, {voxels(ways[way]['most_error'])}"
                         for way in ("own_prism", "near_prisms", "mesh_to_volume", "deep_field")),
                       f"{dense['wrong_signs']} ({voxels(dense['deepest_wrong_sign'])})" if dense["wrong_signs"] else "0",
                       f"{exact['cpu_seconds']:.2f}",
                       *(ratio(ways[way], exact) for way in ("own_prism", "near_prisms", "mesh_to_volume", "deep_field")),
                       *(f"{way['peak_mib']:.0f}" for way in (exact, dense, deep))])
        alone = next_frame["exact"]
        frames.append([*head, f"{alone['cpu_seconds']:.2f}", ratio(next_frame["exact_next"], alone),
                       *(cell for way in ("own_prism", "own_prism_next", "near_prisms", "near_prisms_next")
                         for cell in (f"{voxels(next_frame[way]['mean_error'])}, {voxels(next_frame[way]['most_error'])}",
                                      ratio(next_frame[way], alone)))])
    return fields, frames


def summary(results, half_of):
    lines = []
    for half in ("tuning", "judging"):
        runs = [run for name, run in results.items() if half_of[name] == half]
        if not runs:
            continue
        seconds = {way: sum(run["ways"][way]["cpu_seconds"] for run in runs) for way in WAYS}
        peaks = {way: sum(run["ways"][way]["peak_mib"] for run in runs) for way in WAYS}
        wrong = sum(run["ways"]["mesh_to_volume"]["wrong_signs"] for run in runs)
        meshes = sum(run["ways"]["mesh_to_volume"]["wrong_signs"] > 0 for run in runs)
        own = sum(run["ways"][way]["wrong_signs"] for run in runs for way in ("own_prism", "near_prisms", "exact", "deep_field"))
        after = sum(run["next_frame"]["exact_next"]["cpu_seconds"] for run in runs)
        alone = sum(run["next_frame"]["exact"]["cpu_seconds"] for run in runs)
        lines.append(f"- {half}, {len(runs)} meshes: exact distances by tets take {seconds['exact']:.1f} s of CPU time in all, meshToVolume "
                     f"{seconds['mesh_to_volume'] / seconds['exact']:.1f} times that, the deep field "
                     f"{seconds['deep_field'] / seconds['exact']:.1f} times, the bounds {seconds['own_prism'] / seconds['exact']:.2f} and "
                     f"{seconds['near_prisms'] / seconds['exact']:.2f} times; memory {peaks['exact']:.0f} MiB in all, against "
                     f"{peaks['mesh_to_volume']:.0f} and {peaks['deep_field']:.0f}. meshToVolume has {wrong} voxels of a wrong sign, "
                     f"on {meshes} meshes, the others {own}. A frame that begins with the last one's nearest triangles takes "
                     f"{after / alone:.2f} times as long as one that does not.")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("meshes", type=pathlib.Path)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--resolution", type=int, default=256)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--only", nargs="+", help="names without their folder")
    options = parser.parse_args()
    half_of, kept = read_halves(LIST), options.page.with_suffix(".json")
    old = json.loads(kept.read_text()) if kept.exists() else {}
    known = old.get("meshes", {}) if old.get("resolution") == options.resolution else {}
    results = {}
    for name in half_of:
        if options.only and name.split("/")[-1] not in options.only:
            continue
        if name not in known:
            done = subprocess.run([options.build / "tests/distance_probe", options.meshes / f"{name}.obj", str(options.resolution),
                                   str(options.repeats)], check=True, capture_output=True, text=True)
            known[name] = json.loads(done.stdout)
            print(name, known[name]["ways"]["exact"], flush=True)
        results[name] = known[name]
        kept.write_text(json.dumps({"resolution": options.resolution, "meshes": results}, indent=1) + "\n")
    fields, frames = rows_of(results, half_of)
    errors = [f"{WAYS[way]}: mean, most" for way in ("own_prism", "near_prisms", "mesh_to_volume", "deep_field")]
    seconds = [f"{WAYS[way]} / exact" for way in ("own_prism", "near_prisms", "mesh_to_volume", "deep_field")]
    replace_tables(options.page, summary(results, half_of) + ["", "### One field", ""] + table(
        ["mesh", "half", "triangles", "fill", "voxels, millions", "exact, sampled: most", *errors, "meshToVolume: wrong signs (deepest)",
         "exact s", *seconds, "exact MiB", "meshToVolume MiB", "deep field MiB"], fields)
        + ["", "### The next frame", ""] + table(
        ["mesh", "half", "exact alone s", "exact after the last / alone", "own prism: mean, most", "/ exact", "own, after the last",
         "/ exact", "near prisms: mean, most", "/ exact", "near, after the last", "/ exact"], frames))


if __name__ == "__main__":
    main()
