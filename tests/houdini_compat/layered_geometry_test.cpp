// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/shell_geometry.h"
#include "vdb_shell/pipeline.h"

#include "houdini_compat/geometries.h"
#include "houdini_compat/round_trip.h"
#include "support/files.h"
#include "support/shapes.h"
#include "support/tapered.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

// Shells of several layers, and those outside their surface, as Houdini geometry.

namespace vdb_shell::houdini
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using test::expect_round_trips;
using test::has;
using test::held;
using test::layered_shell_file;
using test::refusal_of_changed;
using test::values_of;

TriangleMesh centred_box()
{
    return test::box(Vec3d(-1), Vec3d(1));
}

/// Three layers outside the surface and two inside, where triangle 0 has no layer at all.
ShellFile both_sided_shell()
{
    const TriangleMesh mesh = test::icosphere(1.0, 1);
    const openvdb::Vec3I t = mesh.triangles[0];
    return layered_shell_file(mesh, {1.75f, 1.5f, 1.25f, 1.0f, 0.75f, 0.5f}, 3, {t[0], t[1], t[2]},
                              3);
}

TEST(LayeredGeometry, EveryFormGivesTheSameStackBackBitForBit)
{
    expect_round_trips(layered_shell_file(centred_box(), {1.0f, 0.75f, 0.5f, 0.25f}, 0));
    expect_round_trips(layered_shell_file(test::icosphere(1.0, 2), {1.5f, 1.0f}, 1));
    expect_round_trips(layered_shell_file(test::icosphere(1.0, 2), {1.5f, 1.0f, 0.5f}, 1));
    expect_round_trips(both_sided_shell());
}

TEST(LayeredGeometry, PillarsMayBePinnedInAnyLayers)
{
    const openvdb::Vec3I t = centred_box().triangles[0];
    const std::set<std::uint32_t> corners{t[0], t[1], t[2]};
    for (const std::size_t first : {0, 1, 2})
        for (const std::size_t skin : {0, 1, 2, 3})
            expect_round_trips(layered_shell_file(centred_box(), {1.0f, 0.75f, 0.5f, 0.25f}, skin,
                                                  corners, first));
    // Cut pillars may stay whole: pinned in all layers but the farthest.
    ShellFile whole = layered_shell_file(centred_box(), {1.0f, 0.75f, 0.5f, 0.25f}, 0);
    for (const std::uint32_t v : corners) {
        for (std::size_t k = 0; k < 2; ++k)
            whole.stack.layers[k].inner[v] = whole.stack.layers[k + 1].outer[v] =
                whole.stack.layers[0].outer[v];
    }
    whole.tets = make_tets(whole.stack);
    expect_round_trips(whole);
}

TEST(LayeredGeometry, TaperedStacksComeBackBitForBit)
{
    for (const ShellStack& stack : {test::two_sheets(), test::layers_to_a_point(),
                                    test::coned(test::octahedron(), Vec3s(1, 0, 0))}) {
        ShellFile file;
        file.stack = stack;
        file.tets = make_tets(stack);
        file.parameters_json = file.report_json = "{}";
        expect_round_trips(file);
        const HoudiniGeometry geometry = shell_geometry(file);
        EXPECT_TRUE(shell_of_geometry(geometry, "x").stack.tapered);
        EXPECT_NE(find(geometry.detail_attributes, "vdb_shell_tapered"), nullptr);
    }
}

TEST(LayeredGeometry, OneLayerSaysNothingOfLayers)
{
    const HoudiniGeometry g =
        shell_geometry(test::scaled_shell_file(test::icosphere(1.0, 1), 0.5f));
    EXPECT_EQ(std::get<std::vector<std::int32_t>>(
                  find(g.detail_attributes, "vdb_shell_schema")->values)[0],
              1);
    EXPECT_EQ(find(g.detail_attributes, "vdb_shell_layers"), nullptr);
    EXPECT_EQ(find(g.point_attributes, "surface"), nullptr);
    EXPECT_EQ(find(g.point_groups, "skin"), nullptr);
    EXPECT_EQ(find(g.primitive_groups, "skin"), nullptr);
}

TEST(LayeredGeometry, AttributesSayWhereAPointLies)
{
    const std::vector<float> scales{1.75f, 1.5f, 1.25f, 1.0f, 0.75f, 0.5f};
    const HoudiniGeometry g =
        shell_geometry(layered_shell_file(test::icosphere(1.0, 1), scales, 3));
    ASSERT_EQ(g.points, 6u * 42u);
    const auto& p = held<float>(g.point_attributes, "P");
    const auto& opposite = held<float>(g.point_attributes, "opposite");
    const auto& surface = held<std::int32_t>(g.point_attributes, "surface");
    const auto &skin = find(g.point_groups, "skin")->members,
               &outer = find(g.point_groups, "outer")->members,
               &inner = find(g.point_groups, "inner")->members;
    for (std::size_t i = 0; i < g.points; ++i) {
        const auto k = static_cast<std::size_t>(surface[i]);
        ASSERT_EQ(k, i / 42);
        const auto radius = [&](const std::vector<float>& at) {
            return Vec3d(at[3 * i], at[3 * i + 1], at[3 * i + 2]).length();
        };
        EXPECT_NEAR(radius(p), scales[k], 1e-6);
        EXPECT_NEAR(radius(opposite), scales[k == 5 ? 4 : k + 1], 1e-6);
        EXPECT_FLOAT_EQ(held<float>(g.point_attributes, "depth")[i], static_cast<float>(k) / 5);
        EXPECT_NEAR(held<float>(g.point_attributes, "thickness")[i], 1.25, 1e-6);
        EXPECT_EQ(outer[i], k == 0);
        EXPECT_EQ(skin[i], k == 3);
        EXPECT_EQ(inner[i], k == 5);
        const auto source = held<std::int32_t>(g.point_attributes, "source_vertex")[i];
        EXPECT_EQ(source, static_cast<std::int32_t>(i % 42));
        const auto reason = [&](const char* name) {
            return std::get<Strings>(find(g.point_attributes, name)->values).at(i);
        };
        EXPECT_EQ(reason("stop_reason"), name_of(StopReason(source % kStopReasonCount)));
        EXPECT_EQ(reason("stop_reason_outer"),
                  name_of(StopReason((source + 1) % kStopReasonCount)));
    }
}

/// Six times the volume under the primitives of each layer (tets) or surface (triangles).
std::map<std::string, double> volumes(const HoudiniGeometry& g)
{
    const auto& p = held<float>(g.point_attributes, "P");
    const auto& layer = held<std::int32_t>(g.primitive_attributes, "layer");
    std::map<std::string, double> sums;
    std::size_t first = 0;
    for (std::size_t i = 0; i < g.primitives.size(); ++i) {
        const auto at = [&](std::size_t k) {
            const std::size_t point = g.vertex_point[first + k];
            return Vec3d(p[3 * point], p[3 * point + 1], p[3 * point + 2]);
        };
        if (g.primitives[i].type == PrimitiveType::tetrahedron) {
            const double det = (at(1) - at(0)).dot((at(2) - at(0)).cross(at(3) - at(0)));
            EXPECT_LT(det, 0.0) << i;
            sums["layer " + std::to_string(layer[i])] -= det;
        } else {
            for (const char* name : {"outer", "skin", "inner"})
                if (find(g.primitive_groups, name)->members[i])
                    sums[name] -= at(0).dot(at(1).cross(at(2)));
        }
        first += g.primitives[i].vertices;
    }
    return sums;
}

TEST(LayeredGeometry, LayersFillWhatLiesBetweenTheSurfaces)
{
    const auto box =
        volumes(shell_geometry(layered_shell_file(centred_box(), {1.5f, 1.0f, 0.5f}, 1)));
    EXPECT_NEAR(box.at("outer"), 6 * 27.0, 1e-9);
    EXPECT_NEAR(box.at("skin"), 6 * 8.0, 1e-9);
    EXPECT_NEAR(box.at("inner"), 6 * 1.0, 1e-9);
    EXPECT_NEAR(box.at("layer 0"), 6 * 19.0, 1e-9);
    EXPECT_NEAR(box.at("layer 1"), 6 * 7.0, 1e-9);
    // The skin is the innermost surface of an outward shell.
    const auto outward = volumes(shell_geometry(layered_shell_file(centred_box(), {2, 1}, 1)));
    EXPECT_EQ(outward.at("skin"), outward.at("inner"));
    EXPECT_NEAR(outward.at("layer 0"), 6 * 56.0, 1e-9);
}

TEST(LayeredGeometry, CollapsedPrismsAreTriangles)
{
    const HoudiniGeometry g = shell_geometry(both_sided_shell());
    // Triangle 0 has no tets in layers 3 and 4; its diagonals there are told by the triangles of
    // the skin and of the innermost surface, so nothing is left to tell.
    const auto members = [](const HoudiniGeometry& in, const char* name) {
        const auto& group = find(in.primitive_groups, name)->members;
        return std::count(group.begin(), group.end(), true);
    };
    EXPECT_EQ(members(g, "collapsed"), 0);
    EXPECT_EQ(members(g, "skin"), 80);
    const openvdb::Vec3I t = centred_box().triangles[0];
    const HoudiniGeometry box = shell_geometry(
        layered_shell_file(centred_box(), {1.0f, 0.75f, 0.5f, 0.25f}, 0, {t[0], t[1], t[2]}, 1));
    EXPECT_EQ(members(box, "collapsed"), 1);
    EXPECT_EQ(held<std::int32_t>(box.primitive_attributes, "layer").back(), 1);
    EXPECT_EQ(held<std::int32_t>(box.primitive_attributes, "prism").back(), 0);
}

template <typename Change> std::string refusal_of_layers(const Change& change)
{
    const openvdb::Vec3I t = centred_box().triangles[0];
    return refusal_of_changed(
        layered_shell_file(centred_box(), {1.0f, 0.75f, 0.5f, 0.25f}, 0, {t[0], t[1], t[2]}, 1),
        change);
}

TEST(LayeredGeometry, SaysWhichNumberOfLayersContradicts)
{
    const auto detail = [&](const char* name, std::int32_t value) {
        return refusal_of_layers(
            [&](auto& g) { values_of<std::int32_t>(g.detail_attributes, name)[0] = value; });
    };
    has(detail("vdb_shell_layers", 0), "\"vdb_shell_layers\" is 0");
    has(detail("vdb_shell_layers", 251), "\"vdb_shell_layers\" is 251, which is not in [0, 250]");
    has(detail("vdb_shell_layers", 5), "36 prisms are not a multiple of 5 layers");
    has(detail("vdb_shell_layers", 18), "8 vertices cannot all be corners of 2 triangles");
    has(detail("vdb_shell_skin", 4), "\"vdb_shell_skin\" is 4, which is not in [0, 3]");
    has(detail("vdb_shell_skin", 3), "checksum");
    has(detail("vdb_shell_skin", 1), "80 tets and 36 prisms make at least 116");
}

TEST(LayeredGeometry, SaysWhichElementContradicts)
{
    has(refusal_of_layers(
            [](auto& g) { values_of<std::int32_t>(g.point_attributes, "surface")[3] = 1; }),
        "\"surface\" of point 3 is 1, expected 0 to 0");
    has(refusal_of_layers(
            [](auto& g) { values_of<std::int32_t>(g.point_attributes, "surface").back() = 4; }),
        "is 4, expected 1 to 3");
    has(refusal_of_layers([](auto& g) {
            values_of<std::int32_t>(g.point_attributes, "source_vertex")[9] =
                values_of<std::int32_t>(g.point_attributes, "source_vertex")[8];
        }),
        "\"source_vertex\" of point 9 is 0, as of point 8");
    has(refusal_of_layers(
            [](auto& g) { values_of<std::int32_t>(g.point_attributes, "surface").back() = 2; }),
        "of point 25 is 7, as of point 20 on the same surface");
    has(refusal_of_layers(
            [](auto& g) { values_of<std::int32_t>(g.primitive_attributes, "layer")[0] = 3; }),
        "\"layer\" of primitive 0 is 3 of 3");
    has(refusal_of_layers(
            [](auto& g) { values_of<std::int32_t>(g.primitive_attributes, "layer").back() = 0; }),
        "prism 0: point 8 is not below point 0");
    has(refusal_of_layers(
            [](auto& g) { values_of<std::int32_t>(g.primitive_attributes, "layer")[0] = 1; }),
        "checksum");
    has(refusal_of_layers([](auto& g) {
            for (auto& attribute : g.primitive_attributes)
                std::visit(
                    [&](auto& values) {
                        if constexpr (!std::is_same_v<std::decay_t<decltype(values)>, Strings>)
                            values.resize(values.size() - static_cast<std::size_t>(attribute.size));
                    },
                    attribute.values);
            g.primitives.pop_back();
            g.vertex_point.resize(g.vertex_point.size() - 3);
        }),
        "no primitive tells the diagonals of prism 0 in layer 1");
    ShellFile loose = layered_shell_file(test::unit_tetrahedron(), {1.0f, 0.5f, 0.25f}, 0);
    for (PrismShell& layer : loose.stack.layers) {
        layer.outer.resize(13);
        layer.inner.resize(13);
        layer.stop.resize(13);
    }
    EXPECT_THROW(shell_geometry(loose), InvalidOption);
}

TEST(LayeredGeometry, CheckCertifiesWhatWasReadBack)
{
    const test::TemporaryFolder folder;
    const std::pair<Side, int> kinds[] = {
        {Side::inward, 3}, {Side::outward, 1}, {Side::both, 1}, {Side::both, 2}};
    for (const auto& [side, layers] : kinds) {
        ShellOptions options;
        options.side = side;
        options.layers.layers = layers;
        options.level_set.resolution = 16;
        options.coverage.samples = 0;
        test::expect_verified_files(folder, test::file_of_built(options, test::icosphere(1.0, 2)));
    }
}

} // namespace
} // namespace vdb_shell::houdini
