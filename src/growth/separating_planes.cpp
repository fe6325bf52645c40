// SPDX-License-Identifier: Apache-2.0

// Takes: the state at the beginning of a round, where no two triangles touch, and the trust radii.
// Leaves: a plane between all pairs that could meet in this round, so that moves of different
// vertices need not know of each other. Any plane between the two triangles of a pair would be
// right; which one decides how thick the shell gets. The argument: docs/theory.md, "Separating
// planes".

#include "growth/separating_planes.h"

#include "core/fail.h"
#include "core/parallel.h"
#include "growth/separation.h"
#include "vdb_shell/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace vdb_shell::growth
{
namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Groups of the tree whose pairs one task lists. The cut depends on the tree alone, never on the
// number of threads.
constexpr std::size_t kGroupsAtOnce = 3;
// In units of the rounding error of a plane's value. A pair is locked where the gap between its
// triangles does not leave each of them this margin on its side of the plane several times over.
constexpr double kLeastGapInErrors = 8, kMarginInErrors = 2;

/// The two faces of a plane: the corners of inner face f lie where value > 0, those of inner face g
/// where it is < 0.
struct Pair {
    int f, g;                 ///< g: -1 for an outer triangle
    std::uint8_t reached = 0; ///< bit k: corner k of f could reach the plane, bit 3 + k: that of g
};

/// What one task lists.
struct Chunk {
    std::vector<SeparatingPlane> plane;
    std::vector<PlaneRange> range;
    std::vector<Pair> pair;
    std::vector<int> locked; ///< faces too close to another for a plane
};

/// A pinned corner belongs to both surfaces: nothing can separate an inner triangle there from an
/// outer one. Moves test such pairs themselves (adjacent_clear_at).
bool share_a_pin(const GrowState& s, int f, int g)
{
    for (int k = 0; k < 3; ++k) {
        const int v = s.mesh->corner(f, k);
        if (s.pinned[v] && s.mesh->incident_to(g, v))
            return true;
    }
    return false;
}

/// Whether the other triangle lies farther than that from the plane through p, on one side.
bool beyond(const Vec3d& normal, const Vec3d& p, const Corners& other, double distance)
{
    const double a = normal.dot(other[0] - p), b = normal.dot(other[1] - p),
                 c = normal.dot(other[2] - p);
    return std::min({a, b, c}) > distance || std::max({a, b, c}) < -distance;
}

/// Bound on the rounding error of SeparatingPlane::value at a point of the shell.
double rounding_of_values(const GrowState& s)
{
    // Four roundings of terms of at most |x|, and the offset's own, with room to spare.
    // GrowState::rounding is that of one coordinate to float32; values are computed in doubles.
    constexpr double kRoundings = 16;
    constexpr double kOfDoubles =
        std::numeric_limits<double>::epsilon() / double(std::numeric_limits<float>::epsilon());
    return kRoundings * kOfDoubles * s.rounding;
}

/// Pairs that wait until there are as many as are computed at once.
struct Waiting {
    std::size_t count = 0;
    std::array<std::array<Corners, 2>, kSlabsAtOnce> corners; ///< what the queries point to
    std::array<SlabQuery, kSlabsAtOnce> query;
    std::array<Pair, kSlabsAtOnce> pair;
};

class Builder
{
public:
    Builder(const GrowState& s, const FaceSnapshot& faces,
            const std::vector<std::uint8_t>& inactive, double rounding_error)
        : s_(s), faces_(faces), inactive_(inactive), error_(rounding_error)
    {
    }

    /// Lists the planes of the triangles of one group of the inner tree, but for the pairs that are
    /// left waiting.
    void list(std::size_t group, BoxTree::Near& near, Waiting& waiting, Chunk& out) const
    {
        const auto moves = [&](int f) { return !faces_.inactive[f]; };
        s_.inner_tree.for_each_overlap_of(group, s_.inner_tree, near, moves, [&](int f, int g) {
            // Each pair once: from its smaller face, or from the one that moves.
            if (g == f || (g < f && moves(g)) || s_.mesh->share_a_corner(f, g))
                return;
            const double enough = faces_.trust_radius[f] + faces_.trust_radius[g];
            add(inner_corners(s_, f), inner_corners(s_, g), faces_.normal[g], enough, {f, g},
                waiting, out);
        });
        s_.inner_tree.for_each_overlap_of(group, s_.outer_tree, near, moves, [&](int f, int g) {
            if (!share_a_pin(s_, f, g))
                add(inner_corners(s_, f), outer_corners(s_, g), faces_.outer_normal[g],
                    faces_.trust_radius[f], {f, -1}, waiting, out);
        });
    }

    void list_waiting(Waiting& waiting, Chunk& out) const
    {
        // The pairs that passed the cheap test are gathered until all lanes have one. A slab
        // depends on its own pair alone, so it makes no difference which pairs happen to be
        // computed together.
        std::array<Slab, kSlabsAtOnce> slab;
        slabs_between(waiting.query.data(), waiting.count, slab.data());
        for (std::size_t i = 0; i < waiting.count; ++i)
            put_plane(waiting.query[i], slab[i], waiting.pair[i], out);
        waiting.count = 0;
    }

private:
    /// Most pairs are left out here: there is room enough across the plane of one of the two.
    void add(const Corners& first, const Corners& second, const Vec3d& normal_of_second,
             double enough, const Pair& pair, Waiting& waiting, Chunk& out) const
    {
        // Far above the relative error of the distances to the plane, in doubles.
        constexpr double kAboveRounding = 1 + 1e-9;
        if (beyond(faces_.normal[pair.f], first[0], second, kAboveRounding * enough) ||
            beyond(normal_of_second, second[0], first, kAboveRounding * enough))
            return;
        std::array<Corners, 2>& corners = waiting.corners[waiting.count] = {first, second};
        waiting.query[waiting.count] = {&corners[0], &corners[1], enough};
        waiting.pair[waiting.count] = pair;
        if (++waiting.count == kSlabsAtOnce)
            list_waiting(waiting, out);
    }

    void put_plane(const SlabQuery& query, const Slab& slab, Pair pair, Chunk& out) const
    {
        const int f = pair.f, g = pair.g;
        if (slab.gap > query.enough)
            return;
        // Too close for doubles to say which side a corner is on: both faces stay for this round.
        if (!(slab.gap > kLeastGapInErrors * error_)) {
            out.locked.push_back(f);
            if (g >= 0)
                out.locked.push_back(g);
            return;
        }
        // Two triangles that move get half the gap each; one that does not move needs none of it.
        const double share = g < 0 || faces_.inactive[g] ? 0.0 : 0.5;
        const double at = slab.hi + std::max(share * slab.gap, kMarginInErrors * error_);
        const SeparatingPlane plane{slab.n, Vec3d(slab.n).dot((*query.first)[0]) + at};
        double room_of_f = kInfinity, room_of_g = kInfinity;
        for (int k = 0; k < 3; ++k) {
            pair.reached |= std::uint8_t(reaches(plane, f, k, 1.0, room_of_f) << k);
            if (share > 0)
                pair.reached |= std::uint8_t(reaches(plane, g, k, -1.0, room_of_g) << (3 + k));
        }
        // A plane that no corner can get to stops nobody.
        if (!pair.reached)
            return;
        out.plane.push_back(plane);
        out.range.push_back({f, share > 0 ? g : -1, plane.d - room_of_g, plane.d + room_of_f});
        out.pair.push_back(pair);
    }

    /// Whether corner k of face f could get to the plane in this round. If not, lowers `room` to
    /// how far the plane is beyond its trust radius.
    bool reaches(const SeparatingPlane& plane, int f, int k, double side, double& room) const
    {
        const int v = s_.mesh->corner(f, k);
        if (inactive_[v])
            return false;
        const double beyond = side * plane.value(s_.trust_centre[v]) -
                              (s_.trust_radius[v] + kMarginInErrors * error_);
        if (beyond >= 0)
            room = std::min(room, beyond);
        return beyond < 0;
    }

    const GrowState& s_;
    const FaceSnapshot& faces_;
    const std::vector<std::uint8_t>& inactive_;
    double error_;
};

template <class Visit> void for_each_reached(const GrowState& s, const Pair& pair, Visit&& visit)
{
    for (int k = 0; k < 3; ++k) {
        if (pair.reached >> k & 1)
            visit(s.mesh->corner(pair.f, k), 0U);
        if (pair.reached >> (3 + k) & 1)
            visit(s.mesh->corner(pair.g, k), 1U);
    }
}

/// Sides are kept in 32 bits: moves read these lists all the time, and half the memory is read
/// sooner.
void require_32_bits(std::size_t sides)
{
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
    if (sides > kMost)
        fail<GeometryError>("growth: ", sides, " sides of separating planes, over the limit of ",
                            kMost, "; --decimate-to makes fewer triangles");
}

/// Puts the planes one after another, in the order of the chunks; gives back where each begins.
std::vector<std::size_t> gather_planes(std::vector<Chunk>& chunks, SeparatingPlanes& planes)
{
    std::vector<std::size_t> base(chunks.size() + 1, 0);
    for (std::size_t c = 0; c < chunks.size(); ++c)
        base[c + 1] = base[c] + chunks[c].plane.size();
    // A side is twice the index of its plane or one more.
    require_32_bits(2 * base.back());
    planes.plane.resize(base.back());
    planes.range.resize(base.back());
    for_each_index(
        chunks.size(),
        [&](std::size_t c) {
            const auto at = static_cast<std::ptrdiff_t>(base[c]);
            std::copy(chunks[c].plane.begin(), chunks[c].plane.end(), planes.plane.begin() + at);
            std::copy(chunks[c].range.begin(), chunks[c].range.end(), planes.range.begin() + at);
            chunks[c].plane = {};
            chunks[c].range = {};
        },
        4);
    return base;
}

/// Bucket sort of the sides by vertex, stable in the order of the planes. Each block of chunks is
/// counted first, so that all blocks can write at the same time, each to places of its own. Linear,
/// and the same lists for any number of threads.
void sort_by_vertex(const GrowState& s, std::vector<Chunk> chunks, SeparatingPlanes& planes)
{
    constexpr std::size_t kBlocks = 8;
    const std::vector<std::size_t> base = gather_planes(chunks, planes);
    const std::size_t vertices = s.b.size();
    std::array<std::vector<std::uint32_t>, kBlocks> next;
    const auto for_each_side = [&](std::size_t block, const auto& visit) {
        const std::size_t end = chunks.size() * (block + 1) / kBlocks;
        for (std::size_t c = chunks.size() * block / kBlocks; c < end; ++c)
            for (std::size_t i = 0; i < chunks[c].pair.size(); ++i)
                for_each_reached(s, chunks[c].pair[i], [&](int v, unsigned side) {
                    visit(v, static_cast<std::uint32_t>(2 * (base[c] + i) + side));
                });
    };
    const auto for_each_block = [&](const auto& body) { for_each_index(kBlocks, body, 1); };
    for_each_block([&](std::size_t block) {
        next[block].resize(vertices);
        for_each_side(block, [&](int v, std::uint32_t) { ++next[block][v]; });
    });
    planes.first.resize(vertices + 1);
    std::size_t total = 0;
    for (std::size_t v = 0; v < vertices; ++v) {
        planes.first[v] = total;
        // Each count gives way to the place of the first side that its block will write.
        for (std::vector<std::uint32_t>& of_block : next)
            total += std::exchange(of_block[v], static_cast<std::uint32_t>(total));
    }
    require_32_bits(total);
    planes.first[vertices] = total;
    planes.side.resize(total);
    for_each_block([&](std::size_t block) {
        for_each_side(block,
                      [&](int v, std::uint32_t side) { planes.side[next[block][v]++] = side; });
    });
}

/// Which vertices must not move: the corners of faces that are too close for a plane.
void lock_close_faces(const GrowState& s, const std::vector<Chunk>& chunks,
                      SeparatingPlanes& planes)
{
    planes.locked.assign(s.b.size(), 0);
    for (const Chunk& chunk : chunks)
        for (const int f : chunk.locked)
            for (int k = 0; k < 3; ++k)
                planes.locked[s.mesh->corner(f, k)] = 1;
}

} // namespace

void separate_triangles(GrowState& s, const std::vector<std::uint8_t>& inactive,
                        SeparatingPlanes& planes, TreeUpdate update)
{
    take_snapshot(s, inactive, planes.faces);
    const FaceSnapshot& faces = planes.faces;
    const bool refit = update == TreeUpdate::refit && s.inner_tree.size() == faces.box.size();
    refit ? s.inner_tree.refit(faces.box) : s.inner_tree.build(faces.box);
    // Ranges of groups are listed apart and joined in order, so the planes do not depend on
    // threads.
    planes.rounding_error = rounding_of_values(s);
    const std::size_t groups = s.inner_tree.groups();
    std::vector<Chunk> chunks((groups + kGroupsAtOnce - 1) / kGroupsAtOnce);
    const Builder builder(s, faces, inactive, planes.rounding_error);
    for_each_index(
        chunks.size(),
        [&](std::size_t c) {
            BoxTree::Near near;
            Waiting waiting;
            const std::size_t end = std::min(groups, (c + 1) * kGroupsAtOnce);
            for (std::size_t group = c * kGroupsAtOnce; group < end; ++group)
                builder.list(group, near, waiting, chunks[c]);
            builder.list_waiting(waiting, chunks[c]);
        },
        1);
    lock_close_faces(s, chunks, planes);
    sort_by_vertex(s, std::move(chunks), planes);
}

void recentre_planes(const GrowState& s, SeparatingPlanes& planes)
{
    const double least_room = kLeastGapInErrors * planes.rounding_error;
    for_each_index(
        planes.plane.size(),
        [&](std::size_t i) {
            const auto& [f, g, least_d, most_d] = planes.range[i];
            if (g < 0)
                return;
            SeparatingPlane& plane = planes.plane[i];
            double room_of_f = kInfinity, room_of_g = kInfinity;
            for (int k = 0; k < 3; ++k) {
                room_of_f = std::min(room_of_f, plane.value(s.b[s.mesh->corner(f, k)]));
                room_of_g = std::min(room_of_g, -plane.value(s.b[s.mesh->corner(g, k)]));
            }
            // With less room than this the middle may be lost in the rounding. The range keeps the
            // plane away from the trust regions of corners that do not have it on their lists.
            if (room_of_f > least_room && room_of_g > least_room)
                plane.d = std::clamp(plane.d + 0.5 * (room_of_f - room_of_g), least_d, most_d);
        },
        256);
}

} // namespace vdb_shell::growth
