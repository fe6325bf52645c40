// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"
#include "vdb_shell/write/cross_section.h"

#include "support/files.h"
#include "support/shapes.h"
#include "write/hand_made.h"
#include "write/read_png.h"

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
