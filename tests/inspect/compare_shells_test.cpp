// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/inspect/compare_shells.h"

#include "vdb_shell/core/error.h"

#include "support/shapes.h"
#include "support/shells.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace vdb_shell::test
{
namespace
{

/// A ball of radius 1 whose inner surface is the outer one times `scale`.
ShellFile ball(double scale)
{
    const TriangleMesh surface = icosphere(1.0, 3);
    PrismShell shell;
    shell.outer = surface.points;
    shell.triangles = surface.triangles;
    for (const openvdb::Vec3s& p : surface.points)
        shell.inner.push_back(p * float(scale));
    shell.stop.resize(surface.points.size());
    const PrismSplit split = split_prisms(shell, {});
    ShellFile file;
    file.stack = one_layer(shell, split);
    file.tets = make_tets(file.stack);
    file.parameters_json = R"({"growth": {"rounds": 8}, "taper": {"on": false}})";
    return file;
}

TEST(CompareShells, FiguresAreThoseOfGeometry)
{
    const ShellFile file = ball(0.5);
    const ShellFigures figures = shell_figures(file);
    EXPECT_EQ(figures.vertices, file.stack.surface(0).size());
    EXPECT_EQ(figures.tets, 3 * figures.triangles);
    EXPECT_EQ(figures.tets_per_triangle, 3.0);
    EXPECT_EQ(figures.pinned, 0u);
    // Volumes grow with the third power of the scale.
    EXPECT_NEAR(figures.fill, 1 - 0.125, 1e-6);
    EXPECT_NEAR(figures.mean_thickness, 0.5, 1e-6);
    EXPECT_NEAR(figures.largest_thickness, 0.5, 1e-6);
}

TEST(CompareShells, AShellIsTheSameAsItself)
{
    const ShellFile file = ball(0.5);
    const ShellComparison same = compare_shells(file, file);
    EXPECT_TRUE(same.same_bits);
    EXPECT_TRUE(same.same_triangles);
    EXPECT_TRUE(same.same_tets);
    EXPECT_EQ(same.outer->largest, 0);
    EXPECT_EQ(same.inner->largest, 0);
    EXPECT_TRUE(same.options.empty());
}

TEST(CompareShells, DistancesAreInTheUnitOfTheFilesAndBetweenPointsOfOneNumber)
{
    const ShellFile first = ball(0.5);
    ShellFile second = ball(0.75);
    const ShellComparison comparison = compare_shells(first, second);
    EXPECT_FALSE(comparison.same_bits);
    EXPECT_TRUE(comparison.same_triangles);
    EXPECT_EQ(comparison.outer->largest, 0);
    EXPECT_NEAR(comparison.inner->mean, 0.25, 1e-6);

    // The same numbers in a file whose unit is twice as long and whose origin lies elsewhere.
    ShellFile placed = ball(0.5);
    placed.placement.unit = 2;
    placed.placement.origin = {10, 0, 0};
    const ShellComparison moved = compare_shells(first, placed);
    EXPECT_FALSE(moved.same_bits);
    EXPECT_NEAR(moved.second.solid_volume / moved.first.solid_volume, 8, 1e-6);
    EXPECT_NEAR(moved.second.largest_thickness, 1, 1e-6);
    EXPECT_NEAR(moved.outer->largest, 11, 1e-2); // a point near (1, 0, 0): 2 + 10 - 1

    ShellFile nudged = ball(0.5);
    nudged.stack.layers[0].inner[7].x() += 0.125f;
    EXPECT_EQ(compare_shells(first, nudged).inner->at, 7u);
    EXPECT_NEAR(compare_shells(first, nudged).inner->largest, 0.125, 1e-6);
}

TEST(CompareShells, OtherTrianglesHaveFiguresAlone)
{
    ShellFile other = ball(0.5);
    std::swap(other.stack.layers[0].triangles[0], other.stack.layers[0].triangles[1]);
    const ShellComparison comparison = compare_shells(ball(0.5), other);
    EXPECT_FALSE(comparison.same_triangles);
    EXPECT_FALSE(comparison.outer || comparison.inner);
    EXPECT_NE(comparison_text(comparison, "a", "b").find("other triangles"), std::string::npos);
}

TEST(CompareShells, OptionsThatDifferAreNamed)
{
    const ShellFile first = ball(0.5);
    ShellFile second = ball(0.5);
    second.parameters_json =
        R"({"growth": {"rounds": 40}, "taper": {"on": false}, "layers": {"count": 2}})";
    const ShellComparison comparison = compare_shells(first, second);
    ASSERT_EQ(comparison.options.size(), 2u);
    EXPECT_EQ(comparison.options[0], (std::array<std::string, 3>{"/growth/rounds", "8", "40"}));
    EXPECT_EQ(comparison.options[1], (std::array<std::string, 3>{"/layers/count", "", "2"}));
    const auto json = nlohmann::json::parse(comparison_json(comparison, "a.vdb", "b.vdb"));
    EXPECT_EQ(json["options"]["/growth/rounds"], nlohmann::json::parse("[8, 40]"));
    EXPECT_TRUE(json["options"]["/layers/count"][0].is_null());
    EXPECT_EQ(json["first"]["file"], "a.vdb");
    second.parameters_json = "{";
    EXPECT_THROW(compare_shells(first, second), ReadError);
}

} // namespace
} // namespace vdb_shell::test
