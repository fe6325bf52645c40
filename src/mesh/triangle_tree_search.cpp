// SPDX-License-Identifier: Apache-2.0

// Finds the nearest triangle in the tree, eight boxes or triangles at a time, in floats. Nodes wait
// on a stack, the nearest of a node's children on top, and are dropped when they are farther than
// the best triangle so far; a query begins with the leaf where the last one ended, which is mostly
// near the right one. Without tolerance the distance found is the least of all triangles as
// computed here, whatever the order of the visits, because boxes are widened by more than the
// rounding; so neither seed nor processor changes a bit of it. Which of two equally near triangles
// is named does depend on the seed. Compiled once for each kind of processor (core/simd.h).

#include "core/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mesh/triangle_tree_search.cpp"
#include <hwy/foreach_target.h>

#include "core/dispatch.h"
#include "core/simd-inl.h"
#include "mesh/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#ifndef VDB_SHELL_TRIANGLE_TREE_SEARCH_ONCE
#define VDB_SHELL_TRIANGLE_TREE_SEARCH_ONCE
namespace vdb_shell
{
namespace
{

constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Picked boxes are all compared in every query of the ball. With more of them than this, queries
// take longer over these than over the levels above.
constexpr std::size_t kMostPicked = 48;

/// A child, by its node and its place there: the box of a child stands in the node above it.
struct Place {
    std::uint32_t node, lane;
};
struct Places {
    std::array<Place, kMostPicked> at;
    std::size_t count = 0;
};

/// What is told of the triangles that are found, and whom.
struct Listener {
    void* list;
    void (*add)(void* list, std::uint32_t triangle);
};

} // namespace
} // namespace vdb_shell
#endif

HWY_BEFORE_NAMESPACE();
namespace vdb_shell
{
namespace HWY_NAMESPACE
{
namespace
{

using namespace simd::HWY_NAMESPACE;
using openvdb::Vec3d;
using openvdb::Vec3f;
using Arrays = TriangleTree::Arrays;
using Block = TriangleTree::Block;
using Found = TriangleTree::Found;
using LaneFloats = TriangleTree::LaneFloats;
using Nearby = TriangleTree::Nearby;
using Node = TriangleTree::Node;
using Picked = TriangleTree::Picked;
using Seed = TriangleTree::Seed;
constexpr std::uint32_t kLeafBit = TriangleTree::kLeafBit;

HWY_INLINE Floats load(const TriangleTree::LaneFloats& from)
{
    return Floats::load(from.data());
}

/// The squared distances of a point to eight boxes, 0 within. Along each axis of a box at most one
/// of the two differences is positive, so the greater one, or 0, is how far the point is outside.
template <typename Boxes> HWY_INLINE Floats box_distances(const Boxes& node, const FloatPoint& p)
{
    const Floats zero(0.0F);
    Floats squared = zero;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto& axis = node.axis[k];
        const Floats x = load(axis[0]) * p[0] + load(axis[1]) * p[1] + load(axis[2]) * p[2];
        Floats off = load(node.low[k]) - x;
        raise_to(off, x - load(node.high[k]));
        raise_to(off, zero);
        squared += off * off;
    }
    return squared;
}

/// The squared distances of a point to eight triangles. The point is taken relative to corner k and
/// goes on from corner to corner, and the foot on each side is cut off at its ends. If the point is
/// beyond a side, seen along the normal, the nearest of the three feet counts, else the height
/// above the plane. The bias of a triangle without a normal stands for a place beyond its sides, so
/// that its height is never used.
HWY_INLINE Floats distances(const TriangleTree::Block& t, const FloatPoint& p)
{
    const Floats zero(0.0F), one(1.0F);
    Floats nearest(kInfinity), outside = load(t.bias);
    Floats x = p[0] - load(t.corner[0][0]), y = p[1] - load(t.corner[0][1]),
           z = p[2] - load(t.corner[0][2]);
    const Floats height = x * load(t.normal[0]) + y * load(t.normal[1]) + z * load(t.normal[2]);
    for (std::size_t k = 0; k < 3; ++k) {
        const auto &from = t.corner[k], &to = t.corner[(k + 1) % 3], &m = t.beyond[k];
        const Floats ex = load(to[0]) - load(from[0]), ey = load(to[1]) - load(from[1]),
                     ez = load(to[2]) - load(from[2]);
        const Floats along = clamped((x * ex + y * ey + z * ez) * load(t.inverse[k]), zero, one);
        const Floats dx = x - along * ex, dy = y - along * ey, dz = z - along * ez;
        lower_to(nearest, dx * dx + dy * dy + dz * dz);
        raise_to(outside, x * load(m[0]) + y * load(m[1]) + z * load(m[2]));
        x -= ex, y -= ey, z -= ez;
    }
    return select(outside > zero, nearest, height * height);
}

HWY_INLINE FloatPoint everywhere(const Vec3f& p)
{
    return {Floats(p[0]), Floats(p[1]), Floats(p[2])};
}

/// A query under way.
struct Search {
    struct Entry {
        float squared;
        std::uint32_t id;
    };
    // No list of members in braces: that would clear the stack for every query.
    HWY_INLINE Search(const Arrays& tree, const Vec3d& at, float spare, Seed& last)
        : nodes(tree.nodes.data()), blocks(tree.blocks.data()), tolerance(spare), seed(last)
    {
        point = everywhere(Vec3f((at - tree.middle) / tree.unit));
    }
    const Node* nodes;
    const Block* blocks;
    FloatPoint point;
    float tolerance;
    Seed& seed;
    Seed done = TriangleTree::kNoSeed; ///< the block looked into first
    float limit = std::numeric_limits<float>::max();
    Found found{0, kInfinity};
    // Room for what is picked, and at each of at most 12 levels for all siblings of the child that
    // is looked into. Twelve levels of eight are more leaves than numbers of 32 bits can name.
    std::array<Entry, kMostPicked + 12 * kLanes> stack;
    std::size_t top = 0;

    HWY_INLINE void look_into(std::uint32_t id)
    {
        const Block& block = blocks[id & ~kLeafBit];
        const Floats squared = distances(block, point);
        unsigned bits = bits_of(squared < found.squared);
        if (bits == 0)
            return;
        alignas(kLanesAlignment) LaneFloats d;
        store(squared, d.data());
        for (; bits != 0; bits &= bits - 1) {
            const auto i = static_cast<std::size_t>(__builtin_ctz(bits));
            if (d[i] < found.squared)
                found = {block.triangle[i], d[i]};
        }
        seed = id;
        // From here on only what is nearer by more than the tolerance is looked for.
        const float nearer = std::max(std::sqrt(found.squared) - tolerance, 0.0F);
        limit = tolerance > 0 ? nearer * nearer : found.squared;
    }

    HWY_INLINE void begin()
    {
        done = seed;
        if (seed != TriangleTree::kNoSeed)
            look_into(seed);
    }

    /// Puts an entry on the stack so that what is above `bottom` stays sorted, the nearest on top.
    HWY_INLINE void push(const Entry& entry, std::size_t bottom)
    {
        std::size_t place = top++;
        for (; place > bottom && stack[place - 1].squared < entry.squared; --place)
            stack[place] = stack[place - 1];
        stack[place] = entry;
    }

    HWY_INLINE void run()
    {
        while (top > 0) {
            const Entry entry = stack[--top];
            // The limit may have fallen since this was put on the stack.
            if (entry.squared > limit || entry.id == done)
                continue;
            if (entry.id & kLeafBit) {
                look_into(entry.id);
                continue;
            }
            const Node& node = nodes[entry.id];
            const Floats squared = box_distances(node, point);
            alignas(kLanesAlignment) LaneFloats d;
            store(squared, d.data());
            const std::size_t bottom = top;
            for (unsigned bits = bits_of(squared <= limit); bits != 0; bits &= bits - 1) {
                const auto i = static_cast<std::size_t>(__builtin_ctz(bits));
                push({d[i], node.first_child + std::uint32_t(i)}, bottom);
            }
        }
    }
};

Found nearest(const Arrays& tree, const Vec3d& at, float tolerance, Seed& seed)
{
    Search search(tree, at, tolerance, seed);
    search.begin();
    search.push({0.0F, tree.root}, 0);
    search.run();
    return search.found;
}

float squared_distance(const Arrays& tree, const Vec3d& at, Nearby& nearby)
{
    Search search(tree, at, 0.0F, nearby.seed);
    search.begin();
    for (std::size_t g = 0; g * kLanes < nearby.count; ++g) {
        const Picked& picked = nearby.picked[g];
        const Floats squared = box_distances(picked, search.point);
        alignas(kLanesAlignment) LaneFloats d;
        store(squared, d.data());
        for (unsigned bits = bits_of(squared <= search.limit); bits != 0; bits &= bits - 1) {
            const auto i = static_cast<std::size_t>(__builtin_ctz(bits));
            search.push({d[i], picked.child[i]}, 0);
        }
    }
    search.run();
    return search.found.squared;
}

void list_within(const Arrays& tree, const Vec3d& centre, double radius, Listener found)
{
    const FloatPoint point = everywhere(Vec3f((centre - tree.middle) / tree.unit));
    const auto reach = static_cast<float>(radius / tree.unit);
    const float most = reach * reach;
    std::array<std::uint32_t, 12 * kLanes> stack; // as of Search
    std::size_t top = 0;
    stack[top++] = tree.root;
    while (top > 0) {
        const std::uint32_t id = stack[--top];
        if (id & kLeafBit) {
            const Block& block = tree.blocks[id & ~kLeafBit];
            for (unsigned bits = bits_of(distances(block, point) <= most); bits != 0;
                 bits &= bits - 1)
                found.add(found.list,
                          block.triangle[static_cast<std::size_t>(__builtin_ctz(bits))]);
            continue;
        }
        const Node& node = tree.nodes[id];
        for (unsigned bits = bits_of(box_distances(node, point) <= most); bits != 0;
             bits &= bits - 1)
            stack[top++] = node.first_child + static_cast<std::uint32_t>(__builtin_ctz(bits));
    }
}

void gather(const Arrays& tree, const Vec3d& centre, double radius, Places& places, Nearby& nearby)
{
    nearby.centre = centre;
    nearby.radius = radius;
    const auto distance = std::sqrt(nearest(tree, centre, 0.0F, nearby.seed).squared);
    // A point of the ball is at most the radius farther from the centre's nearest triangle than the
    // centre is, and its own nearest triangle is again at most the radius farther from the centre.
    // So twice the radius is enough. Rounding is far less than a hundredth of the ball.
    const float reach = distance + 2.01F * static_cast<float>(radius / tree.unit);
    const FloatPoint point = everywhere(Vec3f((centre - tree.middle) / tree.unit));
    // Level by level, as long as that does not give too many.
    std::array<Place, kMostPicked> list, next;
    std::size_t count = 0;
    std::array<std::uint32_t, kMostPicked> ids{tree.root};
    for (std::size_t parents = 1; !(ids[0] & kLeafBit);) {
        std::size_t found = 0;
        for (std::size_t n = 0; n < parents && found <= kMostPicked; ++n) {
            const Floats squared = box_distances(tree.nodes[ids[n]], point);
            for (unsigned bits = bits_of(squared <= reach * reach); bits != 0;
                 bits &= bits - 1, ++found)
                if (found < kMostPicked)
                    next[found] = {ids[n], static_cast<std::uint32_t>(__builtin_ctz(bits))};
        }
        // One level more would be too many; the level before is a complete answer as well, with
        // larger boxes. A tree that is a single leaf picks nothing: the seed is that leaf.
        if (found > kMostPicked)
            break;
        std::swap(list, next);
        count = parents = found;
        for (std::size_t n = 0; n < count; ++n)
            ids[n] = tree.nodes[list[n].node].first_child + list[n].lane;
    }
    places.count = count;
    places.at = list;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace vdb_shell
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdb_shell
{

HWY_EXPORT(nearest);
HWY_EXPORT(squared_distance);
HWY_EXPORT(list_within);
HWY_EXPORT(gather);

TriangleTree::Found TriangleTree::nearest(const openvdb::Vec3d& at, float tolerance,
                                          Seed& seed) const
{
    return VDB_SHELL_KERNEL(nearest)(arrays_, at, tolerance, seed);
}

float TriangleTree::squared_distance(const openvdb::Vec3d& at, Nearby& nearby) const
{
    return VDB_SHELL_KERNEL(squared_distance)(arrays_, at, nearby);
}

void TriangleTree::list_within(const openvdb::Vec3d& centre, double radius,
                               std::vector<std::uint32_t>& triangles) const
{
    triangles.clear();
    const Listener listener{&triangles, [](void* to, std::uint32_t triangle) {
                                auto& list = *static_cast<std::vector<std::uint32_t>*>(to);
                                // A block with room to spare ends with copies of its last one.
                                if (list.empty() || list.back() != triangle)
                                    list.push_back(triangle);
                            }};
    VDB_SHELL_KERNEL(list_within)(arrays_, centre, radius, listener);
}

void TriangleTree::gather(const openvdb::Vec3d& centre, double radius, Nearby& nearby) const
{
    Places places;
    VDB_SHELL_KERNEL(gather)(arrays_, centre, radius, places, nearby);
    // What follows uses the standard library's vectors and is therefore kept out of the kernels,
    // which are compiled for other processors.
    const auto& [list, count] = places;
    nearby.picked.resize((count + kLanes - 1) / kLanes);
    nearby.count = count;
    for (std::size_t n = 0; n < nearby.picked.size() * kLanes; ++n) {
        Picked& to = nearby.picked[n / kLanes];
        const std::size_t i = n % kLanes;
        const Node* from = n < count ? &arrays_.nodes[list[n].node] : nullptr;
        const std::size_t lane = n < count ? list[n].lane : 0;
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                to.axis[k][axis][i] = from ? from->axis[k][axis][lane] : 0.0F;
            to.low[k][i] = from ? from->low[k][lane] : kInfinity;
            to.high[k][i] = from ? from->high[k][lane] : kInfinity;
        }
        to.child[i] = from ? from->first_child + static_cast<std::uint32_t>(lane) : 0;
    }
}

} // namespace vdb_shell
#endif
