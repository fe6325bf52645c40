// SPDX-License-Identifier: Apache-2.0
// The field of a wrap, in voxels and negative inside. It is the smaller of two: a distance to the
// triangles that bound a solid, with the sign of the winding number (A. Jacobson and others, 2013),
// and the distance to the sheets less half the thickness of a plate. Where the triangles leave a
// gap, the fall of the winding number takes the place of the distance, and its zero closes the gap.
// Values are computed by many threads and written by one, in the order of the tree, so the bits
// do not depend on the number of threads. Values are only about distances; their zero set is what
// counts. docs/stages/wrap.md, "What a wrap is", explains the numbers.

#include "field/wrap_field.h"

#include "core/parallel.h"
#include "core/stage_stop.h"
#include "field/mesh_distances.h"
#include "field/voxel_distances.h"

#include <openvdb/tools/LevelSetUtil.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Coord;
using openvdb::Vec3d;

constexpr double kBandVoxels = 3.0;
// Turns the fall of the winding number across a gap into a field about as steep as a distance.
// Times 1 - kInsideWinding it is no less than the band, so closed solids reach their full depth.
constexpr double kVoxelsPerTurn = 8.0;
constexpr std::size_t kVoxelsAtOnce = 4096;
// Voxels. Any depth will do in a void that was filled; 0 would be a surface.
constexpr float kLeastFilledDepth = 0.1F;

openvdb::FloatGrid::Ptr unsigned_distance(const std::vector<TriangleCorners>& pieces, double band)
{
    TriangleMesh mesh;
    // Pieces do not share points, since the distance does not need it.
    for (const TriangleCorners& piece : pieces) {
        const auto first = static_cast<openvdb::Vec3I::ValueType>(mesh.points.size());
        for (const Vec3d& corner : piece)
            mesh.points.emplace_back(corner);
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    if (fills_voxels(mesh, band))
        return unsigned_distances_by_voxels(mesh, band);
    return unsigned_distances(mesh, *openvdb::math::Transform::createLinearTransform(1.0), band,
                              stage_stop());
}

/// The parts of the field at voxels. An accessor must not be shared, so each range of voxels has an
/// object of its own.
class FieldValues
{
public:
    FieldValues(const openvdb::FloatGrid& boundary, const openvdb::FloatGrid& sheet,
                double sheet_voxels, const Vec3d& half_size)
        : boundary_(boundary.getConstAccessor()), sheet_(sheet.getConstAccessor()),
          sheet_voxels_(sheet_voxels), limit_(half_size + Vec3d(sheet_voxels))
    {
    }

    float at(const Coord& voxel, float turns) { return value(voxel, short_of_inside(turns)); }

private:
    float value(const Coord& voxel, double turns)
    {
        // On a triangle that bounds a solid the winding number jumps and the distance is 0. In a
        // gap the distance is not small, but the winding number passes its threshold continuously.
        // So the smaller of both has its zero set on the triangles and across the gaps.
        const double depth = std::min(
            {double(boundary_.getValue(voxel)), kVoxelsPerTurn * std::abs(turns), kBandVoxels});
        const Vec3d at = voxel.asVec3d();
        double beyond = -kBandVoxels;
        for (int axis = 0; axis < 3; ++axis)
            beyond = std::max(beyond, std::abs(at[axis]) - limit_[axis]);
        // Triangles that lie one behind the other, turned alike, such as the faces of a tet mesh,
        // are seen as a solid far beyond them. Nothing of it is kept outside of their box.
        const double solid = std::max(turns < 0 ? -depth : depth, std::min(beyond, kBandVoxels));
        return static_cast<float>(std::min(solid, double(sheet_.getValue(voxel)) - sheet_voxels_));
    }

    openvdb::FloatGrid::ConstAccessor boundary_, sheet_;
    double sheet_voxels_;
    Vec3d limit_; ///< of the solid: the box of the triangles, with room for their thickness
};

template <typename Visit> void for_each_neighbour(const Coord& voxel, const Visit& visit)
{
    for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j)
            for (int k = -1; k <= 1; ++k)
                if (i != 0 || j != 0 || k != 0)
                    visit(voxel.offsetBy(i, j, k));
}

/// The active voxels of both, each once.
std::vector<Coord> band_voxels(const openvdb::FloatGrid& boundary, const openvdb::FloatGrid& sheet)
{
    openvdb::MaskTree both;
    both.topologyUnion(boundary.tree());
    both.topologyUnion(sheet.tree());
    return active_voxels(both);
}

/// Voxels without a value beside those where the sign changes at one of `fresh`. Both ends of a
/// change count, so that the contour finds all eight corners of every cube that it crosses.
std::vector<Coord> beyond_sign_changes(const std::vector<Coord>& fresh,
                                       const openvdb::FloatGrid& field)
{
    openvdb::MaskTree beyond;
    openvdb::tree::ValueAccessor<openvdb::MaskTree> mark(beyond);
    const auto values = field.getConstAccessor();
    const auto add_unknown = [&](const Coord& voxel) {
        if (!values.isValueOn(voxel))
            mark.setValueOn(voxel);
    };
    for (const Coord& voxel : fresh) {
        const bool inside = values.getValue(voxel) < 0;
        bool changes = false;
        for_each_neighbour(voxel, [&](const Coord& other) {
            float value = 0;
            if (values.probeValue(other, value) && (value < 0) != inside) {
                changes = true;
                for_each_neighbour(other, add_unknown);
            }
        });
        if (changes)
            for_each_neighbour(voxel, add_unknown);
    }
    return active_voxels(beyond);
}

} // namespace

openvdb::FloatGrid::Ptr wrap_field(const WrapPieces& pieces, WindingGrid& winding,
                                   double sheet_voxels, const Vec3d& half_size,
                                   const StageProgress& progress)
{
    const auto boundary = unsigned_distance(pieces.boundary, kBandVoxels);
    const auto sheet = unsigned_distance(pieces.sheet, sheet_voxels + kBandVoxels);
    auto field = openvdb::FloatGrid::create(static_cast<float>(kBandVoxels));
    field->setGridClass(openvdb::GRID_LEVEL_SET);
    auto values = field->getAccessor();
    // The winding number is harmonic away from the triangles, so a surface on which it is constant
    // ends on triangles only. Followed from their band, no part of it is missed. Each pass computes
    // voxels that had no value before, so the loop ends when the surface is closed.
    std::vector<Coord> fresh = band_voxels(*boundary, *sheet);
    while (!fresh.empty()) {
        progress.stop_if_interrupted(50);
        std::vector<float> computed = winding.at(fresh);
        for_each_range(
            fresh.size(),
            [&](std::size_t begin, std::size_t end) {
                stop_if_stage_wants();
                FieldValues values_at(*boundary, *sheet, sheet_voxels, half_size);
                for (std::size_t i = begin; i < end; ++i)
                    computed[i] = values_at.at(fresh[i], computed[i]);
            },
            kVoxelsAtOnce);
        for (std::size_t i = 0; i < fresh.size(); ++i)
            values.setValue(fresh[i], computed[i]);
        fresh = beyond_sign_changes(fresh, *field);
    }
    openvdb::tools::signedFloodFill(field->tree());
    return field;
}

std::size_t fill_voids(openvdb::FloatGrid& field)
{
    const auto solid = openvdb::tools::extractEnclosedRegion(field);
    const auto is_solid = solid->getConstAccessor();
    std::size_t filled = 0;
    for (auto leaf = field.tree().beginLeaf(); leaf; ++leaf)
        for (auto value = leaf->beginValueOn(); value; ++value)
            if (*value >= 0 && is_solid.isValueOn(value.getCoord())) {
                value.setValue(-std::max(*value, kLeastFilledDepth));
                ++filled;
            }
    openvdb::tools::signedFloodFill(field.tree());
    return filled;
}

} // namespace vdb_shell
