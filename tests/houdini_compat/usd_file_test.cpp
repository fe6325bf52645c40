// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/usd_file.h"

#include "houdini_compat/geometries.h"
#include "support/files.h"
#include "support/shapes.h"
#include "usd_text.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

// Counts, ranges, orientation, extents and samples of whole stages are
// tests/external/check_usda.py's matter; it is run on every stage that is written here.

namespace vdb_shell::test
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

/// The volume under a closed surface of outward triangles.
double enclosed(const TetMesh& tets, const std::vector<Vec3I>& faces)
{
    return signed_volume(tets.points, faces);
}

double volume_of(const TetMesh& tets)
{
    double sum = 0.0;
    for (const openvdb::Vec4I& t : tets.tets) {
        const Vec3d a(tets.points[t[0]]), b(tets.points[t[1]]), c(tets.points[t[2]]),
            d(tets.points[t[3]]);
        sum += (b - a).cross(c - a).dot(d - a) / 6.0;
    }
    return sum;
}

class Usd : public ::testing::Test
{
protected:
    /// What the independent reader says of a stage.
    std::string check(const std::filesystem::path& path)
    {
        const std::string line = std::string(VDB_SHELL_CHECK_USDA) + " " + path.string() + " >" +
                                 (folder / "out").string() + " 2>&1";
        const int status = std::system(line.c_str());
        const bool good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
        return (good ? "" : "FAILED ") + read_bytes(folder / "out");
    }

    void expect_good(const std::filesystem::path& path)
    {
        if (std::string(VDB_SHELL_CHECK_USDA).empty())
            GTEST_SKIP() << "python3 is not there";
        const std::string text = check(path);
        EXPECT_EQ(text.find("FAILED"), std::string::npos) << text;
    }

    void expect_refusal(const std::vector<UsdSample>& samples, const UsdOptions& options,
                        const std::vector<std::string>& words)
    {
        try {
            write_usd(folder / "refused.usda", samples, options);
            ADD_FAILURE() << "written, though it should say " << words.front();
        } catch (const Error& error) {
            for (const std::string& word : words)
                EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
        }
        EXPECT_FALSE(std::filesystem::exists(folder / "refused.usda"));
    }

    TemporaryFolder folder;
};

TEST_F(Usd, NumbersAreTheFloatAlsoThroughADouble)
{
    std::mt19937 random(7);
    std::uniform_int_distribution<std::uint32_t> bits;
    for (int i = 0; i < 200000; ++i) {
        const std::uint32_t pattern = bits(random);
        float value = 0.0f;
        std::memcpy(&value, &pattern, sizeof value);
        if (!std::isfinite(value))
            continue;
        const std::string text = usd_value(value);
        EXPECT_EQ(std::strtof(text.c_str(), nullptr), value) << text;
        EXPECT_EQ(float(std::strtod(text.c_str(), nullptr)), value) << text;
    }
    EXPECT_EQ(usd_value(0.5f), "0.5");
    EXPECT_EQ(usd_value(std::numeric_limits<float>::max()).substr(0, 8), "3.402823");
}

TEST_F(Usd, AssetPathsKeepTheirDelimiters)
{
    EXPECT_EQ(usd_asset("./a.vdb"), "@./a.vdb@");
    EXPECT_EQ(usd_asset("a@b.vdb"), "@@@a@b.vdb@@@");
    EXPECT_EQ(usd_asset("a@@@b.vdb"), "@@@a\\@@@b.vdb@@@");
}

TEST_F(Usd, BoundaryOfATetIsItsFourFacesOutward)
{
    TetMesh tet;
    tet.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    tet.tets = {{0, 1, 2, 3}};
    const std::vector<Vec3I> expected{{0, 1, 3}, {0, 2, 1}, {0, 3, 2}, {1, 2, 3}};
    EXPECT_EQ(boundary_triangles(tet), expected);
    EXPECT_DOUBLE_EQ(enclosed(tet, expected), 1.0 / 6.0);
}

TEST_F(Usd, BoundaryOfAShellEnclosesItsVolume)
{
    for (const HandMade& made : {hand_made_shell(icosphere(1.0, 2), 0.7),
                                 hand_made_shell(gridded_box({0, 0, 0}, {1, 2, 3}, 3), 0.5, {0, 5}),
                                 hand_made_shell(unit_tetrahedron(), 0.5, {0, 1, 2})}) {
        const std::vector<Vec3I> faces = boundary_triangles(made.tets);
        EXPECT_NEAR(enclosed(made.tets, faces), volume_of(made.tets), 1e-12);
        EXPECT_TRUE(std::is_sorted(faces.begin(), faces.end()));
    }
    // Two spheres, the outer and the inner one, and no face between the tets.
    EXPECT_EQ(boundary_triangles(hand_made_shell(icosphere(1.0, 1), 0.7).tets).size(), 2u * 80u);
}

TEST_F(Usd, OneSampleIsTimeless)
{
    const ShellFile file = hand_made_file(hand_made_shell(icosphere(1.0, 1), 0.7, {3}), 0.1);
    write_shell_vdb(folder / "s.vdb", file);
    write_usd(folder / "s.usda", {{7.0, &file, folder / "s.vdb"}}, {UpAxis::z, 0.01});
    const std::string text = read_bytes(folder / "s.usda");
    EXPECT_EQ(text.find("timeSamples"), std::string::npos);
    EXPECT_EQ(text.find("TimeCode"), std::string::npos);
    for (const char* word : {"upAxis = \"Z\"", "metersPerUnit = 0.01", "@./s.vdb@"})
        EXPECT_NE(text.find(word), std::string::npos) << word;
    write_usd(folder / "t.usda", {{7.0, &file, folder / "s.vdb"}}, {UpAxis::z, 0.01});
    EXPECT_EQ(text, read_bytes(folder / "t.usda"));
    expect_good(folder / "s.usda");
}

TEST_F(Usd, WithoutAVolumeThereIsNone)
{
    ShellFile file = hand_made_file(hand_made_shell(icosphere(1.0, 1), 0.5), 0.1);
    file.surface = file.depth = nullptr;
    write_usd(folder / "s.usda", {{0.0, &file, {}}});
    EXPECT_EQ(read_bytes(folder / "s.usda").find("Volume"), std::string::npos);
    expect_good(folder / "s.usda");
}

TEST_F(Usd, AShellWithoutAnyTetIsAStageToo)
{
    ShellFile file = hand_made_file(hand_made_shell(unit_tetrahedron(), 0.5), 0.1);
    file.stack.layers.front().inner = file.stack.layers.front().outer;
    file.tets = {};
    write_usd(folder / "s.usda", {{0.0, &file, {}}});
    expect_good(folder / "s.usda");
}

TEST_F(Usd, LayersShareOneSurface)
{
    const TriangleMesh sphere = icosphere(1.0, 1);
    const openvdb::Vec3I t = sphere.triangles[0];
    struct Kind {
        std::vector<float> scales;
        std::size_t skin;
    };
    for (const Kind& kind : {Kind{{1.0f, 0.75f, 0.5f, 0.25f}, 0}, Kind{{1.5f, 1.0f}, 1},
                             Kind{{2.0f, 1.5f, 1.0f, 0.5f}, 2}}) {
        const ShellFile free = layered_shell_file(sphere, kind.scales, kind.skin);
        // Everywhere else the surface has a point of its own.
        const ShellFile pinned =
            layered_shell_file(sphere, kind.scales, kind.skin, {t[0], t[1], t[2]}, kind.skin);
        for (const ShellFile* file : {&free, &pinned}) {
            write_usd(folder / "s.usda", {{0.0, file, {}}});
            expect_good(folder / "s.usda");
            EXPECT_NEAR(enclosed(file->tets, boundary_triangles(file->tets)), volume_of(file->tets),
                        1e-6);
        }
        const std::string text = read_bytes(folder / "s.usda");
        EXPECT_NE(text.find("int userProperties:skin = " + std::to_string(kind.skin)),
                  std::string::npos);
    }
    const ShellFile one = scaled_shell_file(sphere, 0.5f);
    write_usd(folder / "s.usda", {{0.0, &one, {}}});
    EXPECT_EQ(read_bytes(folder / "s.usda").find("userProperties:layer"), std::string::npos);
}

TEST_F(Usd, WhatMovesIsTimeSampledAndNothingElse)
{
    const TriangleMesh sphere = icosphere(1.0, 1);
    std::vector<ShellFile> frames;
    std::vector<UsdSample> samples;
    for (int frame = 0; frame < 3; ++frame)
        frames.push_back(hand_made_file(
            hand_made_shell(translated(sphere, Vec3d(0.25 * frame, 0, 0)), 0.7), 0.1));
    for (std::size_t frame = 0; frame < 3; ++frame) {
        const std::filesystem::path volume = folder / ("s." + std::to_string(frame) + ".vdb");
        write_shell_vdb(volume, frames[frame]);
        samples.push_back({1001.0 + double(frame), &frames[frame], volume});
    }
    write_usd(folder / "s.usda", samples, {UpAxis::y, 1.0, 25.0});
    const std::string text = read_bytes(folder / "s.usda");
    for (const char* word :
         {"startTimeCode = 1001", "endTimeCode = 1003", "timeCodesPerSecond = 25",
          "point3f[] points.timeSamples", "float3[] extent.timeSamples",
          "asset filePath.timeSamples", "1002: @./s.1.vdb@", "int4[] tetVertexIndices = ",
          "int[] faceVertexIndices = ", "int[] primvars:sourceVertex = "})
        EXPECT_NE(text.find(word), std::string::npos) << word;
    expect_good(folder / "s.usda");
}

TEST_F(Usd, PosedShellsSayWhereTheyWereAndHowFastTheyMove)
{
    const TriangleMesh sphere = icosphere(1.0, 1);
    const Vec3d step(0.25, 0, 0);
    const ShellFile rest = hand_made_file(hand_made_shell(sphere, 0.7), 0.1);
    std::vector<ShellFile> frames{rest};
    for (int frame = 1; frame < 3; ++frame) {
        ShellFile posed =
            hand_made_file(hand_made_shell(translated(sphere, frame * step), 0.7), 0.1);
        posed.rest = rest_points(rest);
        for (std::size_t k = 0; k < posed.stack.surfaces(); ++k)
            posed.rest.velocity.surface.emplace_back(sphere.points.size(), 24 * step);
        frames.push_back(std::move(posed));
    }
    write_usd(folder / "s.usda", {{1.0, &frames[1], {}}, {2.0, &frames[2], {}}});
    const std::string moving = read_bytes(folder / "s.usda");
    // At rest they are in the same places at all times.
    EXPECT_NE(moving.find("point3f[] primvars:rest = "), std::string::npos);
    EXPECT_NE(moving.find("vector3f[] velocities = [(6, 0, 0), "), std::string::npos);
    EXPECT_NE(moving.find("points.timeSamples"), std::string::npos);
    expect_good(folder / "s.usda");
    // Of a frame at rest nobody knows how fast it moves.
    write_usd(folder / "s.usda", {{0.0, &frames[0], {}}, {1.0, &frames[1], {}}});
    const std::string mixed = read_bytes(folder / "s.usda");
    EXPECT_NE(mixed.find("primvars:rest = "), std::string::npos);
    EXPECT_EQ(mixed.find("velocities"), std::string::npos);
    expect_good(folder / "s.usda");
    write_usd(folder / "s.usda", {{0.0, &rest, {}}});
    EXPECT_EQ(read_bytes(folder / "s.usda").find("rest"), std::string::npos);
}

TEST_F(Usd, TetsThatChangeAreTimeSampledToo)
{
    const TriangleMesh sphere = icosphere(1.0, 1);
    const ShellFile free = hand_made_file(hand_made_shell(sphere, 0.7), 0.1);
    const ShellFile pinned = hand_made_file(hand_made_shell(sphere, 0.7, {0, 1}), 0.1);
    write_usd(folder / "s.usda", {{1.0, &free, {}}, {2.0, &pinned, {}}});
    const std::string text = read_bytes(folder / "s.usda");
    EXPECT_NE(text.find("tetVertexIndices.timeSamples"), std::string::npos);
    expect_good(folder / "s.usda");
}

TEST_F(Usd, RefusesWhatIsNoStage)
{
    const ShellFile sphere = hand_made_file(hand_made_shell(icosphere(1.0, 1), 0.7), 0.1);
    const ShellFile other = hand_made_file(hand_made_shell(unit_tetrahedron(), 0.7), 0.1);
    const ShellFile layers = layered_shell_file(icosphere(1.0, 1), {1.0f, 0.75f, 0.5f}, 0);
    ShellFile without = sphere;
    without.depth = nullptr;
    const UsdSample good{1.0, &sphere, {}};
    expect_refusal({}, {}, {"refused.usda", "at least one"});
    expect_refusal({good, {1.0, &sphere, {}}}, {}, {"sample 1", "increase"});
    expect_refusal({{std::nan(""), &sphere, {}}}, {}, {"sample 0", "finite"});
    expect_refusal({{1.0, nullptr, {}}}, {}, {"sample 0", "no shell"});
    expect_refusal({good, {2.0, &other, {}}}, {}, {"sample 1", "other triangles"});
    expect_refusal({good, {2.0, &layers, {}}}, {}, {"sample 1", "2 layers", "1 and 0"});
    expect_refusal({good, {2.0, &sphere, "a.vdb"}}, {}, {"sample 1", "volume"});
    expect_refusal({{1.0, &without, "a.vdb"}}, {}, {"sample 0", "no grids"});
    expect_refusal({good}, {UpAxis::y, 0.0}, {"metres per unit", "0"});
    expect_refusal({good}, {UpAxis::y, 1.0, -24.0}, {"frames per second", "-24"});
    EXPECT_THROW(write_usd(folder / "none" / "s.usda", {good}), WriteError);
}

} // namespace
} // namespace vdb_shell::test
