#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How full the default's shells are on large surfaces that nobody made for a textbook, for docs/measurements/scans.md.

    scan_figures.py COMMAND docs/measurements/scans.md FOLDER ... [--before OTHER_COMMAND] [--meshes LIST] [--wall] [--flags="FLAGS"]

LIST has a line "tuning NAME" or "judging NAME" for each mesh, found as NAME.obj or NAME.off in one of the folders; what
is not there is left out and named. --before is a binary of an older version. Each build is one run on one thread; times
are processor times, so other work on the machine matters little. Where TetGen is installed its time is measured too.
--wall: also the wall time of a build with a .vdb on all threads over TetGen's, the better of two runs each, for a machine
that does nothing else. --flags: with these, for docs/measurements/scans_thickest.md and scans_speed.md.
"""
import argparse
import pathlib
import resource
import shutil
import statistics
import subprocess
import tempfile
import time

from halves import read_halves
from runs import build, replace_tables, table

EXTENSIONS = [".obj", ".off"]
# Y: no new points on the surface, as our shells have none.
TETGEN = ["-pY", "-p"]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("folders", type=pathlib.Path, nargs="+")
    parser.add_argument("--before", help="the binary of an older version")
    parser.add_argument("--wall", action="store_true")
    parser.add_argument("--flags", type=str.split, default=[])
    parser.add_argument("--meshes", type=pathlib.Path,
                        default=pathlib.Path(__file__).parent.parent / "measurements/scan_meshes.txt")
    return parser.parse_args()


def find(name, folders):
    places = [folder / (name + extension) for folder in folders for extension in EXTENSIONS]
    return next((place for place in places if place.exists()), None)


def meshes_of(options):
    """[(name, half, mesh)] of the list's that are in the folders, and lines for the page that name the others."""
    found = [(name, half, find(name, options.folders)) for name, half in read_halves(options.meshes).items()]
    missing = [name for name, _, mesh in found if mesh is None]
    note = [f"Not there when this was measured: {', '.join(missing)}.", ""] if missing else []
    return [entry for entry in found if entry[2] is not None], note


def tetgen_seconds(mesh, flags):
    """Processor and wall time of tetgen on the same surface; nothing where it is not installed or fails."""
    if not shutil.which("tetgen"):
        return None
    with tempfile.TemporaryDirectory() as folder:
        surface = pathlib.Path(folder) / "surface.off"
        points, faces = [], []
        for words in (line.split() for line in mesh.read_text().splitlines() if mesh.suffix == ".obj"):
            if words[:1] == ["v"]:
                points.append(" ".join(words[1:4]))
            elif words[:1] == ["f"]:
                corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
                faces += [(corners[0], b, c) for b, c in zip(corners[1:], corners[2:])]
        if mesh.suffix == ".obj":
            lines = ["OFF", f"{len(points)} {len(faces)} 0", *points, *(f"3 {a} {b} {c}" for a, b, c in faces)]
            surface.write_text("\n".join(lines) + "\n")
        else:
            shutil.copy(mesh, surface)
        before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        done = subprocess.run(["tetgen", flags + "Q", surface.name], cwd=folder, capture_output=True, check=False)
        wall, after = time.monotonic() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode != 0:
            return None
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, wall


def wall_seconds(command, mesh, flags):
    """Of a build that writes a .vdb, on all threads."""
    with tempfile.TemporaryDirectory() as folder:
        begin = time.monotonic()
        subprocess.run([command, "build", *flags, "-q", "-o", f"{folder}/shell.vdb", mesh], check=True)
        return time.monotonic() - begin


def row_of(mesh, command, before, wall, flags):
    now = build(command, mesh, flags)
    if now["exit"] != 0:
        raise SystemExit(f"{mesh}: {now['message']}")
    row = {"now": now, "then": build(before, mesh, flags) if before else None, "time": {}, "wall": {}}
    ours = min(wall_seconds(command, mesh, flags) for _ in range(2)) if wall else None
    for name in TETGEN:
        took = tetgen_seconds(mesh, name)
        row["time"][name] = now["seconds"] / took[0] if took else None
        row["wall"][name] = ours / min(took[1], tetgen_seconds(mesh, name)[1]) if took and wall else None
    return row


def ratio(value):
    return "-" if value is None else f"{value:.2f}"


def mean_of(values):
    known = [value for value in values if value is not None]
    return statistics.mean(known) if known else None


def cells(name, half, row):
    now, then = row["now"], row["then"]
    made = [name, half, f"{now['triangles']:,}", f"{now['fill']:.4f}", str(now["pinned"]),
            str(now["demanded_pins"]), str(now["without_tet"]), "yes" if now["certified"] else "no",
            *(ratio(row[kind][other]) for kind in ("time", "wall") for other in TETGEN)]
    if then:
        made += [f"{then['fill']:.4f}", str(then["pinned"]), ratio(now["seconds"] / then["seconds"])]
    return made


def means(half, rows):
    now = [row["now"]["fill"] for row in rows]
    made = [f"mean of {half}", half, "", f"{statistics.mean(now):.4f}", "", "", "", "",
            *(ratio(mean_of([row[kind][other] for row in rows])) for kind in ("time", "wall") for other in TETGEN)]
    if rows[0]["then"]:
        made += [f"{statistics.mean(row['then']['fill'] for row in rows):.4f}", "",
                 ratio(statistics.mean(row["now"]["seconds"] / row["then"]["seconds"] for row in rows))]
    return made


def main():
    options = arguments()
    head = ["mesh", "half", "triangles", "fill", "pins", "demanded", "without a tet", "certified",
            *(f"{word} / TetGen {name}" for word in ("time", "wall time") for name in TETGEN)]
    if options.before:
        head += ["fill before", "pins before", "time / before"]
    lines, by_half = [], {}
    meshes, note = meshes_of(options)
    for name, half, mesh in meshes:
        row = row_of(mesh, options.command, options.before, options.wall, options.flags)
        by_half.setdefault(half, []).append(row)
        lines.append(cells(name, half, row))
        print(" ".join(lines[-1]), flush=True)
    lines += [means(half, rows) for half, rows in by_half.items()]
    replace_tables(options.page, note + table(head, lines))


if __name__ == "__main__":
    main()
