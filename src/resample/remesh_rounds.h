// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "resample/far_points.h"
#include "resample/remesh_surface.h"

#include <cstdint>
#include <vector>

#include <cstddef>

namespace vdb_shell
{

// Shares of the wanted length. Botsch and Kobbelt: halving an edge of 4/3 or collapsing one of 4/5
// brings its length nearer to the wanted one, and neither undoes the other.
constexpr double kTooLong = 4.0 / 3.0, kTooShort = 4.0 / 5.0;

/// The corners of a triangle so that its longest side comes first.
std::array<std::uint32_t, 3> from_longest(const RemeshSurface& surface, std::uint32_t t);

// What each round of remeshing does. All of it is in the order of the edges' lengths or of the
// vertices, one after another, so the result is determined.

/// Splits edges that are too long for their wanted length, longest first. `needles`: those of
/// triangles with an angle under a degree too, as the input may have.
void split_long_edges(RemeshSurface& surface, bool needles);
/// Collapses edges that are too short for it, shortest first. Where the tolerance or a feature does
/// not allow that, the wanted length becomes that of the edge, but no less than `least_size`.
void collapse_short_edges(RemeshSurface& surface, double least_size);
/// Flips edges so that vertices get six neighbours.
void flip_to_valence(RemeshSurface& surface);
/// Flips edges so that the smallest of the angles on both sides gets larger; those of triangles
/// that have become what they are at `since` or later.
void flip_to_angle(RemeshSurface& surface, std::uint64_t since = 0);
/// Moves vertices to the middle of the triangles around them, over the surface or along curves.
void smooth(RemeshSurface& surface);
/// Flips, collapses and moves at triangles with an angle below the one of this cosine, each only if
/// the smallest angle around gets larger. How many were done.
std::size_t raise_angles(RemeshSurface& surface, double cosine);

/// Cuts the triangles where the surfaces are too far apart, which are counted among those that are
/// there, at their longest sides, and moves the vertices around towards the input. From now on
/// operations look at those points of the input too.
void bring_nearer(RemeshSurface& surface, const std::vector<FarPoint>& far);

/// Lets no wanted length be larger than `largest`, nor change by more than `slope` from a length's
/// one end to the other; before that, all of them grow by `growth`.
void grade_sizes(RemeshSurface& surface, double largest, double slope, double growth);

} // namespace vdb_shell
