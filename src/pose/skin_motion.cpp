// SPDX-License-Identifier: Apache-2.0

// Takes a skin at rest and in a pose. Gives for any place near it where the skin carries that
// place. The rotation comes from the matrix of second moments by the two directions in which the
// skin around extends most, so a flat piece of skin, whose matrix has rank two, is enough.

#include "pose/skin_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using Matrix = openvdb::math::Mat3<double>;

/// A node is taken whole if its radius is below this share of its distance. Points carried with a
/// half of it differ by less than a hundredth of an edge (docs/measurements/pose.md).
constexpr double kOpening = 0.4;
/// What skin seen from its back weighs beside skin seen from the place's own side, so that a place
/// that sees none has weights too.
constexpr double kBehind = 1e-4;

Matrix outer_product(const Vec3d& u, const Vec3d& v)
{
    return {u[0] * v[0], u[0] * v[1], u[0] * v[2], u[1] * v[0], u[1] * v[1],
            u[1] * v[2], u[2] * v[0], u[2] * v[1], u[2] * v[2]};
}

/// Any unit vector at right angles to a unit vector.
Vec3d across(const Vec3d& u)
{
    const Vec3d axis = std::abs(u[0]) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
    Vec3d v = u.cross(axis);
    v.normalize(0.0);
    return v;
}

/// The rotation R with the largest trace of R^T m.
Matrix nearest_rotation(const Matrix& m)
{
    Matrix vectors;
    Vec3d values;
    // Jacobi's rotations stop by an absolute bound, so the matrix is brought to size one.
    const double size = m.absMax();
    if (!(size > 0) || !std::isfinite(size))
        return Matrix::identity();
    const Matrix scaled = m * (1 / size);
    openvdb::math::diagonalizeSymmetricMatrix(scaled.transpose() * scaled, vectors, values);
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int i, int j) { return values[i] > values[j]; });
    const Vec3d v0 = vectors.col(order[0]), v1 = vectors.col(order[1]), v2 = v0.cross(v1);
    Vec3d u0 = scaled * v0, u1 = scaled * v1;
    if (!u0.normalize(0.0))
        return Matrix::identity();
    u1 -= u0 * u0.dot(u1);
    if (!u1.normalize(0.0))
        u1 = across(u0);
    const Vec3d u2 = u0.cross(u1);
    return outer_product(u0, v0) + outer_product(u1, v1) + outer_product(u2, v2);
}

} // namespace

SkinMotion::SkinMotion(const std::vector<openvdb::Vec3s>& rest,
                       const std::vector<openvdb::Vec3I>& triangles)
    : normal_(rest.size(), Vec3d(0.0)), area_(rest.size(), 0.0), order_(rest.size())
{
    for (const openvdb::Vec3s& p : rest)
        origin_ += Vec3d(p) / static_cast<double>(rest.size());
    place_.reserve(rest.size());
    for (const openvdb::Vec3s& p : rest)
        place_.push_back(Vec3d(p) - origin_);
    for (const openvdb::Vec3I& t : triangles) {
        const Vec3d cross = (place_[t[1]] - place_[t[0]]).cross(place_[t[2]] - place_[t[0]]) / 6.0;
        for (int k = 0; k < 3; ++k) {
            normal_[t[k]] += cross;
            area_[t[k]] += cross.length();
        }
    }
    std::iota(order_.begin(), order_.end(), 0U);
    nodes_.reserve(2 * rest.size());
    if (!rest.empty())
        build(0, static_cast<std::uint32_t>(rest.size()));
}

/// Halves along the longest side, at the median; vertices of equal coordinate go by index, so the
/// tree is the same on every machine.
void SkinMotion::build(std::uint32_t begin, std::uint32_t end)
{
    const auto index = nodes_.size();
    nodes_.emplace_back();
    Node node;
    node.begin = begin, node.end = end;
    Vec3d low(std::numeric_limits<double>::infinity()), high = -low, mean(0.0);
    for (std::uint32_t i = begin; i < end; ++i) {
        const std::uint32_t v = order_[i];
        low = openvdb::math::minComponent(low, place_[v]);
        high = openvdb::math::maxComponent(high, place_[v]);
        mean += place_[v] / static_cast<double>(end - begin);
        node.centre += area_[v] * place_[v];
        node.area_normal += normal_[v];
        node.area += area_[v];
    }
    node.centre = node.area > 0 ? node.centre / node.area : mean;
    for (std::uint32_t i = begin; i < end; ++i)
        node.radius = std::max(node.radius, (place_[order_[i]] - node.centre).length());
    if (end - begin > 1) {
        const Vec3d sides = high - low;
        const int axis =
            sides[0] >= sides[1] ? (sides[0] >= sides[2] ? 0 : 2) : (sides[1] >= sides[2] ? 1 : 2);
        const std::uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                         [&](std::uint32_t u, std::uint32_t v) {
                             return place_[u][axis] != place_[v][axis]
                                        ? place_[u][axis] < place_[v][axis]
                                        : u < v;
                         });
        build(begin, middle);
        node.right = static_cast<std::uint32_t>(nodes_.size());
        build(middle, end);
    }
    nodes_[index] = node;
}

SkinMotion::Frame SkinMotion::frame(const std::vector<openvdb::Vec3s>& posed) const
{
    Frame made;
    if (nodes_.empty())
        return made;
    for (const openvdb::Vec3s& p : posed)
        made.origin += Vec3d(p) / static_cast<double>(posed.size());
    made.sums.resize(nodes_.size());
    // Children stand behind their parents.
    for (std::size_t n = nodes_.size(); n-- > 0;) {
        const Node& node = nodes_[n];
        Frame::Sums& sums = made.sums[n];
        if (node.right == 0) {
            const std::uint32_t v = order_[node.begin];
            sums.centre = Vec3d(posed[v]) - made.origin;
            continue;
        }
        const std::size_t children[] = {n + 1, node.right};
        const auto area = [&](std::size_t c) {
            return node.area > 0 ? nodes_[c].area / node.area : 0.5;
        };
        for (const std::size_t c : children)
            sums.centre += area(c) * made.sums[c].centre;
        // Moments about the node's own centres, so that no digits are lost far from the origin.
        for (const std::size_t c : children)
            sums.moment +=
                area(c) * (made.sums[c].moment + outer_product(made.sums[c].centre - sums.centre,
                                                               nodes_[c].centre - node.centre));
    }
    return made;
}

openvdb::Vec3d SkinMotion::carry(const Frame& frame, const openvdb::Vec3d& place, Side side) const
{
    struct Piece {
        std::uint32_t node;
        double weight;
    };
    std::vector<Piece> pieces;
    pieces.reserve(256);
    const Vec3d p = place - origin_;
    const double towards = side == Side::inside ? 1.0 : -1.0;
    double sum = 0;
    Vec3d centre(0.0), posed(0.0);
    for (std::uint32_t n = 0, next = 0; n < nodes_.size(); n = next) {
        const Node& node = nodes_[n];
        const Vec3d way = node.centre - p;
        const double distance2 = way.lengthSqr();
        if (node.right != 0 && node.radius * node.radius > kOpening * kOpening * distance2) {
            next = n + 1;
            continue;
        }
        // The nodes of a subtree stand together: 2 k - 1 of k vertices.
        next = n + 2 * (node.end - node.begin) - 1;
        if (!(distance2 > 0))
            return Vec3d(frame.sums[n].centre) + frame.origin;
        const double seen = towards * node.area_normal.dot(way) / std::sqrt(distance2);
        const double weight = (std::max(seen, 0.0) + kBehind * node.area) / (distance2 * distance2);
        sum += weight;
        centre += weight * node.centre;
        posed += weight * frame.sums[n].centre;
        pieces.push_back({n, weight});
    }
    if (!(sum > 0))
        return place;
    centre /= sum, posed /= sum;
    Matrix moment = Matrix::zero();
    for (const Piece& piece : pieces) {
        const Frame::Sums& sums = frame.sums[piece.node];
        moment +=
            piece.weight / sum *
            (sums.moment + outer_product(sums.centre - posed, nodes_[piece.node].centre - centre));
    }
    return nearest_rotation(moment) * (p - centre) + posed + frame.origin;
}

} // namespace vdb_shell
