#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Gives the inputs of tiny_meshes names that say what tests/fuzz/tiny_meshes.cpp makes of them.

    name_inputs.py tests/fuzz/inputs/tiny_meshes

The surface it begins with, what the shell is asked for, and how often the surface is changed in which way:
`torus.thickest.both.taper.move3.merge.bin`. Inputs of the same name are numbered. Those that a fuzzer named, by a hash, are named,
and those that were named here before; names that somebody gave stay. Reads the bytes in the order of
tiny_meshes.cpp, and has to be changed with it; a wrong name does no harm."""
import argparse
import collections
import pathlib
import re

SURFACES = {"tet": 4, "box": 12, "ball": 20, "torus": 18, "ball_with_cavity": 32, "two_tets": 8}
BITS = {1: "thin", 2: "repair", 4: "layers", 8: "taper", 16: "stitched", 32: "turned", 64: "half", 128: "split"}
# What a change is called, how many bytes it takes and how many triangles come with it.
CHANGES = [("move", 4, 0), ("move", 4, 0), ("far", 6, 0), ("onto", 2, 0), ("split", 1, 2), ("cut", 1, 2), ("turn", 1, 0),
           ("merge", 2, 0), ("scale", 4, 0), ("add", 3, 4)]
MOST_CHANGES, MOST_TRIANGLES = 24, 40


def name_of(data):
    rest = list(data)

    def take():
        return rest.pop(0) if rest else 0

    words = []
    at_origin = take() < 27
    how = take()
    words.append(("certified", "thickest")[how % 2])
    words += ["mend"] * (how % 8 == 6)
    side = take() % 8
    words += {7: ["both"], 6: ["outward"]}.get(side, [])
    bits = take()
    for bit, word in BITS.items():
        if bits & bit:
            words.append(word + (str(take() % 4) if bit in (4, 128) else ""))
    surface = list(SURFACES)[take() % 6]
    triangles, counts = SURFACES[surface], collections.Counter()
    for _ in range(MOST_CHANGES):
        if not rest:
            break
        change, size, more = CHANGES[take() % 10]
        if change == "add" and triangles >= MOST_TRIANGLES:
            continue
        counts[change] += 1
        triangles += more
        del rest[:size]
    changes = [change + (str(count) if count > 1 else "") for change, count in counts.items()]
    return ".".join([surface, *(["at_origin"] if at_origin else []), *words, *changes])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    files = [(file, file.read_bytes()) for file in sorted(parser.parse_args().folder.iterdir())
             if re.fullmatch(r"[0-9a-f]{40}|.*\.bin", file.name)]
    for file, _ in files:
        file.unlink()
    used = collections.Counter()
    for _, data in sorted(files, key=lambda one: (name_of(one[1]), one[1])):
        name = name_of(data)
        used[name] += 1
        number = f".{used[name]}" if used[name] > 1 else ""
        (files[0][0].parent / f"{name}{number}.bin").write_bytes(data)


if __name__ == "__main__":
    main()
