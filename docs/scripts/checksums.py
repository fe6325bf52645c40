#!/usr/bin/env python3
"""Checksums of the shells that a command makes, to hold two builds against each other.

    checksums.py COMMAND MESHES [--against FILE] > FILE

One line a mesh and set of options: SHA-256 of the tets (.vtu, which names no version and no time),
file name, options. With --against the lines that differ are printed instead, and those of FILE that
were not made (none of them with --only); the exit status is 1 if there are any, or nothing was made. MESHES is a folder with paper/, artist/ and scans/, or any folder of meshes.
"""
import argparse
import hashlib
import pathlib
import subprocess
import sys
import tempfile

# Closed, manifold, oriented and embedded as they are.
CLEAN = """box support_box cylinder pointy diku tube lamp sphere teapot glass propella funnel jack
dragon_small_resolution cow bunny_low_resolution bend bowl torus knot cheburashka fandisk rocker-arm""".split()
CLEAN_SCANS = "boot hammer skull".split()
# Every stage that changes tets, on surfaces small enough for it.
VARIANTS = {
    "cow": ["--method thickest", "--side outward --thickness .02", "--side both --thickness .01",
            "--layers 3 --thickness-scale .8", "--min-quality .05", "--refine-rounds 2",
            "--decimate-to 800", "--subdivide 1", "--smooth 2", "--wrap --wrap-resolution 64",
            "--stop-test bisection --method raw", "--split ripple --method raw", "--limit adaptive",
            "--directions gradient", "--perturb .05", "--rescale", "--recentre --thickness .03"],
    "fandisk": ["--method thickest", "--layers 2", "--field dense"],
    "bunny_medium_resolution": ["--repair", "--allow-self-intersections", "--wrap --wrap-resolution 64"],
    "stanford-bunny": ["--repair"],
}


def jobs(folder):
    for path in sorted(folder.rglob("*")):
        if path.suffix in (".obj", ".ply", ".off", ".stl") and path.stem in CLEAN + CLEAN_SCANS:
            yield path, ""
    for path in sorted(folder.rglob("*")):
        if path.suffix in (".obj", ".ply", ".off", ".stl") and path.parent.name != "scans":
            for options in VARIANTS.get(path.stem, []):
                # artist/cow crosses itself; the variants are for the paper's.
                if not (path.stem == "cow" and path.parent.name == "artist"):
                    yield path, options


def checksum(command, path, options, folder):
    tets = pathlib.Path(folder) / "tets.vtu"
    tets.unlink(missing_ok=True)
    done = subprocess.run([command, "build", str(path), "-o", str(tets), "-q", *options.split()],
                          capture_output=True, text=True)
    # 7: written, but not valid, as the raw method may be.
    if done.returncode not in (0, 7) or not tets.exists():
        return f"exit {done.returncode}".ljust(64)
    return hashlib.sha256(tets.read_bytes()).hexdigest()


def what_of(line):
    """File and options of a line, behind the 64 characters of its checksum (or of the status in its place)."""
    return line[65:]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("meshes", type=pathlib.Path)
    parser.add_argument("--against", type=pathlib.Path)
    parser.add_argument("--only", default="", help="a part of the mesh's name")
    arguments = parser.parse_args()
    before = set(arguments.against.read_text().splitlines()) if arguments.against else set()
    differ = same = 0
    made = set()
    with tempfile.TemporaryDirectory() as folder:
        for path, options in jobs(arguments.meshes):
            if arguments.only not in path.stem:
                continue
            line = f"{checksum(arguments.command, path, options, folder)} {path.parent.name}/{path.stem} {options}".rstrip()
            made.add(what_of(line))
            if line in before:
                same += 1
                continue
            differ += 1
            print(line, flush=True)
    if not arguments.against:
        return 0 if made else 1
    missing = [] if arguments.only else sorted(line for line in before if what_of(line) not in made)
    for line in missing:
        print(f"not made: {line}")
    print(f"{same} the same, {differ} differ, {len(missing)} not made", file=sys.stderr)
    return 1 if differ or missing or not made else 0


if __name__ == "__main__":
    sys.exit(main())
