// SPDX-License-Identifier: Apache-2.0
#include "growth/diagonals.h"

#include "growth/half_full_sphere.h"
#include "growth/move_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace
{

using namespace vdb_shell;
using namespace vdb_shell::growth;

/// A sphere whose inner points are thrown about: some splits of many prisms have tets that are not
/// positive.
struct SphereSplitByIndex : test::HalfFullSphere {
    SphereSplitByIndex() : HalfFullSphere(0.04, 3)
    {
        s.twelve = false;
        // By index: they conform, and know nothing of the tets.
        for (int f = 0; f < s.mesh->face_count(); ++f) {
            PrismOrder order{0, 1, 2};
            std::sort(order.begin(), order.end(),
                      [&](int l, int m) { return s.mesh->corner(f, l) < s.mesh->corner(f, m); });
            s.order[std::size_t(f)] = static_cast<std::uint8_t>(order_index(order));
        }
    }
    std::vector<int> failing() const
    {
        std::vector<int> counts;
        for (int f = 0; f < s.mesh->face_count(); ++f)
            counts.push_back(failing_tets(s, f, s.order[std::size_t(f)]));
        return counts;
    }
};

/// Whether the diagonal of the edge from u to w starts at u's outer end, as face f has it.
bool starts_at(const GrowState& s, int f, int u, int w)
{
    for (const int local : tables().order[s.order[std::size_t(f)]]) {
        const int v = s.mesh->corner(f, local);
        if (v == u || v == w)
            return v == u;
    }
    return false;
}

std::ptrdiff_t count_failing(const std::vector<int>& tets)
{
    return std::count_if(tets.begin(), tets.end(), [](int n) { return n > 0; });
}

TEST(Diagonals, AreTurnedUntilFewerPrismsFailAndNoneThatWasSound)
{
    SphereSplitByIndex sphere;
    GrowState& s = sphere.s;
    const std::vector<int> before = sphere.failing();
    const std::vector<Vec3d> places = s.b;
    std::vector<int> all(before.size());
    std::iota(all.begin(), all.end(), 0);
    EXPECT_GT(flip_to_mend(s, all), 10U);
    EXPECT_EQ(s.b, places);
    const std::vector<int> after = sphere.failing();
    // What is left has no sound split, or one that a neighbour would pay for.
    EXPECT_LE(count_failing(after), count_failing(before) - 10);
    for (std::size_t f = 0; f < before.size(); ++f)
        if (before[f] == 0) {
            EXPECT_EQ(after[f], 0) << f;
        }
    // Both prisms at an edge have the same diagonal.
    for (int u = 0; u < s.mesh->vertices; ++u)
        for (const int w : neighbours(*s.mesh, u)) {
            std::vector<bool> by_face;
            for (const FaceCorner& at : star(*s.mesh, u))
                if (s.mesh->incident_to(at.face, w))
                    by_face.push_back(starts_at(s, at.face, u, w));
            ASSERT_EQ(by_face.size(), 2U);
            EXPECT_EQ(by_face[0], by_face[1]) << u << " " << w;
        }
}

TEST(Diagonals, OfOtherFacesAreTurnedOnlyWithThem)
{
    SphereSplitByIndex sphere;
    GrowState& s = sphere.s;
    const std::vector<int> before = sphere.failing();
    const std::vector<std::uint8_t> orders = s.order;
    EXPECT_EQ(flip_to_mend(s, {}), 0U);
    EXPECT_EQ(s.order, orders);
    // One that can be mended alone: nothing changes but it and those beside it.
    for (std::size_t f = 0; f < before.size(); ++f) {
        if (before[f] == 0)
            continue;
        if (flip_to_mend(s, {int(f)}) == 0)
            continue;
        for (int g = 0; g < s.mesh->face_count(); ++g)
            if (!s.mesh->share_a_corner(int(f), g)) {
                EXPECT_EQ(s.order[std::size_t(g)], orders[std::size_t(g)]);
            }
        return;
    }
    FAIL() << "no prism could be mended";
}

} // namespace
