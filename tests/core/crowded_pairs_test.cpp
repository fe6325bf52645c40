// SPDX-License-Identifier: Apache-2.0
#include "core/crowded_pairs.h"

#include "core/triangle_piece.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;

/// Counts how often two items are looked at.
struct Counted : TrianglePiece {
    std::atomic<std::size_t>* looked_at;

    Counted(const TrianglePiece& piece, std::atomic<std::size_t>& counter)
        : TrianglePiece(piece), looked_at(&counter)
    {
    }
    bool surely_apart(const Counted& other) const
    {
        ++*looked_at;
        return TrianglePiece::surely_apart(other);
    }
    Counted halve() { return Counted(TrianglePiece::halve(), *looked_at); }
};

/// How many pairs are looked at for each triangle of two cones over one rim. Those of one cone are
/// no pairs, and those of the two come near each other along the rim alone.
double looked_at_each(std::uint32_t around)
{
    std::vector<Vec3s> points{Vec3s(0, 0, 1), Vec3s(0, 0, -1)};
    for (std::uint32_t i = 0; i < around; ++i)
        points.emplace_back(std::cos(2 * M_PI * i / around), std::sin(2 * M_PI * i / around), 0);
    std::atomic<std::size_t> count{0};
    std::vector<Counted> pieces;
    for (std::uint32_t apex = 0; apex < 2; ++apex)
        for (std::uint32_t i = 0; i < around; ++i)
            pieces.emplace_back(TrianglePiece(points, Vec3I(apex, 2 + i, 2 + (i + 1) % around),
                                              apex * around + i,
                                              {apex, BoxTree::kNoMark, BoxTree::kNoMark}),
                                count);
    const double triangles = double(pieces.size());
    const PairBounds all;
    const PolledStop stop(nullptr);
    std::vector<std::array<std::uint32_t, 2>> pairs;
    std::atomic<std::size_t> kept{0};
    EXPECT_TRUE(CrowdedPairs<Counted>(std::move(pieces), all, stop)
                    .list([&](std::uint32_t, std::uint32_t) { return ++kept, true; }, pairs));
    // Each triangle shares an edge with one of the other cone, and a corner with two more.
    EXPECT_GE(kept, 3 * std::size_t(around));
    return double(count) / triangles;
}

TEST(CrowdedPairs, OfTwoConesOverOneRimAreNoMoreEachWhereThereAreMoreTriangles)
{
    const double few = looked_at_each(4000), many = looked_at_each(64000);
    EXPECT_LT(many, 2 * few);
    EXPECT_LT(many, 100);
}

} // namespace
} // namespace vdb_shell
