// SPDX-License-Identifier: Apache-2.0
#include "growth/walls.h"

#include "core/parallel.h"
#include "growth/separation.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace vdb_shell::growth
{
namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kChunk = 3; ///< groups of faces whose walls are listed together

/// Whose wall it is: corners 0..2 of face f lie where value > 0, those of inner face g where it is
/// < 0.
struct Owners {
    int f, g;                 ///< g: -1 for an outer triangle
    std::uint8_t reached = 0; ///< bit k: corner k of f, bit 3 + k: corner k of g
};

struct Chunk {
    std::vector<Wall> wall;
    std::vector<WallPlace> place; ///< of each wall
    std::vector<Owners> owners;
    std::vector<int> locked; ///< faces
};

bool share_a_pin(const GrowState& s, int f, int g)
{
    for (int k = 0; k < 3; ++k) {
        const int v = s.mesh->corner(f, k);
        if (s.pinned[v] && s.mesh->incident_to(g, v))
            return true;
    }
    return false;
}

Vec3d unit_normal(const Corners& c)
{
    const Vec3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
    const double length = normal.length();
    return length > 0 ? normal / length : Vec3d(0.0);
}

/// Whether the other triangle lies farther than that from the plane through p, on one side.
bool beyond(const Vec3d& normal, const Vec3d& p, const Corners& other, double distance)
{
    const double a = normal.dot(other[0] - p), b = normal.dot(other[1] - p),
                 c = normal.dot(other[2] - p);
    return std::min({a, b, c}) > distance || std::max({a, b, c}) < -distance;
}

void take_stock_of_outer(const GrowState& s, FaceStock& stock)
{
    const std::size_t count = s.mesh->faces.size();
    stock.outer.resize(count);
    stock.outer_normal.resize(count);
    for_each_index(
        count,
        [&](std::size_t f) {
            stock.outer[f] = outer_corners(s, static_cast<int>(f));
            stock.outer_normal[f] = unit_normal(stock.outer[f]);
        },
        256);
}

void take_stock(GrowState& s, const std::vector<std::uint8_t>& still, FaceStock& stock)
{
    const std::size_t count = s.mesh->faces.size();
    s.home = s.b;
    if (stock.outer.empty())
        take_stock_of_outer(s, stock);
    stock.corner.resize(count);
    stock.normal.resize(count);
    stock.reach.resize(count);
    stock.box.resize(count);
    stock.still.resize(count);
    for_each_index(
        count,
        [&](std::size_t i) {
            const int f = static_cast<int>(i);
            double reach = 0;
            stock.still[f] = 1;
            for (int k = 0; k < 3; ++k) {
                const int v = s.mesh->corner(f, k);
                if (still[v])
                    continue;
                reach = std::max(reach, s.reach[v]);
                stock.still[f] = 0;
            }
            stock.corner[f] = inner_corners(s, f);
            stock.normal[f] = unit_normal(stock.corner[f]);
            stock.reach[f] = reach;
            stock.box[f] = float_box_of(stock.corner[f], reach);
        },
        256);
}

/// GrowState::rounding is that of one coordinate to float32.
double rounding_of_walls(const GrowState& s)
{
    // Four roundings of terms of at most |x|, and the offset's own.
    constexpr double kRoundings = 16;
    constexpr double kOfDoubles =
        std::numeric_limits<double>::epsilon() / double(std::numeric_limits<float>::epsilon());
    return kRoundings * kOfDoubles * s.rounding;
}

class Builder
{
public:
    Builder(const GrowState& s, const FaceStock& stock, const std::vector<std::uint8_t>& still,
            double slack)
        : s_(s), stock_(stock), still_(still), slack_(slack)
    {
    }

    /// Pairs that wait until there are enough of them.
    struct Waiting {
        std::size_t count = 0;
        std::array<SlabQuery, kSlabsAtOnce> query;
        std::array<Owners, kSlabsAtOnce> owners;
    };

    /// The walls of the triangles of one group of the inner tree, but for those that are left
    /// waiting.
    void list(std::size_t group, BoxTree::Near& near, Waiting& waiting, Chunk& out) const
    {
        const auto moves = [&](int f) { return !stock_.still[f]; };
        s_.inner_tree.for_each_overlap_of(group, s_.inner_tree, near, moves, [&](int f, int g) {
            // Each pair once: from its smaller face, or from the one that moves.
            if (g == f || (g < f && moves(g)) || s_.mesh->share_a_corner(f, g))
                return;
            add({&stock_.corner[f], &stock_.corner[g], stock_.reach[f] + stock_.reach[g]},
                stock_.normal[g], {f, g}, waiting, out);
        });
        s_.inner_tree.for_each_overlap_of(group, s_.outer_tree, near, moves, [&](int f, int g) {
            if (!share_a_pin(s_, f, g))
                add({&stock_.corner[f], &stock_.outer[g], stock_.reach[f]}, stock_.outer_normal[g],
                    {f, -1}, waiting, out);
        });
    }

    void list_waiting(Waiting& waiting, Chunk& out) const
    {
        std::array<Slab, kSlabsAtOnce> slab;
        slabs_between(waiting.query.data(), waiting.count, slab.data());
        for (std::size_t i = 0; i < waiting.count; ++i)
            put_wall(waiting.query[i], slab[i], waiting.owners[i], out);
        waiting.count = 0;
    }

private:
    /// Most pairs are left out here: across the plane of one of the two is room enough.
    void add(const SlabQuery& query, const Vec3d& normal_of_second, const Owners& owners,
             Waiting& waiting, Chunk& out) const
    {
        constexpr double kAboveRounding = 1 + 1e-9;
        const double enough = kAboveRounding * query.enough;
        if (beyond(stock_.normal[owners.f], (*query.first)[0], *query.second, enough) ||
            beyond(normal_of_second, (*query.second)[0], *query.first, enough))
            return;
        waiting.query[waiting.count] = query;
        waiting.owners[waiting.count] = owners;
        if (++waiting.count == kSlabsAtOnce)
            list_waiting(waiting, out);
    }

    void put_wall(const SlabQuery& query, const Slab& slab, Owners owners, Chunk& out) const
    {
        const int f = owners.f, g = owners.g;
        if (slab.gap > query.enough)
            return;
        if (!(slab.gap > 8 * slack_)) {
            out.locked.push_back(f);
            if (g >= 0)
                out.locked.push_back(g);
            return;
        }
        // The share of the gap that goes to the other triangle.
        const double share = g < 0 || stock_.still[g] ? 0.0 : 0.5;
        const double at = slab.hi + std::max(share * slab.gap, 2 * slack_);
        const Wall wall{slab.n, Vec3d(slab.n).dot((*query.first)[0]) + at};
        double room_of_f = kInfinity, room_of_g = kInfinity;
        for (int k = 0; k < 3; ++k) {
            owners.reached |= std::uint8_t(reaches(wall, f, k, 1.0, room_of_f) << k);
            if (share > 0)
                owners.reached |= std::uint8_t(reaches(wall, g, k, -1.0, room_of_g) << (3 + k));
        }
        if (!owners.reached)
            return;
        out.wall.push_back(wall);
        out.place.push_back({f, share > 0 ? g : -1, wall.d - room_of_g, wall.d + room_of_f});
        out.owners.push_back(owners);
    }

    /// Lowers `room` to how far the wall is beyond the reach of a corner that does not reach it.
    bool reaches(const Wall& wall, int f, int k, double side, double& room) const
    {
        const int v = s_.mesh->corner(f, k);
        if (still_[v])
            return false;
        const double beyond = side * wall.value(s_.home[v]) - (s_.reach[v] + 2 * slack_);
        if (beyond >= 0)
            room = std::min(room, beyond);
        return beyond < 0;
    }

    const GrowState& s_;
    const FaceStock& stock_;
    const std::vector<std::uint8_t>& still_;
    double slack_;
};

template <class Visit> void for_each_reached(const GrowState& s, const Owners& o, Visit&& visit)
{
    for (int k = 0; k < 3; ++k) {
        if (o.reached >> k & 1)
            visit(s.mesh->corner(o.f, k), 0U);
        if (o.reached >> (3 + k) & 1)
            visit(s.mesh->corner(o.g, k), 1U);
    }
}

/// Puts the walls one after another, in the order of the chunks; gives back where each begins.
std::vector<std::size_t> gather_walls(std::vector<Chunk>& chunks, Walls& w)
{
    std::vector<std::size_t> base(chunks.size() + 1, 0);
    for (std::size_t c = 0; c < chunks.size(); ++c)
        base[c + 1] = base[c] + chunks[c].wall.size();
    assert(base.back() < std::numeric_limits<std::uint32_t>::max() / 2);
    w.wall.resize(base.back());
    w.place.resize(base.back());
    for_each_index(
        chunks.size(),
        [&](std::size_t c) {
            std::copy(chunks[c].wall.begin(), chunks[c].wall.end(),
                      w.wall.begin() + std::ptrdiff_t(base[c]));
            std::copy(chunks[c].place.begin(), chunks[c].place.end(),
                      w.place.begin() + std::ptrdiff_t(base[c]));
            chunks[c].wall = {};
            chunks[c].place = {};
        },
        4);
    return base;
}

/// Lists by vertex, in the order of the walls: counted first, by blocks of chunks, so that each
/// block knows where its own go.
void hand_out(const GrowState& s, std::vector<Chunk> chunks, Walls& w)
{
    constexpr std::size_t kBlocks = 8;
    const std::vector<std::size_t> base = gather_walls(chunks, w);
    const std::size_t vertices = s.b.size();
    std::array<std::vector<std::uint32_t>, kBlocks> next;
    const auto for_each_side = [&](std::size_t block, const auto& visit) {
        const std::size_t end = chunks.size() * (block + 1) / kBlocks;
        for (std::size_t c = chunks.size() * block / kBlocks; c < end; ++c)
            for (std::size_t i = 0; i < chunks[c].owners.size(); ++i)
                for_each_reached(s, chunks[c].owners[i], [&](int v, unsigned side) {
                    visit(v, static_cast<std::uint32_t>(2 * (base[c] + i) + side));
                });
    };
    for_each_index(
        kBlocks,
        [&](std::size_t block) {
            next[block].resize(vertices);
            for_each_side(block, [&](int v, std::uint32_t) { ++next[block][v]; });
        },
        1);
    w.first.resize(vertices + 1);
    std::uint32_t total = 0;
    for (std::size_t v = 0; v < vertices; ++v) {
        w.first[v] = total;
        for (std::vector<std::uint32_t>& of_block : next)
            total += std::exchange(of_block[v], total);
    }
    w.first[vertices] = total;
    w.side.resize(total);
    for_each_index(
        kBlocks,
        [&](std::size_t block) {
            for_each_side(block,
                          [&](int v, std::uint32_t side) { w.side[next[block][v]++] = side; });
        },
        1);
}

} // namespace

void raise_walls(GrowState& s, const std::vector<std::uint8_t>& still, Walls& w, Tree tree)
{
    take_stock(s, still, w.stock);
    const FaceStock& stock = w.stock;
    const bool kept = tree == Tree::kept && s.inner_tree.size() == stock.box.size();
    kept ? s.inner_tree.refit(stock.box) : s.inner_tree.build(stock.box);
    w.slack = rounding_of_walls(s);
    const std::size_t groups = s.inner_tree.groups();
    std::vector<Chunk> chunks((groups + kChunk - 1) / kChunk);
    const Builder builder(s, stock, still, w.slack);
    for_each_index(
        chunks.size(),
        [&](std::size_t c) {
            BoxTree::Near near;
            Builder::Waiting waiting;
            for (std::size_t g = c * kChunk; g < std::min(groups, (c + 1) * kChunk); ++g)
                builder.list(g, near, waiting, chunks[c]);
            builder.list_waiting(waiting, chunks[c]);
        },
        1);
    w.locked.assign(s.b.size(), 0);
    for (const Chunk& chunk : chunks)
        for (const int f : chunk.locked)
            for (int k = 0; k < 3; ++k)
                w.locked[s.mesh->corner(f, k)] = 1;
    hand_out(s, std::move(chunks), w);
}

void recentre_walls(const GrowState& s, Walls& w)
{
    for_each_index(
        w.wall.size(),
        [&](std::size_t i) {
            const auto& [f, g, least_d, most_d] = w.place[i];
            if (g < 0)
                return;
            Wall& wall = w.wall[i];
            double of_f = kInfinity, of_g = kInfinity;
            for (int k = 0; k < 3; ++k) {
                of_f = std::min(of_f, wall.value(s.b[s.mesh->corner(f, k)]));
                of_g = std::min(of_g, -wall.value(s.b[s.mesh->corner(g, k)]));
            }
            // Else the middle may be lost in the rounding.
            if (of_f > 8 * w.slack && of_g > 8 * w.slack)
                wall.d = std::clamp(wall.d + 0.5 * (of_f - of_g), least_d, most_d);
        },
        256);
}

} // namespace vdb_shell::growth
