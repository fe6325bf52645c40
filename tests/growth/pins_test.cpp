// SPDX-License-Identifier: Apache-2.0
#include "growth/pins.h"

#include "core/stage_progress.h"
#include "growth/diagonals.h"
#include "growth/half_full_sphere.h"
#include "growth/initialise.h"
#include "growth/line_directions.h"
#include "growth/mend_prolonged.h"
#include "growth/move_tests.h"
#include "growth/pillars_around_pin.h"
#include "growth/predicates.h"
#include "growth/violations.h"
#include "support/pinned_patches.h"
#include "support/shapes.h"
#include "vdb_shell/mesh/normals.h"
#include "vdb_shell/step/directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;

/// Whether inner triangle f meets no other.
bool clear(const growth::GrowState& s, int f)
{
    const growth::InnerTriangle triangle(s, f);
    for (int g = 0; g < s.mesh->face_count(); ++g)
        if (triangle.meets_outer(g) || (g != f && triangle.meets_inner(g)))
            return false;
    return true;
}

void expect_valid(const growth::GrowState& s)
{
    for (int f = 0; f < s.mesh->face_count(); ++f) {
        EXPECT_TRUE(growth::prism_valid(s, f)) << f;
        EXPECT_TRUE(clear(s, f)) << f;
    }
}

TEST(Pins, AreReleasedWhereTheExactTestsAllowItAndNotWithoutVisibility)
{
    const TriangleMesh ball = test::icosphere(1, 1);
    const Directions directions = directions_along(ball, pseudo_normals(ball));
    const growth::Connectivity mesh = growth::connect(ball.points.size(), ball.triangles);
    const std::vector<double> cap(ball.points.size(), std::numeric_limits<double>::infinity());
    growth::GrowState s = growth::make_state(mesh, ball.points, cap);
    growth::shrink_until_valid(s, directions, std::vector<double>(s.b.size(), 0.5),
                               StageProgress(nullptr, "test"));
    // Neighbours too: each is released beside pins that are not yet.
    for (const int v : {0, 1, 11}) {
        s.pinned[v] = 1;
        s.b[v] = s.a[v];
    }
    EXPECT_EQ(growth::release_pins(s, std::vector<double>(s.b.size(), 0.0),
                                   growth::PillarsBesidePin::shortened),
              0);
    EXPECT_EQ(growth::release_pins(s, directions.visibility, growth::PillarsBesidePin::kept), 3);
    expect_valid(s);
    for (const int v : {0, 1, 11})
        EXPECT_NE(s.b[v], s.a[v]);
}

growth::GrowState with_pinned(const growth::Connectivity& mesh, const TriangleMesh& patch,
                              const std::vector<openvdb::Vec3s>& inner, std::size_t pinned)
{
    const std::vector<double> cap(patch.points.size(), std::numeric_limits<double>::infinity());
    growth::GrowState s = growth::make_state(mesh, patch.points, cap);
    s.b.assign(inner.begin(), inner.end());
    s.pinned[pinned] = 1;
    return s;
}

std::vector<double> visibility_of(const TriangleMesh& patch, std::size_t vertex)
{
    std::vector<double> visibility(patch.points.size(), 0.0);
    visibility[vertex] = directions_along(patch, pseudo_normals(patch)).visibility[vertex];
    return visibility;
}

/// Builds the tree of the inner triangles, too.
std::ptrdiff_t violations(growth::GrowState& s)
{
    const std::size_t faces = s.mesh->faces.size();
    const auto bad = growth::violating_faces(s, std::vector<std::uint8_t>(faces, 1), true);
    return std::count(bad.begin(), bad.end(), 1);
}

/// A block with an edge of 106 degrees whose wall is dented a little at one point: the sliver
/// between that point and the edge faces back along the wall.
TriangleMesh block_with_sliver(float dent)
{
    TriangleMesh block;
    block.points = {{0, 0, 0},         {0, 0, 1},      {0.28f, 0.96f, 0},
                    {0.28f, 0.96f, 1}, {-1, 0.96f, 0}, {-1, 0.96f, 1},
                    {-1, 0, 0},        {-1, 0, 1},     {0, dent, 0.5f}};
    block.triangles = {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}, {4, 6, 5}, {5, 6, 7}, {6, 0, 8},
                       {8, 1, 7}, {6, 8, 7}, {0, 1, 8}, {0, 4, 2}, {0, 6, 4}, {1, 3, 5}, {1, 5, 7}};
    return block;
}

TEST(Pins, BesideTwoPinsGetPillarsWithinTheAngleOfTheSurfaceAtTheEdgeBetweenThem)
{
    const TriangleMesh block = block_with_sliver(1e-7f);
    ASSERT_NEAR(signed_volume(block.points, block.triangles), 0.5 * (1.0 + 1.28) * 0.96, 1e-5);
    const Directions directions = directions_along(block, pseudo_normals(block));
    const growth::Connectivity mesh = growth::connect(block.points.size(), block.triangles);
    const std::vector<double> cap(block.points.size(), std::numeric_limits<double>::infinity());
    growth::GrowState s = growth::make_state(mesh, block.points, cap);
    for (const std::size_t v : {2, 3, 4, 5, 6, 7})
        s.b[v] = growth::rounded(s.a[v] + 0.1 * directions.inward[v]);
    for (const std::size_t v : {0, 1, 8}) {
        s.pinned[v] = 1;
        s.b[v] = s.a[v];
    }
    ASSERT_EQ(violations(s), 0);
    // What sees the triangles of the point best leans out of the block, but for lengths of less
    // than a rounding.
    const growth::View view = growth::best_view(s, 8);
    const std::optional<growth::View> beside = growth::view_beside_pins(s, 8, 0.1, view);
    ASSERT_TRUE(beside);
    const Vec3d across(0.96, -0.28, 0.0);
    EXPECT_GT(across.dot(view.direction), 0.1);
    EXPECT_LT(across.dot(beside->direction), 0.0);
    EXPECT_GT(beside->least, 0.0);
    EXPECT_EQ(growth::release_pins(s, visibility_of(block, 8), growth::PillarsBesidePin::kept), 1);
    EXPECT_GT((s.b[8] - s.a[8]).length(), 0.01);
    expect_valid(s);
}

/// Around a vertex of the scan hammer. The cone of its directions is a hundredth wide: a search
/// that is no finer than that finds none and shortens the pillars beside it.
TEST(Pins, AreReleasedWhereTheConeOfDirectionsIsNarrow)
{
    TriangleMesh patch;
    patch.points = {
        {-0.0666489974f, 0.240922004f, 1.31606603f}, {-0.0423990004f, 0.240054995f, 1.30983305f},
        {-0.0247179996f, 0.241646007f, 1.31958795f}, {-0.0209129993f, 0.239775002f, 1.31107402f},
        {-0.0335180014f, 0.242434993f, 1.32223797f}, {-0.0113779996f, 0.241573006f, 1.32670796f},
        {-0.0542830005f, 0.242008001f, 1.32983696f}, {-0.0298629999f, 0.246963993f, 1.33577204f},
        {-0.0230119992f, 0.246375993f, 1.33394301f}, {-0.00540400017f, 0.240300998f, 1.33795798f},
        {-0.0443800017f, 0.243808001f, 1.33604205f}, {-0.0600030012f, 0.242327005f, 1.34311497f},
        {-0.0221040007f, 0.246757001f, 1.338817f},   {-0.0319069996f, 0.245669007f, 1.34502494f},
        {-0.0747530013f, 0.241707996f, 1.34364104f}, {-0.0478189997f, 0.243189007f, 1.34683204f}};
    patch.triangles = {{3, 1, 2},   {2, 1, 6},    {6, 4, 2},    {5, 3, 2},   {1, 0, 6},
                       {5, 2, 8},   {4, 6, 10},   {8, 4, 7},    {2, 4, 8},   {14, 6, 0},
                       {10, 7, 4},  {8, 9, 5},    {10, 6, 11},  {7, 12, 8},  {9, 8, 12},
                       {6, 14, 11}, {15, 10, 11}, {13, 10, 15}, {7, 10, 13}, {12, 7, 13}};
    const std::vector<openvdb::Vec3s> inner = {{-0.0668844208f, 0.188681379f, 1.31690311f},
                                               {-0.0451119095f, 0.229998216f, 1.3125999f},
                                               {-0.0252777189f, 0.241342768f, 1.32036197f},
                                               {-0.0633692592f, 0.0908759758f, 1.30123305f},
                                               {-0.0335180014f, 0.242434993f, 1.32223797f},
                                               {-0.0194509886f, 0.218504205f, 1.32542336f},
                                               {-0.0542830005f, 0.242008001f, 1.32983696f},
                                               {-0.0308174379f, 0.242812514f, 1.33524466f},
                                               {-0.0234992094f, 0.244435355f, 1.33373368f},
                                               {-0.0693478584f, 0.0368232317f, 1.33616006f},
                                               {-0.0466065519f, 0.233885199f, 1.33468521f},
                                               {-0.0713027716f, 0.178802997f, 1.34000468f},
                                               {-0.0853439793f, 0.0178102143f, 1.33877361f},
                                               {-0.08753784f, 0.0181829277f, 1.34142542f},
                                               {-0.0779920369f, 0.222780228f, 1.34203458f},
                                               {-0.0916419849f, 0.00921160448f, 1.33990109f}};
    const growth::Connectivity mesh = growth::connect(patch.points.size(), patch.triangles);
    growth::GrowState s = with_pinned(mesh, patch, inner, 4);
    s.pinned[6] = 1;
    const std::vector<double> visibility = visibility_of(patch, 4);
    ASSERT_GT(visibility[4], 0.1);
    EXPECT_EQ(violations(s), 0);
    EXPECT_EQ(growth::release_pins(s, visibility, growth::PillarsBesidePin::kept), 1);
    EXPECT_NE(s.b[4], s.a[4]);
    std::vector<openvdb::Vec3d> others(inner.begin(), inner.end());
    others[4] = s.b[4];
    EXPECT_EQ(s.b, others);
    expect_valid(s);
}

/// A fan whose pillars lean: every prism is valid without the pillar in the middle, and no
/// direction of that one suits all six.
TEST(Pins, AreReleasedByShorteningThePillarsThatLeaveNoDirection)
{
    TriangleMesh patch;
    patch.points = {
        {0, 0, 0},       {1, 0, -0.25f},          {0.5f, 0.866f, 0.25f}, {-0.5f, 0.866f, -0.25f},
        {-1, 0, -0.75f}, {-0.5f, -0.866f, 0.75f}, {0.5f, -0.866f, -0.5f}};
    patch.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 6}, {0, 6, 1}};
    const std::vector<openvdb::Vec3s> inner = {{0, 0, 0},
                                               {0, -0.5f, -1.25f},
                                               {0.75f, 1.616f, -1},
                                               {-0.25f, 0.616f, -2},
                                               {-0.5f, 0.25f, -2.5f},
                                               {-0.5f, -0.616f, -0.25f},
                                               {0.5f, -1.866f, -1.25f}};
    const growth::Connectivity mesh = growth::connect(patch.points.size(), patch.triangles);
    growth::GrowState s = with_pinned(mesh, patch, inner, 0);
    const std::vector<double> visibility = visibility_of(patch, 0);
    ASSERT_GT(visibility[0], 0.5);
    EXPECT_EQ(violations(s), 0);
    const std::vector<openvdb::Vec3d> before = s.b;
    EXPECT_EQ(growth::release_pins(s, visibility, growth::PillarsBesidePin::kept), 0);
    EXPECT_EQ(s.b, before) << "a release that fails changes nothing";
    EXPECT_NE(s.pinned[0], 0);
    EXPECT_EQ(growth::release_pins(s, visibility, growth::PillarsBesidePin::shortened), 1);
    EXPECT_NE(s.b[0], s.a[0]);
    expect_valid(s);
    // The pillars beside it may have changed, each to a half of a half of what it was.
    for (std::size_t u = 1; u < before.size(); ++u) {
        const openvdb::Vec3d was = before[u] - s.a[u], now = s.b[u] - s.a[u];
        if (s.b[u] != before[u]) {
            EXPECT_NEAR(was.cross(now).length(), 0, 1e-5 * was.length());
            EXPECT_LT(now.length(), 0.51 * was.length());
        }
    }
}

Directions directions_of(const TriangleMesh& surface)
{
    Directions directions = directions_along(surface, pseudo_normals(surface));
    growth::mend_directions(surface, directions, GrowthSchedule{}.initial);
    return directions;
}

/// No pin is left, nothing around it meets anything, and no pillar has become longer.
void expect_released(const test::PinnedPatch& patch)
{
    const TriangleMesh& surface = patch.surface;
    const growth::Connectivity mesh = growth::connect(surface.points.size(), surface.triangles);
    growth::GrowState s = with_pinned(mesh, surface, patch.inner, patch.pinned);
    const Directions directions = directions_of(surface);
    const std::vector<openvdb::Vec3d> before = s.b;
    EXPECT_EQ(violations(s), 0);
    EXPECT_EQ(growth::release_pins(s, directions.visibility, growth::PillarsBesidePin::kept), 0);
    EXPECT_EQ(s.b, before);
    EXPECT_EQ(growth::release_pins(s, directions.visibility, growth::PillarsBesidePin::turned), 1);
    EXPECT_NE(s.b[patch.pinned], s.a[patch.pinned]);
    expect_valid(s);
    for (std::size_t u = 0; u < before.size(); ++u)
        if (u != patch.pinned) {
            EXPECT_LE((s.b[u] - s.a[u]).length(), (before[u] - s.a[u]).length()) << u;
        }
}

TEST(Pins, AreReleasedBesidePillarsThatRoundingWouldTurnOver)
{
    expect_released(test::patch_of_cheburashka());
}

TEST(Pins, AreReleasedBesideAPillarThatHardlySeesItsTriangles)
{
    expect_released(test::patch_of_hammer());
}

/// A vertex that hardly sees its triangles, among pillars that cannot give way any more.
TEST(Pins, AreReleasedBeforeVerticesThatAreServedMoreEasily)
{
    const test::PinnedPatch patch = test::patch_of_nefertiti();
    const TriangleMesh& surface = patch.surface;
    const growth::Connectivity mesh = growth::connect(surface.points.size(), surface.triangles);
    growth::GrowState s = with_pinned(mesh, surface, patch.inner, patch.pinned);
    Directions directions = directions_of(surface);
    EXPECT_EQ(violations(s), 0);
    const std::vector<openvdb::Vec3d> before = s.b;
    EXPECT_EQ(growth::release_pins(s, directions.visibility, growth::PillarsBesidePin::turned), 0);
    EXPECT_EQ(s.b, before) << "a release that fails changes nothing";
    const StageProgress progress(nullptr, "test");
    EXPECT_EQ(growth::release_last_pins(s, directions.visibility, progress), 1);
    EXPECT_EQ(growth::count_pins(s), 0);
    for (std::size_t u = 0; u < s.b.size(); ++u)
        EXPECT_NE(s.b[u], s.a[u]) << u;
    expect_valid(s);
    // Without a direction in which it sees all of them there is nothing to be done.
    growth::GrowState blind = with_pinned(mesh, surface, patch.inner, patch.pinned);
    EXPECT_EQ(violations(blind), 0);
    directions.visibility[patch.pinned] = 0;
    EXPECT_EQ(growth::release_last_pins(blind, directions.visibility, progress), 0);
    EXPECT_EQ(blind.b, before);
}

/// A sphere whose inner points are thrown about, valid under the three-tet test alone.
struct MendedSphere : test::HalfFullSphere {
    explicit MendedSphere(int seed) : HalfFullSphere(0.12, static_cast<std::uint64_t>(seed))
    {
        s.twelve = false;
        growth::order_by_length(s);
        growth::mend_placed(s, StageProgress(nullptr, "test"), growth::MendFrom::chosen_tets);
    }
};

/// Under the three-tet test a shortened pillar may turn over a tet that one beside it stands on. At
/// these seeds and vertices neither shortening nor taking away those beside helps.
TEST(Pins, AreReleasedUnderTheThreeTetTestAmongPrismsThatPassTheOther)
{
    const auto all_pass_twelve = [](const growth::GrowState& s, int v) {
        const growth::Slice<int> around = growth::neighbours(*s.mesh, v);
        return std::all_of(around.begin(), around.end(), [&](int u) {
            const std::vector<int> faces = growth::faces_at(*s.mesh, u);
            return std::all_of(faces.begin(), faces.end(),
                               [&](int f) { return growth::twelve_tets_valid(s, f); });
        });
    };
    for (const auto& [seed, v] : {std::pair{38, 77}, std::pair{136, 581}, std::pair{226, 42}}) {
        MendedSphere sphere(seed);
        growth::GrowState& s = sphere.s;
        const Directions directions = directions_along(sphere.mesh, pseudo_normals(sphere.mesh));
        s.b[v] = s.a[v];
        s.pinned[v] = 1;
        EXPECT_EQ(violations(s), 0);
        const std::vector<openvdb::Vec3d> before = s.b;
        std::vector<double> visibility(s.b.size(), 0.0);
        visibility[v] = directions.visibility[v];
        for (const int u : growth::neighbours(*s.mesh, v))
            visibility[u] = directions.visibility[u];
        EXPECT_EQ(growth::release_pins(s, visibility, growth::PillarsBesidePin::turned), 0);
        EXPECT_EQ(s.b, before) << "a release that fails changes nothing";
        EXPECT_FALSE(all_pass_twelve(s, v));
        EXPECT_EQ(growth::release_last_pins(s, visibility, StageProgress(nullptr, "test")), 1);
        EXPECT_FALSE(s.twelve);
        EXPECT_NE(s.b[v], s.a[v]);
        EXPECT_TRUE(all_pass_twelve(s, v));
        expect_valid(s);
    }
}

/// Of all vertices of the spheres of 250 seeds that are left a pin by the other ways, the only one
/// for which pillars have to be shortened more than five edges away.
TEST(Pins, AreReleasedUnderTheThreeTetTestWhereThatTakesPillarsFarAround)
{
    MendedSphere sphere(67);
    growth::GrowState& s = sphere.s;
    const Directions directions = directions_along(sphere.mesh, pseudo_normals(sphere.mesh));
    constexpr int kPin = 617;
    s.b[kPin] = s.a[kPin];
    s.pinned[kPin] = 1;
    EXPECT_EQ(violations(s), 0);
    EXPECT_EQ(growth::release_pins(s, directions.visibility, growth::PillarsBesidePin::turned), 0);
    EXPECT_EQ(growth::release_last_pins(s, directions.visibility, StageProgress(nullptr, "test")),
              1);
    EXPECT_NE(s.b[kPin], s.a[kPin]);
    EXPECT_EQ(growth::count_pins(s), 0);
    expect_valid(s);
}

} // namespace
