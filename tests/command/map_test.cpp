// SPDX-License-Identifier: Apache-2.0
#include "command_fixture.h"

#include "core/grid_instances.h"
#include "support/files.h"
#include "support/shapes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/io/File.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>

// `map`.

namespace vdb_shell::test
{
namespace
{

using command::ExitCode;

/// An OBJ of the mesh with u around z and v up, cut where the angle jumps.
std::string textured_obj(const TriangleMesh& mesh)
{
    std::ostringstream out;
    out.precision(9);
    for (const openvdb::Vec3s& p : mesh.points)
        out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
    int count = 0;
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const openvdb::Vec3s middle = mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]];
        const double about = std::atan2(double(middle[1]), double(middle[0]));
        for (int k = 0; k < 3; ++k) {
            const openvdb::Vec3s& p = mesh.points[t[k]];
            double angle = std::atan2(double(p[1]), double(p[0]));
            angle += 2 * M_PI * std::round((about - angle) / (2 * M_PI));
            out << "vt " << angle / (2 * M_PI) << ' ' << p[2] << '\n';
        }
        out << 'f';
        for (int k = 0; k < 3; ++k)
            out << ' ' << t[k] + 1 << '/' << ++count;
        out << '\n';
    }
    return out.str();
}

class Map : public Command
{
protected:
    Map()
    {
        const TriangleMesh mesh = torus(1.0, 0.4, 24, 12);
        write_bytes(skin, textured_obj(mesh));
        EXPECT_EQ(run("build " + skin + " --resolution 48 -q -o " + shell).status,
                  ExitCode::success);
        openvdb::initialize();
        const auto density = openvdb::FloatGrid::create();
        density->fill({{0, 0, 0}, {19, 19, 9}}, 1.0f);
        density->fill({{0, 0, 0}, {9, 9, 9}}, 2.0f);
        density->setName("density");
        density->setGridClass(openvdb::GRID_FOG_VOLUME);
        density->setSaveFloatAsHalf(true);
        const auto colour = openvdb::Vec3SGrid::create();
        colour->fill({{0, 0, 0}, {3, 3, 3}}, openvdb::Vec3s(1, 0, 0.5f));
        colour->setName("Cd");
        openvdb::io::File(bricks).write({density, colour});
    }

    const std::string skin = file("torus.obj"), shell = file("torus.vdb"),
                      bricks = file("bricks.vdb"), out = file("out.vdb");
};

TEST_F(Map, PushesEveryGridIntoTheShell)
{
    const Outcome all = run("map " + bricks + " --shell " + shell + " --mesh " + skin +
                            " --repeat-u 6 --to-depth 0.5 --report - -o " + out);
    ASSERT_EQ(all.status, ExitCode::success) << all.err;
    const auto report = nlohmann::json::parse(all.out);
    EXPECT_EQ(report["triangles"], report["triangles_of_the_mesh"]);
    ASSERT_EQ(report["grids"].size(), 2u);
    for (const auto& grid : report["grids"]) {
        EXPECT_GT(grid["active"], 1000);
        EXPECT_GT(grid["stretch"], 1);
        EXPECT_EQ(grid["singular"], 0);
    }
    openvdb::io::File made(out);
    made.open(false);
    const openvdb::GridBase::Ptr density = made.readGrid("density");
    EXPECT_EQ(density->getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_TRUE(density->saveFloatAsHalf());
    EXPECT_EQ(density->activeVoxelCount(), report["grids"][0]["active"]);
    EXPECT_EQ(made.readGrid("Cd")->valueType(), "vec3s");
}

TEST_F(Map, NamesOfGridsMayBeAnything)
{
    const auto density = openvdb::FloatGrid::create();
    density->fill({{0, 0, 0}, {3, 3, 3}}, 1.0f);
    // A control character, no UTF-8, and more than a line.
    const std::string name = "\x1b[2Jcaf\xe9" + std::string(400, 'x') + "end";
    density->setName(name);
    openvdb::io::File(bricks).write({density});
    const std::string call =
        "map " + bricks + " --shell " + shell + " --mesh " + skin + " -o " + out;
    const Outcome said = run(call);
    ASSERT_EQ(said.status, ExitCode::success) << said.err;
    EXPECT_EQ(said.out.find('\x1b'), std::string::npos);
    EXPECT_NE(said.out.find("end: "), std::string::npos) << said.out;
    EXPECT_NE(said.out.find("stretch"), std::string::npos) << said.out;
    const Outcome report = run(call + " --report -");
    ASSERT_EQ(report.status, ExitCode::success) << report.err;
    EXPECT_EQ(nlohmann::json::parse(report.out).at("grids").size(), 1u);
    const Outcome doctor = run("doctor " + bricks);
    EXPECT_EQ(doctor.out.find('\x1b'), std::string::npos);
    EXPECT_NE(doctor.out.find("end\""), std::string::npos) << doctor.out;
    const Outcome none = run(call + " --grid none");
    EXPECT_EQ(none.status, ExitCode::read_error);
    EXPECT_EQ(none.err.find('\x1b'), std::string::npos) << none.err;
}

TEST_F(Map, IsTheSameForAnyNumberOfThreads)
{
    std::set<std::string> seen;
    for (const std::string threads : {"1", "2", "3"}) {
        ASSERT_EQ(run("map " + bricks + " --shell " + shell + " --mesh " + skin + " -q --threads " +
                      threads + " -o " + out)
                      .status,
                  ExitCode::success);
        seen.insert(read_bytes(out));
    }
    EXPECT_EQ(seen.size(), 1u);
}

TEST_F(Map, OfARemeshedShellSaysWhichTrianglesAreNew)
{
    const std::string other = file("other.vdb");
    ASSERT_EQ(run("build " + skin + " --resolution 48 --subdivide 1 -q -o " + other).status,
              ExitCode::success);
    const Outcome all =
        run("map " + bricks + " --shell " + other + " --mesh " + skin + " -o " + out);
    EXPECT_EQ(all.status, ExitCode::success) << all.err;
    EXPECT_NE(all.err.find("2304 of 2304 triangles are none of"), std::string::npos) << all.err;
}

TEST_F(Map, RefusesBadInputAndLeavesWhatIsThere)
{
    const std::string common = " --shell " + shell + " -o " + out;
    ASSERT_EQ(run("map " + bricks + common + " -q --mesh " + skin).status, ExitCode::success);
    const std::string kept = read_bytes(out);
    const std::string plain = mesh_file("plain.obj", torus(1.0, 0.4, 24, 12));
    expect_refusal("map " + bricks + common + " --mesh " + plain, ExitCode::read_error,
                   {"plain.obj", "no texture coordinates"});
    expect_refusal("map " + bricks + common + " --mesh " + skin + " --grid smoke",
                   ExitCode::read_error, {"smoke", "density"});
    expect_refusal("map " + bricks + common + " --mesh " + skin +
                       " --from-depth 0.7 --to-depth 0.3",
                   ExitCode::usage_error, {"0.7", "0.3"});
    expect_refusal("map " + bricks + common + " --mesh " + skin + " --repeat-u 0",
                   ExitCode::usage_error, {"--repeat-u"});
    EXPECT_EQ(run("map " + bricks + common).status, ExitCode::usage_error) << "no --mesh";

    const auto empty = openvdb::FloatGrid::create();
    empty->setName("nothing");
    const auto frustum = openvdb::FloatGrid::create();
    frustum->setName("camera");
    frustum->fill({{0, 0, 0}, {7, 7, 7}}, 1.0f);
    frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(100)), 0.5, 10));
    openvdb::io::File(file("bad.vdb")).write({empty, frustum});
    for (const std::string grid : {"nothing", "camera"})
        expect_refusal("map " + file("bad.vdb") + common + " --mesh " + skin + " --grid " + grid,
                       ExitCode::usage_error, {grid});
    EXPECT_EQ(read_bytes(out), kept);
}

} // namespace
} // namespace vdb_shell::test
