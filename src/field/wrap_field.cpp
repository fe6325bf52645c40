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
#include "core/stage_stop.h"
#include "field/mesh_distances.h"
#include "resample/triangle_pieces.h"

#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <array>
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
// How many pieces and voxels ask for the winding number together: with fewer the tree is walked
// more often, with more less of it is far from all of them.
constexpr std::size_t kPiecesAtOnce = 64;
constexpr int kBlockSideLog = 2;
constexpr std::size_t kBlockVoxels = std::size_t(1) << (3 * kBlockSideLog);

enum class Part : char { boundary, sheet, interior };

/// By how much a winding number is short of the inside, in turns; negative in the solid. The
/// absolute value lets a component be inside out.
double short_of_inside(float turns)
{
    return kInsideWinding - std::abs(double(turns));
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
    Stance stance{(piece[0] + piece[1] + piece[2]) / 3.0,
                  (piece[1] - piece[0]).cross(piece[2] - piece[0]), true};
    stance.has_sides = stance.normal.normalize();
    return stance;
}

/// What a run of pieces is, which stand near each other: first just above and below each, then
/// where only one side is inside, at the depth at which a solid is one.
void sort_run(const TriangleCorners* pieces, std::size_t count, const WindingNumber& winding,
              Part* parts)
{
    std::array<Stance, kPiecesAtOnce> stances{};
    std::array<Vec3d, 2 * kPiecesAtOnce> points{};
    std::array<float, 2 * kPiecesAtOnce> turns{};
    for (std::size_t i = 0; i < count; ++i) {
        stances[i] = stance_of(pieces[i]);
        points[2 * i] = stances[i].centre + kBesideVoxels * stances[i].normal;
        points[2 * i + 1] = stances[i].centre - kBesideVoxels * stances[i].normal;
    }
    winding.around(points.data(), 2 * count, turns.data());
    std::size_t deep = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const bool above = short_of_inside(turns[2 * i]) < 0;
        const bool below = short_of_inside(turns[2 * i + 1]) < 0;
        parts[i] = above && below && stances[i].has_sides ? Part::interior : Part::sheet;
        if (above == below || !stances[i].has_sides)
            continue; // without area it leaves a trace as a sheet
        stances[i].inner_side = above ? 1 : -1;
        points[deep++] =
            stances[i].centre + stances[i].inner_side * kSolidVoxels * stances[i].normal;
    }
    winding.around(points.data(), deep, turns.data());
    deep = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (stances[i].inner_side != 0 &&
            short_of_inside(turns[deep++]) < kInsideWinding - kSureWinding)
            parts[i] = Part::boundary;
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

/// The parts of the field at voxels. An accessor must not be shared, so each range of voxels has an
/// object of its own.
class FieldValues
{
public:
    FieldValues(const openvdb::FloatGrid& boundary, const openvdb::FloatGrid& sheet,
                const WindingNumber& winding, double sheet_voxels)
        : boundary_(boundary.getConstAccessor()), sheet_(sheet.getConstAccessor()),
          winding_(winding), sheet_voxels_(sheet_voxels)
    {
    }

    /// At voxels of one block.
    void at(const Coord* voxels, std::size_t count, float* values)
    {
        std::array<Vec3d, kBlockVoxels> points{};
        for (std::size_t i = 0; i < count; ++i)
            points[i] = voxels[i].asVec3d();
        winding_.around(points.data(), count, values);
        for (std::size_t i = 0; i < count; ++i)
            values[i] = value(voxels[i], short_of_inside(values[i]));
    }

private:
    float value(const Coord& voxel, double turns)
    {
        // On a triangle that bounds a solid the winding number jumps and the distance is 0. In a
        // gap the distance is not small, but the winding number passes its threshold continuously.
        // So the smaller of both has its zero set on the triangles and across the gaps.
        const double depth = std::min(
            {double(boundary_.getValue(voxel)), kVoxelsPerTurn * std::abs(turns), kBandVoxels});
        const double solid = turns < 0 ? -depth : depth;
        return static_cast<float>(std::min(solid, double(sheet_.getValue(voxel)) - sheet_voxels_));
    }

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

Coord block_of(const Coord& voxel)
{
    return voxel >> kBlockSideLog;
}

/// By block, and in a block by coordinate: the order does not depend on how the voxels were found.
void sort_and_unite(std::vector<Coord>& voxels)
{
    std::sort(voxels.begin(), voxels.end(), [](const Coord& a, const Coord& b) {
        const Coord block_a = block_of(a), block_b = block_of(b);
        return block_a == block_b ? a < b : block_a < block_b;
    });
    voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
}

/// Where each block begins in sorted voxels, and their number.
std::vector<std::size_t> block_begins(const std::vector<Coord>& voxels)
{
    std::vector<std::size_t> begins;
    for (std::size_t i = 0; i < voxels.size(); ++i)
        if (i == 0 || block_of(voxels[i]) != block_of(voxels[i - 1]))
            begins.push_back(i);
    begins.push_back(voxels.size());
    return begins;
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

WrapPieces sort_pieces(const WindingNumber& winding, const StageProgress& progress)
{
    const std::vector<TriangleCorners> all = cut_up(winding.triangles());
    std::vector<Part> parts(all.size());
    for_each_index((all.size() + kPiecesAtOnce - 1) / kPiecesAtOnce, [&](std::size_t run) {
        stop_if_stage_wants();
        const std::size_t begin = run * kPiecesAtOnce;
        sort_run(&all[begin], std::min(kPiecesAtOnce, all.size() - begin), winding, &parts[begin]);
    });
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
        const std::vector<std::size_t> begins = block_begins(fresh);
        for_each_range(begins.size() - 1, [&](std::size_t begin, std::size_t end) {
            FieldValues values_at(*boundary, *sheet, winding, sheet_voxels);
            for (std::size_t b = begin; b < end; ++b) {
                stop_if_stage_wants();
                values_at.at(&fresh[begins[b]], begins[b + 1] - begins[b], &computed[begins[b]]);
            }
        });
        for (std::size_t i = 0; i < fresh.size(); ++i)
            values.setValue(fresh[i], computed[i]);
        fresh = beyond_sign_changes(fresh, *field);
    }
    openvdb::tools::signedFloodFill(field->tree());
    return field;
}

} // namespace vdb_shell
