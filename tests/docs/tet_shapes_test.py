#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the shape figures of docs/scripts to tets whose figures are known, and its readers to each other.

    tet_shapes_test.py SCRIPTS COMMAND MESH.obj

Exit status 77 when numpy is not there.
"""
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("numpy is not there")
    sys.exit(77)

SCRIPTS, COMMAND, MESH = sys.argv[1:]
sys.path.insert(0, SCRIPTS)
from tet_files import read_obj, read_tets  # noqa: E402
from tet_makers import cavities, components  # noqa: E402
from tet_shapes import amips, dihedral_degrees, edge_ratios, enclosed_volume, shape_figures, volumes  # noqa: E402

ONE = np.array([[0, 1, 2, 3]])
failures = []


def expect(what, found, wanted, tolerance=1e-9):
    if not np.allclose(found, wanted, rtol=0, atol=tolerance):
        failures.append(f"{what}: {found}, expected {wanted}")


def known_tets():
    regular = np.array([[1, 1, 1], [-1, 1, -1], [1, -1, -1], [-1, -1, 1.]])
    regular = regular[[0, 1, 3, 2]] if volumes(regular, ONE)[0] < 0 else regular
    expect("AMIPS of a regular tet", amips(7 * regular, ONE), 3)
    expect("its angles", dihedral_degrees(regular, ONE), np.degrees(np.arccos(1 / 3)))
    expect("its edges", edge_ratios(regular, ONE), 1)
    corner = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.]])
    expect("a corner's volume", volumes(corner, ONE), 1 / 6)
    expect("its angles", np.sort(dihedral_degrees(corner, ONE)[0]), [54.73561031724535] * 3 + [90] * 3)
    flat = corner * [1, 1, 1e-3]
    expect("smallest angle of a flat one", dihedral_degrees(flat, ONE).min(), np.degrees(np.arctan(1e-3 * 2 ** .5)))
    expect("AMIPS of an inverted one", np.isinf(amips(corner, ONE[:, [0, 2, 1, 3]])), [True])
    found = shape_figures(flat, ONE, corner, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
    for key, wanted in (("fill", 1e-3), ("under_5_degrees", 1), ("sofa_bad", 1), ("tets_per_triangle", .25)):
        expect(key, found[key], wanted)


def hollow():
    points, triangles = read_obj(MESH)
    middle, count = points.mean(0), len(points)
    both = np.concatenate([points, middle + (points - middle) / 2])
    faces = np.concatenate([triangles, triangles[:, ::-1] + count])
    expect("components", np.unique(components(faces)), [0, 1])
    expect("hollow volume", enclosed_volume(both, faces), 7 / 8 * enclosed_volume(points, triangles), 1e-6)
    holes = cavities(both, faces)
    if len(holes) != 1 or len(cavities(points, triangles)) != 0:
        failures.append(f"{len(holes)} cavities in a hollow shape")
        return
    inside = (np.abs(holes[0] - middle) < np.ptp(points, axis=0) / 4).all()  # of a box
    expect("the point is in the cavity", inside, True)


def readers():
    with tempfile.TemporaryDirectory() as folder:
        names = [pathlib.Path(folder) / f"shell{extension}" for extension in (".vtu", ".msh", ".node")]
        outputs = [word for name in names for word in ("-o", str(name))]
        subprocess.run([COMMAND, "build", MESH, "--resolution", "32", "-q", *outputs], check=True)
        first, surface = read_tets(names[0]), read_obj(MESH)
        expect("share of the solid", .9 < shape_figures(*first, *surface)["fill"] <= 1, True)
        for name in names[1:]:
            points, tets = read_tets(name)
            expect(f"points of {name.suffix}", points, first[0], 0)
            expect(f"tets of {name.suffix}", tets, first[1], 0)


known_tets()
hollow()
readers()
for failure in failures:
    print("FAILED: " + failure)
sys.exit(1 if failures else 0)
