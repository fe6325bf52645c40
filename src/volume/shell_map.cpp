// SPDX-License-Identifier: Apache-2.0

#include "vdb_shell/volume/shell_map.h"

#include "core/parallel.h"
#include "core/stage_stop.h"
#include "mesh/topology.h"
#include "vdb_shell/shell/core_tets.h"
#include "volume/wedge.h"

#include <openvdb/math/Math.h>

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

// Takes a finished stack and its tets; tells where a point is in the shell, and where a place of
// the shell is in space. A point comes with a tet that holds it, so nothing is searched here: its
// linear weights in that tet are the first guess of its place in the curved prism, and Newton's
// method (wedge.h) does the rest. Prisms whose map may not be one-to-one stay linear in their tets
// (docs/theory.md, "Coordinates of a shell").
namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;
using openvdb::Vec4d;

/// By triangle and corner: the triangle across the side that is opposite the corner. The skin of a
/// shell is a closed manifold, so sorting puts the two uses of each edge side by side; a side
/// without a partner keeps kNone.
std::vector<Vec3I> triangles_beyond(const std::vector<Vec3I>& triangles)
{
    std::vector<Vec3I> beyond(triangles.size(), Vec3I(ShellPlace::kNone));
    const EdgeUses uses = sorted_edge_uses(triangles);
    for (std::size_t i = 0; i + 1 < uses.size(); ++i) {
        const EdgeUse &a = uses[i], &b = uses[i + 1];
        if (a.edge != b.edge)
            continue;
        // Side i runs from corner i to the next, so it is opposite the one after that.
        beyond[a.triangle][(a.side + 2) % 3] = b.triangle;
        beyond[b.triangle][(b.side + 2) % 3] = a.triangle;
    }
    return beyond;
}

/// In doubles, for Newton's method goes on to more digits than float32 has.
template <typename Corners> Wedge wedge_of(const Corners& corners)
{
    Wedge wedge;
    for (std::size_t i = 0; i < 3; ++i) {
        wedge.outer[i] = Vec3d(corners[i]);
        wedge.inner[i] = Vec3d(corners[i + 3]);
    }
    return wedge;
}

WedgePlace wedge_place(const Vec4d& weight)
{
    return {weight[1], weight[2], weight[3]};
}

/// Weights that add up to one in spite of rounding.
Vec4d weights_of(const WedgePlace& place)
{
    return {1.0 - place[0] - place[1], place[0], place[1], place[2]};
}

/// Mean of the prism's coordinates over the corners that are one point. Where outer and inner ones
/// are, the point is on the outer surface.
WedgePlace corner_place(std::uint8_t bits)
{
    WedgePlace sum(0.0);
    int count = 0;
    // The lower three bits are the outer corners in the order of the triangle, the upper three the
    // inner ones.
    const bool outer = (bits & 7) != 0;
    for (int k = 0; k < 6; ++k)
        if ((bits >> k & 1) != 0 && (k < 3) == outer) {
            sum += WedgePlace(k % 3 == 1, k % 3 == 2, k >= 3);
            ++count;
        }
    return count == 0 ? sum : sum / count;
}

/// A point's weights in a tet as coordinates of the prism, linear between the tet's corners. In a
/// curved prism the point is not quite there, but near enough for Newton's method to begin.
WedgePlace place_of_weights(const std::array<std::uint8_t, 4>& bits, const Vec4d& weight)
{
    WedgePlace place(0.0);
    for (std::size_t i = 0; i < 4; ++i)
        place += weight[int(i)] * corner_place(bits[i]);
    return place;
}

/// Points on sides are both prisms'. The unit is that of the weights.
constexpr double kOnSide = 1e-9;

bool all_inside(const Vec4d& weight)
{
    for (int i = 0; i < 4; ++i)
        // Turned round, so that weights that are no numbers, as a flat tet gives, count as outside.
        if (!(weight[i] >= -kOnSide))
            return false;
    return true;
}

} // namespace

ShellMap::ShellMap(const ShellStack& stack, TetMesh tets)
    : tets_(std::move(tets)), triangles_(stack.triangles().size()),
      beyond_(triangles_beyond(stack.triangles()))
{
    corners_.resize(stack.layers.size() * triangles_);
    curved_.assign(corners_.size(), 0);
    has_tets_.assign(corners_.size(), 0);
    for_each_index(corners_.size(), [&](std::size_t p) {
        const PrismShell& layer = stack.layers[p / triangles_];
        const Vec3I& triangle = stack.triangles()[p % triangles_];
        for (std::size_t i = 0; i < 3; ++i) {
            corners_[p][i] = layer.outer[triangle[int(i)]];
            corners_[p][i + 3] = layer.inner[triangle[int(i)]];
        }
        // Prism by prism: one that fails does not make its neighbours linear. So the side between
        // them is curved for one and flat for the other, which place_of has to bear.
        curved_[p] = has_positive_jacobian(wedge_of(corners_[p]));
    });
    corner_bits_.resize(tets_.tets.size());
    for (std::size_t t = 0; t < tets_.tets.size(); ++t) {
        stop_if_stage_wants(t);
        if (tets_.prism[t] == kCorePrism)
            continue;
        const std::size_t p = tets_.prism_layer[t] * triangles_ + tets_.prism[t];
        has_tets_[p] = 1;
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t k = 0; k < 6; ++k)
                // By place and not by index, for the tets number points in their own way. A pinned
                // inner corner has the place of its outer one, and tapering gives several corners
                // one place, so a corner of a tet may have several bits.
                if (corners_[p][k] == tets_.points[tets_.tets[t][int(i)]])
                    corner_bits_[t][i] = std::uint8_t(corner_bits_[t][i] | 1u << k);
    }
    count_prisms();
}

/// A prism that has no tets left, by three pins or by tapering, has no inside and is not counted.
void ShellMap::count_prisms()
{
    prisms_ = linear_prisms_ = 0;
    for (std::size_t p = 0; p < corners_.size(); ++p) {
        prisms_ += has_tets_[p];
        linear_prisms_ += has_tets_[p] && !curved_[p];
    }
}

void make_linear_alike(ShellMap& a, ShellMap& b)
{
    assert(a.curved_.size() == b.curved_.size());
    for (std::size_t p = 0; p < a.curved_.size(); ++p)
        a.curved_[p] = b.curved_[p] = a.curved_[p] && b.curved_[p];
    a.count_prisms();
    b.count_prisms();
}

Vec4d ShellMap::tet_weights(std::uint32_t tet, const Vec3d& point) const
{
    const openvdb::Vec4I& corner = tets_.tets[tet];
    const Vec3d a(tets_.points[corner[0]]);
    const Vec3d b = Vec3d(tets_.points[corner[1]]) - a, c = Vec3d(tets_.points[corner[2]]) - a,
                d = Vec3d(tets_.points[corner[3]]) - a, p = point - a;
    // Cramer's rule. Numerators and determinant change their signs together, so an inverted tet
    // needs no case of its own.
    const Vec3d cd = c.cross(d);
    const double det = b.dot(cd);
    const Vec3d weight(p.dot(cd) / det, p.dot(d.cross(b)) / det, p.dot(b.cross(c)) / det);
    return {1.0 - weight[0] - weight[1] - weight[2], weight[0], weight[1], weight[2]};
}

bool ShellMap::holds(std::uint32_t tet, const Vec3d& point) const
{
    return all_inside(tet_weights(tet, point));
}

ShellPlace ShellMap::linear_place(std::uint32_t tet, const Vec4d& weight) const
{
    ShellPlace place;
    place.tet = tet;
    place.weight = weight;
    return place;
}

ShellPlace ShellMap::place_in(std::uint32_t tet, const Vec3d& point) const
{
    return place_of(tet, tet_weights(tet, point), point);
}

ShellPlace ShellMap::find_in(std::uint32_t tet, const Vec3d& point) const
{
    const Vec4d weight = tet_weights(tet, point);
    return all_inside(weight) ? place_of(tet, weight, point) : ShellPlace();
}

/// The tet says which prism would have the point if sides were flat; where a side is curved the
/// point may lie beyond it, and the most negative weight says beyond which. Invariant of the loop:
/// `triangle` has a curved prism in this layer, and `best` is the place, of those seen so far, that
/// leaves its prism least. Where the prism beside is linear it would not have the point either:
/// that is in the sliver between its flat side and this curved one, and keeps its negative weight.
/// Where Newton's method does not settle, or more than a whole prism away, the tet's own weights
/// stand.
ShellPlace ShellMap::place_of(std::uint32_t tet, const Vec4d& weight, const Vec3d& point) const
{
    if (tets_.prism[tet] == kCorePrism)
        return linear_place(tet, weight);
    const std::size_t layer = tets_.prism_layer[tet] * triangles_;
    std::uint32_t triangle = tets_.prism[tet];
    if (!curved_[layer + triangle])
        return linear_place(tet, weight);
    WedgePlace guess = place_of_weights(corner_bits_[tet], weight);
    ShellPlace best = linear_place(tet, weight);
    double best_outside = 1.0;
    for (int i = 0; i < kMostPrisms; ++i) {
        const auto prism = std::uint32_t(layer + triangle);
        const std::optional<WedgePlace> found =
            vdb_shell::place_of(wedge_of(corners_[prism]), point, guess);
        if (!found)
            break;
        const Vec4d at = weights_of(*found);
        const double outside = outside_of(*found);
        if (outside < best_outside) {
            best.prism = prism;
            best.weight = at;
            best_outside = outside;
        }
        // Outer and inner triangles are flat: there the tet has decided.
        const int least = int(openvdb::math::MinIndex(Vec3d(at[0], at[1], at[2])));
        if (at[least] >= -kOnSide)
            break;
        triangle = beyond_[triangle][least];
        if (triangle == ShellPlace::kNone || !curved_[layer + triangle])
            break;
        // The neighbour numbers its corners differently; only the depth is the same.
        guess = {1.0 / 3, 1.0 / 3, std::clamp(at[3], 0.0, 1.0)};
    }
    return best;
}

std::vector<std::uint8_t>
ShellMap::tets_that(const std::function<bool(const openvdb::BBoxd&)>& meets) const
{
    std::vector<std::uint8_t> prism(corners_.size()), tet(tets_.tets.size());
    for_each_index(corners_.size(), [&](std::size_t p) {
        openvdb::BBoxd box;
        for (const Vec3s& corner : corners_[p])
            box.expand(Vec3d(corner));
        prism[p] = meets(box);
    });
    prism = with_prisms_beside(std::move(prism));
    for_each_index(tet.size(), [&](std::size_t t) {
        if (tets_.prism[t] == kCorePrism) {
            openvdb::BBoxd box;
            for (int i = 0; i < 4; ++i)
                box.expand(Vec3d(tets_.points[tets_.tets[t][i]]));
            tet[t] = meets(box);
            return;
        }
        tet[t] = prism[tets_.prism_layer[t] * triangles_ + tets_.prism[t]];
    });
    return tet;
}

/// A place that is looked for from a tet is found in its own prism or in one that place_of goes on
/// to, across a side each time.
std::vector<std::uint8_t> ShellMap::with_prisms_beside(std::vector<std::uint8_t> prism) const
{
    for (int step = 1; step < kMostPrisms; ++step) {
        const std::vector<std::uint8_t> before = prism;
        for_each_index(prism.size(), [&](std::size_t p) {
            const std::size_t triangle = p % triangles_, layer = p - triangle;
            for (int i = 0; i < 3; ++i)
                if (const std::uint32_t beside = beyond_[triangle][i]; beside != ShellPlace::kNone)
                    prism[p] = prism[p] || before[layer + beside];
        });
    }
    return prism;
}

Vec3d ShellMap::point_of(const ShellPlace& place) const
{
    if (place.prism != ShellPlace::kNone)
        return vdb_shell::point_of(wedge_of(corners_[place.prism]), wedge_place(place.weight));
    Vec3d point(0.0);
    for (int i = 0; i < 4; ++i)
        point += place.weight[i] * Vec3d(tets_.points[tets_.tets[place.tet][i]]);
    return point;
}

openvdb::Mat3d ShellMap::jacobian_of(const ShellPlace& place) const
{
    if (place.prism != ShellPlace::kNone)
        return vdb_shell::jacobian_of(wedge_of(corners_[place.prism]), wedge_place(place.weight));
    const openvdb::Vec4I& corner = tets_.tets[place.tet];
    const Vec3d a(tets_.points[corner[0]]);
    // Affine in the tet, so its edges from corner 0 are the derivatives by the three other weights.
    return {Vec3d(tets_.points[corner[1]]) - a, Vec3d(tets_.points[corner[2]]) - a,
            Vec3d(tets_.points[corner[3]]) - a, false};
}

SurfacePlace ShellMap::on_surface(const ShellPlace& place) const
{
    SurfacePlace on;
    if (place.prism == ShellPlace::kNone && tets_.prism[place.tet] == kCorePrism)
        return on;
    WedgePlace at = wedge_place(place.weight);
    if (place.prism != ShellPlace::kNone) {
        on.triangle = std::uint32_t(place.prism % triangles_);
        on.layer = std::uint32_t(place.prism / triangles_);
    } else {
        on.triangle = tets_.prism[place.tet];
        on.layer = tets_.prism_layer[place.tet];
        at = place_of_weights(corner_bits_[place.tet], place.weight);
    }
    on.weight = {1.0 - at[0] - at[1], at[0], at[1]};
    // By rounding a place may be a little above its layer or below it; depths are added up over
    // layers and must stay within theirs.
    on.share = std::clamp(at[2], 0.0, 1.0);
    return on;
}

} // namespace vdb_shell
