// SPDX-License-Identifier: Apache-2.0

// Takes a pose of a tapered shell. Gives the free faces that stand against its certificate: those
// that touch, and neighbours that have been turned past each other, which touch nothing. The second
// is how the small voids that tapering leaves get turned inside out.

#include "pose/face_contacts.h"

#include "core/exact.h"
#include "core/parallel.h"
#include "core/triangle_pairs.h"
#include "mesh/surface_defects.h"
#include "mesh/triangle_contacts.h"

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;
using Parts = RestShell::Parts;

/// Of FreeFaces::points: outer ones that no tet has come last.
std::vector<Vec3s> points_of_faces(const FreeFaces& free, const std::vector<Vec3I>& triangles,
                                   std::vector<Vec3s> points, const std::vector<Vec3s>& skin)
{
    points.resize(free.points.size());
    for (std::size_t t = 0; t < free.outer_count; ++t)
        for (int k = 0; k < 3; ++k)
            points[free.faces[t][k]] = skin[triangles[t][k]];
    return points;
}

bool tets_overlap(const Parts& parts, const std::vector<Vec3s>& points, const FacePair& pair)
{
    std::array<exact::Tet, 2> tet;
    for (std::size_t i = 0; i < 2; ++i) {
        const openvdb::Vec4I& c = parts.all[parts.free.tet[pair[i]]];
        tet[i] = {points[c[0]], points[c[1]], points[c[2]], points[c[3]]};
        if (exact::orient3d(tet[i][0], tet[i][1], tet[i][2], tet[i][3]) <= 0)
            return false;
    }
    return exact::tets_overlap(tet[0], tet[1]);
}

} // namespace

std::vector<FacePair> faces_not_apart(const Parts& parts, const std::vector<Vec3s>& points,
                                      const std::vector<Vec3s>& skin,
                                      const SkinCrossings& crossings)
{
    const FreeFaces& free = parts.free;
    if (free.faces.empty())
        return {};
    const auto excused = [&](std::uint32_t f, std::uint32_t g) {
        return !crossings.region.empty() && crossings.region[parts.triangle_of_face[f]] != 0 &&
               crossings.region[parts.triangle_of_face[g]] != 0;
    };
    const std::vector<Vec3s> corners = points_of_faces(free, parts.stack.triangles(), points, skin);
    const std::vector<char> degenerate = find_degenerate(corners, free.faces);
    const TriangleContacts contacts(corners, free.faces);
    std::vector<FacePair> pairs = overlapping_triangles(
        corners, free.faces,
        [&](std::uint32_t f, std::uint32_t g) {
            return (free.inner(f) || free.inner(g)) && !excused(f, g) && contacts.touch(f, g);
        },
        nullptr, degenerate);
    std::vector<std::uint8_t> passed(parts.neighbour_faces.size());
    for_each_index(passed.size(), [&](std::size_t i) {
        const FacePair& pair = parts.neighbour_faces[i];
        passed[i] = !excused(pair[0], pair[1]) && tets_overlap(parts, points, pair);
    });
    for (std::size_t i = 0; i < passed.size(); ++i)
        if (passed[i])
            pairs.push_back(parts.neighbour_faces[i]);
    return pairs;
}

} // namespace vdb_shell
