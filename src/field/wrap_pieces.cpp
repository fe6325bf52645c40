// SPDX-License-Identifier: Apache-2.0
// Takes: the triangles of a wrap. Gives: which of them, or which parts of them, bound a solid, are
// sheets, or stand inside, by the winding number on both sides. Where all voxels around a piece are
// on one side, these tell it; the others are looked at one by one. docs/stages/wrap.md, "What a
// wrap is", explains the numbers.

#include "field/wrap_pieces.h"

#include "core/stage_stop.h"
#include "field/winding_field.h"
#include "resample/triangle_pieces.h"

#include <openvdb/tools/Morphology.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>

namespace vdb_shell
{
namespace
{

using openvdb::Coord;
using openvdb::Vec3d;

// Lines can step into a solid that is deeper than this, and it can be meshed without help.
constexpr double kSolidVoxels = 1.5;
// At that depth the winding number has to be clear of doubt. Beside a triangle that is turned the
// wrong way it is not, and a part without a thickness of its own would leak there.
constexpr double kSureWinding = 0.75;
// The distance from the surface at which the two sides of a piece are looked at.
constexpr double kBesideVoxels = 0.3;
constexpr double kPieceVoxels = 2.0;
// What the winding number is summed up of is cut, so that few triangles are near to a point: long
// ones would be near to most of the grid. Half as long, the faces of a tet mesh take a tenth longer
// and 8,000 needles a tenth less time, and there are three times as many triangles.
constexpr double kSummedVoxels = 8.0;
// From the voxel that the middle of a piece is in to all that are nearer to it than kSolidVoxels.
constexpr int kReachVoxels = 2;

enum class Part : char { boundary, sheet, interior };

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
void for_each_cut(const TriangleCorners& triangle, double voxels, const Visit& visit)
{
    for_each_piece(triangle[0], triangle[1], triangle[2], voxels,
                   [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
                       visit(TriangleCorners{a, b, c});
                   });
}

template <typename Visit>
void for_each_cut(const std::vector<TriangleCorners>& triangles, double voxels, const Visit& visit)
{
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        stop_if_stage_wants(t);
        for_each_cut(triangles[t], voxels, visit);
    }
}

/// The voxels around pieces where the winding number says inside, and those where it says outside,
/// each with all voxels that a piece might reach from the one that its middle is in. Where all
/// voxels around a piece are on one side, the grid cannot show another. A soup may have many times
/// more pieces than there are voxels, and nearly all are of this kind.
struct KnownSides {
    openvdb::MaskTree::Ptr inside, outside;
};

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

/// Pieces to ask for. The grid shows one surface in a voxel, so pieces that have their middles in
/// one and are turned alike get one answer, which bounds the pieces to ask for by the voxels.
class Questions
{
public:
    void add(const TriangleCorners& piece)
    {
        const auto next = static_cast<std::uint32_t>(asked_.size());
        const auto [at, is_new] = known_.try_emplace(kind_of(piece), next);
        if (is_new)
            asked_.push_back(piece);
        answer_.push_back(at->second);
    }
    const std::vector<TriangleCorners>& asked() const { return asked_; }
    /// For each piece that was added, which of those that are asked answers for it.
    const std::vector<std::uint32_t>& answer() const { return answer_; }

private:
    std::vector<TriangleCorners> asked_;
    std::vector<std::uint32_t> answer_;
    std::map<Kind, std::uint32_t> known_;
};

double area_of(const TriangleCorners& t)
{
    return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).length();
}

/// None: it has to be asked for.
std::optional<Part> known_part(const TriangleCorners& piece, const KnownSides& sides)
{
    if (!sides.inside)
        return {};
    const Coord voxel = Coord::round(middle_of(piece));
    if (!sides.inside->isValueOn(voxel))
        return Part::sheet;
    if (!sides.outside->isValueOn(voxel) && area_of(piece) > 0)
        return Part::interior;
    return {};
}

/// Pieces inside the solid are left out: the distance to them would bring values near zero into the
/// solid.
void put(const TriangleCorners& piece, Part part, WrapPieces& pieces)
{
    const double area = area_of(piece);
    if (part == Part::interior) {
        pieces.interior_area += area;
        return;
    }
    const bool sheet = part == Part::sheet;
    (sheet ? pieces.sheet : pieces.boundary).push_back(piece);
    (sheet ? pieces.sheet_area : pieces.boundary_area) += area;
}

} // namespace

std::vector<TriangleCorners> cut_to_sum_up(const std::vector<TriangleCorners>& triangles)
{
    std::vector<TriangleCorners> pieces;
    for_each_cut(triangles, kSummedVoxels,
                 [&](const TriangleCorners& piece) { pieces.push_back(piece); });
    return pieces;
}

WrapPieces sort_pieces(WindingGrid& winding, const StageProgress& progress)
{
    const std::vector<TriangleCorners>& triangles = winding.number().triangles();
    const KnownSides sides = sides_around(triangles, winding);
    progress.stop_if_interrupted(10);
    Questions questions;
    for_each_cut(triangles, kPieceVoxels, [&](const TriangleCorners& piece) {
        if (!known_part(piece, sides))
            questions.add(piece);
    });
    const std::vector<Part> answers = parts_of(questions.asked(), winding.number());
    progress.stop_if_interrupted(20);
    // Cut a second time, since a soup may have many times more pieces than the memory holds.
    WrapPieces pieces;
    auto answer = questions.answer().begin();
    std::vector<TriangleCorners> cut;
    std::vector<Part> parts;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        stop_if_stage_wants(t);
        cut.clear(), parts.clear();
        for_each_cut(triangles[t], kPieceVoxels, [&](const TriangleCorners& piece) {
            const std::optional<Part> known = known_part(piece, sides);
            cut.push_back(piece);
            parts.push_back(known ? *known : answers[*answer++]);
        });
        // A large triangle may bound the solid in one part and stick out of it in another.
        const bool one = std::equal(parts.begin() + 1, parts.end(), parts.begin());
        if (one)
            put(triangles[t], parts.front(), pieces);
        for (std::size_t i = 0; i < cut.size() && !one; ++i)
            put(cut[i], parts[i], pieces);
    }
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

} // namespace vdb_shell
