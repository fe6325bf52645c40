// SPDX-License-Identifier: Apache-2.0
#include "shapes/creature.h"

#include "core/parallel.h"
#include "shapes/remesh.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <cmath>

namespace vdb_shell::samples
{

namespace
{

using openvdb::Coord;
using openvdb::Vec3d;

constexpr double kVoxelSize = 0.016;
constexpr double kBand = 3.0 * kVoxelSize;
const Vec3d lowest(-0.95, -0.1, -1.65), highest(0.95, 2.0, 1.65);

using Leaf = openvdb::FloatTree::LeafNodeType;

/// The block's voxels, or null when the skin is certainly not in it.
Leaf* sample_block(const Coord& origin, double& value_at_centre)
{
    const double half = 0.5 * Leaf::DIM * kVoxelSize;
    value_at_centre = creature_field(origin.asVec3d() * kVoxelSize + Vec3d(half));
    // The field's slope stays below 2.
    if (std::abs(value_at_centre) > 2.0 * std::sqrt(3.0) * half + kBand)
        return nullptr;
    auto* leaf = new Leaf(origin, static_cast<float>(kBand), true);
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        const Vec3d position = leaf->offsetToGlobalCoord(i).asVec3d() * kVoxelSize;
        leaf->setValueOnly(i, static_cast<float>(creature_field(position)));
    }
    return leaf;
}

openvdb::FloatGrid::Ptr sample_field()
{
    const Coord low = Coord::floor(lowest / kVoxelSize) & ~(Leaf::DIM - 1);
    const Coord blocks = (Coord::ceil(highest / kVoxelSize) - low + Coord(Leaf::DIM - 1)) >>
                         static_cast<std::size_t>(Leaf::LOG2DIM);
    const auto count = static_cast<std::size_t>(blocks[0]) * blocks[1] * blocks[2];
    const auto origin_of = [&](std::size_t i) {
        const auto n = static_cast<openvdb::Int32>(i);
        const Coord cell(n % blocks[0], n / blocks[0] % blocks[1], n / (blocks[0] * blocks[1]));
        return low + (cell << static_cast<std::size_t>(Leaf::LOG2DIM));
    };
    std::vector<Leaf*> leaves(count, nullptr);
    std::vector<double> centres(count, 0.0);
    for_each_index(count,
                   [&](std::size_t i) { leaves[i] = sample_block(origin_of(i), centres[i]); });
    auto grid = openvdb::createLevelSet<openvdb::FloatGrid>(kVoxelSize, 3.0F);
    for (std::size_t i = 0; i < count; ++i) {
        if (leaves[i])
            grid->tree().addLeaf(leaves[i]);
        else if (centres[i] < 0)
            grid->tree().addTile(1, origin_of(i), -static_cast<float>(kBand), false);
    }
    return grid;
}

PolygonMesh raw_skin()
{
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(*sample_field(), points, quads);
    PolygonMesh mesh;
    mesh.points.assign(points.begin(), points.end());
    // OpenVDB's quads run clockwise seen from outside.
    for (const openvdb::Vec4I& q : quads) {
        mesh.faces.push_back({q[0], q[2], q[1]});
        mesh.faces.push_back({q[0], q[3], q[2]});
    }
    return mesh;
}

} // namespace

PolygonMesh creature()
{
    return remesh(raw_skin(), creature_field, {});
}

} // namespace vdb_shell::samples
