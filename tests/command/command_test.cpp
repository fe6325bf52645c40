// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/io/read_mesh.h"

#include "command_fixture.h"
#include "support/shapes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

namespace vdb_shell::test
{
namespace
{

using command::ExitCode;

TEST_F(Command, BuildsEveryFormatAndTheFigures)
{
    const std::string sphere = mesh_file("sphere.obj", icosphere(1.0, 2));
    std::string outputs;
    for (const char* name : {"s.vdb", "s.vtu", "s.node", "s.mesh", "s.msh", "inner.ply", "s.png"})
        outputs += " -o " + file(name);
    const Outcome result =
        run("build " + sphere + kCoarse + outputs + " --report " + file("s.json"));
    ASSERT_EQ(result.status, ExitCode::success) << result.err;
    for (const char* name :
         {"s.vdb", "s.vtu", "s.node", "s.ele", "s.face", "s.mesh", "s.msh", "inner.ply", "s.png"})
        EXPECT_GT(std::filesystem::file_size(folder / name), 0u) << name;
    const auto report = nlohmann::json::parse(read_bytes(folder / "s.json"));
    EXPECT_EQ(report.at("source"), "sphere.obj");
    EXPECT_GT(report.at("volume").at("fill").get<double>(), 0.5);
    EXPECT_FALSE(result.out.empty());
}

TEST_F(Command, WritesAndReadsHoudiniGeometry)
{
    const std::string sphere = mesh_file("sphere.obj", icosphere(1.0, 2));
    const std::vector<std::string> names{"s.geo", "s.bgeo", "s.bgeo.sc"};
    std::string outputs = " -o " + file("s.vdb");
    for (const std::string& name : names)
        outputs += " -o " + file(name);
    ASSERT_EQ(run("build " + sphere + kCoarse + outputs).status, ExitCode::success);
    for (const std::string& name : names) {
        const Outcome check = run("check " + file(name));
        EXPECT_EQ(check.status, ExitCode::success) << check.out << check.err;
        EXPECT_EQ(run("info " + file(name)).status, ExitCode::success);
        // From any form to any other, and from the .vdb, the bytes are the same.
        for (const std::string& from : {std::string("s.geo"), std::string("s.vdb")}) {
            ASSERT_EQ(run("convert " + file(from) + " -o " + file("again." + name)).status,
                      ExitCode::success);
            EXPECT_EQ(read_bytes(folder / ("again." + name)), read_bytes(folder / name)) << name;
        }
    }
    expect_refusal("build " + file("s.bgeo"), ExitCode::read_error,
                   {"s.bgeo", "primitive 0 is a tetrahedron"});
    expect_refusal("convert " + file("s.bgeo") + " -o " + file("t.vdb"), ExitCode::usage_error,
                   {"\"surface\" is missing"});
    std::string damaged = read_bytes(folder / "s.bgeo");
    damaged.resize(damaged.size() / 2);
    write_bytes(folder / "half.bgeo", damaged);
    expect_refusal("check " + file("half.bgeo"), ExitCode::read_error, {"half.bgeo", "byte"});
}

TEST_F(Command, LayersOnBothSidesInHoudiniGeometryAndUsd)
{
    const std::string ring = mesh_file("torus.obj", torus(1.0, 0.3, 24, 12));
    const std::vector<std::string> names{"t.bgeo.sc", "t.bgeo", "t.geo"};
    std::string outputs = " -o " + file("t.vdb") + " -o " + file("t.usda");
    for (const std::string& name : names)
        outputs += " -o " + file(name);
    const Outcome built = run("build " + ring + kCoarse + "--layers 3 --side both" + outputs);
    ASSERT_EQ(built.status, ExitCode::success) << built.err;
    for (const std::string& name : names) {
        const Outcome check = run("check " + file(name));
        EXPECT_EQ(check.status, ExitCode::success) << check.out << check.err;
        EXPECT_EQ(check.out.find("FAILED"), std::string::npos) << check.out;
        ASSERT_EQ(run("convert " + file("t.vdb") + " -o " + file("again." + name)).status,
                  ExitCode::success);
        EXPECT_EQ(read_bytes(folder / ("again." + name)), read_bytes(folder / name)) << name;
    }
    EXPECT_NE(read_bytes(folder / "t.usda").find("int userProperties:skin = 3"), std::string::npos);
    expect_refusal("check " + file("t.usda"), ExitCode::read_error, {"t.usda"});
}

TEST_F(Command, BuildsFromHoudiniPolygons)
{
    // A box of quads, clockwise seen from outside.
    write_bytes(
        folder / "box.geo",
        R"(["pointcount",8,"vertexcount",24,"primitivecount",6,"topology",["pointref",["indices",
                [0,1,2,3,7,6,5,4,0,4,5,1,1,5,6,2,2,6,7,3,3,7,4,0]]],"attributes",["pointattributes",[[
                ["type","numeric","name","P"],["size",3,"storage","fpreal32","values",["size",3,"tuples",
                [[0,0,0],[1,0,0],[1,1,0],[0,1,0],[0,0,1],[1,0,1],[1,1,1],[0,1,1]]]]]]],
                "primitives",[[["type","Polygon_run"],["startvertex",0,"nprimitives",6,"nvertices_rle",[4,6]]]]])");
    const Outcome built =
        run("build " + file("box.geo") + kCoarse + " -q --report " + file("box.json"));
    ASSERT_EQ(built.status, ExitCode::success) << built.err;
    const auto report = nlohmann::json::parse(read_bytes(folder / "box.json"));
    EXPECT_EQ(report.at("read").at("format"), "Houdini geometry (text)");
    EXPECT_EQ(report.at("read").at("polygons_triangulated"), 6);
    EXPECT_EQ(report.at("mesh").at("volume"), 1.0);
}

TEST_F(Command, TakesOptionsBeforeTheMesh)
{
    const std::string sphere = mesh_file("sphere.obj", icosphere(1.0, 1));
    EXPECT_EQ(run("build -o " + file("s.vdb") + " -o " + file("s.vtu") + kCoarse + sphere).status,
              ExitCode::success);
}

TEST_F(Command, QuietPrintsNothing)
{
    const std::string sphere = mesh_file("sphere.obj", icosphere(1.0, 1));
    const Outcome result = run("build -q " + sphere + kCoarse + " -o " + file("s.vdb"));
    EXPECT_EQ(result.status, ExitCode::success);
    EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Command, CheckAcceptsWhatBuildWrote)
{
    const std::string sphere = mesh_file("sphere.obj", icosphere(1.0, 2));
    ASSERT_EQ(run("build " + sphere + kCoarse + " -o " + file("s.vdb")).status, ExitCode::success);
    const Outcome check = run("check " + file("s.vdb"));
    EXPECT_EQ(check.status, ExitCode::success) << check.out << check.err;
    EXPECT_EQ(check.out.find("FAILED"), std::string::npos) << check.out;
}

TEST_F(Command, ConvertGivesTheFilesThatBuildGave)
{
    const std::string sphere = mesh_file("sphere.obj", icosphere(1.0, 2));
    ASSERT_EQ(run("build " + sphere + kCoarse + " -o " + file("s.vdb") + " -o " + file("a.vtu") +
                  " -o " + file("a.mesh") + " -o " + file("a.stl"))
                  .status,
              ExitCode::success);
    ASSERT_EQ(run("convert " + file("s.vdb") + " -o " + file("b.vtu") + " -o " + file("b.mesh") +
                  " -o " + file("b.stl"))
                  .status,
              ExitCode::success);
    for (const char* extension : {"vtu", "mesh", "stl"})
        EXPECT_EQ(read_bytes(folder / (std::string("a.") + extension)),
                  read_bytes(folder / (std::string("b.") + extension)))
            << extension;
}

TEST_F(Command, InspectSaysWhatIsWrongByItsExitStatus)
{
    const std::string good = mesh_file("good.obj", icosphere(1.0, 2));
    Outcome result = run("inspect " + good);
    EXPECT_EQ(result.status, ExitCode::success) << result.err;
    EXPECT_NE(result.out.find("usable as it is"), std::string::npos) << result.out;

    const std::string open = mesh_file("open.obj", without_triangle(icosphere(1.0, 2), 3));
    result = run("inspect --json " + open + " -o " + file("defects.ply"));
    EXPECT_EQ(result.status, ExitCode::check_failed);
    EXPECT_EQ(result.err, "");
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_FALSE(json.at("usable").get<bool>());
    EXPECT_EQ(json.at("boundary_loops").size(), 1u);
    EXPECT_GT(std::filesystem::file_size(folder / "defects.ply"), 0u);
    expect_refusal("inspect " + open + " -o " + open, ExitCode::usage_error, {"is the input"});
    expect_refusal("inspect " + file("none.obj"), ExitCode::read_error, {"none.obj"});
}

TEST_F(Command, BuildRepairsWhenAsked)
{
    const TriangleMesh hollow = without_triangle(icosphere(1.0, 2), 3);
    const std::string open = mesh_file("open.obj", hollow);
    expect_refusal("build " + open + kCoarse + " -o " + file("s.vdb"), ExitCode::geometry_error,
                   {"3 boundary edges", "--repair"});
    const Outcome result = run("build --repair " + open + kCoarse + " -o " + file("s.vdb") +
                               " --report " + file("s.json"));
    ASSERT_EQ(result.status, ExitCode::success) << result.err;
    EXPECT_NE(result.out.find("hole at point"), std::string::npos) << result.out;
    const auto report = nlohmann::json::parse(read_bytes(folder / "s.json"));
    EXPECT_EQ(report.at("repair").at("holes").at(0).at("new_triangles"), 1);
    EXPECT_EQ(report.at("repair").at("kept_triangles"), hollow.triangles.size());
    EXPECT_TRUE(report.at("certificate").at("certified").get<bool>());
    EXPECT_EQ(run("check " + file("s.vdb")).status, ExitCode::success);
    const auto info = nlohmann::json::parse(run("info --json " + file("s.vdb")).out);
    EXPECT_EQ(info.at("parameters").at("repair").at("weld_tolerance"), 0.0);
    expect_refusal("build " + open + " --weld-tolerance 0.1 -q -o " + file("t.vdb"),
                   ExitCode::usage_error, {"--repair"});
}

TEST_F(Command, RepairWritesTheMendedSurface)
{
    const TriangleMesh hollow = without_triangle(icosphere(1.0, 2), 3);
    const std::string open = mesh_file("open.obj", hollow);
    const Outcome result = run("repair " + open + " -o " + file("closed.obj"));
    ASSERT_EQ(result.status, ExitCode::success) << result.err;
    const TriangleMesh closed = read_mesh(folder / "closed.obj").mesh;
    EXPECT_EQ(closed.triangles.size(), hollow.triangles.size() + 1);
    EXPECT_EQ(closed.points, hollow.points);
    EXPECT_NE(result.out, "");
    EXPECT_EQ(run("repair -q " + open + " -o " + file("again.obj")).out, "");
    EXPECT_EQ(read_bytes(folder / "again.obj"), read_bytes(folder / "closed.obj"));
    EXPECT_EQ(run("inspect " + file("closed.obj")).status, ExitCode::success);
    // A single triangle is a sheet: it is written, but nothing closes it.
    TriangleMesh sheet;
    sheet.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    sheet.triangles = {{0, 1, 2}};
    expect_refusal("repair " + mesh_file("sheet.obj", sheet) + " -o " + file("left.obj"),
                   ExitCode::check_failed, {"3 boundary edges", "--wrap"});
}

TEST_F(Command, InfoPrintsTheStoredFigures)
{
    const std::string sphere = mesh_file("sphere.obj", icosphere(1.0, 1));
    ASSERT_EQ(run("build " + sphere + kCoarse + " -o " + file("s.vdb")).status, ExitCode::success);
    const Outcome info = run("info --json " + file("s.vdb"));
    ASSERT_EQ(info.status, ExitCode::success) << info.err;
    const auto json = nlohmann::json::parse(info.out);
    EXPECT_EQ(json.at("parameters").at("level_set").at("resolution"), 24);
    EXPECT_EQ(json.at("report").at("source"), "sphere.obj");
}

TEST_F(Command, SameBytesForAnyNumberOfThreads)
{
    const std::string torus_file = mesh_file("torus.obj", torus(1.0, 0.4, 24, 12));
    std::vector<std::string> bytes;
    for (const char* threads : {"1", "2", "7"}) {
        const std::string name = std::string("t") + threads;
        ASSERT_EQ(run("--threads " + std::string(threads) + " build " + torus_file +
                      " --resolution 48 -o " + file(name + ".vdb") + " -o " + file(name + ".vtu") +
                      " -o " + file(name + ".png"))
                      .status,
                  ExitCode::success);
        bytes.push_back(read_bytes(folder / (name + ".vdb")) +
                        read_bytes(folder / (name + ".vtu")) +
                        read_bytes(folder / (name + ".png")));
    }
    EXPECT_EQ(bytes[0], bytes[1]);
    EXPECT_EQ(bytes[0], bytes[2]);
}

TEST_F(Command, RefusesBadInputAndLeavesTheOutputAlone)
{
    const std::string kept = "what stood here before";
    write_bytes(folder / "kept.vdb", kept);
    const std::string to_kept = " -o " + file("kept.vdb");
    const struct {
        const char *name, *bytes, *word;
    } kFiles[] = {{"empty.obj", "", "empty"},
                  {"nan.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n", "vertex"},
                  {"inf.obj", "v 0 0 0\nv 1 0 1e99\nv 0 1 0\nf 1 2 3\n", "vertex"},
                  {"range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n", "face"},
                  {"points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "face"},
                  {"mesh.xyz", "0 0 0\n", ".xyz"}};
    for (const auto& [name, bytes, word] : kFiles) {
        write_bytes(folder / name, bytes);
        expect_refusal("build " + file(name) + to_kept, ExitCode::read_error, {name, word});
    }
    expect_refusal("build " + file("none.obj") + to_kept, ExitCode::read_error, {"none.obj"});
    const std::string open = mesh_file("open.obj", without_triangle(icosphere(1.0, 1), 3));
    expect_refusal("build " + open + to_kept, ExitCode::geometry_error, {"open.obj", "boundary"});
    const std::string inside_out = mesh_file("inside_out.obj", reversed(icosphere(1.0, 1)));
    expect_refusal("build " + inside_out + to_kept, ExitCode::geometry_error,
                   {"inside_out.obj", "--turn-outward"});
    EXPECT_EQ(read_bytes(folder / "kept.vdb"), kept);
}

TEST_F(Command, RefusesBadOptionsAndOutputs)
{
    const std::string sphere = mesh_file("sphere.obj", icosphere(1.0, 1));
    const struct {
        std::string options;
        int code;
        std::vector<std::string> words;
    } kCases[] = {
        {"--voxel-size 3", ExitCode::geometry_error, {"voxel", "3"}},
        {"--voxel-size 2e-5", ExitCode::geometry_error, {"voxel", "GiB"}},
        {"--voxel-size 1e-6", ExitCode::geometry_error, {"voxel", "1e-06"}},
        {"--voxel-size 0", ExitCode::usage_error, {"voxel"}},
        {"--voxel-size 0.1 --resolution 9", ExitCode::usage_error, {"--resolution"}},
        {"--stop-test none", ExitCode::usage_error, {"stop test"}},
        {"--stop-test nonsense", ExitCode::usage_error, {"nonsense"}},
        {"--thickness-grid " + file("none.vdb"), ExitCode::read_error, {"none.vdb"}},
        {"-o " + file("out.abc"), ExitCode::usage_error, {"out.abc", ".abc"}},
        {"-o " + file("no_folder/out.vdb"), ExitCode::write_error, {"no_folder"}},
        {"-o " + sphere, ExitCode::usage_error, {"input"}},
        {"--metres-per-unit 0 -o " + file("a.usda"), ExitCode::usage_error, {"--metres-per-unit"}}};
    for (const auto& [options, code, words] : kCases) {
        const bool output = options.find("-o ") != std::string::npos;
        expect_refusal("build " + sphere + " " + options + (output ? "" : " -o " + file("a.vdb")),
                       code, words);
        EXPECT_FALSE(std::filesystem::exists(folder / "a.vdb")) << options;
    }
    expect_refusal("check " + sphere, ExitCode::read_error, {"sphere.obj"});
    expect_no_call("", {"subcommand"});
    expect_no_call("build", {"mesh"});
}

TEST_F(Command, DocumentationIsWhatHelpSays)
{
    const std::string page = read_bytes(VDB_SHELL_COMMAND_PAGE);
    std::vector<std::string> calls{"--help", "options"};
    const auto schema = nlohmann::json::parse(run("options --json").out);
    for (const auto& [name, command] : schema.at("commands").items())
        calls.push_back(name + " --help");
    for (const char* command : {"build", "pose", "volumes", "deform", "map"})
        EXPECT_EQ(std::count(calls.begin(), calls.end(), std::string(command) + " --help"), 1);
    for (const std::string& arguments : calls) {
        const Outcome help = run(arguments);
        EXPECT_EQ(help.status, ExitCode::success) << arguments;
        // Any page has an empty text in it.
        ASSERT_FALSE(help.out.empty()) << arguments;
        EXPECT_NE(page.find(help.out), std::string::npos)
            << "docs/command_line.md is not what `vdb_shell " << arguments
            << "` prints; run docs/scripts/command_line.py";
    }
}

TEST_F(Command, TurnsAnInsideOutMeshOnlyWhenAsked)
{
    const std::string inside_out = mesh_file("inside_out.obj", reversed(icosphere(1.0, 2)));
    const Outcome result =
        run("build --turn-outward " + inside_out + kCoarse + " --report " + file("r.json"));
    ASSERT_EQ(result.status, ExitCode::success) << result.err;
    const auto report = nlohmann::json::parse(read_bytes(folder / "r.json"));
    EXPECT_GT(report.at("volume").at("solid").get<double>(), 0.0);
}

TEST_F(Command, ASurfaceThatCrossesItselfIsRefusedOrCertifiedPrismByPrism)
{
    const std::string boxes =
        mesh_file("boxes.obj", joined(gridded_box({0, 0, 0}, {1, 1, 1}, 3),
                                      gridded_box({0.53, 0.57, 0.61}, {1.53, 1.57, 1.61}, 3)));
    expect_refusal("build " + boxes + kCoarse + " -o " + file("x.vtu"), ExitCode::geometry_error,
                   {"cross", "--allow-self-intersections"});
    const std::string allowed = "build " + boxes + kCoarse + " --allow-self-intersections";
    const Outcome grown = run(allowed + " -o " + file("g.vdb") + " -o " + file("g.vtu") +
                              " --report " + file("g.json"));
    ASSERT_EQ(grown.status, ExitCode::success) << grown.err;
    EXPECT_NE(grown.out.find("proven tet by tet; not certified"), std::string::npos) << grown.out;
    EXPECT_NE(read_bytes(folder / "g.vtu").find("Name=\"certified\""), std::string::npos);
    const auto report = nlohmann::json::parse(read_bytes(folder / "g.json"));
    EXPECT_FALSE(report.at("certificate").at("certified").get<bool>());
    EXPECT_EQ(report.at("overlaps").at("pairs").at("count"), 0);
    ASSERT_EQ(run("convert " + file("g.vdb") + " -o " + file("h.vtu")).status, ExitCode::success);
    EXPECT_EQ(read_bytes(folder / "h.vtu"), read_bytes(folder / "g.vtu"));
    const Outcome check = run("check " + file("g.vdb"));
    EXPECT_EQ(check.status, ExitCode::success) << check.out;
    EXPECT_NE(check.out.find("ok      overlaps are as stated"), std::string::npos) << check.out;

    const Outcome raw =
        run(allowed + " --method raw --stop-test none --thickness 0.4 -o " + file("r.vdb"));
    ASSERT_EQ(raw.status, ExitCode::check_failed) << raw.err;
    EXPECT_NE(raw.out.find("pairs of tets that overlap"), std::string::npos) << raw.out;
    EXPECT_EQ(run("check " + file("r.vdb")).status, ExitCode::success);

    // An edge of four triangles stays refused.
    TriangleMesh edge = joined(box({0, 0, 0}, {1, 1, 1}), box({1, 1, 0}, {2, 2, 1}));
    expect_refusal("build " + mesh_file("edge.obj", edge) + kCoarse +
                       " --allow-self-intersections -o " + file("x.vtu"),
                   ExitCode::geometry_error, {"edge of three or more"});
}

TEST_F(Command, ThicknessIsNeverExceeded)
{
    const std::string sphere = mesh_file("sphere.obj", icosphere(1.0, 2));
    const Outcome result =
        run("build " + sphere + kCoarse + " --thickness 0.25 --report " + file("r.json"));
    ASSERT_EQ(result.status, ExitCode::success) << result.err;
    const auto report = nlohmann::json::parse(read_bytes(folder / "r.json"));
    EXPECT_LE(report.at("lines").at("length").at("max").get<double>(), 0.25);
    EXPECT_NEAR(report.at("lines").at("length").at("median").get<double>(), 0.25, 1e-6);
}

TEST_F(Command, WrapsAnOpenSurfaceAndBuildsFromItsOwnVdb)
{
    const std::string open = mesh_file("open.obj", without_triangle(icosphere(1, 2), 3));
    const std::string quick = " --resolution 32 --samples 0 ";
    expect_refusal("build " + open + quick, ExitCode::geometry_error, {"open.obj"});
    const Outcome wrapped =
        run("build " + open + quick + "--wrap --wrap-resolution 24 --field dense -o " +
            file("a.vdb")); // a band deep enough to be stepped through again
    EXPECT_EQ(wrapped.status, ExitCode::success) << wrapped.err;
    EXPECT_NE(wrapped.out.find("input to wrap"), std::string::npos) << wrapped.out;

    const Outcome again =
        run("build " + file("a.vdb") + ":surface" + quick + "-o " + file("b.obj"));
    EXPECT_EQ(again.status, ExitCode::success) << again.err;
    EXPECT_NE(again.out.find("as given"), std::string::npos) << again.out;
    expect_refusal("build " + file("a.vdb") + ":depth" + quick, ExitCode::geometry_error,
                   {"a.vdb", "depth", "fog volume"});
    expect_refusal("build " + file("a.vdb") + quick + "-o " + file("a.vdb"), ExitCode::usage_error,
                   {"a.vdb"});
    expect_refusal("build " + file("a.vdb") + quick + "--wrap", ExitCode::usage_error, {"a.vdb"});
}

} // namespace
} // namespace vdb_shell::test
