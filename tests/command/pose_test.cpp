// SPDX-License-Identifier: Apache-2.0
#include "command_fixture.h"
#include "support/bends.h"

#include "core/grid_instances.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/write/vdb_file.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <sstream>

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

    /// p.#.vdb, bent more from frame to frame.
    int pose_frames(const std::vector<int>& numbers, const std::string& frames)
    {
        for (const int frame : numbers)
            mesh_file("b." + std::to_string(frame) + ".obj", bent(0.1 * frame));
        return run("pose " + file("rest.vdb") + " " + file("b.#.obj") + frames + "-q -o " +
                   file("p.#.vdb"))
            .status;
    }

    const TriangleMesh rest = round_rod();
    const std::string rod = mesh_file("rod.obj", rest);
};

TEST_F(Pose, TheSkinOfAWrappedSurfaceIsAPoseOfItsShell)
{
    const std::string open = mesh_file("open.obj", without_triangle(rest, 3));
    ASSERT_EQ(
        run("build " + open + kCoarse + " --wrap --wrap-resolution 24 -q -o " + file("wrapped.vdb"))
            .status,
        ExitCode::success);
    ASSERT_EQ(run("convert " + file("wrapped.vdb") + " --surface skin -o " + file("skin.obj") +
                  " -o " + file("skin.ply"))
                  .status,
              ExitCode::success);
    for (const char* skin : {"skin.obj", "skin.ply"}) {
        EXPECT_EQ(run("inspect " + file(skin)).status, ExitCode::success);
        const Outcome posed =
            run("pose " + file("wrapped.vdb") + " " + file(skin) + " -q -o " + file("posed.vdb"));
        ASSERT_EQ(posed.status, ExitCode::success) << posed.err;
        const ShellStack before = read_shell_vdb(folder / "wrapped.vdb").stack,
                         after = read_shell_vdb(folder / "posed.vdb").stack;
        EXPECT_EQ(after.surface(0), before.surface(0));
        EXPECT_EQ(after.surface(1), before.surface(1));
    }
    expect_refusal("convert " + file("wrapped.vdb") + " --surface skin -o " + file("skin.vtu"),
                   ExitCode::usage_error, {"--surface", ".obj"});
}

TEST_F(Pose, WritesEveryFormatAndCheckProvesThem)
{
    const std::string skin = mesh_file("bent.obj", bent(1.2));
    std::string outputs;
    for (const char* name :
         {"p.vdb", "p.bgeo", "p.vtu", "p.usda", "p.msh", "p.png", "p.html", "p.obj"})
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

TEST_F(Pose, FramesComeIntoOneStage)
{
    const std::string frames = " --frames 12-8x2 ";
    ASSERT_EQ(pose_frames({12, 10, 8}, frames), ExitCode::success);
    const std::string call = "usd " + file("p.#.vdb") + frames;
    const Outcome made = run(call + "--up-axis z --frames-per-second 30 -o " + file("p.usda"));
    ASSERT_EQ(made.status, ExitCode::success) << made.err;
    const std::string stage = read_bytes(folder / "p.usda");
    // Times are the frames, in their order.
    for (const char* said : {"startTimeCode = 8\n", "endTimeCode = 12\n", "upAxis = \"Z\"",
                             "timeCodesPerSecond = 30\n", "@./p.10.vdb@", "points.timeSamples"})
        EXPECT_NE(stage.find(said), std::string::npos) << said;
    EXPECT_LT(stage.find("@./p.8.vdb@"), stage.find("@./p.12.vdb@"));
    // The tets are those at rest at all times, so they are written once.
    EXPECT_EQ(stage.find("tetVertexIndices.timeSamples"), std::string::npos);
    expect_refusal(call + "-o " + file("p.usd"), ExitCode::usage_error, {"p.usd", ".usda"});
    expect_refusal(call + "-o " + file("p.#.usda"), ExitCode::usage_error, {"into one file"});
    expect_refusal("usd " + file("p.8.vdb") + " " + file("none.vdb") + " -o " + file("q.usda"),
                   ExitCode::read_error, {"none.vdb"});
}

TEST_F(Pose, FramesComeOntoOnePage)
{
    const std::string frames = " --frames 1-3 ";
    ASSERT_EQ(pose_frames({1, 2, 3}, frames), ExitCode::success);
    const std::string page = "page " + file("p.#.vdb") + frames + "-o ";
    const Outcome plan = run(page + file("p.html") + " --dry-run");
    EXPECT_EQ(plan.out, "reads " + file("p.1.vdb") + " " + file("p.2.vdb") + " " + file("p.3.vdb") +
                            ", writes " + file("p.html") + "\n");
    EXPECT_EQ(run(page + file("p.html")).status, ExitCode::success);
    const std::string text = read_bytes(folder / "p.html");
    EXPECT_NE(text.find("id=\"frame2\""), std::string::npos);
    EXPECT_EQ(text.find("id=\"frame3\""), std::string::npos);
    // The same without --frames; and one of them, by the way of all other formats.
    const std::string named = file("p.1.vdb") + " " + file("p.2.vdb") + " " + file("p.3.vdb");
    EXPECT_EQ(run("page " + named + " -o " + file("n.html")).status, ExitCode::success);
    EXPECT_EQ(read_bytes(folder / "n.html"), text);
    EXPECT_EQ(run("page " + file("p.2.vdb") + " -o " + file("a.html")).status, ExitCode::success);
    EXPECT_EQ(run("convert " + file("p.2.vdb") + " -o " + file("b.html")).status,
              ExitCode::success);
    // Only what the frame is called differs: the page's own parts are the same.
    EXPECT_EQ(read_bytes(folder / "a.html").substr(0, 5000),
              read_bytes(folder / "b.html").substr(0, 5000));

    expect_refusal(page + file("p.#.html"), ExitCode::usage_error, {"\"#\"", "into one file"});
    expect_refusal(page + file("p.png"), ExitCode::usage_error, {".html"});
    expect_refusal("page " + file("p.#.vdb") + " --frames 2-4 -o " + file("x.html"),
                   ExitCode::read_error, {"p.4.vdb"});
    expect_refusal("convert " + file("p.#.vdb") + frames + "-o " + file("x.html"),
                   ExitCode::usage_error, {"vdb_shell page"});
    ASSERT_EQ(run("build " + rod + kCoarse + " --layers 2 -q -o " + file("two.vdb")).status,
              ExitCode::success);
    expect_refusal("page " + file("p.1.vdb") + " " + file("two.vdb") + " -o " + file("x.html"),
                   ExitCode::geometry_error, {"two", "not those of p.1"});
    EXPECT_FALSE(std::filesystem::exists(folder / "x.html"));
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
                   ExitCode::geometry_error, {"t.obj", "--rest-mesh", "rest.vdb"});
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

/// Quads, each of which is two triangles of the mesh.
std::string write_quads(const std::filesystem::path& path, const TriangleMesh& mesh)
{
    std::ostringstream out;
    for (const openvdb::Vec3s& p : mesh.points)
        out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 2) {
        const openvdb::Vec3I &a = mesh.triangles[t], &b = mesh.triangles[t + 1];
        out << "f " << a[0] + 1 << ' ' << a[1] + 1 << ' ' << a[2] + 1 << ' ' << b[2] + 1 << '\n';
    }
    write_bytes(path, out.str());
    return path.string();
}

TEST_F(Pose, PolygonsMayBeCutOtherwiseThanAtRest)
{
    TriangleMesh box = gridded_box({0, 0, 0}, {6, 6, 6}, 6);
    ASSERT_EQ(run("build " + write_quads(folder / "quads.obj", box) + kCoarse + " -q -o " +
                  file("quads.vdb"))
                  .status,
              ExitCode::success);
    // Beyond the diagonal of a quad beside it, which is not convex then.
    const openvdb::Vec3s inside(3, 3, 6);
    *std::find(box.points.begin(), box.points.end(), inside) = {3.7F, 3.7F, 6};
    const std::string posed = write_quads(folder / "posed.obj", box);
    ASSERT_NE(read_mesh(posed).mesh.triangles, read_mesh(file("quads.obj")).mesh.triangles);
    ASSERT_EQ(run("pose " + file("quads.vdb") + " " + posed + " -q -o " + file("p.vdb")).status,
              ExitCode::success);
    const ShellFile shell = read_shell_vdb(folder / "p.vdb");
    EXPECT_EQ(shell.stack.surface(shell.stack.skin), box.points);

    // Quads of other vertices are another surface, as many as there may be.
    std::rotate(box.points.begin(), box.points.begin() + 1, box.points.end());
    for (openvdb::Vec3I& t : box.triangles)
        for (int k = 0; k < 3; ++k)
            t[k] = (t[k] + std::uint32_t(box.points.size()) - 1) % std::uint32_t(box.points.size());
    expect_refusal("pose " + file("quads.vdb") + " " + write_quads(folder / "other.obj", box) +
                       " -q -o " + file("o.vdb"),
                   ExitCode::geometry_error, {"other.obj", "not those of the surface of"});
}

/// The mesh's points back to front, as text, with ids.
std::string with_ids(const TriangleMesh& mesh, const std::function<int(std::size_t)>& id)
{
    const std::size_t n = mesh.points.size();
    std::ostringstream out;
    out.precision(9);
    out << "ply\nformat ascii 1.0\nelement vertex " << n
        << "\nproperty float x\nproperty float y\nproperty float z\nproperty int id\nelement face "
        << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
    for (std::size_t i = n; i-- > 0;)
        out << mesh.points[i][0] << ' ' << mesh.points[i][1] << ' ' << mesh.points[i][2] << ' '
            << id(i) << '\n';
    for (const openvdb::Vec3I& t : mesh.triangles)
        out << "3 " << n - 1 - t[0] << ' ' << n - 1 - t[1] << ' ' << n - 1 - t[2] << '\n';
    return out.str();
}

TEST_F(Pose, VelocitiesAreThoseOfTheFramesBesides)
{
    // It is faster from frame to frame: 0, .3, .9, 1.8 along x.
    for (int k = 0; k < 4; ++k)
        mesh_file("w." + std::to_string(k + 1) + ".obj",
                  translated(rest, {0.15 * k * (k + 1), 0, 0}));
    const std::string call = "pose " + file("rest.vdb") + " " + file("w.#.obj") + " --frames 1-4";
    const std::string neighbours =
        " --mesh-before " + file("w.#.obj") + " --mesh-after " + file("w.#.obj");
    const Outcome moving = run(call + neighbours + " --frame-seconds 0.5 -q -o " + file("v.#.vdb") +
                               " -o " + file("v.#.bgeo"));
    ASSERT_EQ(moving.status, ExitCode::success) << moving.err;
    ASSERT_EQ(run(call + " -q -o " + file("s.#.vdb")).status, ExitCode::success);
    // One way at both ends, and over two frames between them; by hand.
    const std::array<double, 4> expected{0.6, 0.9, 1.5, 1.8};
    for (int k = 0; k < 4; ++k) {
        const std::string number = std::to_string(k + 1);
        const ShellFile shell = read_shell_vdb(folder / ("v." + number + ".vdb"));
        const ShellFile still = read_shell_vdb(folder / ("s." + number + ".vdb"));
        EXPECT_TRUE(still.rest.velocity.empty());
        ASSERT_EQ(shell.rest.velocity.surface.size(), 2U);
        for (std::size_t surface = 0; surface < 2; ++surface) {
            EXPECT_EQ(shell.stack.surface(surface), still.stack.surface(surface));
            for (const openvdb::Vec3s& v : shell.rest.velocity.surface[surface])
                EXPECT_LT((Vec3d(v) - Vec3d(expected[std::size_t(k)], 0, 0)).length(), 1e-5);
        }
        openvdb::io::File grids(file("v." + number + ".vdb"));
        grids.open();
        const auto volume = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grids.readGrid("v"));
        EXPECT_GT(volume->activeVoxelCount(), 100U);
        for (auto voxel = volume->cbeginValueOn(); voxel; ++voxel)
            EXPECT_NEAR(voxel->x(), expected[std::size_t(k)], 1e-5);
    }
    // No frame has a neighbour of a name that is misspelt.
    const Outcome misspelt = run("pose " + file("rest.vdb") + " " + file("w.2.obj") +
                                 " --mesh-before " + file("v.1.obj") + " -q -o " + file("m.bgeo"));
    EXPECT_EQ(misspelt.status, ExitCode::success);
    EXPECT_NE(misspelt.err.find("w.2.obj: no velocities, for there is no"), std::string::npos)
        << misspelt.err;
    // A piece of the sequence has the same bytes as the whole one, so that a farm can share it out.
    const std::string whole = read_bytes(folder / "v.2.bgeo");
    ASSERT_EQ(run("pose " + file("rest.vdb") + " " + file("w.#.obj") + neighbours +
                  " --frames 2 --frame-seconds 0.5 -q -o " + file("v.#.bgeo"))
                  .status,
              ExitCode::success);
    EXPECT_EQ(read_bytes(folder / "v.2.bgeo"), whole);
    ASSERT_EQ(run("convert " + file("v.2.vdb") + " -o " + file("again.vtu") + " && " +
                  VDB_SHELL_COMMAND + " convert " + file("v.2.bgeo") + " -o " + file("houdini.vtu"))
                  .status,
              ExitCode::success);
    EXPECT_NE(read_bytes(folder / "again.vtu").find("Name=\"v\""), std::string::npos);
    EXPECT_EQ(read_bytes(folder / "again.vtu"), read_bytes(folder / "houdini.vtu"));
    expect_refusal(call + neighbours + " --frame-seconds 0 -q -o " + file("x.#.vdb"),
                   ExitCode::usage_error, {"--frame-seconds"});
    expect_refusal(call + " --frame-seconds 1 -q -o " + file("x.#.vdb"), ExitCode::usage_error,
                   {"--frame-seconds", "--mesh-before"});
}

TEST_F(Pose, IdsSayWhichPointIsWhich)
{
    const TriangleMesh pose = bent(0.8);
    ASSERT_EQ(
        run("pose " + file("rest.vdb") + " " + mesh_file("b.obj", pose) + " -q -o " + file("b.vdb"))
            .status,
        ExitCode::success);
    write_bytes(folder / "ids.ply", with_ids(pose, [](std::size_t v) { return int(v); }));
    const Outcome by_ids =
        run("pose " + file("rest.vdb") + " " + file("ids.ply") + " -q -o " + file("i.vdb"));
    ASSERT_EQ(by_ids.status, ExitCode::success) << by_ids.err;
    EXPECT_EQ(read_shell_vdb(folder / "i.vdb").stack.surface(1),
              read_shell_vdb(folder / "b.vdb").stack.surface(1));

    // Names of the artist's own, which the surface at rest has too.
    const auto name = [](std::size_t v) { return 1000 - 3 * int(v); };
    write_bytes(folder / "posed.ply", with_ids(pose, name));
    write_bytes(folder / "still.ply", with_ids(rest, name));
    expect_refusal("pose " + file("rest.vdb") + " " + file("posed.ply") + " -q -o " + file("o.vdb"),
                   ExitCode::geometry_error, {"posed.ply", "no point has the id"});
    EXPECT_EQ(run("pose " + file("rest.vdb") + " " + file("posed.ply") + " --rest-mesh " +
                  file("still.ply") + " -q -o " + file("o.vdb"))
                  .status,
              ExitCode::success);
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

TEST_F(Pose, AMirroredSkinIsWarnedOf)
{
    TriangleMesh ball = icosphere(1.0, 2);
    const std::string shell = file("ball.vdb");
    ASSERT_EQ(run("build " + mesh_file("ball.obj", ball) + kCoarse + " -q -o " + shell).status,
              ExitCode::success);
    const std::string to = " --report " + file("pose.json");
    EXPECT_EQ(run("pose " + shell + " " + file("ball.obj") + to).err, "");
    for (openvdb::Vec3s& p : ball.points)
        p[0] = -p[0];
    const Outcome posed = run("pose " + shell + " " + mesh_file("mirrored.obj", ball) + to);
    EXPECT_NE(posed.err.find("mirrored.obj: the skin is inside out"), std::string::npos)
        << posed.err;
}

TEST_F(Pose, ASkinThatLeavesNoPlaceGivesAShellThatIsToldToBeNotValid)
{
    TriangleMesh ball = icosphere(1.0, 2);
    ASSERT_EQ(
        run("build " + mesh_file("ball.obj", ball) + kCoarse + " -q -o " + file("ball.vdb")).status,
        ExitCode::success);
    // A cup: the upper half is pushed almost onto the lower one, and crosses nothing.
    for (openvdb::Vec3s& p : ball.points)
        if (p[2] > 0)
            p[2] *= -0.9F;
    const Outcome posed = run("pose " + file("ball.vdb") + " " + mesh_file("cup.obj", ball) +
                              " --report " + file("cup.json") + " -o " + file("cup.vdb"));
    EXPECT_EQ(posed.status, ExitCode::check_failed);
    EXPECT_NE(posed.err.find("cup.obj: the shell is NOT VALID: "), std::string::npos) << posed.err;
    EXPECT_EQ(posed.err.find('\n') + 1, posed.err.size()) << posed.err;
    EXPECT_NE(posed.out.find("verdict     NOT VALID"), std::string::npos) << posed.out;
    // It is written all the same, and its file claims no more than that.
    const auto report = nlohmann::json::parse(read_bytes(folder / "cup.json"));
    EXPECT_FALSE(report.at("certificate").at("certified").get<bool>());
    EXPECT_EQ(report.at("mesh").at("self_intersections"), 0);
    EXPECT_EQ(run("check " + file("cup.vdb")).status, ExitCode::success);
}

TEST_F(Pose, TextsOfAShellMayBeAnything)
{
    ShellFile file_at_rest = read_shell_vdb(folder / "rest.vdb");
    const std::string skin = mesh_file("bent.obj", bent(0.5)), odd = file("odd.vdb");
    const auto with = [&](const std::string& parameters, const std::string& report) {
        file_at_rest.parameters_json = parameters;
        file_at_rest.report_json = report;
        write_shell_vdb(odd, file_at_rest);
    };
    constexpr std::size_t kDeep = 200000;
    std::string deep =
        R"({"certificate": )" + std::string(kDeep, '[') + std::string(kDeep, ']') + "}";
    with("{}", deep);
    const auto refused = [&](const std::string& call, const std::string& said) {
        expect_refusal(call, ExitCode::read_error, {"odd.vdb: its " + said});
    };
    refused("pose " + odd + " " + skin + " --report -", "report: its JSON has more than 100");
    refused("info --json " + odd, "report: its JSON has more than 100");
    EXPECT_EQ(run("check " + odd).status, ExitCode::check_failed)
        << "a report of that depth is none";
    with("nothing", "nothing");
    refused("pose " + odd + " " + skin + " --report -", "report: is no JSON");
    with(deep, "{}");
    refused("compare --json " + odd + " " + file("rest.vdb"), "parameters: its JSON has more than");
    with("\x1b[2J\nnothing", "{}");
    EXPECT_NE(run("info " + odd).out.find("parameters ?[2J\nnothing"), std::string::npos);
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
