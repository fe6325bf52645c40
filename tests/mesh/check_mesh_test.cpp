// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/mesh/check_mesh.h"

#include "support/files.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/io/read_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;
using test::box;
using test::joined;
using test::reversed;

TriangleMesh unit_box(const Vec3d& centre, double size)
{
    return box(centre - Vec3d(size / 2), centre + Vec3d(size / 2));
}

void expect_clean(const MeshCheck& check)
{
    EXPECT_TRUE(check.closed());
    EXPECT_TRUE(check.manifold());
    EXPECT_TRUE(check.embedded());
    EXPECT_EQ(check.inconsistent_edges.count, 0U);
    EXPECT_EQ(check.degenerate_triangles.count, 0U);
    EXPECT_EQ(check.duplicate_triangles.count, 0U);
    EXPECT_EQ(check.inside_out_components(), 0U);
    EXPECT_NO_THROW(require_usable(check, {}, "mesh"));
}

std::string complaint(const MeshCheck& check, const CheckOptions& options = {})
{
    try {
        require_usable(check, options, "thing.obj");
    } catch (const GeometryError& error) {
        return error.what();
    }
    return {};
}

TEST(check_mesh, finds_nothing_wrong_with_clean_surfaces)
{
    const MeshCheck sphere = check_mesh(test::icosphere(1, 3));
    expect_clean(sphere);
    ASSERT_EQ(sphere.components.size(), 1U);
    EXPECT_EQ(sphere.components[0].euler, 2);
    EXPECT_GT(sphere.volume, 0.95 * 4 * M_PI / 3);
    EXPECT_LT(sphere.volume, 4 * M_PI / 3);

    const MeshCheck torus = check_mesh(test::torus(1, 0.3, 24, 12));
    expect_clean(torus);
    EXPECT_EQ(torus.components.at(0).euler, 0);

    // Flat vertices, coplanar neighbours and shared edges are no self-intersections.
    const MeshCheck gridded = check_mesh(test::gridded_box(Vec3d(0), Vec3d(1, 2, 3), 4));
    expect_clean(gridded);
    EXPECT_NEAR(gridded.volume, 6.0, 1e-12);
}

TEST(check_mesh, lists_the_boundary_of_an_open_surface)
{
    const MeshCheck check = check_mesh(test::without_triangle(test::unit_tetrahedron(), 0));
    EXPECT_EQ(check.boundary_edges.count, 3U);
    EXPECT_EQ(check.boundary_edges.first, (std::vector<Edge>{{0, 1}, {0, 2}, {1, 2}}));
    EXPECT_TRUE(check.manifold());
    EXPECT_FALSE(check.components.at(0).closed);
    EXPECT_FALSE(check.components.at(0).inside_out);
    EXPECT_EQ(check.components.at(0).euler, 1);
    const std::string message = complaint(check, {true, true});
    EXPECT_NE(message.find("thing.obj"), message.npos) << message;
    EXPECT_NE(message.find("3 boundary edges"), message.npos) << message;
    EXPECT_NE(message.find("(0, 1), (0, 2), (1, 2)"), message.npos) << message;
}

TEST(check_mesh, lists_at_most_the_first_offenders)
{
    TriangleMesh sheet = test::gridded_box(Vec3d(0), Vec3d(1), 8);
    sheet.triangles.resize(128); // one side
    const MeshCheck check = check_mesh(sheet);
    EXPECT_EQ(check.boundary_edges.count, 32U);
    EXPECT_EQ(check.boundary_edges.first.size(), Defect<Edge>::kFirstShown);
    EXPECT_NE(complaint(check).find(", ..."), std::string::npos);
}

TEST(check_mesh, tells_non_manifold_edges_and_vertices_apart)
{
    // Two tetrahedra that share the edge 0-1, then two that share only the vertex 0.
    TriangleMesh edge = test::unit_tetrahedron();
    edge.points.insert(edge.points.end(), {Vec3s(0, -1, 0), Vec3s(0, 0, -1)});
    edge.triangles.insert(edge.triangles.end(),
                          {Vec3I(0, 4, 1), Vec3I(0, 1, 5), Vec3I(0, 5, 4), Vec3I(1, 4, 5)});
    const MeshCheck by_edge = check_mesh(edge);
    EXPECT_EQ(by_edge.non_manifold_edges.first, (std::vector<Edge>{{0, 1}}));
    EXPECT_EQ(by_edge.non_manifold_vertices.first, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(by_edge.components.size(), 1U);

    TriangleMesh vertex = test::unit_tetrahedron();
    vertex.points.insert(vertex.points.end(), {Vec3s(-1, 0, 0), Vec3s(0, -1, 0), Vec3s(0, 0, -1)});
    vertex.triangles.insert(vertex.triangles.end(),
                            {Vec3I(0, 4, 5), Vec3I(0, 6, 4), Vec3I(0, 5, 6), Vec3I(4, 6, 5)});
    const MeshCheck by_vertex = check_mesh(vertex);
    EXPECT_EQ(by_vertex.non_manifold_edges.count, 0U);
    EXPECT_EQ(by_vertex.non_manifold_vertices.first, (std::vector<std::uint32_t>{0}));
    EXPECT_EQ(by_vertex.components.size(), 2U);
    EXPECT_TRUE(by_vertex.embedded()) << "a shared vertex is no crossing";
    EXPECT_NE(complaint(by_vertex).find("1 vertex whose triangles do not form one fan: 0"),
              std::string::npos);
}

TEST(check_mesh, finds_one_triangle_turned_round)
{
    TriangleMesh mesh = test::icosphere(1, 1);
    std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
    const MeshCheck check = check_mesh(mesh);
    EXPECT_EQ(check.inconsistent_edges.count, 3U);
    EXPECT_TRUE(check.closed());
    EXPECT_FALSE(check.components.at(0).inside_out) << "it has no inside to speak of";
    EXPECT_NE(complaint(check).find("opposite orientation"), std::string::npos);
}

TEST(check_mesh, finds_degenerate_and_duplicate_triangles)
{
    TriangleMesh mesh = test::unit_tetrahedron();
    mesh.points.emplace_back(0.5F, 0.F, 0.F); // on the edge 0-1
    mesh.triangles.emplace_back(0, 4, 1);
    mesh.triangles.emplace_back(2, 2, 1);
    mesh.triangles.emplace_back(1, 0, 2);
    const MeshCheck check = check_mesh(mesh);
    EXPECT_EQ(check.degenerate_triangles.first, (std::vector<std::uint32_t>{4, 5}));
    EXPECT_EQ(check.duplicate_triangles.first, (std::vector<std::uint32_t>{6}));
    EXPECT_EQ(check.self_intersections.count, 0U) << "they are listed as what they are";
}

TEST(check_mesh, calls_a_thin_triangle_degenerate_only_when_its_area_is_exactly_zero)
{
    const float next = std::nextafter(1.0F, 2.0F);
    TriangleMesh mesh{{Vec3s(0, 0, 0), Vec3s(1, 1, 1), Vec3s(2, 2, 2), Vec3s(1, 1, next)},
                      {Vec3I(0, 1, 2), Vec3I(0, 3, 2)}};
    EXPECT_EQ(check_mesh(mesh).degenerate_triangles.first, (std::vector<std::uint32_t>{0}));
}

TEST(check_mesh, finds_crossings_folds_and_contacts)
{
    const TriangleMesh crossing =
        joined(unit_box(Vec3d(0), 1), unit_box(Vec3d(0.5, 0.25, 0.125), 1));
    const MeshCheck check = check_mesh(crossing);
    EXPECT_GT(check.self_intersections.count, 0U);
    for (const TrianglePair& pair : check.self_intersections.first) {
        EXPECT_LT(pair[0], 12U);
        EXPECT_GE(pair[1], 12U);
    }
    EXPECT_NE(complaint(check).find("--allow-self-intersections"), std::string::npos);
    EXPECT_EQ(complaint(check, {true, false}), "");

    // A vertex of the second that lies inside a face of the first, nothing deeper.
    const TriangleMesh contact =
        joined(test::unit_tetrahedron(),
               test::translated(test::unit_tetrahedron(), Vec3d(0.25, 0.25, -1)));
    EXPECT_EQ(check_mesh(contact).self_intersections.count, 3U);

    // Two triangles folded flat onto each other over a shared edge.
    const TriangleMesh fold{{Vec3s(0, 0, 0), Vec3s(1, 0, 0), Vec3s(0, 1, 0), Vec3s(0.25F, 0.5F, 0)},
                            {Vec3I(0, 1, 2), Vec3I(1, 0, 3)}};
    EXPECT_EQ(check_mesh(fold).self_intersections.first, (std::vector<TrianglePair>{{0, 1}}));
}

TEST(check_mesh, tells_outer_surfaces_from_cavities)
{
    // A box, a cavity in it, a box in the cavity, and a box beside them.
    TriangleMesh mesh = unit_box(Vec3d(0), 8);
    mesh = joined(mesh, reversed(unit_box(Vec3d(0), 4)));
    mesh = joined(mesh, unit_box(Vec3d(0), 2));
    mesh = joined(mesh, unit_box(Vec3d(20, 0, 0), 2));
    const MeshCheck check = check_mesh(mesh);
    expect_clean(check);
    ASSERT_EQ(check.components.size(), 4U);
    const int depth[] = {0, 1, 2, 0};
    const double volume[] = {512, -64, 8, 8};
    for (std::size_t c = 0; c < 4; ++c) {
        EXPECT_EQ(check.components[c].nesting_depth, depth[c]) << c;
        EXPECT_NEAR(check.components[c].volume, volume[c], 1e-9) << c;
        EXPECT_EQ(check.components[c].first_triangle, 12 * c);
    }
    EXPECT_NEAR(check.volume, 464, 1e-9);
}

TEST(check_mesh, a_sheet_closed_by_its_own_back_encloses_nothing)
{
    // A tetrahedron whose corners lie in one plane, at places that doubles would round.
    const TriangleMesh flat{
        {{0.1f, 0.7f, 0.3f}, {1.1f, 0.7f, 0.3f}, {1.1f, 2.3f, 0.3f}, {0.1f, 2.9f, 0.3f}},
        {Vec3I(0, 1, 2), Vec3I(0, 2, 3), Vec3I(0, 3, 1), Vec3I(1, 3, 2)}};
    const TriangleMesh both = joined(unit_box(Vec3d(5), 2), flat);
    const MeshCheck check = check_mesh(both);
    EXPECT_FALSE(check.components.at(0).flat);
    EXPECT_TRUE(check.components.at(1).flat);
    EXPECT_FALSE(check.components.at(1).inside_out);
    const std::string message = complaint(check, {true, true});
    EXPECT_NE(message.find("1 component encloses no volume: 1"), message.npos) << message;
}

TEST(check_mesh, tells_and_turns_what_is_inside_out)
{
    // The outer box and the cavity are both wrong, the box beside them is right.
    TriangleMesh mesh = joined(reversed(unit_box(Vec3d(0), 8)), unit_box(Vec3d(0), 4));
    mesh = joined(mesh, unit_box(Vec3d(20, 0, 0), 2));
    const MeshCheck check = check_mesh(mesh);
    EXPECT_EQ(check.inside_out_components(), 2U);
    EXPECT_TRUE(check.components[0].inside_out);
    EXPECT_TRUE(check.components[1].inside_out);
    EXPECT_FALSE(check.components[2].inside_out);
    const std::string message = complaint(check);
    EXPECT_NE(message.find("2 components are inside out: 0, 1"), message.npos) << message;
    EXPECT_NE(message.find("--turn-outward"), message.npos) << message;
    EXPECT_EQ(complaint(check, {false, true}), "");

    const MeshCheck turned = check_mesh(turn_outward(mesh, check));
    expect_clean(turned);
    EXPECT_NEAR(turned.volume, 512 - 64 + 8, 1e-9);
}

TEST(check_mesh, nests_by_other_points_where_one_lies_on_the_surface_around)
{
    // The inner tetrahedron's first corner lies in a face of the outer box.
    const TriangleMesh inner = test::unit_tetrahedron();
    const MeshCheck check = check_mesh(joined(reversed(inner), box(Vec3d(0, -4, -4), Vec3d(4))));
    EXPECT_EQ(check.components.at(0).nesting_depth, 1);
    EXPECT_EQ(check.components.at(1).nesting_depth, 0);
}

TEST(check_mesh, nests_pieces_that_share_corners_by_index)
{
    // Thirty tetrahedra in a row around an edge, and in each of them one with the same edge and a
    // third corner of the next; around them all, a box that shares no corner.
    constexpr std::uint32_t kCount = 30;
    TriangleMesh mesh = unit_box(Vec3d(0), 8);
    const auto first = std::uint32_t(mesh.points.size());
    const auto add_tet = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        for (const Vec3I& t : {Vec3I(a, c, b), Vec3I(a, b, d), Vec3I(b, c, d), Vec3I(a, d, c)})
            mesh.triangles.push_back(t);
    };
    mesh.points.emplace_back(0.f, 0.f, 0.f);
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const double angle = 2 * M_PI * i / kCount;
        const auto at = [&](double turn, double radius, double z) {
            return Vec3s(float(radius * std::cos(angle + turn)),
                         float(radius * std::sin(angle + turn)), float(z));
        };
        const auto outer = std::uint32_t(mesh.points.size());
        mesh.points.insert(mesh.points.end(), {at(0, 2, -.5), at(.15, 2, -.5), at(.075, 2, .5)});
        add_tet(first, outer, outer + 1, outer + 2);
        // Within it, from the same corner.
        mesh.points.insert(mesh.points.end(), {at(.05, 1, -.1), at(.1, 1, -.1), at(.075, 1, .1)});
        add_tet(first, outer + 3, outer + 4, outer + 5);
    }
    const MeshCheck check = check_mesh(mesh);
    ASSERT_EQ(check.components.size(), 1 + 2 * kCount);
    EXPECT_EQ(check.self_intersections.count, 0u);
    EXPECT_EQ(check.components[0].nesting_depth, 0);
    for (std::uint32_t i = 0; i < kCount; ++i) {
        EXPECT_EQ(check.components[1 + 2 * i].nesting_depth, 1) << i;
        EXPECT_EQ(check.components[2 + 2 * i].nesting_depth, 2) << i;
    }
}

TEST(check_mesh, nests_a_piece_of_which_every_corner_is_of_another_by_index)
{
    TriangleMesh mesh = unit_box(Vec3d(0), 8);
    const auto first = std::uint32_t(mesh.points.size());
    mesh.points.insert(mesh.points.end(), {Vec3s(0.f, 0.f, 0.f), Vec3s(1.f, 0.f, 0.f),
                                           Vec3s(0.f, 1.f, 0.f), Vec3s(0.f, 0.f, 1.f)});
    const auto add_tet = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        for (const Vec3I& t : {Vec3I(a, c, b), Vec3I(a, b, d), Vec3I(b, c, d), Vec3I(a, d, c)})
            mesh.triangles.push_back(t);
    };
    add_tet(first, first + 1, first + 2, first + 3);
    // One beyond each corner.
    for (std::uint32_t k = 0; k < 4; ++k) {
        const Vec3s& corner = mesh.points[first + k];
        const Vec3s away = (corner - Vec3s(.25f)) * .5f;
        const auto next = std::uint32_t(mesh.points.size());
        mesh.points.insert(mesh.points.end(), {Vec3s(corner + away + Vec3s(.1f, 0.f, 0.f)),
                                               Vec3s(corner + away + Vec3s(0.f, .1f, 0.f)),
                                               Vec3s(corner + away + Vec3s(0.f, 0.f, .1f))});
        add_tet(first + k, next, next + 1, next + 2);
    }
    const MeshCheck check = check_mesh(mesh);
    ASSERT_EQ(check.components.size(), 6u);
    EXPECT_EQ(check.self_intersections.count, 0u);
    for (std::size_t c = 0; c < 6; ++c)
        EXPECT_EQ(check.components[c].nesting_depth, c == 0 ? 0 : 1) << c;
}

TEST(check_mesh, nests_pieces_that_meet_in_a_place_under_numbers_of_their_own)
{
    // Tets in a box, all with a corner in one place, which is the first corner of each.
    TriangleMesh mesh = unit_box(Vec3d(0), 8);
    const TriangleMesh tet = test::unit_tetrahedron();
    for (int octant = 0; octant < 8; ++octant) {
        TriangleMesh turned = tet;
        int mirrors = 0;
        for (int axis = 0; axis < 3; ++axis)
            for (Vec3s& p : turned.points)
                if (octant >> axis & 1)
                    p[axis] = -p[axis];
        for (int axis = 0; axis < 3; ++axis)
            mirrors += octant >> axis & 1;
        for (Vec3I& t : turned.triangles)
            if (mirrors % 2 == 1)
                std::swap(t[1], t[2]);
        mesh = joined(mesh, turned);
    }
    const MeshCheck check = check_mesh(mesh);
    ASSERT_EQ(check.components.size(), 9u);
    for (std::size_t c = 0; c < 9; ++c)
        EXPECT_EQ(check.components[c].nesting_depth, c == 0 ? 0 : 1) << c;
    EXPECT_FALSE(check.self_intersections.at_least);
}

TEST(check_mesh, says_where_it_has_not_counted_all_contacts)
{
    TriangleMesh pages;
    constexpr std::uint32_t kPages = 3000;
    for (std::uint32_t i = 0; i < kPages; ++i) {
        const double angle = 2 * M_PI * i / kPages;
        pages.points.insert(pages.points.end(),
                            {Vec3s(0, 0, -1), Vec3s(0, 0, 1),
                             Vec3s(float(std::cos(angle)), float(std::sin(angle)), 0)});
        pages.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    const MeshCheck check = check_mesh(pages);
    EXPECT_TRUE(check.self_intersections.at_least);
    EXPECT_GT(check.self_intersections.count, 1'000'000u);
    EXPECT_LT(check.self_intersections.count, std::size_t(kPages) * (kPages - 1) / 2);
    EXPECT_NE(complaint(check).find("at least " + std::to_string(check.self_intersections.count) +
                                    " pairs of triangles"),
              std::string::npos);
}

TEST(check_mesh, keeps_the_sign_of_a_small_component_far_away)
{
    const TriangleMesh small = test::translated(unit_box(Vec3d(0), 1), Vec3d(1e5, 0, 0));
    const MeshCheck check = check_mesh(joined(unit_box(Vec3d(0), 1), reversed(small)));
    EXPECT_FALSE(check.components.at(0).inside_out);
    EXPECT_TRUE(check.components.at(1).inside_out);
}

TEST(check_mesh, refuses_what_is_no_mesh)
{
    EXPECT_EQ(check_mesh({}).components.size(), 0U);
    EXPECT_NE(complaint(check_mesh({})).find("no triangles"), std::string::npos);
    TriangleMesh mesh = test::unit_tetrahedron();
    mesh.triangles[2][1] = 4;
    EXPECT_THROW(check_mesh(mesh), InvalidOption);
    mesh = test::unit_tetrahedron();
    mesh.points[1][2] = NAN;
    EXPECT_THROW(check_mesh(mesh), InvalidOption);
}

// The table beside the meshes, measured by exact predicates on double coordinates. Other than
// there: components hang together by edges (there suzanne is 1, by vertices); a duplicate triangle
// is not also a self-intersection (suzanne 91); edges of three or more triangles are counted once
// each (suzanne 2, beetle 48 and 297 at the boundary: a count of the file's own edges gives these).
// The two larger bunnies have polygons that touch themselves; the table leaves out the triangles of
// two different corners that fans make of them (8 and 16), so what lies in those polygons is kSome.
struct Measured {
    const char* name;
    std::size_t points, triangles, components, boundary, non_manifold;
    int genus; ///< -1: not measured
    std::size_t self_intersections;
    double volume;
};
constexpr std::size_t kSome = SIZE_MAX;
constexpr Measured kMeasured[] = {
    {"paper/box", 8, 12, 1, 0, 0, 0, 0, 1},
    {"paper/support_box", 8, 12, 1, 0, 0, 0, 0, 0.2},
    {"paper/cylinder", 26, 48, 1, 0, 0, 0, 0, 0.6},
    {"paper/pointy", 50, 96, 1, 0, 0, 0, 0, 0.09747},
    {"paper/diku", 146, 288, 1, 0, 0, 0, 0, 0.01713},
    {"paper/tube", 256, 512, 1, 0, 0, 1, 0, 0.3676},
    {"paper/lamp", 298, 600, 1, 0, 0, 2, 0, 0.006317},
    {"paper/sphere", 382, 760, 1, 0, 0, 0, 0, 0.5119},
    {"paper/teapot", 528, 1056, 1, 0, 0, 1, 0, 0.1093},
    {"paper/glass", 537, 1070, 1, 0, 0, 0, 0, 0.1089},
    {"paper/propella", 602, 1200, 1, 0, 0, 0, 0, 0.005982},
    {"paper/funnel", 640, 1280, 1, 0, 0, 1, 0, 0.03462},
    {"paper/jack", 724, 1440, 2, 0, 0, 0, 0, 0.02392},
    {"paper/dragon_small_resolution", 750, 1496, 1, 0, 0, 0, 0, 0.03323},
    {"paper/cow", 752, 1500, 1, 0, 0, 0, 0, 0.04337},
    {"paper/bunny_low_resolution", 752, 1500, 1, 0, 0, 0, 0, 0.1997},
    {"paper/bend", 804, 1604, 1, 0, 0, 0, 0, 0.0654},
    {"paper/bowl", 1342, 2680, 1, 0, 0, 0, 0, 0.08083},
    {"paper/torus", 1536, 3072, 1, 0, 0, 1, 0, 0.07793},
    {"paper/knot", 2880, 5760, 1, 0, 0, 1, 0, 0.1727},
    {"paper/bunny_medium_resolution", 1886, 3808, 2, 0, kSome, -1, kSome, 0.1987},
    {"paper/bunny_high_resolution", 8142, 16328, 3, 0, kSome, -1, kSome, 0.2002},
    {"artist/cheburashka", 6669, 13334, 1, 0, 0, 0, 0, 0.05438},
    {"artist/fandisk", 6475, 12946, 1, 0, 0, 0, 0, 20.24},
    {"artist/rocker-arm", 10044, 20088, 1, 0, 0, 1, 0, 0.04251},
    {"artist/stanford-bunny", 34834, 69451, 1, 223, 0, -1, 0, 0.0007611},
    {"artist/suzanne", 505, 968, 3, 42, 1, -1, 90, 2.326},
    {"artist/beetle", 1148, 2053, 2, 296, 47, -1, 59, 0.04178},
    {"artist/cow", 2903, 5804, 1, 0, 0, -1, 81, 53.57},
    {"artist/woody", 694, 1267, 1, 119, 0, -1, 0, 0},
};

TEST(check_mesh, agrees_with_what_was_measured_on_real_meshes)
{
    VDB_SHELL_NEEDS_REAL_MESHES();
    for (const Measured& measured : kMeasured) {
        SCOPED_TRACE(measured.name);
        const ReadResult read =
            read_mesh(test::real_meshes() / (std::string(measured.name) + ".obj"));
        EXPECT_TRUE(read.report.skipped_faces.empty());
        const MeshCheck check = check_mesh(read.mesh);
        EXPECT_EQ(check.points, measured.points);
        EXPECT_EQ(check.triangles, measured.triangles);
        EXPECT_EQ(check.components.size(), measured.components);
        EXPECT_EQ(check.boundary_edges.count, measured.boundary);
        if (measured.non_manifold == kSome) {
            EXPECT_GT(check.non_manifold_edges.count, 0U);
            EXPECT_GT(check.self_intersections.count, 0U);
        } else {
            EXPECT_EQ(check.non_manifold_edges.count, measured.non_manifold);
            EXPECT_EQ(check.self_intersections.count, measured.self_intersections);
        }
        // The table has four digits; an open surface has no volume that all origins agree on.
        if (check.closed()) {
            EXPECT_NEAR(check.volume, measured.volume, 5e-4 * measured.volume);
        }
        if (measured.genus >= 0) {
            EXPECT_EQ(check.components[0].euler, 2 - 2 * measured.genus);
        }
    }
}

TEST(check_mesh, sees_the_cavity_at_the_centre_of_the_jack)
{
    VDB_SHELL_NEEDS_REAL_MESHES();
    const MeshCheck check = check_mesh(read_mesh(test::real_meshes() / "paper/jack.obj").mesh);
    ASSERT_EQ(check.components.size(), 2U);
    EXPECT_EQ(check.components[1].triangles, 48U);
    EXPECT_EQ(check.components[1].nesting_depth, 1);
    EXPECT_LT(check.components[1].volume, 0.0);
}

TEST(check_mesh, accepts_every_clean_real_mesh)
{
    VDB_SHELL_NEEDS_REAL_MESHES();
    for (const std::string& name : test::clean_meshes()) {
        SCOPED_TRACE(name);
        const ReadResult read = read_mesh(test::real_meshes() / (name + ".obj"));
        EXPECT_NO_THROW(require_usable(check_mesh(read.mesh), {}, name));
    }
}

TEST(read_mesh, counts_every_face_of_the_real_meshes)
{
    VDB_SHELL_NEEDS_REAL_MESHES();
    for (const std::string& name : test::clean_meshes()) {
        SCOPED_TRACE(name);
        const ReadReport report = read_mesh(test::real_meshes() / (name + ".obj")).report;
        const std::string text = test::read_bytes(test::real_meshes() / (name + ".obj"));
        std::size_t faces = 0;
        for (std::size_t at = 0; at != text.npos; at = text.find('\n', at + 1))
            faces += text.compare(at == 0 ? 0 : at + 1, 2, "f ") == 0;
        EXPECT_EQ(report.file_faces, faces);
        EXPECT_TRUE(report.skipped_faces.empty());
    }
}

} // namespace
} // namespace vdb_shell
