// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/write/picture.h"

#include "vdb_shell/core/error.h"

#include "support/files.h"
#include "support/shapes.h"
#include "write/hand_made.h"
#include "write/read_png.h"

#include "write/shaded_picture.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <set>

namespace vdb_shell::test
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3f;

constexpr double kPi = 3.14159265358979323846;
const Picture::Colour kWhite{255, 255, 255};

ShellFile file_of(const TriangleMesh& surface, double scale)
{
    const HandMade made = hand_made_shell(surface, scale);
    ShellFile file;
    file.stack = one_layer(made.shell, made.split);
    file.tets = made.tets;
    return file;
}

/// From the front, so that x is to the right and y up.
PictureOptions in_front(PictureKind kind, int width)
{
    PictureOptions options;
    options.kind = kind;
    options.view.azimuth_radians = options.view.elevation_radians = 0;
    options.section.width_pixels = width;
    return options;
}

Picture drawn(const ShellFile& file, const PictureOptions& options)
{
    const TemporaryFolder folder;
    write_picture(folder / "p.png", file, options);
    return read_png(folder / "p.png");
}

std::size_t covered(const Picture& picture)
{
    return picture.rgb.size() / 3 - picture.pixels_of(kWhite);
}

TEST(Picture, ViewsAreOrthonormalAndStandWhereTheySay)
{
    for (const UpAxis up : {UpAxis::y, UpAxis::z})
        for (const double azimuth : {0.0, 0.6, 2.0, -3.0})
            for (const double elevation : {-kPi / 2, 0.0, 0.4}) {
                const ViewAxes axes = view_axes({up, azimuth, elevation});
                EXPECT_NEAR(axes.right.cross(axes.up).dot(axes.towards), 1, 1e-12);
                EXPECT_NEAR(axes.right.dot(axes.up), 0, 1e-12);
                EXPECT_NEAR(axes.towards[up == UpAxis::y ? 1 : 2], std::sin(elevation), 1e-12);
            }
    // Counter-clockwise seen from above: a quarter turn from the front shows the side of +x.
    EXPECT_NEAR(view_axes({UpAxis::y, kPi / 2, 0}).towards.x(), 1, 1e-12);
    EXPECT_NEAR(view_axes({UpAxis::z, kPi / 2, 0}).towards.x(), 1, 1e-12);
    EXPECT_NEAR(view_axes({UpAxis::z, 0, 0}).towards.y(), -1, 1e-12);
    EXPECT_NEAR(view_axes({UpAxis::y, 0, 0, 4, 1}).towards.x(), 1, 1e-12);
}

TEST(Picture, ASphereIsADiscAndABoxSeenAcrossItsCornerIsWider)
{
    // Of a polyhedron of 1,280 faces the outline loses .3 % of the disc.
    const Picture ball =
        drawn(file_of(icosphere(1.0, 3), 0.5), in_front(PictureKind::surface, 400));
    EXPECT_EQ(ball.width, ball.height);
    const double radius = 0.47 * ball.width;
    EXPECT_NEAR(double(covered(ball)) / (kPi * radius * radius), 1.0, 0.015);

    PictureOptions across = in_front(PictureKind::surface, 400);
    across.view.azimuth_radians = kPi / 4;
    const Picture box = drawn(file_of(gridded_box({0, 0, 0}, {1, 1, 1}, 2), 0.5), across);
    EXPECT_NEAR((box.height - 24.0) / (box.width - 24.0), std::sqrt(0.5), 0.01);
}

TEST(Picture, ACutFacingTheViewerHasTheTintsOfASection)
{
    const ShellFile file = file_of(icosphere(1.0, 3), 0.5);
    PictureOptions options = in_front(PictureKind::cut_away, 400);
    options.section.axis = Axis::z;
    const Picture along = drawn(file, options);
    options.section.axis = Axis::view;
    const Picture facing = drawn(file, options);
    // The plane that faces a viewer in front is the one across z.
    EXPECT_EQ(along.rgb, facing.rgb);
    const Picture section = drawn(file, in_front(PictureKind::section, 400));
    // The section's void is grey; behind the one in space is the inner surface.
    const Picture::Colour tint{158, 201, 230};
    ASSERT_GT(section.pixels_of(tint), 1000u);
    EXPECT_NEAR(double(along.pixels_of(tint)) / double(section.pixels_of(tint)), 1.0, 0.1);
    EXPECT_EQ(drawn(file, in_front(PictureKind::surface, 400)).pixels_of(tint), 0u);
}

TEST(Picture, WhatLiesOnTheViewersSideIsTakenAwayFromWhereverItIsSeen)
{
    const ShellFile file = file_of(gridded_box({0, 0, 0}, {1, 1, 1}, 4), 0.5);
    for (const double azimuth : {0.0, kPi}) {
        PictureOptions options = in_front(PictureKind::cut_away, 200);
        options.view.azimuth_radians = azimuth;
        options.section.position = 0.25;
        // The cut is seen, not the back of the box: colours of tints are not lit.
        EXPECT_GT(drawn(file, options).pixels_of({158, 201, 230}), 100u) << azimuth;
    }
}

TEST(Picture, TheNearestTriangleIsSeenWhateverTheOrder)
{
    ShadedTriangle far{{Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0)}};
    far.colour = Vec3f(1, 0, 0);
    ShadedTriangle near{{Vec3d(0, 0, 1), Vec3d(1, 0, 1), Vec3d(0, 1, 1)}};
    near.colour = Vec3f(0, 0, 1);
    for (ShadedTriangle* t : {&far, &near}) {
        t->lit = false;
        t->edges = 0;
    }
    const ShadedFrame frame{{0, 0}, {1, 1}, 100};
    const Image one = draw_shaded({far, near}, frame), other = draw_shaded({near, far}, frame);
    EXPECT_EQ(one.rgb, other.rgb);
    const Picture picture{one.width, one.height, one.rgb};
    EXPECT_GT(picture.pixels_of({0, 0, 255}), 4000u);
    EXPECT_EQ(picture.pixels_of({255, 0, 0}), 0u);
    // Cut away where x > 1/2: the far one shows in the strip beyond, whose area is a quarter.
    near.in_front = {-0.5, 0.5, -0.5};
    const Image cut = draw_shaded({far, near}, frame);
    const Picture half{cut.width, cut.height, cut.rgb};
    EXPECT_NEAR(double(half.pixels_of({255, 0, 0})) / double(half.pixels_of({0, 0, 255})), 1 / 3.0,
                0.03);
}

TEST(Picture, AllFramesOfATurntableHaveOneSizeAndScale)
{
    const ShellFile file = file_of(gridded_box({0, 0, 0}, {4, 1, 1}, 2), 0.5);
    PictureOptions options = in_front(PictureKind::surface, 200);
    options.view.turntable = 8;
    std::set<std::size_t> areas;
    for (int frame = 0; frame < 4; ++frame) {
        options.view.turntable_frame = frame;
        const Picture picture = drawn(file, options);
        EXPECT_EQ(picture.width, 200);
        EXPECT_EQ(picture.height, 200);
        areas.insert(covered(picture));
    }
    // Broadside, across a corner, end on, across the other corner, the last equal to the second.
    EXPECT_GE(areas.size(), 3u);
    options.view.turntable_frame = 2;
    const double end_on = double(covered(drawn(file, options)));
    options.view.turntable_frame = 0;
    EXPECT_NEAR(double(covered(drawn(file, options))) / end_on, 4.0, 0.2);
}

TEST(Picture, ColoursFollowWhatTheyTell)
{
    // All tets of a shell of a fine grid that is nearly as thin as paper are slivers.
    const ShellFile thin = file_of(icosphere(1.0, 2), 0.999);
    PictureOptions options = in_front(PictureKind::surface, 200);
    options.colours = PictureColours::quality;
    EXPECT_GT(drawn(thin, options).red_pixels(), 1000u);
    const ShellFile thick = file_of(icosphere(1.0, 2), 0.8);
    EXPECT_LT(drawn(thick, options).red_pixels(), 100u);
    std::set<std::vector<std::uint8_t>> pictures;
    for (const PictureColours colours : {PictureColours::prism, PictureColours::layer,
                                         PictureColours::quality, PictureColours::thickness}) {
        options.kind = PictureKind::cut_away;
        options.colours = colours;
        pictures.insert(drawn(thick, options).rgb);
    }
    EXPECT_EQ(pictures.size(), 4u);
}

TEST(Picture, PosedFramesAreSeenFromOnePlace)
{
    ShellFile file = file_of(icosphere(1.0, 2), 0.5);
    file.rest.surface = {file.stack.surface(0), file.stack.surface(1)};
    const PictureOptions options = in_front(PictureKind::surface, 200);
    const Picture before = drawn(file, options);
    for (auto* points : {&file.stack.layers[0].outer, &file.stack.layers[0].inner})
        for (openvdb::Vec3s& p : *points)
            p *= 0.5f;
    const Picture after = drawn(file, options);
    EXPECT_EQ(after.width, before.width);
    EXPECT_NEAR(double(covered(after)) / double(covered(before)), 0.25, 0.02);
}

TEST(Picture, PosedFramesAreCutAcrossOneAxis)
{
    ShellFile file = file_of(gridded_box({0, 0, 0}, {1, 4, 2}, 4), 0.5);
    file.rest.surface = {file.stack.surface(0), file.stack.surface(1)};
    // At rest most of it is cut across x, in this pose across y.
    for (auto* points :
         {&file.stack.layers[0].outer, &file.stack.layers[0].inner, &file.tets.points})
        for (openvdb::Vec3s& p : *points)
            p[1] *= 0.0625f;
    PictureOptions options = in_front(PictureKind::section, 200);
    const Picture posed = drawn(file, options);
    options.section.axis = Axis::x;
    EXPECT_EQ(posed.rgb, drawn(file, options).rgb);
    options.section.axis = Axis::y;
    EXPECT_NE(posed.rgb, drawn(file, options).rgb);
}

TEST(Picture, APairHasOneScale)
{
    const TemporaryFolder folder;
    const ShellFile large = file_of(icosphere(2.0, 2), 0.5),
                    small = file_of(icosphere(1.0, 2), 0.5);
    for (const PictureKind kind : {PictureKind::section, PictureKind::surface}) {
        write_picture_pair(folder / "p.png", large, small, in_front(kind, 200));
        const Picture pair = read_png(folder / "p.png");
        EXPECT_EQ(pair.width, 400);
        std::array<double, 2> area{};
        for (int x = 0; x < pair.width; ++x)
            for (int y = 0; y < pair.height; ++y)
                area[std::size_t(x / 200)] +=
                    pair.at((x + 0.5) / pair.width, (y + 0.5) / pair.height) != kWhite;
        EXPECT_NEAR(area[0] / area[1], 4.0, 0.3);
    }
}

TEST(Picture, SameBytesForAnyNumberOfThreads)
{
    const TemporaryFolder folder;
    const ShellFile file = file_of(torus(1.0, 0.4, 48, 24), 0.9);
    PictureOptions options;
    options.kind = PictureKind::cut_away;
    std::set<std::string> contents;
    for (const std::size_t threads : {1u, 2u, 7u}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        write_picture(folder / "p.png", file, options);
        contents.insert(read_bytes(folder / "p.png"));
    }
    EXPECT_EQ(contents.size(), 1u);
}

TEST(Picture, RefusesImpossibleOptions)
{
    const TemporaryFolder folder;
    const ShellFile file = file_of(icosphere(1.0, 1), 0.5);
    const auto refused = [&](const PictureOptions& options) {
        EXPECT_THROW(write_picture(folder / "p.png", file, options), InvalidOption);
    };
    PictureOptions options;
    options.section.axis = Axis::view; // of a section
    refused(options);
    options = in_front(PictureKind::surface, 15);
    refused(options);
    options = in_front(PictureKind::surface, 100);
    options.view.elevation_radians = 2;
    refused(options);
    options = in_front(PictureKind::surface, 100);
    options.view.azimuth_radians = std::nan("");
    refused(options);
    options = in_front(PictureKind::surface, 100);
    EXPECT_THROW(write_picture(folder / "none/p.png", file, options), WriteError);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

} // namespace
} // namespace vdb_shell::test
