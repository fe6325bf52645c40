// SPDX-License-Identifier: Apache-2.0
#include "growth/move_tests.h"

#include "core/counter_random.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{

using openvdb::Vec3d;
using namespace vdb_shell;
using namespace vdb_shell::growth;

GrowState state_of(const Connectivity& connectivity, const TriangleMesh& mesh)
{
    return make_state(
        connectivity, mesh.points,
        std::vector<double>(mesh.points.size(), std::numeric_limits<double>::infinity()));
}

/// Every triangle around v against every other that has a corner in common with it.
bool clear_by_all_pairs(GrowState s, int v, const Vec3d& x)
{
    s.b[v] = x;
    for (const FaceCorner& at : star(*s.mesh, v))
        for (int g = 0; g < s.mesh->face_count(); ++g) {
            if (g != at.face && s.mesh->share_a_corner(at.face, g) &&
                improper_contact(inner_corners(s, at.face), inner_ids(s, at.face),
                                 inner_corners(s, g), inner_ids(s, g)))
                return false;
            for (int k = 0; k < 3; ++k)
                if (s.pinned[s.mesh->corner(at.face, k)] &&
                    s.mesh->incident_to(g, s.mesh->corner(at.face, k)) &&
                    improper_contact(inner_corners(s, at.face), inner_ids(s, at.face),
                                     outer_corners(s, g), outer_ids(s, g)))
                    return false;
        }
    return true;
}

/// Moves of all lengths, from where few triangles meet to where most do.
void expect_as_all_pairs(const GrowState& s, std::uint64_t seed)
{
    const CounterRandom random(seed);
    int clear = 0, meets = 0;
    for (int v = 0; v < s.mesh->vertices; ++v)
        for (std::uint64_t i = 0; i < 6; ++i) {
            if (s.pinned[v])
                continue;
            Vec3d step;
            for (std::uint64_t k = 0; k < 3; ++k)
                step[static_cast<int>(k)] =
                    random.unit(18 * static_cast<std::uint64_t>(v) + 3 * i + k) - 0.5;
            const Vec3d x = rounded(s.b[v] + step * (0.1 * double(1 << i)));
            const bool found = adjacent_clear_at(s, v, x);
            EXPECT_EQ(found, clear_by_all_pairs(s, v, x)) << "vertex " << v;
            ++(found ? clear : meets);
        }
    EXPECT_GT(clear, 30);
    EXPECT_GT(meets, 30);
}

TEST(AdjacentClear, IsWhatAllPairsWithACommonCornerSay)
{
    const TriangleMesh mesh = test::torus(2.0, 0.7, 12, 8);
    const Connectivity connectivity = connect(mesh.points.size(), mesh.triangles);
    GrowState s = state_of(connectivity, mesh);
    expect_as_all_pairs(s, 1);
    for (const int pin : {3, 40, 41}) {
        s.pinned[pin] = 1;
        s.b[pin] = s.a[pin];
    }
    expect_as_all_pairs(s, 2);
}

TEST(AdjacentClear, HoldsWhereMoreTrianglesMeetThanAFanTakes)
{
    // A cone of 40 triangles above one of 40 below.
    TriangleMesh mesh;
    constexpr std::uint32_t kAround = 40;
    mesh.points = {{0, 0, 1}, {0, 0, -1}};
    for (std::uint32_t i = 0; i < kAround; ++i) {
        const double angle = 2 * M_PI * i / kAround;
        mesh.points.emplace_back(float(std::cos(angle)), float(std::sin(angle)), 0.0F);
    }
    for (std::uint32_t i = 0; i < kAround; ++i) {
        const std::uint32_t p = 2 + i, q = 2 + (i + 1) % kAround;
        mesh.triangles.emplace_back(0U, p, q);
        mesh.triangles.emplace_back(1U, q, p);
    }
    const Connectivity connectivity = connect(mesh.points.size(), mesh.triangles);
    expect_as_all_pairs(state_of(connectivity, mesh), 3);
}

} // namespace
