// SPDX-License-Identifier: Apache-2.0
#include "field/triangle_tree.h"

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
constexpr std::size_t kWidth = 4;

Four smaller(const Four& a, const Four& b)
{
    return a < b ? a : b;
}
Four larger(const Four& a, const Four& b)
{
    return a > b ? a : b;
}

} // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh, double unit) : unit_(unit)
{
    const Bounds bounds = bounds_of(mesh.points);
    middle_ = 0.5 * (bounds.low + bounds.high);
    std::vector<Item> items(mesh.triangles.size());
    for (std::size_t t = 0; t < items.size(); ++t) {
        Item& item = items[t];
        item.triangle = static_cast<std::uint32_t>(t);
        const std::array<Vec3d, 3> c = corners(mesh, item.triangle);
        item.low = item.high = Vec3f(c[0]);
        for (std::size_t k = 1; k < 3; ++k) {
            item.low = openvdb::math::minComponent(item.low, Vec3f(c[k]));
            item.high = openvdb::math::maxComponent(item.high, Vec3f(c[k]));
        }
    }
    blocks_.reserve(items.size() / 3 + 1);
    nodes_.reserve(items.size() / 8 + 1);
    root_ = build(mesh, items, 0, items.size());
}

std::array<Vec3d, 3> TriangleTree::corners(const TriangleMesh& mesh, std::uint32_t triangle) const
{
    std::array<Vec3d, 3> c;
    for (std::size_t k = 0; k < 3; ++k)
        c[k] = (Vec3d(mesh.points[mesh.triangles[triangle][int(k)]]) - middle_) / unit_;
    return c;
}

std::uint32_t TriangleTree::add_block(const TriangleMesh& mesh, const std::vector<Item>& items,
                                      std::size_t begin, std::size_t end)
{
    Block block;
    for (std::size_t i = 0; i < kWidth; ++i) {
        // The last one fills the places that are left.
        const std::uint32_t triangle = items[std::min(begin + i, end - 1)].triangle;
        const PreparedTriangle t = prepare_triangle(corners(mesh, triangle));
        for (std::size_t k = 0; k < 3; ++k) {
            const PreparedTriangle::Side& from = t.side[k];
            Block::Side& to = block.side[k];
            to.x[i] = from.x, to.y[i] = from.y, to.z[i] = from.z;
            to.ex[i] = from.ex, to.ey[i] = from.ey, to.ez[i] = from.ez;
            to.inverse[i] = from.inverse;
            to.mx[i] = from.mx, to.my[i] = from.my, to.mz[i] = from.mz;
        }
        block.nx[i] = t.nx, block.ny[i] = t.ny, block.nz[i] = t.nz;
        block.bias[i] = t.bias;
        block.triangle[i] = triangle;
    }
    blocks_.push_back(block);
    return static_cast<std::uint32_t>(blocks_.size() - 1) | kLeafBit;
}

std::uint32_t TriangleTree::build(const TriangleMesh& mesh, std::vector<Item>& items,
                                  std::size_t begin, std::size_t end)
{
    if (end - begin <= kWidth)
        return add_block(mesh, items, begin, end);
    const auto split = [&](std::size_t first, std::size_t last) {
        if (last - first <= kWidth)
            return last;
        Vec3f low(kInfinity), high(-kInfinity);
        for (std::size_t i = first; i < last; ++i) {
            const Vec3f centre = items[i].low + items[i].high;
            low = openvdb::math::minComponent(low, centre);
            high = openvdb::math::maxComponent(high, centre);
        }
        const int axis = static_cast<int>(openvdb::math::MaxIndex(high - low));
        // Whole blocks on the left.
        const std::size_t middle = first + ((last - first) / 2 + kWidth - 1) / kWidth * kWidth;
        const auto at = [&](std::size_t i) { return items.begin() + std::ptrdiff_t(i); };
        std::nth_element(at(first), at(middle), at(last), [&](const Item& a, const Item& b) {
            const float x = a.low[axis] + a.high[axis], y = b.low[axis] + b.high[axis];
            return x != y ? x < y : a.triangle < b.triangle;
        });
        return middle;
    };
    const std::size_t half = split(begin, end);
    const std::array<std::size_t, kWidth + 1> cut{begin, split(begin, half), half, split(half, end),
                                                  end};
    const auto id = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    Node node;
    for (std::size_t k = 0; k < kWidth; ++k) {
        Vec3f low(kInfinity), high(kInfinity);
        node.child[k] = kNone;
        if (cut[k] < cut[k + 1]) {
            high = Vec3f(-kInfinity);
            for (std::size_t i = cut[k]; i < cut[k + 1]; ++i) {
                low = openvdb::math::minComponent(low, items[i].low);
                high = openvdb::math::maxComponent(high, items[i].high);
            }
            node.child[k] = build(mesh, items, cut[k], cut[k + 1]);
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            node.low[axis][k] = low[int(axis)];
            node.high[axis][k] = high[int(axis)];
        }
    }
    nodes_[id] = node;
    return id;
}

template <typename N>
inline Four TriangleTree::box_distances(const N& node, const std::array<Four, 3>& point)
{
    Four squared{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Four below = node.low[axis] - point[axis], above = point[axis] - node.high[axis];
        const Four off = larger(larger(below, above), Four{});
        squared += off * off;
    }
    return squared;
}

template <typename B> inline Four TriangleTree::distances(const B& t, const std::array<Four, 3>& p)
{
    const Four zero{}, one = zero + 1.0F;
    Four nearest = zero + kInfinity, outside = t.bias, height = zero;
    for (const auto& s : t.side) {
        const Four x = p[0] - s.x, y = p[1] - s.y, z = p[2] - s.z;
        const Four along = smaller(larger((x * s.ex + y * s.ey + z * s.ez) * s.inverse, zero), one);
        const Four dx = x - along * s.ex, dy = y - along * s.ey, dz = z - along * s.ez;
        nearest = smaller(nearest, dx * dx + dy * dy + dz * dz);
        outside = larger(outside, x * s.mx + y * s.my + z * s.mz);
        height = x * t.nx + y * t.ny + z * t.nz;
    }
    return outside > zero ? nearest : height * height;
}

std::uint32_t TriangleTree::nearest(const Vec3d& point, float tolerance) const
{
    const Vec3f p((point - middle_) / unit_);
    const std::array<Four, 3> four{Four{} + p[0], Four{} + p[1], Four{} + p[2]};
    struct Entry {
        float squared;
        std::uint32_t id;
    };
    // Three siblings are left behind at each level, and there are at most 16 levels.
    std::array<Entry, 64> stack;
    std::size_t top = 0;
    stack[top++] = {0.0F, root_};
    float best = kInfinity, limit = kInfinity;
    std::uint32_t triangle = 0;
    while (top > 0) {
        const Entry entry = stack[--top];
        if (entry.squared > limit)
            continue;
        if (entry.id & kLeafBit) {
            const Block& block = blocks_[entry.id & ~kLeafBit];
            const Four d = distances(block, four);
            for (std::size_t i = 0; i < kWidth; ++i)
                if (d[i] < best) {
                    best = d[i];
                    triangle = block.triangle[i];
                    const float nearer = std::max(std::sqrt(best) - tolerance, 0.0F);
                    limit = nearer * nearer;
                }
            continue;
        }
        const Node& node = nodes_[entry.id];
        const Four d = box_distances(node, four);
        // Nearest on top.
        const std::size_t bottom = top;
        for (std::size_t i = 0; i < kWidth; ++i) {
            if (!(d[i] <= limit) || node.child[i] == kNone)
                continue;
            std::size_t place = top++;
            for (; place > bottom && stack[place - 1].squared < d[i]; --place)
                stack[place] = stack[place - 1];
            stack[place] = {d[i], node.child[i]};
        }
    }
    return triangle;
}

} // namespace vdb_shell
