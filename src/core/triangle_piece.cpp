// SPDX-License-Identifier: Apache-2.0

// Covers triangles with boxes for those who look for what lies at a point or along a ray. How many
// boxes a ray meets goes by their surface, so a triangle is halved as long as that makes the
// surfaces of its boxes less by a good part: a needle that lies askew is, a triangle as wide as
// long is not.

#include "core/triangle_piece.h"

#include "core/parallel.h"

namespace vdb_shell
{
namespace
{

double surface_of(const FloatBox& box)
{
    const openvdb::Vec3d side(double(box.hi[0]) - box.lo[0], double(box.hi[1]) - box.lo[1],
                              double(box.hi[2]) - box.lo[2]);
    return 2 * (side[0] * side[1] + side[1] * side[2] + side[2] * side[0]);
}

// A needle's halves have half of its box's surface, those of an oblique square five sixths.
constexpr double kWorthHalving = 0.7;
// Four times: of 32,000 needles in a cube a point is in 40 boxes then, and in 9,000 without.
constexpr int kMostHalvings = 4;

void add_parts(const TrianglePiece& piece, int halvings, std::vector<FloatBox>& boxes)
{
    const FloatBox whole = piece.box();
    if (halvings > 0 && piece.divisible()) {
        TrianglePiece one = piece;
        const TrianglePiece other = one.halve();
        if (surface_of(one.box()) + surface_of(other.box()) < kWorthHalving * surface_of(whole)) {
            add_parts(one, halvings - 1, boxes);
            add_parts(other, halvings - 1, boxes);
            return;
        }
    }
    boxes.push_back(whole);
}

} // namespace

PartBoxes part_boxes(const std::vector<openvdb::Vec3s>& points,
                     const std::vector<openvdb::Vec3I>& triangles)
{
    constexpr BoxTree::Marks kPlain{BoxTree::kNoMark, BoxTree::kNoMark, BoxTree::kNoMark};
    std::vector<std::vector<FloatBox>> parts(triangles.size());
    for_each_index(triangles.size(), [&](std::size_t t) {
        add_parts(TrianglePiece(points, triangles[t], std::uint32_t(t), kPlain), kMostHalvings,
                  parts[t]);
    });
    PartBoxes all;
    for (std::uint32_t t = 0; t < parts.size(); ++t)
        for (const FloatBox& box : parts[t]) {
            all.boxes.push_back(box);
            all.triangle.push_back(t);
        }
    return all;
}

} // namespace vdb_shell
