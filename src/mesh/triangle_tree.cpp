// SPDX-License-Identifier: Apache-2.0

// Builds the tree that finds the nearest triangle: a bounding volume hierarchy of eight children a
// node and up to eight triangles a leaf, since that many are compared at a time (core/simd.h).
// Boxes are turned with the surface (the header says why). Invariant: as computed in floats, no
// point is nearer to a triangle than to a box around it, because boxes are widened by more than the
// rounding. The number of leaves is a power of two, and items are split evenly among them, so the
// shape follows from the number of triangles alone, and who is in which leaf from coordinates and
// indices; threads change neither. Trap: the mesh must not be empty.

#include "mesh/triangle_tree.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell
{

using openvdb::Vec3d;
using openvdb::Vec3f;

namespace
{

constexpr float kInfinity = std::numeric_limits<float>::infinity();
// With fewer triangles than this a second thread would cost more than it saves.
constexpr std::size_t kLeastParallel = 4096;
// By how much boxes are widened, as a share of the mesh's diagonal: more than rounding makes a
// triangle seem nearer than its box. One rounding of a float is 6e-8 of what is rounded, and a
// distance takes a handful of them; what is rounded is as large as the mesh for points that are not
// many diagonals away from it.
constexpr float kBoxSlack = 2e-6F;

struct Item {
    Vec3f centre;
    std::uint32_t triangle;
};

/// A box in a frame of its own.
struct TurnedBox {
    std::array<Vec3f, 3> axis;
    Vec3f low, high;
};

/// The tree's triangles in the order of its leaves.
class Ordered
{
public:
    Ordered(const TriangleMesh& mesh, const Vec3d& middle, double unit)
        : mesh_(mesh), points_(mesh.points.size()), items_(mesh.triangles.size())
    {
        for_each_index(points_.size(), [&](std::size_t v) {
            points_[v] = Vec3f((Vec3d(mesh.points[v]) - middle) / unit);
        });
        for_each_index(items_.size(), [&](std::size_t t) {
            const openvdb::Vec3I& c = mesh.triangles[t];
            // Three times the centre, which is in the same order.
            items_[t] = {points_[c[0]] + points_[c[1]] + points_[c[2]], std::uint32_t(t)};
        });
        while (leaves_ * kLanes < items_.size())
            leaves_ *= 2;
        halve(0, leaves_);
    }

    std::size_t leaves() const { return leaves_; }
    std::size_t begin(std::size_t leaf) const { return items_.size() * leaf / leaves_; }
    std::uint32_t triangle(std::size_t item) const { return items_[item].triangle; }
    std::array<Vec3f, 3> corners(std::size_t item) const
    {
        const openvdb::Vec3I& t = mesh_.triangles[items_[item].triangle];
        return {points_[t[0]], points_[t[1]], points_[t[2]]};
    }
    TurnedBox box(std::size_t first_leaf, std::size_t last_leaf, float slack) const;

private:
    void halve(std::size_t first, std::size_t last)
    {
        if (last - first < 2)
            return;
        const std::size_t mid = (first + last) / 2;
        const auto at = [&](std::size_t leaf) {
            return items_.begin() + std::ptrdiff_t(begin(leaf));
        };
        Vec3f low(kInfinity), high(-kInfinity);
        std::for_each(at(first), at(last), [&](const Item& item) {
            low = openvdb::math::minComponent(low, item.centre);
            high = openvdb::math::maxComponent(high, item.centre);
        });
        const int axis = static_cast<int>(openvdb::math::MaxIndex(high - low));
        std::nth_element(at(first), at(mid), at(last), [axis](const Item& a, const Item& b) {
            const float x = a.centre[axis], y = b.centre[axis];
            // Ties by index, so that the two halves are the same sets every time.
            return x != y ? x < y : a.triangle < b.triangle;
        });
        const auto left = [&] { halve(first, mid); };
        const auto right = [&] { halve(mid, last); };
        if (begin(last) - begin(first) > kLeastParallel) {
            run_together(left, right);
        } else {
            left();
            right();
        }
    }

    const TriangleMesh& mesh_;
    RawVector<Vec3f> points_;
    RawVector<Item> items_;
    std::size_t leaves_ = 1;
};

/// Along the sum of the triangles' normals, and in the plane across it along and across the
/// longest spread of their corners.
std::array<Vec3f, 3> frame_of(const Ordered& ordered, std::size_t begin, std::size_t end)
{
    Vec3d normal(0.0), centre(0.0);
    for (std::size_t i = begin; i < end; ++i) {
        const auto [a, b, c] = ordered.corners(i);
        normal += Vec3d(b - a).cross(Vec3d(c - a));
        centre += Vec3d(a) + Vec3d(b) + Vec3d(c);
    }
    // The areas of a closed piece add up to nothing; any frame is right for its box.
    if (!normal.normalize())
        normal = Vec3d(0, 0, 1);
    centre /= 3.0 * static_cast<double>(end - begin);
    Vec3d other(0.0);
    other[static_cast<int>(openvdb::math::MinIndex(openvdb::math::Abs(normal)))] = 1;
    const Vec3d x = normal.cross(other).unit(), y = normal.cross(x);
    double xx = 0, xy = 0, yy = 0;
    for (std::size_t i = begin; i < end; ++i)
        for (const Vec3f& corner : ordered.corners(i)) {
            const Vec3d off = Vec3d(corner) - centre;
            const double u = off.dot(x), v = off.dot(y);
            xx += u * u, xy += u * v, yy += v * v;
        }
    // The eigenvector of the larger eigenvalue of the matrix (xx xy; xy yy). Of the two forms that
    // it has, the one is taken in which nothing cancels.
    const double half = 0.5 * (xx - yy), root = std::sqrt(half * half + xy * xy);
    Vec3d along = half > 0 ? (half + root) * x + xy * y : xy * x + (root - half) * y;
    if (!along.normalize())
        along = x;
    return {Vec3f(along), Vec3f(normal.cross(along)), Vec3f(normal)};
}

TurnedBox Ordered::box(std::size_t first_leaf, std::size_t last_leaf, float slack) const
{
    const std::size_t first = begin(first_leaf), last = begin(last_leaf);
    TurnedBox box{frame_of(*this, first, last), Vec3f(kInfinity), Vec3f(-kInfinity)};
    for (std::size_t i = first; i < last; ++i)
        for (const Vec3f& corner : corners(i)) {
            const Vec3f place(box.axis[0].dot(corner), box.axis[1].dot(corner),
                              box.axis[2].dot(corner));
            box.low = openvdb::math::minComponent(box.low, place);
            box.high = openvdb::math::maxComponent(box.high, place);
        }
    box.low -= Vec3f(slack);
    box.high += Vec3f(slack);
    return box;
}

TriangleTree::Block make_block(const Ordered& ordered, std::size_t leaf)
{
    const std::size_t begin = ordered.begin(leaf), end = ordered.begin(leaf + 1);
    TriangleTree::Block block;
    for (std::size_t i = 0; i < kLanes; ++i) {
        // The last triangle fills the places that are left. A search takes a triangle only if it is
        // nearer than what it has, so a copy in a later lane is never found.
        const std::size_t item = std::min(begin + i, end - 1);
        const std::array<Vec3f, 3> corner = ordered.corners(item);
        const Vec3d a(corner[0]), b(corner[1]), c(corner[2]);
        Vec3d n = (b - a).cross(c - a);
        const bool flat = !(n.lengthSqr() > 0);
        n = flat ? Vec3d(0.0) : n / n.length();
        block.bias[i] = flat ? 1.0F : 0.0F;
        block.triangle[i] = ordered.triangle(item);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d e = Vec3d(corner[(k + 1) % 3]) - Vec3d(corner[k]), m = e.cross(n);
            const double squared = e.lengthSqr();
            // With 0 for its inverse a side without length is its first corner.
            block.inverse[k][i] = squared > 0 ? static_cast<float>(1 / squared) : 0.0F;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                block.corner[k][axis][i] = corner[k][int(axis)];
                block.beyond[k][axis][i] = static_cast<float>(m[int(axis)]);
            }
            block.normal[k][i] = static_cast<float>(n[int(k)]);
        }
    }
    return block;
}

/// A node whose children have `leaves` successive leaves each, from `first_leaf` on.
TriangleTree::Node make_node(const Ordered& ordered, std::size_t first_leaf, std::size_t leaves,
                             std::size_t children, float slack)
{
    TriangleTree::Node node{};
    for (std::size_t i = 0; i < kLanes; ++i) {
        // With axes of 0, every point is infinitely far below this box, so a child that is not
        // there needs no test of its own.
        TurnedBox box{{Vec3f(0), Vec3f(0), Vec3f(0)}, Vec3f(kInfinity), Vec3f(kInfinity)};
        if (i < children)
            box = ordered.box(first_leaf + i * leaves, first_leaf + (i + 1) * leaves, slack);
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                node.axis[k][axis][i] = box.axis[k][int(axis)];
            node.low[k][i] = box.low[int(k)];
            node.high[k][i] = box.high[int(k)];
        }
    }
    return node;
}

} // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh, double unit)
{
    RawVector<Node>& nodes = arrays_.nodes;
    RawVector<Block>& blocks = arrays_.blocks;
    arrays_.unit = unit;
    const Bounds bounds = bounds_of(mesh.points);
    arrays_.middle = 0.5 * (bounds.low + bounds.high);
    const float slack = kBoxSlack * static_cast<float>(diagonal_of(bounds) / unit);
    const Ordered ordered(mesh, arrays_.middle, unit);
    blocks.resize(ordered.leaves());
    for_each_index(blocks.size(), [&](std::size_t i) { blocks[i] = make_block(ordered, i); });
    if (ordered.leaves() == 1) {
        arrays_.root = kLeafBit;
        return;
    }
    // The nodes of a level lie together, the root first, and have as many leaves each. Only the
    // root may have fewer than eight children, because all other levels are reached by dividing a
    // power of two by eight.
    std::vector<std::size_t> below{ordered.leaves()};
    while (below.back() > kLanes)
        below.push_back(below.back() / kLanes);
    std::reverse(below.begin(), below.end());
    std::size_t count = 1;
    for (const std::size_t children : below) {
        const std::size_t start = nodes.size(), leaves = ordered.leaves() / children;
        nodes.resize(start + count);
        const std::size_t next = children < ordered.leaves() ? nodes.size() : kLeafBit;
        const std::size_t each = children / count;
        for_each_index(
            count,
            [&](std::size_t i) {
                Node& node = nodes[start + i];
                node = make_node(ordered, i * each * leaves, leaves, each, slack);
                node.first_child = static_cast<std::uint32_t>(next + i * each);
            },
            1);
        count = children;
    }
}

} // namespace vdb_shell
