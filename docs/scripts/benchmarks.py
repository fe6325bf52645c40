#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures whole commands against each other and the stages by themselves; writes the tables of docs/measurements/benchmarks.md.

    benchmarks.py COMMAND MESH_FOLDER docs/measurements/benchmarks.md [--suite PROGRAM] [--quick] [--minutes N] [--timeout SECONDS]
                  [--rounds N] [--bout-seconds SECONDS] [--results FILE.json] [--tables NAME ...]

COMMAND is the vdb_shell binary. --suite is the program vdb_shell_benchmarks; without it the table of stages is left as
it is. --quick runs a few small surfaces once, for a first look. The surfaces come in the order of --tables, and what
--minutes leaves no time for is left out. --results keeps what was measured in a file and takes it from there the next
time; delete it when the command has changed. Programs that are not installed are reported as such.

On each surface the commands take turns for --rounds rounds, or fewer once those took --bout-seconds. Ratios are made
round by round; all figures are medians.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import bench_tables
from bench_commands import DEEP, NOT_INSTALLED, OURS, LEVEL_SET, RIVALS, Job, run_once
from runs import CLEAN_MESHES, Results, arguments

SCALE_MESH = "paper/cow"
# Edges are cut into this many parts: 1,500 to 1,014,000 triangles.
PARTS = [1, 2, 4, 6, 8, 16, 26]
QUICK_PARTS, THREAD_PARTS = [1, 2], 8
RESOLUTION_MESHES, RESOLUTIONS = ["paper/cow", "artist/fandisk"], [64, 128, 256, 512, 1024]
QUICK_MESHES = ["paper/teapot", "paper/cow", "paper/torus"]
# The dense interior grows with the cube: at 1024 it would be gigabytes.
LARGEST_DEEP_RESOLUTION = 512
# Among surfaces of growing size, a rival that took longer than this is not asked again.
LONGEST_RIVAL = 30
# Where growth begins on coarser surfaces, and two ways to have it otherwise.
STARTS = {"from lines": ["--coarse-from", "0"], "default": [], "asked for more": ["--free-rounds", "40"]}
STARTED = [("paper/jack", 2), ("paper/lamp", 3), ("paper/knot", 1), ("paper/dragon_small_resolution", 2),
           ("paper/cow", 2), ("paper/diku", 5), ("paper/glass", 3), ("paper/sphere", 4), ("paper/torus", 2),
           ("artist/fandisk", 1), ("artist/cheburashka", 1), ("artist/rocker-arm", 1), ("paper/cow", 6)]
OPTIONS = [("--suite", {}), ("--minutes", {"type": float, "default": 16.0}),
           ("--timeout", {"type": float, "default": 120.0}), ("--rounds", {"type": int, "default": 5}),
           ("--bout-seconds", {"type": float, "default": 12.0})]


class Clock:
    def __init__(self, options):
        self.end = time.monotonic() + 60 * options.minutes
        self.timeout = options.timeout

    def left(self):
        return self.end - time.monotonic()


def add_run(found, run):
    """Lists by round; a failure ends them."""
    for key, value in run.items():
        if key in ("wall", "cpu", "peak", "floor", "stages"):
            found.setdefault(key, []).append(value)
        else:
            found[key] = value


def bout(jobs, options, clock):
    """`jobs`: name -> (command, Job). name -> figures by round, or None when there was no time for one round."""
    found, begin = {name: {} for name in jobs}, time.monotonic()
    for round_index in range(1 if options.quick else options.rounds):
        if round_index and (time.monotonic() - begin > options.bout_seconds or clock.left() < 0):
            break
        for name, (command, job) in jobs.items():
            if clock.left() < 0 and not round_index:
                return None
            if "failed" not in found[name]:
                add_run(found[name], run_once(command, job, clock.timeout))
    return dict(found, quick=options.quick)


def prepare(options, name, parts, folder):
    """Writes the surface in all formats. Its number of triangles."""
    script = pathlib.Path(__file__).with_name("bench_surfaces.py")
    made = subprocess.run([sys.executable, str(script), str(options.folder / f"{name}.obj"), str(parts), str(folder)],
                          check=True, capture_output=True, text=True)
    return int(made.stdout)


def say(key, found):
    cells = []
    for name, figures in found.items():
        if isinstance(figures, dict):
            cells.append(f"{name} {bench_tables.seconds(figures)}")
    print(f"{key}: {', '.join(cells)}", flush=True)


class Series:
    """Bouts, each kept as soon as it is finished."""

    def __init__(self, options):
        self.options, self.clock, self.results = options, Clock(options), Results(options.results)
        self.command = str(pathlib.Path(options.command).resolve())

    def run(self, key, name, parts, jobs_of):
        """`jobs_of` (folder, mesh) gives the jobs of the bout."""
        if key in self.results.runs or self.clock.left() < 0:
            return self.results.runs.get(key)
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            faces = prepare(self.options, name, parts, folder)
            # The user's own file where there is one: reading is part of the time that a user waits.
            mesh = folder / "surface.obj" if parts > 1 else (self.options.folder / f"{name}.obj").resolve()
            found = bout(jobs_of(folder, mesh), self.options, self.clock)
        if found is not None:
            self.results.keep(key, dict(found, faces=faces))
            say(key, found)
        return found

    def against(self, key, name, parts, rivals, resolution=256):
        return self.run(key, name, parts, lambda folder, mesh: {
            command: (command, Job(self.command, mesh, folder, resolution)) for command in [OURS, *rivals]})


def still_quick_enough(rivals, found):
    """Those that a larger surface is tried with."""
    def keep(name):
        figures = (found or {}).get(name, {})
        if "failed" in figures:
            return figures["failed"] == NOT_INSTALLED
        return max(figures.get("wall", [0])) < LONGEST_RIVAL
    return [name for name in rivals if keep(name)]


def measure_clean(series):
    for name in QUICK_MESHES if series.options.quick else CLEAN_MESHES:
        series.against(f"clean, {name}", name, 1, RIVALS)


def measure_faces(series):
    rivals = [name for name in RIVALS if name != DEEP]
    for parts in QUICK_PARTS if series.options.quick else PARTS:
        found = series.against(f"faces, {parts}", SCALE_MESH, parts, rivals)
        rivals = still_quick_enough(rivals, found)


def measure_threads(series):
    parts = QUICK_PARTS[-1] if series.options.quick else THREAD_PARTS
    series.run("threads", SCALE_MESH, parts, lambda folder, mesh: {
        f"{threads}": (OURS, Job(series.command, mesh, folder, threads=threads)) for threads in (1, 2)})


def measure_resolutions(series):
    for name in QUICK_MESHES[1:2] if series.options.quick else RESOLUTION_MESHES:
        rivals = [LEVEL_SET, DEEP]
        for resolution in RESOLUTIONS[:2] if series.options.quick else RESOLUTIONS:
            if resolution > LARGEST_DEEP_RESOLUTION:
                rivals = [LEVEL_SET]
            found = series.against(f"resolutions, {name}, {resolution}", name, 1, rivals, resolution)
            rivals = still_quick_enough(rivals, found)


def measure_starts(series):
    for name, parts in STARTED[2:5:2] if series.options.quick else STARTED:
        series.run(f"starts, {name}, {parts}", name, parts, lambda folder, mesh: {
            start: (OURS, Job(series.command, mesh, folder, options=options)) for start, options in STARTS.items()})


def measure_stages(series):
    options = series.options
    if not options.suite or "suite" in series.results.runs or series.clock.left() < 0:
        return
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "suite.json"
        flags = ["--benchmark_filter=/(1280|3072)/", "--benchmark_min_time=0.01"] if options.quick else [
            "--benchmark_min_time=0.1", "--benchmark_repetitions=3", "--benchmark_report_aggregates_only=true"]
        try:
            subprocess.run([options.suite, *flags, f"--benchmark_out={out}", "--benchmark_out_format=json"],
                           stdout=subprocess.DEVNULL, check=True, timeout=60 + max(series.clock.left(), 0))
        except subprocess.TimeoutExpired:
            print("stages: no time left", flush=True)
            return
        series.results.keep("suite", {"quick": options.quick, "runs": json.loads(out.read_text())["benchmarks"]})


MEASURES = {"clean": measure_clean, "faces": measure_faces, "threads": measure_threads,
            "resolutions": measure_resolutions, "stages": measure_stages, "starts": measure_starts}


def main():
    options = arguments(__doc__, list(MEASURES), OPTIONS)
    series = Series(options)
    series.results.runs.setdefault("machine", {"threads": os.cpu_count(), "load": os.getloadavg()[0]})
    for name in options.tables:
        MEASURES[name](series)
        bench_tables.WRITERS[name](options.page, series.results.runs)
    bench_tables.write_aims(options.page, series.results.runs)


if __name__ == "__main__":
    main()
