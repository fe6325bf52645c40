// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/field/wrap.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/resample/surface_distance.h"

#include "support/cancelled.h"
#include "support/shapes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

namespace vdb_shell::test
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

WrapOptions with_voxel(double size)
{
    WrapOptions options;
    options.voxel_size = size;
    return options;
}

double volume_of(const TriangleMesh& mesh)
{
    return signed_volume(mesh.points, mesh.triangles);
}

/// Wraps and checks what a wrap promises, whatever it is of: sound, and near the input both ways
/// when the input bounds all of the solid.
WrapResult sound_wrap(const TriangleMesh& mesh, const WrapOptions& options)
{
    const WrapResult wrap = wrap_mesh(mesh, options);
    const MeshCheck check = check_mesh(wrap.mesh);
    EXPECT_TRUE(check.closed());
    EXPECT_TRUE(check.manifold());
    EXPECT_TRUE(check.embedded());
    EXPECT_EQ(check.inside_out_components(), 0U);
    EXPECT_EQ(check.degenerate_triangles.count + check.duplicate_triangles.count, 0U);
    EXPECT_GT(check.volume, 0.0);
    return wrap;
}

/// A strip around z with this many half turns, quads from u to u + du.
TriangleMesh twisted_strip(int half_turns, int around, double half_width)
{
    TriangleMesh mesh;
    for (int i = 0; i < around; ++i) {
        const double u = 2 * M_PI * i / around, turn = 0.5 * half_turns * u;
        for (const double v : {-half_width, half_width})
            mesh.points.emplace_back((1 + v * std::cos(turn)) * std::cos(u),
                                     (1 + v * std::cos(turn)) * std::sin(u), v * std::sin(turn));
    }
    for (int i = 0; i < around; ++i) {
        const bool last = i == around - 1;
        const std::uint32_t a = std::uint32_t(2 * i), b = a + 1;
        std::uint32_t c = last ? 0 : a + 2, d = last ? 1 : a + 3;
        if (last && half_turns % 2 == 1)
            std::swap(c, d);
        mesh.triangles.emplace_back(a, c, b);
        mesh.triangles.emplace_back(b, c, d);
    }
    return mesh;
}

/// The figure-eight immersion of the Klein bottle: it crosses itself and has no sides.
TriangleMesh klein_bottle(int around, int across)
{
    TriangleMesh mesh;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double u = 2 * M_PI * i / around, v = 2 * M_PI * j / across;
            const double w = std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
            mesh.points.emplace_back((2 + w) * std::cos(u), (2 + w) * std::sin(u),
                                     std::sin(u / 2) * std::sin(v) +
                                         std::cos(u / 2) * std::sin(2 * v));
        }
    const auto at = [&](int i, int j) {
        // Once around, v runs backwards.
        const int jj = i == around ? (across - j) % across : j % across;
        return std::uint32_t((i % around) * across + jj);
    };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i, j + 1));
            mesh.triangles.emplace_back(at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
        }
    return mesh;
}

/// Every triangle with corners of its own; every third one turned round.
TriangleMesh loose(const TriangleMesh& mesh)
{
    TriangleMesh out;
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const auto n = static_cast<std::uint32_t>(out.points.size());
        for (int k = 0; k < 3; ++k)
            out.points.push_back(mesh.points[t[k]]);
        const bool turned = (n / 3) % 3 == 0;
        out.triangles.emplace_back(n, turned ? n + 2 : n + 1, turned ? n + 1 : n + 2);
    }
    return out;
}

TEST(Wrap, ACleanSphereComesBackWithinAVoxel)
{
    const WrapResult wrap = sound_wrap(icosphere(1.0, 4), with_voxel(0.05));
    EXPECT_EQ(wrap.report.boundary_share, 1.0);
    EXPECT_LT(wrap.report.input_to_wrap.max, 0.05);
    EXPECT_LT(wrap.report.wrap_to_input.max, 0.05);
    EXPECT_NEAR(volume_of(wrap.mesh), 4.0 / 3.0 * M_PI, 0.05);
}

// More pieces than voxels around them: those of one voxel that are turned alike are looked at
// together.
TEST(Wrap, ASphereFinerThanTheGridComesBackWithinAVoxel)
{
    const double voxel = 0.1;
    const WrapResult wrap = sound_wrap(icosphere(1.0, 6), with_voxel(voxel));
    EXPECT_GT(wrap.report.boundary_share, 0.99);
    EXPECT_LT(wrap.report.input_to_wrap.max, voxel);
    EXPECT_LT(wrap.report.wrap_to_input.max, voxel);
}

// Loose triangles one behind the other, turned alike, have a winding number over one half far
// beyond themselves.
TEST(Wrap, NothingIsSolidBeyondTheBoxOfTheTriangles)
{
    TriangleMesh stack;
    for (int layer = 0; layer < 60; ++layer) {
        const auto first = std::uint32_t(stack.points.size());
        const float z = 0.01F * float(layer);
        for (const Vec3s& corner : {Vec3s(0, 0, z), Vec3s(1, 0, z), Vec3s(1, 1, z), Vec3s(0, 1, z)})
            stack.points.push_back(corner);
        stack.triangles.emplace_back(first, first + 1, first + 2);
        stack.triangles.emplace_back(first, first + 2, first + 3);
    }
    const double voxel = 0.05;
    const WrapResult wrap = sound_wrap(stack, with_voxel(voxel));
    const Bounds bounds = bounds_of(wrap.mesh.points);
    // Half the thickness of a sheet, and a voxel for the contour.
    const double beyond = (WrapOptions().sheet_voxels + 1) * voxel;
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GT(bounds.low[axis], -beyond);
        EXPECT_LT(bounds.high[axis], (axis == 2 ? 0.59 : 1.0) + beyond);
    }
}

TEST(Wrap, TwoCrossingBoxesBecomeTheirUnion)
{
    const TriangleMesh soup = joined(box({0, 0, 0}, {2, 2, 2}), box({1, 1, 1}, {3, 3, 3}));
    const WrapResult wrap = sound_wrap(soup, with_voxel(0.04));
    EXPECT_EQ(wrap.report.contour.components, 1U);
    EXPECT_NEAR(volume_of(wrap.mesh), 15.0, 0.1);
    // A quarter of each box's three faces at the common corner lies inside the other box.
    EXPECT_NEAR(wrap.report.interior_share, 0.125, 0.02);
    EXPECT_LT(wrap.report.wrap_to_input.max, 2 * 0.04);
}

TEST(Wrap, AnOpenBoxIsClosedByALid)
{
    TriangleMesh open = box({0, 0, 0}, {1, 1, 1});
    open.triangles.erase(std::remove_if(open.triangles.begin(), open.triangles.end(),
                                        [&](const openvdb::Vec3I& t) {
                                            return open.points[t[0]][2] == 1 &&
                                                   open.points[t[1]][2] == 1 &&
                                                   open.points[t[2]][2] == 1;
                                        }),
                         open.triangles.end());
    ASSERT_EQ(open.triangles.size(), 10U);
    const WrapResult wrap = sound_wrap(open, with_voxel(0.02));
    EXPECT_EQ(wrap.report.contour.components, 1U);
    // The lid is where the winding number is 0.6: a dent in the box, no deeper than half of it.
    EXPECT_GT(volume_of(wrap.mesh), 0.5);
    EXPECT_LT(volume_of(wrap.mesh), 1.05);
    EXPECT_LT(wrap.report.input_to_wrap.max, 2 * 0.02);
}

TEST(Wrap, AFlatSheetBecomesAPlateOfTheThicknessAskedFor)
{
    const TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    for (const double half_voxels : {1.0, 2.5}) {
        WrapOptions options = with_voxel(0.02);
        options.sheet_voxels = half_voxels;
        options.adaptivity = 0.1;
        const WrapResult wrap = sound_wrap(sheet, options);
        const double h = half_voxels * 0.02;
        EXPECT_EQ(wrap.report.sheet_share, 1.0);
        EXPECT_NEAR(wrap.report.input_to_wrap.max, h, 0.2 * 0.02);
        // Steiner: area * 2h + perimeter * pi h^2 / 2 + ball.
        const double exact = 2 * h + 2 * M_PI * h * h + 4.0 / 3.0 * M_PI * h * h * h;
        EXPECT_NEAR(volume_of(wrap.mesh), exact, 0.05 * exact);
    }
}

TEST(Wrap, OneSidedSurfacesGetAClosedShellAroundThem)
{
    const WrapResult moebius = sound_wrap(twisted_strip(1, 90, 0.3), with_voxel(0.03));
    ASSERT_EQ(moebius.report.contour.components, 1U);
    // The border of a thickened Moebius strip is a torus.
    EXPECT_EQ(check_mesh(moebius.mesh).components[0].euler, 0);
    EXPECT_LT(moebius.report.input_to_wrap.max, 2 * 0.03);
    const WrapResult klein = sound_wrap(klein_bottle(60, 40), with_voxel(0.08));
    EXPECT_EQ(klein.report.contour.components, 1U);
}

TEST(Wrap, ACubeOfLooseTrianglesIsFilled)
{
    const WrapResult wrap =
        sound_wrap(loose(gridded_box({0, 0, 0}, {1, 1, 1}, 4)), with_voxel(0.02));
    EXPECT_EQ(wrap.report.contour.components, 1U);
    EXPECT_NEAR(volume_of(wrap.mesh), std::pow(1.02, 3), 0.08);
    EXPECT_LT(wrap.report.input_to_wrap.max, 2 * 0.02);
}

TEST(Wrap, NestedSurfacesAreFilledUnlessVoidsAreKept)
{
    const TriangleMesh nested = joined(icosphere(1.0, 4), reversed(icosphere(0.5, 4)));
    const double ball = 4.0 / 3.0 * M_PI;
    WrapOptions options = with_voxel(0.04);
    const WrapResult filled = sound_wrap(nested, options);
    EXPECT_NEAR(volume_of(filled.mesh), ball, 0.05 * ball);
    EXPECT_GT(filled.report.filled_voxels, 0U);
    options.keep_voids = true;
    const WrapResult kept = sound_wrap(nested, options);
    EXPECT_NEAR(volume_of(kept.mesh), 0.875 * ball, 0.05 * ball);
    EXPECT_EQ(kept.report.filled_voxels, 0U);
    // Of the same sense as the outer one, the inner sphere is just inside.
    const TriangleMesh same = joined(icosphere(1.0, 4), icosphere(0.5, 4));
    EXPECT_NEAR(volume_of(sound_wrap(same, options).mesh), ball, 0.05 * ball);
}

TEST(Wrap, InsideOutIsTurnedOutward)
{
    const WrapResult wrap = sound_wrap(reversed(icosphere(1.0, 3)), with_voxel(0.05));
    EXPECT_NEAR(volume_of(wrap.mesh), 4.0 / 3.0 * M_PI, 0.1);
}

TEST(Wrap, OneTriangleAndOneNeedleAreEnough)
{
    sound_wrap({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {});
    sound_wrap({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}, {});
}

TEST(Wrap, UnaskedAVoxelIsAsLongAsTheMeanEdgeWithinBounds)
{
    const TriangleMesh ball = icosphere(1.0, 3);
    double edges = 0;
    for (const openvdb::Vec3I& t : ball.triangles)
        for (int k = 0; k < 3; ++k)
            edges += (ball.points[t[k]] - ball.points[t[(k + 1) % 3]]).length();
    const double mean = edges / (3.0 * double(ball.triangles.size()));
    // Two balls so far apart that so many edges make up the length of both.
    const auto voxels = [&](double edges_along) {
        const double apart = edges_along * mean - 2.0;
        const double voxel =
            wrap_voxel_size(joined(ball, translated(ball, Vec3d(apart, 0, 0))), {});
        return (apart + 2.0) / voxel;
    };
    EXPECT_NEAR(voxels(50), 128, 1e-3);
    EXPECT_NEAR(voxels(200), 200, 1e-3);
    EXPECT_NEAR(voxels(900), 256, 1e-3);
    WrapOptions asked;
    asked.resolution = 40;
    EXPECT_NEAR(wrap_voxel_size(ball, asked), 2.0 / 40, 1e-6);
    // An edge of no length is no measure.
    const TriangleMesh spike{{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}}};
    EXPECT_NEAR(wrap_voxel_size(spike, {}), 1.0 / 128, 1e-6);
}

TEST(Wrap, MicronsAreAsGoodAsMetres)
{
    TriangleMesh small = icosphere(1.0, 3);
    for (Vec3s& p : small.points)
        p = p * 1e-6f;
    WrapOptions options;
    options.resolution = 32;
    EXPECT_NEAR(volume_of(sound_wrap(small, options).mesh) * 1e18, 4.0 / 3.0 * M_PI, 0.1);
}

TEST(Wrap, CoordinatesBeyondFloat32AreRefusedByName)
{
    const TriangleMesh far = translated(icosphere(1.0, 3), Vec3d(3e6, 0, 0));
    try {
        wrap_mesh(far, with_voxel(0.05));
        FAIL() << "voxels of 0.05 have no room at 3e6";
    } catch (const GeometryError& error) {
        EXPECT_NE(std::string(error.what()).find("too large for float32"), std::string::npos)
            << error.what();
    }
}

TEST(Wrap, OfManySheetsInOnePlaceIsThatOfOne)
{
    // Three sheets that cross, and each a thousand times, turned by turns, a little off each other,
    // as copies would be dropped. Their distances are taken voxel by voxel then.
    TriangleMesh few;
    few.points = {Vec3s(-1, -1, 0.1F), Vec3s(1, -1, 0),    Vec3s(0, 1, 0),
                  Vec3s(0, -1, -1),    Vec3s(0.2F, 1, -1), Vec3s(0, 0, 1),
                  Vec3s(-1, 0, -1),    Vec3s(1, 0.1F, -1), Vec3s(0, 0, 1)};
    few.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
    constexpr int kLast = 499;
    const auto repeated = [&](int step) {
        TriangleMesh mesh;
        for (int i = 0; i <= kLast; i += step)
            for (const bool turned : {false, true}) {
                const auto first = std::uint32_t(mesh.points.size());
                for (const Vec3s& p : few.points)
                    mesh.points.push_back(p + Vec3s(1e-6F * float(i)));
                for (const openvdb::Vec3I& t : few.triangles)
                    mesh.triangles.push_back(openvdb::Vec3I(first) +
                                             (turned ? openvdb::Vec3I(t[0], t[2], t[1]) : t));
            }
        return mesh;
    };
    constexpr double kVoxel = 0.25;
    const WrapResult one = sound_wrap(repeated(kLast), with_voxel(kVoxel)),
                     all = sound_wrap(repeated(1), with_voxel(kVoxel));
    EXPECT_NEAR(volume_of(all.mesh), volume_of(one.mesh), 1e-3 * volume_of(one.mesh));
    // Winding numbers of a thousand sheets are rounded more.
    EXPECT_LT(surface_distance(all.mesh, one.mesh, kVoxel).max, 0.1 * kVoxel);
    EXPECT_NEAR(all.report.input_to_wrap.max, one.report.input_to_wrap.max, 0.5 * kVoxel);
    EXPECT_NEAR(all.report.input_to_wrap.mean, one.report.input_to_wrap.mean, 0.5 * kVoxel);
}

TEST(Wrap, OfATriangleAndItsCopiesIsThatOfOne)
{
    const TriangleMesh once = test::box(Vec3d(-1), Vec3d(1));
    TriangleMesh often = once;
    // More area than can be measured a voxel apart: 2^27 pieces, eight for each of 128 voxels.
    for (std::uint32_t i = 0; i < 150000; ++i) {
        // Named from any of its corners.
        const openvdb::Vec3I t = once.triangles[0];
        often.triangles.emplace_back(t[i % 3], t[(i + 1) % 3], t[(i + 2) % 3]);
    }
    WrapOptions options;
    options.resolution = 16;
    const TriangleMesh one = wrap_mesh(once, options).mesh, many = wrap_mesh(often, options).mesh;
    EXPECT_EQ(many.points, one.points);
    EXPECT_EQ(many.triangles, one.triangles);
}

TEST(Wrap, IsTheSameForAnyNumberOfThreads)
{
    const TriangleMesh soup = joined(box({0, 0, 0}, {2, 2, 2}), twisted_strip(1, 40, 0.3));
    const WrapResult many = wrap_mesh(soup, with_voxel(0.05));
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    const WrapResult one = wrap_mesh(soup, with_voxel(0.05));
    EXPECT_EQ(many.mesh.points, one.mesh.points);
    EXPECT_EQ(many.mesh.triangles, one.mesh.triangles);
    EXPECT_EQ(many.report.input_to_wrap.mean, one.report.input_to_wrap.mean);
}

TEST(Wrap, BadOptionsAndEmptyMeshesAreRefused)
{
    const TriangleMesh mesh = unit_tetrahedron();
    WrapOptions options;
    for (const double size : {0.0, -1.0, std::nan(""), 1e-9}) {
        options.voxel_size = size;
        EXPECT_THROW(wrap_mesh(mesh, options), InvalidOption) << size;
    }
    options = {};
    options.resolution = 0;
    EXPECT_THROW(wrap_mesh(mesh, options), InvalidOption);
    options = {};
    options.sheet_voxels = 0.5;
    EXPECT_THROW(wrap_mesh(mesh, options), InvalidOption);
    options = {};
    options.adaptivity = -0.1;
    EXPECT_THROW(wrap_mesh(mesh, options), InvalidOption);
    EXPECT_THROW(wrap_mesh({}, {}), GeometryError);
    TriangleMesh beyond = mesh, nowhere = mesh;
    beyond.triangles[0][1] = 4;
    nowhere.points[2][0] = std::nanf("");
    EXPECT_THROW(wrap_mesh(beyond, {}), InvalidOption);
    EXPECT_THROW(wrap_mesh(nowhere, {}), InvalidOption);
    EXPECT_THROW(wrap_mesh({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}}, {}), GeometryError);
}

TEST(Wrap, CanBeCancelled)
{
    const TriangleMesh mesh = icosphere(1.0, 2);
    expect_cancelled(
        [&](Interrupter* interrupter) { wrap_mesh(mesh, with_voxel(0.1), interrupter); });
}

} // namespace
} // namespace vdb_shell::test
