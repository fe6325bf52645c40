// SPDX-License-Identifier: Apache-2.0
// The field of a wrap, in voxels and negative inside. It is the smaller of two: a distance to the
// triangles that bound a solid, with the sign of the winding number (A. Jacobson and others, 2013),
// and the distance to the sheets less half the thickness of a plate. Where the triangles leave a
// gap, the fall of the winding number takes the place of the distance, and its zero closes the gap.
// Values are computed by many threads and written by one, in sorted order, so the bits do not
// depend on the number of threads. Values are only about distances; their zero set is what counts.
// docs/stages/wrap.md, "What a wrap is", explains the numbers.

#include "field/wrap_field.h"

#include "core/parallel.h"
#include "field/mesh_distances.h"
#include "resample/triangle_pieces.h"

#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Coord;
using openvdb::Vec3d;
using openvdb::Vec3s;

// More than the half that the winding number reaches on the face of a single sheet, with room for
// the error of the far dipoles. For closed surfaces any value between does, since it jumps from 0
// to 1 there.
constexpr double kInsideWinding = 0.6;
// Lines can step into a solid that is deeper than this, and it can be meshed without help.
constexpr double kSolidVoxels = 1.5;
// At that depth the winding number has to be clear of doubt. Beside a triangle that is turned the
// wrong way it is not, and a part without a thickness of its own would leak there.
constexpr double kSureWinding = 0.75;
// The distance from the surface at which the two sides of a piece are looked at.
constexpr double kBesideVoxels = 0.3;
constexpr double kPieceVoxels = 2.0;
constexpr double kBandVoxels = 3.0;
// Turns the fall of the winding number across a gap into a field about as steep as a distance.
// Times 1 - kInsideWinding it is no less than the band, so closed solids reach their full depth.
constexpr double kVoxelsPerTurn = 8.0;

enum class Part : char { boundary, sheet, interior };

/// By how much the winding number is short of the inside, in turns; negative in the solid. The
/// absolute value lets a component be inside out.
double winding_field(const WindingNumber& winding, const Vec3d& point)
{
    return kInsideWinding - std::abs(winding.at(point));
}

Part part_of(const TriangleCorners& piece, const WindingNumber& winding)
{
    Vec3d normal = (piece[1] - piece[0]).cross(piece[2] - piece[0]);
    // A piece without area has no sides to look at. As a sheet it at least leaves a trace.
    if (!normal.normalize())
        return Part::sheet;
    const Vec3d centre = (piece[0] + piece[1] + piece[2]) / 3.0;
    const auto inside = [&](double offset) {
        return winding_field(winding, centre + offset * normal) < 0;
    };
    const auto surely_inside = [&](double offset) {
        return winding_field(winding, centre + offset * normal) < kInsideWinding - kSureWinding;
    };
    const bool above = inside(kBesideVoxels), below = inside(-kBesideVoxels);
    if (above && below)
        return Part::interior;
    if (above)
        return surely_inside(kSolidVoxels) ? Part::boundary : Part::sheet;
    return below && surely_inside(-kSolidVoxels) ? Part::boundary : Part::sheet;
}

/// A large triangle may bound the solid in one part and stick out of it in another, so it is judged
/// in pieces of no more than two voxels.
std::vector<TriangleCorners> cut_up(const std::vector<TriangleCorners>& triangles)
{
    std::vector<TriangleCorners> pieces;
    for (const TriangleCorners& t : triangles)
        for_each_piece(t[0], t[1], t[2], kPieceVoxels,
                       [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
                           pieces.push_back({a, b, c});
                       });
    return pieces;
}

double area_of(const TriangleCorners& t)
{
    return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).length();
}

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
    return unsigned_distances(mesh, *openvdb::math::Transform::createLinearTransform(1.0), band,
                              nullptr);
}

/// The parts of the field at a voxel. An accessor must not be shared, so each range of voxels has
/// an object of its own.
class FieldValues
{
public:
    FieldValues(const openvdb::FloatGrid& boundary, const openvdb::FloatGrid& sheet,
                const WindingNumber& winding, double sheet_voxels)
        : boundary_(boundary.getConstAccessor()), sheet_(sheet.getConstAccessor()),
          winding_(winding), sheet_voxels_(sheet_voxels)
    {
    }

    float at(const Coord& voxel)
    {
        const double turns = winding_field(winding_, voxel.asVec3d());
        // On a triangle that bounds a solid the winding number jumps and the distance is 0. In a
        // gap the distance is not small, but the winding number passes its threshold continuously.
        // So the smaller of both has its zero set on the triangles and across the gaps.
        const double depth = std::min(
            {double(boundary_.getValue(voxel)), kVoxelsPerTurn * std::abs(turns), kBandVoxels});
        const double solid = turns < 0 ? -depth : depth;
        return static_cast<float>(std::min(solid, double(sheet_.getValue(voxel)) - sheet_voxels_));
    }

private:
    openvdb::FloatGrid::ConstAccessor boundary_, sheet_;
    const WindingNumber& winding_;
    double sheet_voxels_;
};

template <typename Visit> void for_each_neighbour(const Coord& voxel, const Visit& visit)
{
    for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j)
            for (int k = -1; k <= 1; ++k)
                if (i != 0 || j != 0 || k != 0)
                    visit(voxel.offsetBy(i, j, k));
}

void sort_and_unite(std::vector<Coord>& voxels)
{
    // Sorted, the order does not depend on how the voxels were found.
    std::sort(voxels.begin(), voxels.end());
    voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
}

std::vector<Coord> band_voxels(const openvdb::FloatGrid& boundary, const openvdb::FloatGrid& sheet)
{
    std::vector<Coord> voxels;
    for (const openvdb::FloatGrid* grid : {&boundary, &sheet})
        for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf)
            for (auto value = leaf->cbeginValueOn(); value; ++value)
                voxels.push_back(value.getCoord());
    sort_and_unite(voxels);
    return voxels;
}

/// Voxels without a value beside those where the sign changes at one of `fresh`. Both ends of a
/// change count, so that the contour finds all eight corners of every cube that it crosses.
std::vector<Coord> beyond_sign_changes(const std::vector<Coord>& fresh,
                                       const openvdb::FloatGrid& field)
{
    std::vector<Coord> beyond;
    const auto values = field.getConstAccessor();
    const auto add_unknown = [&](const Coord& voxel) {
        if (!values.isValueOn(voxel))
            beyond.push_back(voxel);
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
    sort_and_unite(beyond);
    return beyond;
}

} // namespace

WrapPieces sort_pieces(const std::vector<TriangleCorners>& triangles, const WindingNumber& winding,
                       const StageProgress& progress)
{
    const std::vector<TriangleCorners> all = cut_up(triangles);
    std::vector<Part> parts(all.size());
    for_each_index(all.size(), [&](std::size_t i) { parts[i] = part_of(all[i], winding); });
    progress.stop_if_interrupted(20);
    WrapPieces pieces;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double area = area_of(all[i]);
        // Pieces inside the solid are left out of the field: the distance to them would bring
        // values near zero into the solid.
        if (parts[i] == Part::interior) {
            pieces.interior_area += area;
            continue;
        }
        const bool sheet = parts[i] == Part::sheet;
        (sheet ? pieces.sheet : pieces.boundary).push_back(all[i]);
        (sheet ? pieces.sheet_area : pieces.boundary_area) += area;
    }
    return pieces;
}

WrapPieces all_sheets(const std::vector<TriangleCorners>& triangles)
{
    WrapPieces pieces;
    pieces.sheet = cut_up(triangles);
    for (const TriangleCorners& piece : pieces.sheet)
        pieces.sheet_area += area_of(piece);
    return pieces;
}

openvdb::FloatGrid::Ptr wrap_field(const WrapPieces& pieces, const WindingNumber& winding,
                                   double sheet_voxels, const StageProgress& progress)
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
        std::vector<float> computed(fresh.size());
        for_each_range(fresh.size(), [&](std::size_t begin, std::size_t end) {
            FieldValues at(*boundary, *sheet, winding, sheet_voxels);
            for (std::size_t i = begin; i < end; ++i)
                computed[i] = at.at(fresh[i]);
        });
        for (std::size_t i = 0; i < fresh.size(); ++i)
            values.setValue(fresh[i], computed[i]);
        fresh = beyond_sign_changes(fresh, *field);
    }
    openvdb::tools::signedFloodFill(field->tree());
    return field;
}

} // namespace vdb_shell
