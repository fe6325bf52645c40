// SPDX-License-Identifier: Apache-2.0
#include "command_fixture.h"
#include "support/shapes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

// Surfaces inside, given to `build`.

namespace vdb_shell::test
{
namespace
{

using command::ExitCode;
using openvdb::Vec3d;

class Cores : public Command
{
protected:
    std::string sphere = mesh_file("sphere.obj", icosphere(1.0, 2));
    std::string ball = mesh_file("ball.obj", icosphere(0.4, 2));

    nlohmann::json report(const std::string& options)
    {
        const Outcome built =
            run("build " + sphere + kCoarse + options + " -q --report " + file("report.json"));
        EXPECT_EQ(built.status, ExitCode::success) << built.err;
        return nlohmann::json::parse(read_bytes(folder / "report.json"));
    }
};

TEST_F(Cores, WordsAndFilesShareTheFlag)
{
    const auto with = report(" --taper --core " + ball + " --core stitched --core-distance 0.1");
    EXPECT_EQ(with.at("cores").at("files").size(), 1U);
    EXPECT_EQ(with.at("cores").at("files")[0].at("name"), "ball.obj");
    EXPECT_GE(with.at("cores").at("least_distance").get<double>(), 0.1);
    EXPECT_GT(with.at("volume").at("fill").get<double>(), 0.5);
    EXPECT_TRUE(report(" --taper --core free").at("cores").is_null());
    const auto two =
        report(" --core " + mesh_file("a.ply", translated(icosphere(0.2, 1), {0.4, 0, 0})) +
               " --core " + mesh_file("b.stl", translated(icosphere(0.2, 1), {-0.4, 0, 0})));
    EXPECT_EQ(two.at("cores").at("files").size(), 2U);
    EXPECT_EQ(two.at("cores").at("files")[1].at("name"), "b.stl");
    expect_refusal("build " + sphere + kCoarse + " -q -o " + file("s.vdb") + " --core loose",
                   ExitCode::read_error, {"loose", "--core takes free, stitched or a file"});
}

TEST_F(Cores, AFileNamedLikeAWordIsGivenWithItsFolder)
{
    std::filesystem::copy_file(ball, folder / "free.obj");
    EXPECT_EQ(report(" --core " + file("free.obj")).at("cores").at("files").size(), 1U);
}

TEST_F(Cores, ALevelSetIsOne)
{
    ASSERT_EQ(run("build " + ball + kCoarse + " -q -o " + file("ball.vdb")).status,
              ExitCode::success);
    for (const std::string& name : {file("ball.vdb"), file("ball.vdb:surface")}) {
        const auto with = report(" --core " + name);
        EXPECT_NEAR(with.at("cores").at("volume").get<double>(), 4.18879 * 0.4 * 0.4 * 0.4, 0.03);
        EXPECT_GT(with.at("volume").at("fill").get<double>(), 0.9);
    }
}

TEST_F(Cores, EveryFormatHasTheFeet)
{
    const std::string outputs = " -o " + file("s.vdb") + " -o " + file("s.vtu") + " -o " +
                                file("s.geo") + " -o " + file("s.bgeo.sc");
    ASSERT_EQ(run("build " + sphere + kCoarse + " -q --core " + ball + outputs).status,
              ExitCode::success);
    EXPECT_NE(read_bytes(folder / "s.vtu").find("Name=\"core_uvw\""), std::string::npos);
    for (const char* from : {"s.vdb", "s.geo", "s.bgeo.sc"}) {
        SCOPED_TRACE(from);
        EXPECT_EQ(run("check " + file(from)).status, ExitCode::success);
        ASSERT_EQ(
            run("convert " + file(from) + " -o " + file("again.geo") + " -o " + file("again.vtu"))
                .status,
            ExitCode::success);
        // The bytes of the .geo tell that .vdb and .geo were read back bit for bit.
        EXPECT_EQ(read_bytes(folder / "again.geo"), read_bytes(folder / "s.geo"));
    }
    const std::string geo = read_bytes(folder / "s.geo");
    for (const char* name : {"core", "core_triangle", "core_uvw", "core_distance"})
        EXPECT_NE(geo.find("\"" + std::string(name) + "\""), std::string::npos) << name;
}

TEST_F(Cores, StandWhereTheSurfaceStands)
{
    // So far out that a coordinate has no room for a core in float32.
    const Vec3d far(1e7, 0, 0);
    const auto write = [&](const std::string& name, const TriangleMesh& mesh) {
        std::string text;
        for (const openvdb::Vec3s& p : mesh.points) {
            const Vec3d q = Vec3d(p) + far;
            text += "v " + std::to_string(q[0]) + " " + std::to_string(q[1]) + " " +
                    std::to_string(q[2]) + "\n";
        }
        for (const openvdb::Vec3I& t : mesh.triangles)
            text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
                    std::to_string(t[2] + 1) + "\n";
        write_bytes(folder / name, text);
        return file(name);
    };
    sphere = write("far.obj", icosphere(1.0, 2));
    const std::string core = write("far_ball.obj", icosphere(0.4, 2));
    const auto with = report(" --recentre --rescale --core-distance 0.1 --core " + core);
    EXPECT_GT(with.at("volume").at("fill").get<double>(), 0.7);
    const double unit = with.at("read").at("placement").at("unit").get<double>();
    EXPECT_GE(with.at("cores").at("least_distance").get<double>() * unit, 0.1);
    EXPECT_LT(with.at("cores").at("least_distance").get<double>() * unit, 0.2);
}

TEST_F(Cores, WhatCannotBeIsRefused)
{
    const std::string build = "build " + sphere + kCoarse + " -q -o " + file("s.vdb");
    expect_refusal(
        build + " --core " + mesh_file("thorn.obj", translated(icosphere(0.2, 1), {0.9, 0, 0})),
        ExitCode::geometry_error, {"core thorn.obj crosses or touches the surface", "triangle"});
    expect_refusal(build + " --core-distance 0.1", ExitCode::usage_error,
                   {"--core-distance needs --core"});
    expect_refusal(build + " --method raw --core " + ball, ExitCode::usage_error, {"--method"});
    expect_refusal(build + " --side both --core " + ball, ExitCode::usage_error, {"--side"});
    expect_refusal("build " + sphere + kCoarse + " -q -o " + ball + " --core " + ball,
                   ExitCode::usage_error, {"is the input"});
    expect_refusal(build + " --core-reach -1 --core " + ball, ExitCode::usage_error,
                   {"--core-reach"});
}

} // namespace
} // namespace vdb_shell::test
