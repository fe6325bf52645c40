#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a surface of a million triangles and of ten million costs, for docs/measurements/size.md.

    size_figures.py COMMAND docs/measurements/size.md SOURCE.obj:PARTS ... [--threads 2] [--keep FOLDER]
                    [--flags "FLAGS"] [--results FILE]

rough_surface.py makes each surface; the default job builds its shell, writes a .vdb and certifies it. Processor and wall
time are those of the whole command, memory the most that it had at a time. A command that takes more than 16 GiB is
ended. --flags: each surface is built a second time, with these. --keep: a folder for the surfaces, which are made only
where they are not there yet.
--results keeps what was measured and measures only what is not in it: ten million triangles take most of an hour.
"""
import argparse
import json
import math
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

from runs import Results, replace_tables, table, usage_of

MOST_BYTES = 16 << 30
LEAST_SECONDS = 0.05


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("surfaces", nargs="+", help="SOURCE.obj:PARTS")
    parser.add_argument("--threads", default="2")
    parser.add_argument("--flags", default="")
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--results")
    return parser.parse_args()


def surface(word, folder):
    source, parts = word.rsplit(":", 1)
    made = folder / f"{pathlib.Path(source).stem}-{parts}.ply"
    if not made.exists():
        maker = pathlib.Path(__file__).with_name("rough_surface.py")
        subprocess.run([sys.executable, maker, source, parts, made], check=True, stdout=subprocess.DEVNULL)
    return made


def build(command, mesh, threads, flags):
    with tempfile.TemporaryDirectory() as folder:
        report, shell = pathlib.Path(folder) / "report.json", pathlib.Path(folder) / "shell.vdb"
        begin = time.monotonic()
        status, usage = usage_of(
            [command, "--threads", threads, "build", "-q", *flags.split(), "-o", shell, "--report", report, mesh],
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_DATA, (MOST_BYTES, MOST_BYTES)))
        wall = time.monotonic() - begin
        if status != 0:
            raise SystemExit(f"{mesh}: exit {status}")
        read = json.loads(report.read_text())
        return {"name": mesh.stem, "flags": flags, "faces": read["mesh"]["triangles"], "fill": read["volume"]["fill"],
                "certified": read["certificate"]["certified"], "pins": read["prisms"]["pinned_vertices"],
                "demanded": read["prisms"]["demanded_pins"]["count"], "wall": wall,
                "cpu": usage.ru_utime + usage.ru_stime, "memory": usage.ru_maxrss * 1024,
                "file": shell.stat().st_size, "mesh": mesh.stat().st_size, "stages": read["stages"]}


def flags_of(run):
    return f"`{run['flags']}`" if run.get("flags") else "none"


def summary(runs):
    head = ["surface", "flags", "faces", "fill", "certified", "pins (demanded)", "wall s", "CPU s", "microseconds of CPU a face",
            "peak GiB", "bytes a face", "mesh file MiB", "shell file MiB"]
    return table(head, [[run["name"], flags_of(run), f"{run['faces']:,}", f"{run['fill']:.4f}", "yes" if run["certified"] else "no",
                         f"{run['pins']} ({run['demanded']})", f"{run['wall']:.1f}", f"{run['cpu']:.1f}",
                         f"{1e6 * run['cpu'] / run['faces']:.1f}", f"{run['memory'] / 2**30:.2f}",
                         f"{run['memory'] / run['faces']:.0f}", f"{run['mesh'] / 2**20:.0f}",
                         f"{run['file'] / 2**20:.0f}"] for run in runs])


def exponent(pairs):
    """Of seconds against faces, least squares on logarithms."""
    xs, ys = ([math.log(value) for value in values] for values in zip(*pairs))
    x, y = statistics.mean(xs), statistics.mean(ys)
    return sum((a - x) * (b - y) for a, b in zip(xs, ys)) / sum((a - x)**2 for a in xs)


def stages(runs):
    names = list(dict.fromkeys(stage["stage"] for run in runs for stage in run["stages"]))
    seconds = [{stage["stage"]: stage["seconds"] for stage in run["stages"]} for run in runs]
    rows = []
    for name in names:
        if max(of.get(name, 0) for of in seconds) < LEAST_SECONDS:
            continue
        known = [(run["faces"], of[name]) for run, of in zip(runs, seconds) if of.get(name, 0) >= LEAST_SECONDS]
        rows.append([name, *(f"{of[name]:.2f}" if name in of else "" for of in seconds),
                     f"{exponent(known):.2f}" if len({faces for faces, _ in known}) > 1 else ""])
    return ["", f"Wall seconds by stage, flags: {flags_of(runs[0])}", "",
            *table(["stage", *(f"{run['faces']:,} faces" for run in runs), "exponent"], rows)]


def main():
    options = arguments()
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.keep or pathlib.Path(scratch)
        results = Results(options.results)
        series = {flags: [] for flags in ("", options.flags)}
        for flags, runs in series.items():
            for word in options.surfaces:
                key = f"{word} {flags}".strip()
                if key not in results.runs:
                    results.keep(key, build(options.command, surface(word, folder), options.threads, flags))
                print(results.runs[key], flush=True)
                runs.append(results.runs[key])
    replace_tables(options.page, ["", *summary([run for runs in series.values() for run in runs]),
                                  *(line for runs in series.values() for line in stages(runs)), ""])


if __name__ == "__main__":
    main()
