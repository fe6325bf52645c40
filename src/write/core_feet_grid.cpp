// SPDX-License-Identifier: Apache-2.0

// Takes: where pillars ended at cores. Leaves: that as columns of the grid of points, and the other
// way round. A file without cores has none of these columns. What a file says of them is checked by
// itself: the checksum covers the shell, which is the same with other feet.

#include "write/core_feet_grid.h"

#include "vdb_shell/core/error.h"

#include <openvdb/points/AttributeArray.h>

#include <cmath>
#include <cstdint>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3s;
using openvdb::points::AttributeHandle;
using PointLeaf = openvdb::points::PointDataTree::LeafNodeType;

constexpr const char* kCore = "core";
constexpr const char* kTriangle = "core_triangle";
constexpr const char* kUvw = "core_uvw";
constexpr const char* kDistance = "core_distance";

template <typename T>
AttributeHandle<T> handle_of(const PointLeaf& leaf, const char* attribute, std::size_t rows,
                             const std::string& name)
{
    const auto* found = leaf.attributeSet().getConst(attribute);
    // In each leaf anew: those of a damaged file need not have the same attributes.
    if (!found || !found->hasValueType<T>() || found->stride() != 1 || found->size() != rows)
        throw ReadError(name + ": attribute \"" + attribute +
                        "\" is missing in a part of the grid, or of another type or length");
    return AttributeHandle<T>(*found);
}

/// No more than can be said without the cores, which the file does not hold.
bool possible(const CoreFoot& foot)
{
    for (int k = 0; k < 3; ++k)
        if (!(foot.uvw[k] >= 0 && foot.uvw[k] <= 1))
            return false;
    return foot.core >= -1 && foot.triangle >= -1 && (foot.core < 0) == (foot.triangle < 0) &&
           std::isfinite(foot.distance) && foot.distance >= 0;
}

} // namespace

/// Feet belong to the innermost points, one for each vertex. All other points have a foot of no
/// core, so that the columns are as long as the grid's others.
std::vector<CoreFoot> feet_by_id(const ShellPoints& points, const std::vector<CoreFoot>& feet)
{
    std::vector<CoreFoot> by_id(points.position.size());
    for (std::size_t v = 0; v < feet.size(); ++v)
        by_id[points.id.back()[v]] = feet[v];
    return by_id;
}

std::vector<CoreFoot> feet_by_vertex(const ShellPoints& points, const std::vector<CoreFoot>& by_id,
                                     const std::string& name)
{
    std::vector<CoreFoot> feet;
    // What other points have is not looked at: nobody asks for it.
    for (const std::uint32_t id : points.id.back()) {
        if (!possible(by_id[id]))
            throw ReadError(name + ": point " + std::to_string(id) +
                            ": no core, triangle, weights and distance of a foot on a core");
        feet.push_back(by_id[id]);
    }
    return feet;
}

void add_core_feet(PointGridBuilder& builder, const ShellPoints& points,
                   const std::vector<CoreFoot>& feet)
{
    if (feet.empty())
        return;
    const std::vector<CoreFoot> rows = feet_by_id(points, feet);
    builder.add<std::int32_t>(kCore, [&](std::size_t i) { return rows[i].core; });
    builder.add<std::int32_t>(kTriangle, [&](std::size_t i) { return rows[i].triangle; });
    builder.add<Vec3s>(kUvw, [&](std::size_t i) { return rows[i].uvw; });
    builder.add<float>(kDistance, [&](std::size_t i) { return rows[i].distance; });
}

std::vector<CoreFoot> read_core_feet(const openvdb::points::PointDataGrid& grid,
                                     const ShellPoints& points, const std::string& name)
{
    const auto first = grid.tree().cbeginLeaf();
    // The first leaf speaks for the grid. Where another one lacks the columns, handle_of refuses
    // the file.
    if (!first || !first->attributeSet().getConst(kCore))
        return {};
    std::vector<CoreFoot> by_id(points.position.size());
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        const std::size_t rows = leaf->attributeSet().getConst("id")->size();
        const auto id = handle_of<std::int32_t>(*leaf, "id", rows, name);
        const auto core = handle_of<std::int32_t>(*leaf, kCore, rows, name);
        const auto triangle = handle_of<std::int32_t>(*leaf, kTriangle, rows, name);
        const auto uvw = handle_of<Vec3s>(*leaf, kUvw, rows, name);
        const auto distance = handle_of<float>(*leaf, kDistance, rows, name);
        for (openvdb::Index row = 0; row < rows; ++row)
            by_id[std::size_t(id.get(row))] = {core.get(row), triangle.get(row), uvw.get(row),
                                               distance.get(row)};
    }
    return feet_by_vertex(points, by_id, name);
}

} // namespace vdb_shell
