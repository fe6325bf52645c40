// SPDX-License-Identifier: Apache-2.0
#include "command_fixture.h"

#include "core/grid_instances.h"
#include "support/files.h"
#include "support/shapes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/io/File.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

// `volumes` and `deform`.

namespace vdb_shell::test
{
namespace
{

using command::ExitCode;

/// Names and numbers of active voxels, by OpenVDB's own reader.
std::map<std::string, std::size_t> grids_in(const std::string& path)
{
    openvdb::initialize();
    openvdb::io::File file(path);
    file.open(false);
    std::map<std::string, std::size_t> grids;
    const openvdb::GridPtrVecPtr all = file.getGrids();
    for (const openvdb::GridBase::Ptr& grid : *all)
        grids[grid->getName()] = grid->activeVoxelCount();
    return grids;
}

class Volumes : public Command
{
protected:
    Volumes()
    {
        TriangleMesh mesh = icosphere(1.0, 2);
        const std::string at_rest = mesh_file("ball.obj", mesh);
        for (openvdb::Vec3s& p : mesh.points)
            p[0] = 1.5f * p[0];
        const std::string in_pose = mesh_file("long.obj", mesh);
        EXPECT_EQ(run("build " + at_rest + kCoarse + " -q -o " + rest).status, ExitCode::success);
        EXPECT_EQ(run("pose " + rest + " " + in_pose + " -q -o " + posed).status,
                  ExitCode::success);
    }

    const std::string rest = file("rest.vdb"), posed = file("posed.vdb"), fog = file("fog.vdb"),
                      out = file("out.vdb");
};

TEST_F(Volumes, AreWrittenAndCarriedToThePose)
{
    const Outcome made = run("volumes " + rest + " --volumes density,rest,prism -o " + fog);
    ASSERT_EQ(made.status, ExitCode::success) << made.err;
    const auto grids = grids_in(fog);
    ASSERT_EQ(grids.size(), 4u);
    EXPECT_GT(grids.at("density"), 1000u);
    EXPECT_EQ(grids.at("density"), grids.at("prism_weights"));

    const Outcome all = run("deform " + fog + " --posed " + posed + " --report - -o " + out);
    ASSERT_EQ(all.status, ExitCode::success) << all.err;
    EXPECT_EQ(grids_in(out).size(), 4u);
    const auto figures = nlohmann::json::parse(all.out)["grids"];
    ASSERT_EQ(figures.size(), 4u);
    const auto density = std::find_if(figures.begin(), figures.end(),
                                      [](const auto& grid) { return grid["grid"] == "density"; });
    ASSERT_NE(density, figures.end());
    EXPECT_NEAR(double((*density)["mass_after"]) / double((*density)["mass_before"]), 1, 0.02);

    EXPECT_EQ(run("deform " + fog + " --rest " + rest + " --posed " + posed +
                  " --grid density -q -o " + out)
                  .status,
              ExitCode::success);
    EXPECT_EQ(grids_in(out).size(), 1u);
}

TEST_F(Volumes, PointsAndVelocitiesGoWithThem)
{
    openvdb::initialize();
    ASSERT_EQ(run("volumes " + rest + " --volumes density -o " + fog).status, ExitCode::success);
    ASSERT_EQ(run("pose " + rest + " " + file("long.obj") + " --mesh-before " + file("ball.obj") +
                  " --frame-seconds 0.5 -q -o " + posed)
                  .status,
              ExitCode::success);
    ASSERT_EQ(run("deform " + fog + " --velocity --posed " + posed + " -q -o " + out).status,
              ExitCode::success);
    openvdb::io::File file(out);
    file.open(false);
    const auto v = openvdb::gridPtrCast<openvdb::Vec3SGrid>(file.readGrid("v"));
    EXPECT_EQ(v->activeVoxelCount(), file.readGrid("density")->activeVoxelCount());
    // The skin has been made half as long again along x, in half a second. What is below moves
    // along x, less far, and no faster than the skin's farthest point.
    double fastest = 0, across = 0;
    for (auto voxel = v->cbeginValueOn(); voxel; ++voxel) {
        fastest = std::max(fastest, std::abs(double((*voxel)[0])));
        across = std::max(across, std::abs(double((*voxel)[1])));
    }
    EXPECT_LE(fastest, 1.0 + 1e-4);
    EXPECT_GT(fastest, 0.8);
    EXPECT_LT(across, 0.5 * fastest);
    file.close();

    // What has its velocities already is refused before it is carried.
    const std::string twice = this->file("twice.vdb");
    expect_refusal("deform " + out + " --velocity --posed " + posed + " -o " + twice,
                   ExitCode::usage_error, {"out.vdb", "\"v\"", "--grid"});
    EXPECT_EQ(run("deform " + out + " --grid density --most-outside 1 --velocity --posed " + posed +
                  " -q -o " + twice)
                  .status,
              ExitCode::success);

    // Any grid of points in the shell will do, such as that of its tets' centres.
    const Outcome points =
        run("deform " + rest + " --grid shell_tets --posed " + posed + " --report - -o " + out);
    ASSERT_EQ(points.status, ExitCode::success) << points.err;
    const auto figures = nlohmann::json::parse(points.out)["grids"][0];
    EXPECT_EQ(figures["active_before"], figures["active_after"]);
    EXPECT_EQ(figures["outside"], 0.0);
}

TEST_F(Volumes, AreTheSameForAnyNumberOfThreads)
{
    std::set<std::string> seen;
    for (const std::string threads : {"1", "2", "3"}) {
        ASSERT_EQ(run("volumes " + rest + " --threads " + threads + " -o " + fog).status,
                  ExitCode::success);
        ASSERT_EQ(
            run("deform " + fog + " --posed " + posed + " -q --threads " + threads + " -o " + out)
                .status,
            ExitCode::success);
        seen.insert(read_bytes(fog) + read_bytes(out));
    }
    EXPECT_EQ(seen.size(), 1u);
}

TEST_F(Volumes, TextureCoordinatesComeFromTheSurface)
{
    // u and v are x and y over 2, plus one half.
    const TriangleMesh mesh = icosphere(1.0, 2);
    std::string text;
    for (const openvdb::Vec3s& p : mesh.points) {
        text += "v " + std::to_string(p[0]) + ' ' + std::to_string(p[1]) + ' ' +
                std::to_string(p[2]) + "\nvt " + std::to_string(p[0] / 2 + 0.5) + ' ' +
                std::to_string(p[1] / 2 + 0.5) + '\n';
    }
    for (const openvdb::Vec3I& t : mesh.triangles) {
        text += "f";
        for (int k = 0; k < 3; ++k)
            text.append(" ")
                .append(std::to_string(t[k] + 1))
                .append("/")
                .append(std::to_string(t[k] + 1));
        text += '\n';
    }
    const std::string textured = file("textured.obj");
    write_bytes(textured, text);
    const Outcome made =
        run("volumes " + rest + " --volumes uvw,depth --texture-from " + textured + " -o " + out);
    ASSERT_EQ(made.status, ExitCode::success) << made.err;
    openvdb::initialize();
    openvdb::io::File opened(out);
    opened.open(false);
    const auto uvw = openvdb::gridPtrCast<openvdb::Vec3SGrid>(opened.readGrid("uvw"));
    const auto depth = openvdb::gridPtrCast<openvdb::FloatGrid>(opened.readGrid("depth"));
    std::size_t near_skin = 0;
    for (auto voxel = uvw->cbeginValueOn(); voxel; ++voxel) {
        const openvdb::Vec3s value = *voxel;
        const float d = depth->tree().getValue(voxel.getCoord());
        EXPECT_EQ(value[2], d);
        if (d > 0.05f)
            continue;
        const openvdb::Vec3d p = uvw->transform().indexToWorld(voxel.getCoord());
        EXPECT_NEAR(value[0], p[0] / 2 + 0.5, 0.05);
        EXPECT_NEAR(value[1], p[1] / 2 + 0.5, 0.05);
        ++near_skin;
    }
    EXPECT_GT(near_skin, 100u);
    expect_refusal("volumes " + rest + " --volumes uvw --texture-from " + file("ball.obj") +
                       " -o " + out,
                   ExitCode::read_error, {"ball.obj", "texture coordinates"});
    expect_refusal("volumes " + rest + " --texture-from " + textured + " -o " + out,
                   ExitCode::usage_error, {"--texture-from", "uvw"});
}

TEST_F(Volumes, RefuseBadInput)
{
    ASSERT_EQ(run("volumes " + rest + " -o " + fog).status, ExitCode::success);
    const std::string kept = read_bytes(fog);
    expect_refusal("volumes " + rest + " --volumes uvw -o " + fog, ExitCode::usage_error,
                   {"texture coordinates"});
    expect_refusal("volumes " + rest + " --volumes colour -o " + fog, ExitCode::usage_error,
                   {"colour", "density"});
    expect_refusal("volumes " + rest + " --density-ramp 1:0,0:1 --volumes density -o " + fog,
                   ExitCode::usage_error, {"--density-ramp"});
    expect_refusal("volumes " + rest + " --density-ramp 0:5 --volumes depth -o " + fog,
                   ExitCode::usage_error, {"--density-ramp", "--volumes density"});
    expect_refusal("volumes " + rest + " -o " + file("a.vtu"), ExitCode::usage_error, {".vdb"});
    expect_refusal("volumes " + rest + " -o " + rest, ExitCode::usage_error, {"rest.vdb"});
    EXPECT_EQ(read_bytes(fog), kept);

    expect_refusal("deform " + fog + " --posed " + rest + " -o " + out, ExitCode::usage_error,
                   {"rest.vdb", "at rest"});
    expect_refusal("deform " + fog + " --posed " + posed + " --grid smoke -o " + out,
                   ExitCode::read_error, {"smoke", "depth"});
    // The level set of the skin lies half outside.
    expect_refusal("deform " + rest + " --grid surface --posed " + posed + " -o " + out,
                   ExitCode::usage_error, {"surface", "outside the shell"});
    expect_refusal("deform " + fog + " --velocity --posed " + posed + " -o " + out,
                   ExitCode::usage_error, {"posed.vdb", "--velocity", "--mesh-before"});
    const std::string other = file("other.vdb");
    ASSERT_EQ(
        run("build " + mesh_file("other.obj", icosphere(1.0, 1)) + kCoarse + " -q -o " + other)
            .status,
        ExitCode::success);
    expect_refusal("deform " + fog + " --rest " + other + " --posed " + posed + " -o " + out,
                   ExitCode::geometry_error, {"posed.vdb", "other.vdb", "not one shell"});
    EXPECT_FALSE(std::filesystem::exists(out));
}

} // namespace
} // namespace vdb_shell::test
