#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs samples/blender/make_volumes.py as samples/volume_pictures.sh does, on a small mesh, and looks at what it makes.

    make_volumes_test.py COMMAND MAKE_VOLUMES.py MESH.obj

Exit status 77 where numpy or pyopenvdb is not there.
"""
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy
    import pyopenvdb
except ImportError as error:
    print(f"left out: {error}")
    sys.exit(77)

COMMAND, MAKE_VOLUMES, MESH = (str(pathlib.Path(word).resolve()) for word in sys.argv[1:4])


def run(*words):
    subprocess.run([str(word) for word in words], check=True)


def make(*words):
    run(sys.executable, MAKE_VOLUMES, *words)


def values(path, name):
    """All values in the box of the active voxels of a grid, and that box's lowest corner."""
    grid = pyopenvdb.read(str(path), name)
    low, high = grid.evalActiveVoxelBoundingBox()
    array = numpy.zeros([b - a + 1 for a, b in zip(low, high)], numpy.float32)
    grid.copyToArray(array, ijk=low)
    return array, low


def words_of(path, first):
    return [line.split() for line in path.read_text().splitlines() if line.split()[:1] == [first]]


def require(condition, text):
    if not condition:
        sys.exit(f"make_volumes: {text}")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        textured, bricks, smoke, marble = (folder / file for file in ("textured.obj", "bricks.vdb", "smoke.vdb", "marble.vdb"))
        shell, density, depth = (folder / file for file in ("shell.vdb", "density.vdb", "depth.vdb"))

        make("unwrap", MESH, textured)
        mesh = pathlib.Path(MESH)
        require(words_of(textured, "v") == words_of(mesh, "v"), "unwrap moves points")
        faces = [[word.split("/")[0] for word in face] for face in words_of(textured, "f")]
        require(faces == [[word.split("/")[0] for word in face] for face in words_of(mesh, "f")], "unwrap changes faces")
        require(len(words_of(textured, "vt")) == sum(len(face) - 1 for face in faces), "not every corner has coordinates")

        # The command takes both for a shell map.
        make("bricks", bricks)
        run(COMMAND, "build", textured, "--resolution", "48", "-q", "-o", shell)
        run(COMMAND, "map", bricks, "--shell", shell, "--mesh", textured, "--repeat-u", "1", "--repeat-v", "1.25",
            "--voxel-size", "0.08", "-q", "-o", folder / "wall.vdb")
        wall, _ = values(folder / "wall.vdb", "bricks")
        require(wall.max() > 0.5 and (wall > 0.5).sum() < wall.size, "no bricks on the wall")

        run(COMMAND, "volumes", shell, "--volumes", "density", "-o", density)
        make("smoke", density, smoke)
        before, low = values(density, "density")
        after, low_after = values(smoke, "density")
        ends = [(b - a, b - a + n) for a, b, n in zip(low, low_after, after.shape)]
        share = before[tuple(slice(*end) for end in ends)]
        require(share.shape == after.shape, "smoke is where no density is")
        require((after <= 1.5 * share + 1e-6).all() and (after >= 0).all(), "smoke is not density times noise")
        inside = share > 0.1
        require((after[inside] / share[inside]).std() > 0.05, "there are no wisps in the smoke")

        run(COMMAND, "volumes", shell, "--volumes", "depth", "-o", depth)
        make("marble", depth, marble)
        solid, _ = values(marble, "solid")
        vein, _ = values(marble, "vein")
        half = solid.shape[0] // 2
        require(solid[:half - 3].max() > 0.99 and solid[half + 3:-3].max() < 0.01, "not one half of the marble is left out")
        require(vein.min() >= 0 and vein.max() <= 1 and vein[vein > 0].std() > 0.1, "there are no veins in the marble")
    return 0


if __name__ == "__main__":
    sys.exit(main())
