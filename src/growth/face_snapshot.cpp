// SPDX-License-Identifier: Apache-2.0

// Takes: the state between two rounds, with a trust radius for each vertex. Leaves: the centres of
// the trust regions where the vertices are, and for each face all that the search for close pairs
// needs, computed once instead of once a pair.

#include "growth/face_snapshot.h"

#include "core/parallel.h"
#include "core/unit_vector.h"

#include <algorithm>

namespace vdb_shell::growth
{
namespace
{

constexpr std::size_t kFacesAtOnce = 256; // a face takes tens of nanoseconds

Vec3d unit_normal(const Corners& c)
{
    // Zero where there is no area: such a face is beyond no plane of its own, so all its pairs are
    // looked at closely.
    return unit_vector((c[1] - c[0]).cross(c[2] - c[0]));
}

void take_snapshot_of_outer(const GrowState& s, FaceSnapshot& faces)
{
    const std::size_t count = s.mesh->faces.size();
    faces.outer_normal.resize(count);
    for_each_index(
        count,
        [&](std::size_t f) {
            faces.outer_normal[f] = unit_normal(outer_corners(s, static_cast<int>(f)));
        },
        kFacesAtOnce);
}

void take_snapshot_of_inner(const GrowState& s, const std::vector<std::uint8_t>& inactive, int f,
                            FaceSnapshot& faces)
{
    // The longest of the corners' radii serves for the whole face: a point of it goes no farther
    // than the corner that goes farthest.
    double radius = 0;
    faces.inactive[f] = 1;
    for (int k = 0; k < 3; ++k) {
        const int v = s.mesh->corner(f, k);
        if (inactive[v])
            continue;
        radius = std::max(radius, s.trust_radius[v]);
        faces.inactive[f] = 0;
    }
    const Corners corners = inner_corners(s, f);
    faces.normal[f] = unit_normal(corners);
    faces.trust_radius[f] = radius;
    faces.box[f] = float_box_of(corners, radius);
}

} // namespace

void take_snapshot(GrowState& s, const std::vector<std::uint8_t>& inactive, FaceSnapshot& faces)
{
    const std::size_t count = s.mesh->faces.size();
    // From here on, until the next snapshot, radii are counted from these places.
    s.trust_centre = s.b;
    if (faces.outer_normal.empty())
        take_snapshot_of_outer(s, faces);
    faces.normal.resize(count);
    faces.trust_radius.resize(count);
    faces.box.resize(count);
    faces.inactive.resize(count);
    for_each_index(
        count,
        [&](std::size_t f) { take_snapshot_of_inner(s, inactive, static_cast<int>(f), faces); },
        kFacesAtOnce);
}

} // namespace vdb_shell::growth
