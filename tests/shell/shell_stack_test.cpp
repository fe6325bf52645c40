// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/shell/shell_stack.h"

#include "support/broken_shells.h"
#include "support/stacks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;
using test::icosphere;

using Position = std::array<float, 3>;
using Face = std::array<Position, 3>;

Position position(const Vec3s& p)
{
    return {p[0], p[1], p[2]};
}

Face face_of(const Vec3s& a, const Vec3s& b, const Vec3s& c)
{
    Face face{position(a), position(b), position(c)};
    std::sort(face.begin(), face.end());
    return face;
}

/// How many tets have each face, by the places of its corners: two points in one place are one.
std::map<Face, int> faces_of(const TetMesh& tets)
{
    std::map<Face, int> faces;
    for (const openvdb::Vec4I& t : tets.tets)
        for (int left_out = 0; left_out < 4; ++left_out) {
            std::vector<Vec3s> corners;
            for (int i = 0; i < 4; ++i)
                if (i != left_out)
                    corners.push_back(tets.points[t[i]]);
            ++faces[face_of(corners[0], corners[1], corners[2])];
        }
    return faces;
}

/// Concentric surfaces. `pins[k]` are the vertices that do not move in layer k.
ShellStack concentric(const TriangleMesh& mesh, const std::vector<double>& radii,
                      const std::vector<std::set<std::uint32_t>>& pins)
{
    ShellStack stack;
    std::vector<Vec3s> above = mesh.points;
    for (std::size_t k = 0; k < radii.size(); ++k) {
        PrismShell layer{above, above, mesh.triangles, {}};
        layer.stop.assign(above.size(), StopReason::thickness);
        for (std::uint32_t v = 0; v < above.size(); ++v)
            if (!pins[k].count(v))
                layer.inner[v] = Vec3s(radii[k] * Vec3d(mesh.points[v]));
        above = layer.inner;
        const SplitRule rule = k % 2 ? SplitRule::length_ascending : SplitRule::vertex_index;
        stack.splits.push_back(split_prisms(layer, {rule, 1}));
        stack.layers.push_back(std::move(layer));
    }
    return stack;
}

ShellStack pinned_here_and_there()
{
    const TriangleMesh ball = icosphere(1, 1);
    const Vec3I whole = ball.triangles[20], everywhere = ball.triangles[50];
    const std::set<std::uint32_t> always{everywhere[0], everywhere[1], everywhere[2]};
    std::vector<std::set<std::uint32_t>> pins(3, always);
    pins[0].insert(3);
    pins[1].insert({7, whole[0], whole[1], whole[2]});
    pins[2].insert({3, 9});
    return concentric(ball, {0.9, 0.7, 0.4}, pins);
}

std::size_t expected_tets(const ShellStack& stack)
{
    std::size_t tets = 0;
    for (const PrismShell& layer : stack.layers)
        for (const Vec3I& t : layer.triangles)
            for (int k = 0; k < 3; ++k)
                tets += layer.pinned(t[k]) ? 0 : 1;
    return tets;
}

TEST(ShellStack, OneLayerGivesTheTetsOfItsShell)
{
    const test::SplitShell made = test::folded_shell(); // with pins
    const ShellStack stack = one_layer(made.shell, made.split);
    EXPECT_EQ(stack.surfaces(), 2U);
    EXPECT_EQ(stack.surface(0), made.shell.outer);
    EXPECT_EQ(stack.surface(1), made.shell.inner);
    const TetMesh whole = make_tets(made.shell, made.split), tets = make_tets(stack);
    EXPECT_EQ(tets.points, whole.points);
    EXPECT_EQ(tets.tets, whole.tets);
    EXPECT_EQ(tets.prism, whole.prism);
    EXPECT_EQ(tets.source_vertex, whole.source_vertex);
    EXPECT_EQ(tets.layer, whole.layer);
    EXPECT_EQ(tets.prism_layer, std::vector<std::uint8_t>(tets.tets.size(), 0));
}

TEST(ShellStack, TetsOfAllLayersMeetFaceToFace)
{
    const ShellStack stack = pinned_here_and_there();
    const TetMesh tets = make_tets(stack);
    EXPECT_EQ(tets.tets.size(), expected_tets(stack));
    const TetSigns signs = count_tet_signs(tets);
    EXPECT_EQ(signs.inverted.count + signs.flat.count, 0U);

    // What only one tet has is the outermost and the innermost surface, where they are two.
    std::set<Face> free_faces, hull;
    for (const auto& [face, count] : faces_of(tets)) {
        EXPECT_LE(count, 2);
        if (count == 1)
            free_faces.insert(face);
    }
    for (const Vec3I& t : stack.triangles()) {
        const auto &top = stack.surface(0), &bottom = stack.surface(3);
        const Face first = face_of(top[t[0]], top[t[1]], top[t[2]]),
                   last = face_of(bottom[t[0]], bottom[t[1]], bottom[t[2]]);
        if (first != last)
            hull.insert({first, last});
    }
    EXPECT_EQ(hull.size(), 2 * (stack.triangles().size() - 1));
    EXPECT_EQ(free_faces, hull);
    EXPECT_TRUE(check_conformity(stack, tets).conforming());
    EXPECT_NEAR(tet_volume(tets),
                signed_volume(stack.surface(0), stack.triangles()) -
                    signed_volume(stack.surface(3), stack.triangles()),
                1e-12);
}

TEST(ShellStack, EachPlaceIsOnePointOfTheFirstSurfaceThatHasIt)
{
    const ShellStack stack = pinned_here_and_there();
    const TetMesh tets = make_tets(stack);
    std::set<Position> places;
    for (std::size_t p = 0; p < tets.points.size(); ++p) {
        EXPECT_TRUE(places.insert(position(tets.points[p])).second) << "point " << p << " twice";
        const std::size_t k = tets.layer[p], v = tets.source_vertex[p];
        EXPECT_EQ(tets.points[p], stack.surface(k)[v]);
        if (k > 0) {
            EXPECT_NE(tets.points[p], stack.surface(k - 1)[v]);
        }
        if (p > 0) {
            EXPECT_LT(std::make_pair(std::size_t(tets.layer[p - 1]),
                                     std::size_t(tets.source_vertex[p - 1])),
                      std::make_pair(k, v));
        }
    }
    for (std::size_t i = 0; i < tets.tets.size(); ++i)
        for (int k = 0; k < 4; ++k)
            EXPECT_LE(tets.layer[tets.tets[i][k]], tets.prism_layer[i] + 1U);
    EXPECT_TRUE(std::is_sorted(tets.prism_layer.begin(), tets.prism_layer.end()));
}

TEST(ShellStack, LeavesOutPointsThatNoTetHas)
{
    // All is pinned in the lower layer; in the upper one all but vertex 0.
    const TriangleMesh ball = icosphere(1, 1);
    std::set<std::uint32_t> all, others;
    for (std::uint32_t v = 0; v < ball.points.size(); ++v)
        all.insert(v);
    others = all;
    others.erase(0);
    const ShellStack stack = concentric(ball, {0.9, 0.8}, {others, all});
    const TetMesh tets = make_tets(stack);
    const auto degree =
        std::size_t(std::count_if(ball.triangles.begin(), ball.triangles.end(), [](const Vec3I& t) {
            return t[0] == 0 || t[1] == 0 || t[2] == 0;
        }));
    EXPECT_EQ(tets.tets.size(), degree);
    EXPECT_EQ(tets.points.size(), degree + 2);
    EXPECT_TRUE(check_conformity(stack, tets).conforming());
}

TEST(ShellStack, HullIsTheOutermostAndTheInnermostSurface)
{
    ShellStack stack = pinned_here_and_there();
    stack.layers.front().stop.assign(stack.surface(0).size(), StopReason::limit);
    stack.layers.back().stop.assign(stack.surface(0).size(), StopReason::prism);
    for (const std::size_t skin : {0U, 2U, 3U}) {
        stack.skin = skin;
        const PrismShell hull = hull_of(stack);
        EXPECT_EQ(hull.outer, stack.surface(0));
        EXPECT_EQ(hull.inner, stack.surface(3));
        EXPECT_EQ(hull.triangles, stack.triangles());
        EXPECT_EQ(hull.stop[0], skin == 3 ? StopReason::limit : StopReason::prism);
    }
}

} // namespace
