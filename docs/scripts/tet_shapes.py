# SPDX-License-Identifier: Apache-2.0
"""Shape figures of tets, from their corners alone. Needs numpy; shares no code with the library."""
import numpy as np

EDGES = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
SLIVER_DEGREES = 5
# SOFA's rule as its mesh checks state it: outside of these a solver is warned.
SOFA_SMALL_DEGREES, SOFA_LARGE_DEGREES, SOFA_EDGE_RATIO = 20, 160, 10
# Columns are the edges of a regular tet of edge 1 from its first corner.
REGULAR = np.array([[1, .5, .5], [0, 3 ** .5 / 2, 3 ** .5 / 6], [0, 0, (2 / 3) ** .5]])


def volumes(points, tets):
    a, b, c, d = (points[tets[:, i]] for i in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def enclosed_volume(points, triangles):
    # About the middle, so that a surface far from the origin keeps its digits.
    a, b, c = (points[triangles[:, i]] - points.mean(0) for i in range(3))
    return np.einsum("ij,ij->", np.cross(a, b), c) / 6


def dihedral_degrees(points, tets):
    """Six a tet: the angle at each edge, between the parts of the opposite corners across that edge."""
    angles = []
    for i, j in EDGES:
        k, l = (m for m in range(4) if m not in (i, j))
        axis = points[tets[:, j]] - points[tets[:, i]]
        u, v = (np.cross(axis, points[tets[:, m]] - points[tets[:, i]]) for m in (k, l))
        # From the tangent, which is exact for small angles where a cosine is not.
        angles.append(np.degrees(np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), np.einsum("ij,ij->i", u, v))))
    return np.stack(angles, 1)


def edge_ratios(points, tets):
    lengths = np.stack([np.linalg.norm(points[tets[:, j]] - points[tets[:, i]], axis=1) for i, j in EDGES], 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return lengths.max(1) / lengths.min(1)


def amips(points, tets):
    """tr(J^T J) / det(J)^(2/3) of the map J from the regular tet: 3 there; infinite for a tet that is not positive."""
    frames = np.stack([points[tets[:, i]] - points[tets[:, 0]] for i in (1, 2, 3)], 2) @ np.linalg.inv(REGULAR)
    determinant = np.linalg.det(frames)
    squares = (frames ** 2).sum((1, 2))
    positive = determinant > 0
    return np.where(positive, squares / np.where(positive, determinant, 1) ** (2 / 3), np.inf)


def shape_figures(points, tets, surface_points, triangles):
    """One row of the table. AMIPS is of the positive tets, and `not_positive` counts the others."""
    if len(tets) == 0:
        raise ValueError("no tets")
    angles, ratios, energy = dihedral_degrees(points, tets), edge_ratios(points, tets), amips(points, tets)
    smallest, largest = angles.min(1), angles.max(1)
    bad = (smallest < SOFA_SMALL_DEGREES) | (largest > SOFA_LARGE_DEGREES) | (ratios > SOFA_EDGE_RATIO)
    finite = energy[np.isfinite(energy)]
    return {"tets": len(tets), "triangles": len(triangles), "tets_per_triangle": len(tets) / len(triangles),
            "fill": float(volumes(points, tets).sum() / enclosed_volume(surface_points, triangles)),
            "under_5_degrees": float((smallest < SLIVER_DEGREES).mean()), "sofa_bad": float(bad.mean()),
            "amips_mean": float(finite.mean()), "amips_worst": float(finite.max()),
            "smallest_degrees": float(smallest.min()), "not_positive": int((~np.isfinite(energy)).sum())}
