// SPDX-License-Identifier: Apache-2.0

// Pairs of triangles that may have a common point. A triangle that is much longer than wide fills
// little of its box: of two fans of needles over one rim, as in a cone, each needle's box would
// overlap half of all others. So needles are cut across into pieces, each with a box of its own,
// and a pair is one of which two pieces' boxes overlap. The pieces cover their triangle, and their
// boxes are widened by more than the rounding, so no pair is lost.

#include "core/triangle_pairs.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

// A piece is cut off for each so many widths of length: a surface of good triangles has none.
constexpr double kWidthsInPiece = 16;
// So that the boxes stay a multiple of the triangles. Two cones of 16,000 needles each took inspect
// 4.8 s with 8, 5.9 with 32 and 8.5 with 128; random needles took 1.4, 1.1 and 1.4 s.
constexpr std::size_t kMostPieces = 16;

/// A triangle by its longest edge and what is left.
struct Needle {
    Vec3d from, to, tip;
    double length = 0, width = 0;

    Needle(const std::vector<Vec3s>& points, const Vec3I& t)
    {
        for (int k = 0; k < 3; ++k) {
            const Vec3d a(points[t[k]]), b(points[t[(k + 1) % 3]]);
            if ((b - a).length() > length)
                length = (b - a).length(), from = a, to = b, tip = Vec3d(points[t[(k + 2) % 3]]);
        }
        if (length > 0)
            width = (to - from).cross(tip - from).length() / length;
    }
    std::size_t pieces() const
    {
        const double wanted = length / (kWidthsInPiece * width);
        // Neither a triangle without an area nor one without a length has a number here.
        if (!(wanted >= 2))
            return 1;
        return wanted < double(kMostPieces) ? std::size_t(wanted) : kMostPieces;
    }
};

/// The part between two shares of the length. Whatever `tip_at` is, the lines across from the edge
/// to the other two sweep the whole triangle, so it may be rounded.
class Slices
{
public:
    Slices(const Needle& needle, const FloatBox& box) : needle_(needle), box_(box)
    {
        const Vec3d along = needle.to - needle.from;
        tip_at_ = std::clamp((needle.tip - needle.from).dot(along) / along.lengthSqr(), 0.0, 1.0);
        double greatest = 0;
        for (int k = 0; k < 3; ++k)
            for (const Vec3d* p : {&needle.from, &needle.to, &needle.tip})
                greatest = std::max(greatest, std::abs((*p)[k]));
        // Some twenty roundings of doubles would be 2e-15 of it.
        pad_ = 1e-13 * greatest;
    }

    FloatBox between(double begin, double end) const
    {
        Vec3d low(std::numeric_limits<double>::infinity()), high = -low;
        const auto add = [&](const Vec3d& p) {
            low = openvdb::math::minComponent(low, p);
            high = openvdb::math::maxComponent(high, p);
        };
        for (const double at : {begin, end}) {
            add(needle_.from + at * (needle_.to - needle_.from));
            add(opposite(at));
        }
        if (begin <= tip_at_ && tip_at_ <= end)
            add(needle_.tip);
        FloatBox piece = box_;
        for (int k = 0; k < 3; ++k) {
            piece.lo[k] = std::max(piece.lo[k], below(low[k]));
            piece.hi[k] = std::min(piece.hi[k], -below(-high[k]));
        }
        return piece;
    }

private:
    /// On the two shorter edges.
    Vec3d opposite(double at) const
    {
        if (at < tip_at_)
            return needle_.from + (at / tip_at_) * (needle_.tip - needle_.from);
        return tip_at_ < 1
                   ? needle_.tip + ((at - tip_at_) / (1 - tip_at_)) * (needle_.to - needle_.tip)
                   : needle_.to;
    }
    float below(double x) const
    {
        return std::nextafter(float(x - pad_), -std::numeric_limits<float>::infinity());
    }

    const Needle& needle_;
    const FloatBox& box_;
    double tip_at_ = 0, pad_ = 0;
};

/// Boxes of the pieces, and of which triangle each is, ascending.
struct Pieces {
    std::vector<FloatBox> boxes;
    std::vector<std::uint32_t> triangle;
};

Pieces cut_needles(const std::vector<Vec3s>& points, const std::vector<Vec3I>& triangles,
                   const std::vector<char>& left_out)
{
    const std::vector<FloatBox> whole = triangle_boxes(points, triangles);
    std::vector<std::size_t> first(triangles.size() + 1);
    for_each_index(triangles.size(), [&](std::size_t t) {
        const bool out = !left_out.empty() && left_out[t];
        first[t + 1] = out ? 0 : Needle(points, triangles[t]).pieces();
    });
    for (std::size_t t = 0; t < triangles.size(); ++t)
        first[t + 1] += first[t];
    Pieces pieces{std::vector<FloatBox>(first.back()), std::vector<std::uint32_t>(first.back())};
    for_each_index(triangles.size(), [&](std::size_t t) {
        const std::size_t count = first[t + 1] - first[t];
        if (count == 0)
            return;
        std::fill_n(pieces.triangle.begin() + std::ptrdiff_t(first[t]), count, std::uint32_t(t));
        if (count == 1) {
            pieces.boxes[first[t]] = whole[t];
            return;
        }
        const Needle needle(points, triangles[t]);
        const Slices slices(needle, whole[t]);
        for (std::size_t i = 0; i < count; ++i)
            pieces.boxes[first[t] + i] =
                slices.between(double(i) / double(count), double(i + 1) / double(count));
    });
    return pieces;
}

} // namespace

std::vector<std::array<std::uint32_t, 2>> overlapping_triangles(const std::vector<Vec3s>& points,
                                                                const std::vector<Vec3I>& triangles,
                                                                const KeepPair& keep,
                                                                Interrupter* interrupter,
                                                                const std::vector<char>& left_out)
{
    const Pieces pieces = cut_needles(points, triangles, left_out);
    const auto keep_pieces = [&](std::uint32_t i, std::uint32_t j) {
        const std::uint32_t s = pieces.triangle[i], t = pieces.triangle[j];
        return s != t && keep(s, t);
    };
    auto pairs = overlapping_pairs(pieces.boxes, keep_pieces, interrupter);
    // Ascending pieces are of ascending triangles, so the smaller one stays in front.
    for (auto& pair : pairs)
        pair = {pieces.triangle[pair[0]], pieces.triangle[pair[1]]};
    if (pieces.boxes.size() > triangles.size()) {
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    }
    return pairs;
}

} // namespace vdb_shell
