# SPDX-License-Identifier: Apache-2.0
"""The meshes of docs/measurements/volumes.md, and the half that each belongs to."""
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
# The maps were made with the first half in view; the others were only measured.
TUNING = ["paper/cow", "creature"]
JUDGING = ["paper/teapot", "paper/bunny_low_resolution", "paper/knot", "artist/fandisk", "artist/cheburashka", "artist/rocker-arm"]


def path(folder, name):
    return ROOT / "samples/meshes/creature.obj" if name == "creature" else folder / f"{name}.obj"


def half(name):
    return "tuning" if name in TUNING else "judging"
