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
#include "core/sort_unique.h"
#include "core/stage_stop.h"
#include "field/mesh_distances.h"
#include "field/voxel_distances.h"
#include "field/winding_field.h"
#include "resample/triangle_pieces.h"

#include <openvdb/tools/LevelSetUtil.h>
#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>

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
// What the winding number is summed up of is cut, so that few triangles are near to a point: long
// ones would be near to most of the grid. Half as long, the faces of a tet mesh take a tenth longer
// and 8,000 needles a tenth less time, and there are three times as many triangles.
constexpr double kSummedVoxels = 8.0;
constexpr std::size_t kVoxelsAtOnce = 4096;
// From the voxel that the middle of a piece is in to all that are nearer to it than kSolidVoxels.
constexpr int kReachVoxels = 2;

// Voxels. Any depth will do in a void that was filled; 0 would be a surface.
constexpr float kLeastFilledDepth = 0.1F;

enum class Part : char { boundary, sheet, interior };

/// By how much a winding number is short of the inside, in turns; negative in the solid. The
/// absolute value lets a component be inside out.
double short_of_inside(float turns)
{
    return kInsideWinding - std::abs(double(turns));
}

Vec3d middle_of(const TriangleCorners& t)
{
    return (t[0] + t[1] + t[2]) / 3.0;
}

/// A piece's middle and unit normal; without area it has none, and no sides to look at.
struct Stance {
    Vec3d centre, normal;
    bool has_sides;
    /// 1 or -1 where just one side is inside the solid: which one, along the normal.
    int inner_side = 0;
};

Stance stance_of(const TriangleCorners& piece)
{
    Stance stance{middle_of(piece), (piece[1] - piece[0]).cross(piece[2] - piece[0]), true};
    stance.has_sides = stance.normal.normalize();
    return stance;
}

/// What each piece is: first from just above and below it, then, where only one side is inside,
/// from the depth at which a solid is one.
std::vector<Part> parts_of(const std::vector<TriangleCorners>& pieces, const WindingNumber& winding)
{
    std::vector<Stance> stances(pieces.size());
    std::vector<Vec3d> points;
    points.reserve(2 * pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        stances[i] = stance_of(pieces[i]);
        points.push_back(stances[i].centre + kBesideVoxels * stances[i].normal);
        points.push_back(stances[i].centre - kBesideVoxels * stances[i].normal);
    }
    const std::vector<float> beside = turns_at(winding, points);
    std::vector<Part> parts(pieces.size());
    points.clear();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        Stance& stance = stances[i];
        const bool above = short_of_inside(beside[2 * i]) < 0;
        const bool below = short_of_inside(beside[2 * i + 1]) < 0;
        parts[i] = above && below && stance.has_sides ? Part::interior : Part::sheet;
        if (above == below || !stance.has_sides)
            continue; // without area it leaves a trace as a sheet
        stance.inner_side = above ? 1 : -1;
        points.push_back(stance.centre + stance.inner_side * kSolidVoxels * stance.normal);
    }
    const std::vector<float> deep = turns_at(winding, points);
    auto turns = deep.begin();
    for (std::size_t i = 0; i < pieces.size(); ++i)
        if (stances[i].inner_side != 0 && short_of_inside(*turns++) < kInsideWinding - kSureWinding)
            parts[i] = Part::boundary;
    return parts;
}

/// Pieces with edges of no more than so many voxels.
template <typename Visit>
void for_each_cut(const std::vector<TriangleCorners>& triangles, double voxels, const Visit& visit)
{
    for (const TriangleCorners& t : triangles)
        for_each_piece(t[0], t[1], t[2], voxels,
                       [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
                           visit(TriangleCorners{a, b, c});
                       });
}

std::vector<TriangleCorners> cut_up(const std::vector<TriangleCorners>& triangles, double voxels)
{
    std::vector<TriangleCorners> pieces;
    for_each_cut(triangles, voxels, [&](const TriangleCorners& piece) { pieces.push_back(piece); });
    return pieces;
}

/// The voxels around pieces where the winding number says inside, and those where it says outside,
/// each with all voxels that a piece might reach from the one that its middle is in. Where all
/// voxels around a piece are on one side, the grid cannot show another. A soup may have many times
/// more pieces than there are voxels, and nearly all are of this kind.
struct KnownSides {
    openvdb::MaskTree::Ptr inside, outside;
};

std::vector<Coord> active_voxels(const openvdb::MaskTree& tree)
{
    std::vector<Coord> voxels;
    voxels.reserve(tree.activeVoxelCount());
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf)
        for (auto value = leaf->cbeginValueOn(); value; ++value)
            voxels.push_back(value.getCoord());
    return voxels;
}

void dilate(openvdb::MaskTree& tree)
{
    openvdb::tools::dilateActiveValues(tree, kReachVoxels, openvdb::tools::NN_FACE_EDGE_VERTEX,
                                       openvdb::tools::IGNORE_TILES);
}

/// No trees where there are more such voxels than points to look at beside the pieces.
KnownSides sides_around(const std::vector<TriangleCorners>& triangles, WindingGrid& winding)
{
    openvdb::MaskTree around;
    openvdb::tree::ValueAccessor<openvdb::MaskTree> mark(around);
    std::size_t pieces = 0;
    for_each_cut(triangles, kPieceVoxels, [&](const TriangleCorners& piece) {
        mark.setValueOn(Coord::round(middle_of(piece)));
        ++pieces;
    });
    dilate(around);
    if (around.activeVoxelCount() > 2 * pieces)
        return {};
    const std::vector<Coord> voxels = active_voxels(around);
    const std::vector<float> turns = winding.at(voxels);
    KnownSides sides{std::make_shared<openvdb::MaskTree>(), std::make_shared<openvdb::MaskTree>()};
    openvdb::tree::ValueAccessor<openvdb::MaskTree> inside(*sides.inside), outside(*sides.outside);
    for (std::size_t i = 0; i < voxels.size(); ++i)
        (short_of_inside(turns[i]) < 0 ? inside : outside).setValueOn(voxels[i]);
    dilate(*sides.inside);
    dilate(*sides.outside);
    return sides;
}

/// Pieces to ask for, and which of them answers for each.
struct Alike {
    std::vector<TriangleCorners> asked;
    std::vector<std::uint32_t> answer;
};

/// A piece's voxel, and its normal's direction as one of those to a cube's faces, edges and
/// corners. None without area.
using Kind = std::array<int, 6>;

Kind kind_of(const TriangleCorners& piece)
{
    const Stance stance = stance_of(piece);
    const Coord voxel = Coord::round(stance.centre);
    Kind kind{voxel[0], voxel[1], voxel[2], 0, 0, 0};
    if (stance.has_sides)
        for (int axis = 0; axis < 3; ++axis)
            kind[std::size_t(3 + axis)] = int(std::lround(1.2 * stance.normal[axis]));
    return kind;
}

/// The grid shows one surface in a voxel, so pieces that have their middles in one and are turned
/// alike get one answer. It bounds the pieces to ask for by the voxels.
Alike alike_in_a_voxel(const std::vector<TriangleCorners>& pieces)
{
    Alike alike;
    std::map<Kind, std::uint32_t> known;
    for (const TriangleCorners& piece : pieces) {
        const auto next = static_cast<std::uint32_t>(alike.asked.size());
        const auto [at, is_new] = known.try_emplace(kind_of(piece), next);
        if (is_new)
            alike.asked.push_back(piece);
        alike.answer.push_back(at->second);
    }
    return alike;
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
    if (fills_voxels(mesh, band))
        return unsigned_distances_by_voxels(mesh, band);
    return unsigned_distances(mesh, *openvdb::math::Transform::createLinearTransform(1.0), band,
                              nullptr);
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
    sort_unique(beyond);
    return beyond;
}

} // namespace

std::vector<float> WindingGrid::at(const std::vector<Coord>& voxels)
{
    auto turns = turns_.getAccessor();
    std::vector<Coord> missing;
    std::vector<Vec3d> points;
    for (const Coord& voxel : voxels)
        if (!turns.isValueOn(voxel)) {
            missing.push_back(voxel);
            points.push_back(voxel.asVec3d());
        }
    const std::vector<float> computed = turns_at(number_, points);
    for (std::size_t i = 0; i < missing.size(); ++i)
        turns.setValue(missing[i], computed[i]);
    std::vector<float> values;
    values.reserve(voxels.size());
    for (const Coord& voxel : voxels)
        values.push_back(turns.getValue(voxel));
    return values;
}

std::vector<TriangleCorners> cut_to_sum_up(const std::vector<TriangleCorners>& triangles)
{
    return cut_up(triangles, kSummedVoxels);
}

WrapPieces sort_pieces(WindingGrid& winding, const StageProgress& progress)
{
    const std::vector<TriangleCorners>& triangles = winding.number().triangles();
    const KnownSides sides = sides_around(triangles, winding);
    progress.stop_if_interrupted(10);
    WrapPieces pieces;
    // Pieces inside the solid are left out of the field: the distance to them would bring values
    // near zero into the solid.
    const auto put = [&](const TriangleCorners& piece, Part part) {
        const double area = area_of(piece);
        if (part == Part::interior) {
            pieces.interior_area += area;
            return;
        }
        const bool sheet = part == Part::sheet;
        (sheet ? pieces.sheet : pieces.boundary).push_back(piece);
        (sheet ? pieces.sheet_area : pieces.boundary_area) += area;
    };
    // A large triangle may bound the solid in one part and stick out of it in another.
    std::vector<TriangleCorners> open, cut;
    for (const TriangleCorners& triangle : triangles) {
        cut.clear();
        const bool known = sides.inside != nullptr;
        bool outside_only = known;
        for_each_cut({triangle}, kPieceVoxels, [&](const TriangleCorners& piece) {
            cut.push_back(piece);
            outside_only = outside_only && !sides.inside->isValueOn(Coord::round(middle_of(piece)));
        });
        if (outside_only) {
            put(triangle, Part::sheet);
            continue;
        }
        for (const TriangleCorners& piece : cut) {
            const Coord voxel = Coord::round(middle_of(piece));
            if (known && !sides.inside->isValueOn(voxel))
                put(piece, Part::sheet);
            else if (known && !sides.outside->isValueOn(voxel) && area_of(piece) > 0)
                put(piece, Part::interior);
            else
                open.push_back(piece);
        }
    }
    const Alike alike = alike_in_a_voxel(open);
    const std::vector<Part> parts = parts_of(alike.asked, winding.number());
    for (std::size_t i = 0; i < open.size(); ++i)
        put(open[i], parts[alike.answer[i]]);
    progress.stop_if_interrupted(20);
    return pieces;
}

WrapPieces all_sheets(const std::vector<TriangleCorners>& triangles)
{
    WrapPieces pieces;
    pieces.sheet = triangles;
    for (const TriangleCorners& triangle : triangles)
        pieces.sheet_area += area_of(triangle);
    return pieces;
}

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
