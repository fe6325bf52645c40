// SPDX-License-Identifier: Apache-2.0

// Takes a mesh and finds the triangles behind which the solid is thinner than a voxel: a ray goes
// inward from the middle of each and leaves the solid through another triangle. The level set
// hardly tells the two sides apart there. Middles stand for their triangles, so a thin place under
// the rest of a large triangle can be missed, and all is in doubles: this advises, it proves
// nothing. A tree over boxes finds the triangles along a ray, so that a ray need not be tried
// against all.

#include "inspect/marks.h"

#include "core/parallel.h"
#include "core/triangle_piece.h"
#include "mesh/ray_through.h"

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

/// Triangles are counter-clockwise from outside, so the product in this order points inward. A
/// triangle without area has no inside, and gets a ray of no direction.
Ray inward_from(const TriangleMesh& mesh, const Vec3I& t)
{
    const Vec3d a(mesh.points[t[0]]), b(mesh.points[t[1]]), c(mesh.points[t[2]]);
    const Vec3d cross = (c - a).cross(b - a);
    const double length = cross.length();
    return {(a + b + c) / 3.0, length > 0 ? cross / length : Vec3d(0.0)};
}

/// Along a sharp edge the other side is always near, however fine the voxels are. So triangles with
/// a common corner do not count, and all that have one are passed over at once: there may be as
/// many as there are triangles.
std::vector<BoxTree::Marks> corners_as_marks(const std::vector<Vec3I>& triangles,
                                             const std::vector<std::uint32_t>& triangle_of_box)
{
    std::vector<BoxTree::Marks> marks;
    marks.reserve(triangle_of_box.size());
    for (const std::uint32_t t : triangle_of_box)
        marks.push_back({triangles[t][0], triangles[t][1], triangles[t][2]});
    return marks;
}

} // namespace

std::vector<std::uint32_t> find_thin_triangles(const TriangleMesh& mesh,
                                               const std::vector<std::uint32_t>& repeats,
                                               double voxel_size)
{
    std::vector<char> left_out(mesh.triangles.size()), thin(mesh.triangles.size());
    for (const std::uint32_t t : repeats)
        left_out[t] = 1;
    std::vector<Vec3I> others;
    for (std::size_t t = 0; t < left_out.size(); ++t)
        if (!left_out[t])
            others.push_back(mesh.triangles[t]);
    BoxTree tree;
    const PartBoxes parts = part_boxes(mesh.points, others);
    tree.build(parts.boxes);
    tree.mark(corners_as_marks(others, parts.triangle));
    // Each index writes its own slot and the answers are collected in order, so threads do not
    // matter.
    for_each_index(thin.size(), [&](std::size_t t) {
        const Ray ray = inward_from(mesh, mesh.triangles[t]);
        if (left_out[t] || ray.along.lengthSqr() == 0)
            return;
        const Vec3I& own = mesh.triangles[t];
        tree.for_each_on_ray_without(
            {own[0], own[1], own[2]}, ray.from, ray.along, voxel_size, [&](int box) {
                const Vec3I& other = others[parts.triangle[std::size_t(box)]];
                thin[t] = leaves_through(mesh, other, ray) < voxel_size;
                return thin[t] == 0; // one is enough
            });
    });
    std::vector<std::uint32_t> found;
    for (std::uint32_t t = 0; t < thin.size(); ++t)
        if (thin[t])
            found.push_back(t);
    return found;
}

} // namespace vdb_shell
