# SPDX-License-Identifier: Apache-2.0
"""The half that each mesh belongs to. tuning: looked at while a number of the library was chosen. judging: only measured.

The lists are docs/measurements/*_meshes.txt: a line "HALF NAME" a mesh, with or without its folder.
"""
import pathlib

FOLDER = pathlib.Path(__file__).parent.parent / "measurements"
HALVES = ["tuning", "judging"]


def read_halves(path):
    """{name as the list has it: half}, in the order of the list."""
    lines = [line.split() for line in path.read_text().splitlines() if line.strip() and not line.startswith("#")]
    for number, words in enumerate(lines, 1):
        if len(words) != 2 or words[0] not in HALVES:
            raise SystemExit(f"{path}: entry {number}: \"{' '.join(words)}\" is not \"tuning NAME\" or \"judging NAME\"")
    return {name: half for half, name in lines}


def all_halves():
    """{name without folder: the set of its halves, of which there should be one}."""
    halves = {}
    for path in sorted(FOLDER.glob("*_meshes.txt")):
        for name, half in read_halves(path).items():
            halves.setdefault(pathlib.PurePosixPath(name).name, set()).add(half)
    return halves


def half_of(mesh):
    """Of a mesh without its folder. What no list names has no half."""
    halves = all_halves().get(mesh)
    return "not listed" if not halves else "tuning" if "tuning" in halves else "judging"
