// SPDX-License-Identifier: Apache-2.0
#include "mesh/triangle_tree.h"

#include "core/parallel.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace vdb_shell
{

using openvdb::Vec3d;
using openvdb::Vec3f;

namespace
{

constexpr std::uint32_t kLeafBit = 1U << 31;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Queries that begin with many boxes take longer over these than over the levels above.
constexpr std::size_t kMostPicked = 48;
// Below it a range is not worth another thread.
constexpr std::size_t kWorthAThread = 4096;
// By how much boxes are widened, as a share of the mesh's diagonal: more than rounding makes a
// triangle seem nearer than its box.
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
            return x != y ? x < y : a.triangle < b.triangle;
        });
        const auto left = [&] { halve(first, mid); };
        const auto right = [&] { halve(mid, last); };
        if (begin(last) - begin(first) > kWorthAThread) {
            tbb::parallel_invoke(left, right);
        } else {
            left();
            right();
        }
    }

    const TriangleMesh& mesh_;
    std::vector<Vec3f> points_;
    std::vector<Item> items_;
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
        // The last one fills the places that are left.
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

/// `leaves` successive leaves to a child.
TriangleTree::Node make_node(const Ordered& ordered, std::size_t first_leaf, std::size_t leaves,
                             std::size_t children, float slack)
{
    TriangleTree::Node node{};
    for (std::size_t i = 0; i < kLanes; ++i) {
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

using Point = std::array<Lanes, 3>;

template <typename Boxes>
VDB_SHELL_LANES_PART void box_distances(const Boxes& node, const Point& p, Lanes& squared)
{
    squared = Lanes{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Lanes x = node.axis[k][0] * p[0] + node.axis[k][1] * p[1] + node.axis[k][2] * p[2];
        Lanes off = node.low[k] - x;
        raise_to(off, x - node.high[k]);
        raise_to(off, Lanes{});
        squared += off * off;
    }
}

VDB_SHELL_LANES_PART void distances(const TriangleTree::Block& t, const Point& p, Lanes& squared)
{
    const Lanes zero{}, one = zero + 1.0F;
    Lanes nearest = zero + kInfinity, outside = t.bias;
    Lanes x = p[0] - t.corner[0][0], y = p[1] - t.corner[0][1], z = p[2] - t.corner[0][2];
    const Lanes height = x * t.normal[0] + y * t.normal[1] + z * t.normal[2];
    for (std::size_t k = 0; k < 3; ++k) {
        const auto &from = t.corner[k], &to = t.corner[(k + 1) % 3], &m = t.beyond[k];
        const Lanes ex = to[0] - from[0], ey = to[1] - from[1], ez = to[2] - from[2];
        Lanes along = (x * ex + y * ey + z * ez) * t.inverse[k];
        raise_to(along, zero);
        lower_to(along, one);
        const Lanes dx = x - along * ex, dy = y - along * ey, dz = z - along * ez;
        lower_to(nearest, dx * dx + dy * dy + dz * dz);
        raise_to(outside, x * m[0] + y * m[1] + z * m[2]);
        x -= ex, y -= ey, z -= ez;
    }
    squared = outside > zero ? nearest : height * height;
}

} // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh, double unit) : unit_(unit)
{
    const Bounds bounds = bounds_of(mesh.points);
    middle_ = 0.5 * (bounds.low + bounds.high);
    const float slack = kBoxSlack * static_cast<float>(diagonal_of(bounds) / unit);
    const Ordered ordered(mesh, middle_, unit);
    blocks_.resize(ordered.leaves());
    for_each_index(blocks_.size(), [&](std::size_t i) { blocks_[i] = make_block(ordered, i); });
    if (ordered.leaves() == 1) {
        root_ = kLeafBit;
        return;
    }
    // The nodes of a level lie together, the root first, and have as many leaves each.
    std::vector<std::size_t> below{ordered.leaves()};
    while (below.back() > kLanes)
        below.push_back(below.back() / kLanes);
    std::reverse(below.begin(), below.end());
    std::size_t count = 1;
    for (const std::size_t children : below) {
        const std::size_t start = nodes_.size(), leaves = ordered.leaves() / children;
        nodes_.resize(start + count);
        const std::size_t next = children < ordered.leaves() ? nodes_.size() : kLeafBit;
        const std::size_t each = children / count;
        for_each_index(
            count,
            [&](std::size_t i) {
                Node& node = nodes_[start + i];
                node = make_node(ordered, i * each * leaves, leaves, each, slack);
                node.first_child = static_cast<std::uint32_t>(next + i * each);
            },
            1);
        count = children;
    }
}

/// A query under way.
struct TriangleTree::Search {
    struct Entry {
        float squared;
        std::uint32_t id;
    };
    // No list of members in braces: that would clear the stack for every query.
    VDB_SHELL_LANES_PART Search(const TriangleTree& tree, const Vec3d& at, float spare, Seed& last)
        : nodes(tree.nodes_), blocks(tree.blocks_), tolerance(spare), seed(last)
    {
        const Vec3f p((at - tree.middle_) / tree.unit_);
        point = {Lanes{} + p[0], Lanes{} + p[1], Lanes{} + p[2]};
    }
    const std::vector<Node>& nodes;
    const std::vector<Block>& blocks;
    Point point;
    float tolerance;
    Seed& seed;
    Seed done = kNoSeed; ///< the block looked into first
    float limit = std::numeric_limits<float>::max();
    Found found{0, kInfinity};
    // What is picked, and at each of at most 12 levels all but one of the siblings.
    std::array<Entry, kMostPicked + 12 * kLanes> stack;
    std::size_t top = 0;

    VDB_SHELL_LANES_PART void look_into(std::uint32_t id)
    {
        const Block& block = blocks[id & ~kLeafBit];
        Lanes d;
        distances(block, point, d);
        unsigned bits = bits_of(d < found.squared);
        if (bits == 0)
            return;
        for (; bits != 0; bits &= bits - 1) {
            const auto i = static_cast<std::size_t>(__builtin_ctz(bits));
            if (d[i] < found.squared)
                found = {block.triangle[i], d[i]};
        }
        seed = id;
        const float nearer = std::max(std::sqrt(found.squared) - tolerance, 0.0F);
        limit = tolerance > 0 ? nearer * nearer : found.squared;
    }

    VDB_SHELL_LANES_PART void begin()
    {
        done = seed;
        if (seed != kNoSeed)
            look_into(seed);
    }

    /// Nearest on top of what is above `bottom`.
    VDB_SHELL_LANES_PART void push(const Entry& entry, std::size_t bottom)
    {
        std::size_t place = top++;
        for (; place > bottom && stack[place - 1].squared < entry.squared; --place)
            stack[place] = stack[place - 1];
        stack[place] = entry;
    }

    VDB_SHELL_LANES_PART void run()
    {
        while (top > 0) {
            const Entry entry = stack[--top];
            if (entry.squared > limit || entry.id == done)
                continue;
            if (entry.id & kLeafBit) {
                look_into(entry.id);
                continue;
            }
            const Node& node = nodes[entry.id];
            Lanes d;
            box_distances(node, point, d);
            const std::size_t bottom = top;
            for (unsigned bits = bits_of(d <= limit); bits != 0; bits &= bits - 1) {
                const auto i = static_cast<std::size_t>(__builtin_ctz(bits));
                push({d[i], node.first_child + std::uint32_t(i)}, bottom);
            }
        }
    }
};

VDB_SHELL_TWO_TARGETS TriangleTree::Found TriangleTree::nearest(const Vec3d& at, float tolerance,
                                                                Seed& seed) const
{
    Search search(*this, at, tolerance, seed);
    search.begin();
    search.push({0.0F, root_}, 0);
    search.run();
    return search.found;
}

VDB_SHELL_TWO_TARGETS float TriangleTree::squared_distance(const Vec3d& at, Nearby& nearby) const
{
    Search search(*this, at, 0.0F, nearby.seed);
    search.begin();
    for (std::size_t g = 0; g * kLanes < nearby.count; ++g) {
        const Picked& picked = nearby.picked[g];
        Lanes d;
        box_distances(picked, search.point, d);
        for (unsigned bits = bits_of(d <= search.limit); bits != 0; bits &= bits - 1) {
            const auto i = static_cast<std::size_t>(__builtin_ctz(bits));
            search.push({d[i], picked.child[i]}, 0);
        }
    }
    search.run();
    return search.found.squared;
}

VDB_SHELL_TWO_TARGETS void TriangleTree::gather(const Vec3d& centre, double radius,
                                                Nearby& nearby) const
{
    nearby.centre = centre;
    nearby.radius = radius;
    nearby.count = 0;
    const auto distance = std::sqrt(nearest(centre, 0.0F, nearby.seed).squared);
    // Rounding is far less than a hundredth of the ball.
    const float reach = distance + 2.01F * static_cast<float>(radius / unit_);
    const Vec3f p((centre - middle_) / unit_);
    const Point point{Lanes{} + p[0], Lanes{} + p[1], Lanes{} + p[2]};
    struct Place {
        std::uint32_t node, lane;
    };
    // Level by level, as long as that does not give too many.
    std::array<Place, kMostPicked> list, next;
    std::size_t count = 0;
    std::array<std::uint32_t, kMostPicked> ids{root_};
    for (std::size_t parents = 1; !(ids[0] & kLeafBit);) {
        std::size_t found = 0;
        for (std::size_t n = 0; n < parents && found <= kMostPicked; ++n) {
            Lanes d;
            box_distances(nodes_[ids[n]], point, d);
            for (unsigned bits = bits_of(d <= reach * reach); bits != 0; bits &= bits - 1, ++found)
                if (found < kMostPicked)
                    next[found] = {ids[n], static_cast<std::uint32_t>(__builtin_ctz(bits))};
        }
        if (found > kMostPicked)
            break;
        std::swap(list, next);
        count = parents = found;
        for (std::size_t n = 0; n < count; ++n)
            ids[n] = nodes_[list[n].node].first_child + list[n].lane;
    }
    nearby.picked.resize((count + kLanes - 1) / kLanes);
    nearby.count = count;
    for (std::size_t n = 0; n < nearby.picked.size() * kLanes; ++n) {
        Picked& to = nearby.picked[n / kLanes];
        const std::size_t i = n % kLanes;
        const Node* from = n < count ? &nodes_[list[n].node] : nullptr;
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
