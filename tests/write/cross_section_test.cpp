// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"
#include "vdb_shell/write/cross_section.h"

#include "support/files.h"
#include "support/shapes.h"
#include "write/hand_made.h"
#include "write/read_png.h"

#include "write/plane_cut.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <set>

namespace vdb_shell
{
namespace
{

using test::hand_made_shell;
using test::HandMade;
using test::Picture;
using test::read_png;
using test::TemporaryFolder;
using Colour = Picture::Colour;

const Colour kWhite{255, 255, 255}, kGrey{230, 230, 230};

TEST(CrossSection, BoxHasBackgroundShellAndVoidWhereTheyBelong)
{
    const TemporaryFolder folder;
    const HandMade made = hand_made_shell(test::gridded_box({0, 0, 0}, {4, 2, 3}, 4), 0.5);
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
        CrossSectionOptions options;
        options.axis = axis;
        options.width_pixels = 200;
        write_cross_section(folder / "cut.png", made.shell, made.tets, options);
        const Picture picture = read_png(folder / "cut.png");
        EXPECT_EQ(picture.at(0.005, 0.005), kWhite);
        EXPECT_EQ(picture.at(0.5, 0.5), kGrey);
        EXPECT_NE(picture.at(0.5, 0.15), kWhite);
        EXPECT_NE(picture.at(0.5, 0.15), kGrey);
        EXPECT_EQ(picture.red_pixels(), 0u);
    }
}

TEST(CrossSection, KeepsTheProportionsOfTheBox)
{
    const TemporaryFolder folder;
    const HandMade made = hand_made_shell(test::gridded_box({0, 0, 0}, {4, 2, 1}, 2), 0.5);
    CrossSectionOptions options;
    options.width_pixels = 400;
    write_cross_section(folder / "cut.png", made.shell, made.tets, options);
    const Picture flat = read_png(folder / "cut.png");
    EXPECT_EQ(flat.width, 400);
    EXPECT_EQ(flat.height, 12 + 188 + 12);
    options.axis = Axis::x; // y to the right, z up
    write_cross_section(folder / "cut.png", made.shell, made.tets, options);
    EXPECT_EQ(read_png(folder / "cut.png").width, 400);
}

TEST(CrossSection, AreaIsThatOfTheSolid)
{
    const openvdb::Vec3d far{4096, -2048, 1024};
    const auto area = [](const TriangleMesh& mesh, Axis axis, double position) {
        CrossSectionOptions options{axis, position};
        return section_area(mesh.points, mesh.triangles,
                            cut_plane(options, bounds_of(mesh.points)));
    };
    const TriangleMesh box = test::translated(test::box({0, 0, 0}, {4, 2, 1}), far);
    EXPECT_EQ(area(box, Axis::x, 0.5), 2.0);
    EXPECT_EQ(area(box, Axis::y, 0.25), 4.0);
    EXPECT_EQ(area(box, Axis::z, 0.75), 8.0);
    // A void is no part of the solid, and a plane beside it cuts all of the box.
    const TriangleMesh hollow = test::joined(test::box({0, 0, 0}, {4, 4, 4}),
                                             test::reversed(test::box({1, 1, 1}, {3, 3, 3})));
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
        EXPECT_EQ(area(hollow, axis, 0.5), 12.0);
        EXPECT_EQ(area(hollow, axis, 0.125), 16.0);
    }
}

TEST(CrossSection, WidestIsTheAxisAcrossWhichMostOfTheSolidIsCut)
{
    const auto widest = [](const TriangleMesh& mesh, double position) {
        return with_axis({Axis::widest, position}, mesh.points, mesh.triangles).axis;
    };
    EXPECT_EQ(widest(test::box({0, 0, 0}, {1, 2, 4}), 0.5), Axis::x);
    EXPECT_EQ(widest(test::box({0, 0, 0}, {2, 1, 4}), 0.5), Axis::y);
    EXPECT_EQ(widest(test::box({0, 0, 0}, {4, 2, 1}), 0.5), Axis::z);
    EXPECT_EQ(widest(test::box({0, 0, 0}, {1, 1, 1}), 0.5), Axis::z);
    // A plate above a thin rod: between the two a plane across z cuts the rod alone.
    const TriangleMesh lamp = test::joined(test::box({-4, -3, 9}, {4, 3, 10}),
                                           test::box({-0.125, -0.125, 0}, {0.125, 0.125, 8.5}));
    EXPECT_EQ(widest(lamp, 0.5), Axis::y);
    EXPECT_EQ(widest(lamp, 0.95), Axis::z);
    // What somebody asks for stays.
    const TriangleMesh box = test::box({0, 0, 0}, {4, 2, 1});
    EXPECT_EQ(with_axis({Axis::x, 0.5}, box.points, box.triangles).axis, Axis::x);
    EXPECT_EQ(with_axis({Axis::view, 0.5}, box.points, box.triangles).axis, Axis::view);

    const TemporaryFolder folder;
    const HandMade made = hand_made_shell(test::gridded_box({0, 0, 0}, {1, 4, 2}, 2), 0.5);
    CrossSectionOptions options;
    write_cross_section(folder / "widest.png", made.shell, made.tets, options);
    options.axis = Axis::x;
    write_cross_section(folder / "x.png", made.shell, made.tets, options);
    EXPECT_EQ(test::read_bytes(folder / "widest.png"), test::read_bytes(folder / "x.png"));
}

TEST(CrossSection, OverlapIsRedAndNothingElseIs)
{
    const TemporaryFolder folder;
    HandMade made = hand_made_shell(test::icosphere(1.0, 3), 0.5);
    write_cross_section(folder / "good.png", made.shell, made.tets);
    EXPECT_EQ(read_png(folder / "good.png").red_pixels(), 0u);

    // The same tets again cover all of the shell twice: an annulus from radius 1/2 to 1.
    const std::size_t count = made.tets.tets.size();
    for (std::size_t t = 0; t < count; ++t) {
        made.tets.tets.push_back(made.tets.tets[t]);
        made.tets.prism.push_back(made.tets.prism[t]);
    }
    write_cross_section(folder / "bad.png", made.shell, made.tets);
    const Picture bad = read_png(folder / "bad.png");
    const double radius = 0.47 * bad.width;
    const double annulus = 0.75 * 3.14159265 * radius * radius;
    // Edges and outlines are drawn over it.
    EXPECT_GT(double(bad.red_pixels()), 0.6 * annulus);
    EXPECT_LT(double(bad.red_pixels()), annulus);
}

TEST(CrossSection, PlanesThroughVerticesAndEndsWork)
{
    const TemporaryFolder folder;
    const HandMade made = hand_made_shell(test::gridded_box({0, 0, 0}, {1, 1, 1}, 4), 0.5);
    for (const double position : {0.0, 0.25, 0.5, 1.0}) {
        CrossSectionOptions options;
        options.position = position;
        options.width_pixels = 64;
        write_cross_section(folder / "cut.png", made.shell, made.tets, options);
        EXPECT_EQ(read_png(folder / "cut.png").red_pixels(), 0u) << position;
    }
}

TEST(CrossSection, SameBytesForAnyNumberOfThreads)
{
    const TemporaryFolder folder;
    const HandMade made = hand_made_shell(test::torus(1.0, 0.4, 48, 24), 0.9);
    std::set<std::string> contents;
    for (const std::size_t threads : {1u, 2u, 7u}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        write_cross_section(folder / "cut.png", made.shell, made.tets);
        contents.insert(test::read_bytes(folder / "cut.png"));
    }
    EXPECT_EQ(contents.size(), 1u);
}

TEST(CrossSection, RefusesImpossibleOptions)
{
    const TemporaryFolder folder;
    const HandMade made = hand_made_shell(test::unit_tetrahedron(), 0.5);
    const auto refused = [&](int width, double position) {
        CrossSectionOptions options;
        options.width_pixels = width;
        options.position = position;
        EXPECT_THROW(write_cross_section(folder / "cut.png", made.shell, made.tets, options),
                     InvalidOption);
    };
    refused(15, 0.5);
    refused(16385, 0.5);
    refused(64, -0.01);
    refused(64, 1.01);
    refused(64, std::nan(""));
    EXPECT_THROW(write_cross_section(folder / "none/cut.png", made.shell, made.tets), WriteError);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

} // namespace
} // namespace vdb_shell
