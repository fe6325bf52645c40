// SPDX-License-Identifier: Apache-2.0
#include "command_fixture.h"
#include "support/bends.h"

#include "vdb_shell/write/vdb_file.h"

#include <openvdb/openvdb.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// `pose`: a shell on its surface in another pose.

namespace vdb_shell::test
{
namespace
{

using command::ExitCode;
using openvdb::Vec3d;

class Pose : public Command
{
protected:
    Pose()
    {
        EXPECT_EQ(run("build " + rod + kCoarse + " -q -o " + file("rest.vdb")).status,
                  ExitCode::success);
    }

    TriangleMesh bent(double angle_radians) const
    {
        return {moved(rest.points, [=](const Vec3d& p) { return elbow(p, angle_radians, 1.0); }),
                rest.triangles};
    }

    const TriangleMesh rest = round_rod();
    const std::string rod = mesh_file("rod.obj", rest);
};

TEST_F(Pose, WritesEveryFormatAndCheckProvesThem)
{
    const std::string skin = mesh_file("bent.obj", bent(1.2));
    std::string outputs;
    for (const char* name : {"p.vdb", "p.bgeo", "p.vtu", "p.usda", "p.msh", "p.png", "p.obj"})
        outputs += " -o " + file(name);
    const Outcome posed =
        run("pose " + file("rest.vdb") + " " + skin + outputs + " --report " + file("p.json"));
    ASSERT_EQ(posed.status, ExitCode::success) << posed.err;
    EXPECT_NE(posed.out.find("proven"), std::string::npos) << posed.out;
    for (const char* name : {"p.vdb", "p.bgeo"}) {
        const Outcome checked = run("check " + file(name));
        EXPECT_EQ(checked.status, ExitCode::success) << checked.out << checked.err;
    }
    const auto report = nlohmann::json::parse(read_bytes(folder / "p.json"));
    EXPECT_EQ(report.at("source"), "rod.obj");
    EXPECT_EQ(report.at("certificate").at("certified"), true);
    EXPECT_EQ(report.at("pose").at("lost_pillars"), 0);
    const ShellFile at_rest = read_shell_vdb(folder / "rest.vdb");
    const ShellFile shell = read_shell_vdb(folder / "p.vdb");
    EXPECT_EQ(shell.tets.tets, at_rest.tets.tets);
    openvdb::io::File volumes(file("p.vdb"));
    volumes.open();
    EXPECT_EQ(volumes.readGridMetadata("rest")->valueType(), "vec3s");
    EXPECT_EQ(shell.rest.surface[1], at_rest.stack.surface(1));
    EXPECT_EQ(shell.surface->voxelSize(), at_rest.surface->voxelSize());
}

TEST_F(Pose, APosedShellIsPosedFromItsRest)
{
    ASSERT_EQ(run("pose " + file("rest.vdb") + " " + mesh_file("a.obj", bent(1.5)) + " -q -o " +
                  file("a.vdb"))
                  .status,
              ExitCode::success);
    const std::string skin = mesh_file("b.obj", bent(0.7));
    ASSERT_EQ(run("pose " + file("rest.vdb") + " " + skin + " -q -o " + file("b.vdb")).status,
              ExitCode::success);
    ASSERT_EQ(run("pose " + file("a.vdb") + " " + skin + " -q -o " + file("ab.vdb")).status,
              ExitCode::success);
    EXPECT_EQ(read_shell_vdb(folder / "ab.vdb").stack.surface(1),
              read_shell_vdb(folder / "b.vdb").stack.surface(1));
}

TEST_F(Pose, OtherTrianglesNeedTheSurfaceAtRest)
{
    const TriangleMesh other = gridded_box({-0.45, -0.45, -2}, {0.45, 0.45, 2}, 8);
    const auto turn = [](const TriangleMesh& mesh) {
        return translated(turned(mesh, {1, 0, 0}, 0.5), {2, 0, 0});
    };
    const std::string at_rest = mesh_file("box.obj", other),
                      posed = mesh_file("t.obj", turn(other));
    expect_refusal("pose " + file("rest.vdb") + " " + posed + " -q -o " + file("o.vdb"),
                   ExitCode::usage_error, {"t.obj", "--rest-mesh", "rest.vdb"});
    EXPECT_FALSE(std::filesystem::exists(folder / "o.vdb"));
    ASSERT_EQ(run("pose " + file("rest.vdb") + " " + posed + " --rest-mesh " + at_rest + " -q -o " +
                  file("o.vdb"))
                  .status,
              ExitCode::success);
    const Points skin = read_shell_vdb(folder / "o.vdb").stack.surface(0),
                 expected = turn(rest).points;
    for (std::size_t v = 0; v < skin.size(); ++v)
        EXPECT_LT((skin[v] - expected[v]).length(), 1e-5f);
}

TEST_F(Pose, StandsWhereARecentredShellStands)
{
    const Vec3d far(1000, 2000, -500);
    const std::string there = mesh_file("far.obj", translated(rest, far));
    ASSERT_EQ(
        run("build " + there + kCoarse + " --recentre --rescale -q -o " + file("f.vdb")).status,
        ExitCode::success);
    ASSERT_EQ(run("pose " + file("f.vdb") + " " + mesh_file("fb.obj", translated(bent(1.0), far)) +
                  " -q -o " + file("fp.vdb"))
                  .status,
              ExitCode::success);
    const ShellFile posed = read_shell_vdb(folder / "fp.vdb");
    const Points expected = translated(bent(1.0), far).points;
    for (std::size_t v = 0; v < expected.size(); v += 5)
        EXPECT_LT(
            (posed.placement.in_file(posed.stack.surface(0)[v]) - Vec3d(expected[v])).length(),
            1e-3);
}

TEST_F(Pose, ASkinThatCrossesItselfIsWarnedOfAndNoFailure)
{
    const TriangleMesh two = joined(rest, translated(rest, {1.5, 0, 0}));
    ASSERT_EQ(
        run("build " + mesh_file("two.obj", two) + kCoarse + " -q -o " + file("two.vdb")).status,
        ExitCode::success);
    const TriangleMesh pushed = joined(rest, translated(rest, {0.7, 0, 0}));
    const Outcome posed = run("pose " + file("two.vdb") + " " + mesh_file("x.obj", pushed) +
                              " -q -o " + file("x.vdb"));
    EXPECT_EQ(posed.status, ExitCode::success);
    EXPECT_NE(posed.err.find("the skin crosses itself"), std::string::npos) << posed.err;
    EXPECT_EQ(run("check " + file("x.vdb")).status, ExitCode::success);
}

TEST_F(Pose, WhatCannotBeIsRefused)
{
    const std::string skin = mesh_file("bent.obj", bent(0.5)), shell = file("rest.vdb");
    expect_refusal("pose " + shell + " " + skin + " -q", ExitCode::usage_error, {"no output"});
    expect_refusal("pose " + shell + " " + skin + " -q -o " + shell, ExitCode::usage_error,
                   {"rest.vdb"});
    expect_refusal("pose " + shell + " " + file("none.obj") + " -q -o " + file("x.vdb"),
                   ExitCode::read_error, {"none.obj"});
    expect_refusal("pose " + shell + " " + skin + " --most-distortion 1 -q -o " + file("x.vdb"),
                   ExitCode::usage_error, {"--most-distortion"});
    ASSERT_EQ(run("convert " + shell + " -o " + file("rest.bgeo")).status, ExitCode::success);
    expect_refusal("pose " + file("rest.bgeo") + " " + skin + " -q -o " + file("x.vdb"),
                   ExitCode::usage_error, {"rest.bgeo", "no level set"});
    EXPECT_FALSE(std::filesystem::exists(folder / "x.vdb"));
}

} // namespace
} // namespace vdb_shell::test
