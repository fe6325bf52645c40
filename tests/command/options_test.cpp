// SPDX-License-Identifier: Apache-2.0
#include "command_fixture.h"
#include "support/shapes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <set>
#include <sstream>
#include <string>

namespace vdb_shell::test
{
namespace
{

using command::ExitCode;
using nlohmann::json;

class Options : public Command
{
protected:
    std::string preset(const std::string& text)
    {
        write_bytes(folder / "preset.json", text);
        return " --options " + file("preset.json") + " ";
    }

    json report_of(const std::string& arguments)
    {
        const Outcome result = run("build -q --report " + file("r.json") + " " + arguments);
        EXPECT_EQ(result.status, ExitCode::success) << result.err;
        return json::parse(read_bytes(folder / "r.json"));
    }

    /// The parameters that the build stores.
    json parameters_of(const std::string& arguments)
    {
        const Outcome result = run("build -q -o " + file("p.vdb") + " " + arguments);
        EXPECT_EQ(result.status, ExitCode::success) << result.err;
        return json::parse(run("info --json " + file("p.vdb")).out).at("parameters");
    }
};

TEST_F(Options, ImpossibleOnesAreRefusedByTheirFlagsBeforeAnyFileIsRead)
{
    const std::string build = "build " + file("none.obj") + " -o " + file("x.vdb") + " ";
    const auto refused = [&](const std::string& given, const std::string& said) {
        expect_refusal(build + given, ExitCode::usage_error, {said});
    };
    refused("--thickness -1", "--thickness is -1, must be above 0");
    refused("--min-quality 2", "--min-quality is 2, must be 0 or more and less than 1");
    refused("--decimate-to -5", "--decimate-to is -5, must be a whole number");
    refused("--samples -1", "--samples is -1, must be a whole number");
    refused("--rho nan", "--rho is nan, must be");
    refused("--layers 1.5", "--layers is 1.5, must be a whole number");
    refused("--resolution many", "--resolution is many, must be a whole number");
    refused("--method fast", "--method is fast, must be one of raw, certified, thickest");
    refused("--refine-rounds 1 --side outward", "--refine-rounds");
    refused("--stop-test none", "stop test is none");
    refused("--voxel-size 1 --resolution 9", "--resolution excludes --voxel-size");
    refused("--thickest --method raw", "--thickest excludes --method");
    refused("--retriangulate-tolerance 1", "--retriangulate-tolerance needs --retriangulate");
    refused("--retriangulate --retriangulate-tolerance -1",
            "--retriangulate-tolerance is -1, must be above 0");
    refused("--decimate-tolerance 1", "--decimate-tolerance needs --decimate-to");
    refused("--remesh-edge-length 0", "--remesh-edge-length is 0, must be above 0");
    refused("--remesh-to 3", "--remesh-to is 3, must be 4 or more");
    refused("--remesh-to 300 --remesh-edge-length 1", "--remesh-to excludes --remesh-edge-length");
    refused("--remesh-tolerance 1", "--remesh-tolerance needs --remesh-edge-length or --remesh-to");
    refused("--remesh-map m.json", "--remesh-map needs --remesh-edge-length or --remesh-to");
    refused("--remesh-feature-angle 1",
            "--remesh-feature-angle needs --remesh-edge-length or --remesh-to");
    refused("--remesh-to 300 --remesh-map m.txt", "unknown extension \".txt\" for a remesh map");
    refused("--remesh-to 300 --decimate-to 300", "decimate and remesh: one or the other");
    expect_refusal("inspect " + file("none.obj") + " --voxel-size 0", ExitCode::usage_error,
                   {"--voxel-size is 0, must be above 0"});
    expect_refusal("repair " + file("none.obj") + " -o x.obj --sliver-height -2",
                   ExitCode::usage_error, {"--sliver-height is -2, must be 0 or more"});
}

TEST_F(Options, OnesWithoutTheirPartnerAreRefused)
{
    const std::string build = "build " + file("none.obj") + " -o " + file("x.vtu") + " ";
    const std::pair<const char*, const char*> lonely[] = {
        {"--half", "--output .vdb"},
        {"--points beside", "--output .vdb"},
        {"--up-axis z", "--output .usda"},
        {"--metres-per-unit 2", "--output .usda"},
        {"--section-axis x", "--output .png"},
        {"--section-position 0.3", "--output .png"},
        {"--picture-width 64", "--output .png"},
        {"--wrap-voxel-size 1", "--wrap or --mend"},
        {"--wrap-resolution 64", "--wrap or --mend"},
        {"--wrap-adaptivity 1", "--wrap or --mend"},
        {"--wrap-sheet 2", "--wrap or --mend"},
        {"--wrap-keep-voids", "--wrap or --mend"},
        {"--perturb-seed 2", "--perturb"},
        {"--ripple-seed 2", "--split ripple"},
        {"--layer-grading 2", "--layers"},
        {"--stop-test none --thickness 1 --rho 0.5",
         "--stop-test normal start-gradient relative-normal"},
        {"--distance-threshold 2", "--stop-test distance bisection"},
        {"--stop-test distance --bisection-iterations 9", "--stop-test bisection"},
        {"--reference 2", "--stop-test relative-normal own-sheet"},
        {"--sheet-angle 0.2", "--stop-test own-sheet"},
        {"--core-fill-ratio 2", "--core-fill tetgen"},
        {"--core-fill gmsh --core-fill-ratio 2", "--core-fill tetgen"},
        {"--core-fill-edge-length 2", "--core-fill"},
        {"--core-fill-seconds 2", "--core-fill"},
        {"--core-reach 0.3", "--core"},
        {"--contour-adaptivity 0.5", "a level set"},
        {"--method raw --min-quality 0.1", "--method certified thickest"},
        {"--method raw --free-rounds 4", "--method certified thickest"},
        {"--method raw --coarse-from 0", "--method certified thickest"}};
    for (const auto& [given, needed] : lonely) {
        const std::string flags(given), last = flags.substr(flags.rfind("--"));
        expect_refusal(build + flags, ExitCode::usage_error,
                       {last.substr(0, last.find(' ')) + " needs " + needed});
    }
    expect_refusal(build + "--core stitched", ExitCode::usage_error,
                   {"--core stitched needs --taper"});
    expect_refusal("convert " + file("none.vdb") + " --half -o " + file("x.vtu"),
                   ExitCode::usage_error, {"--half needs --output .vdb"});
    // With its partner, also from a file or in capitals, or turned off: on to the missing surface.
    for (const std::string& fine :
         {std::string("--wrap-sheet 2 --wrap"),
          preset(R"({"wrap": {"wanted": true}})") + "--wrap-sheet 2", "--half -o " + file("y.VDB"),
          std::string("--no-half --no-wrap-keep-voids"), std::string("--core stitched --taper"),
          std::string("--core free"), std::string("--layers-auto --layer-grading 2")})
        expect_refusal(build + fine, ExitCode::read_error, {"none.obj"});
}

TEST_F(Options, RemeshingReportsWhatItDidAndWritesItsMap)
{
    const TriangleMesh input = icosphere(1.0, 3);
    const json report = report_of(mesh_file("sphere.obj", input) + kCoarse +
                                  " --remesh-edge-length 0.25 --remesh-map " + file("map.json"));
    const json& remesh = report.at("remesh");
    EXPECT_EQ(remesh.at("triangles_before"), 1280);
    EXPECT_EQ(remesh.at("triangles"), report.at("mesh").at("triangles"));
    EXPECT_EQ(remesh.at("edge_length"), 0.25);
    EXPECT_GT(remesh.at("after").at("min_angle_degrees"), 30);
    EXPECT_LE(remesh.at("result_to_input").at("max"), remesh.at("tolerance"));
    const json map = json::parse(read_bytes(folder / "map.json"));
    EXPECT_EQ(map.at("input_on_result").at("weights").size(), input.points.size());
    EXPECT_EQ(map.at("result_on_input").at("weights").size(), report.at("mesh").at("points"));
}

TEST_F(Options, FlagsWinOverAFileOfOptions)
{
    const std::string sphere = mesh_file("sphere.obj", icosphere(1.0, 1));
    const std::string some = preset(R"({"line_step": {"thickness": 0.25}, "grow": {"flips": false},
        "level_set": {"resolution": 24}, "repair": {"sliver_height": 0.001},
        "coverage": {"samples": 0}, "vdb": {"half": true}})");
    const json given = parameters_of(sphere + some);
    EXPECT_EQ(given.at("line_step").at("thickness"), 0.25);
    EXPECT_EQ(given.at("level_set").at("resolution"), 24);
    EXPECT_EQ(given.at("grow").at("flips"), false);
    EXPECT_EQ(given.at("repair").at("sliver_height"), 0.001);
    const json over =
        parameters_of(sphere + some + "--thickness 0.125 --flips --no-repair --voxel-size 0.125");
    EXPECT_EQ(over.at("line_step").at("thickness"), 0.125);
    EXPECT_EQ(over.at("level_set").at("voxel_size"), 0.125);
    EXPECT_EQ(over.at("grow").at("flips"), true);
    EXPECT_TRUE(over.at("repair").is_null());
    EXPECT_EQ(over.at("coverage").at("samples"), 0);
    // Of two that exclude each other the flag holds.
    const std::string voxels = preset(R"({"level_set": {"voxel_size": 0.5}})");
    EXPECT_TRUE(parameters_of(sphere + voxels + "--resolution 20")
                    .at("level_set")
                    .at("voxel_size")
                    .is_null());
}

TEST_F(Options, WhatInfoPrintsRepeatsABuild)
{
    const std::string sphere = mesh_file("sphere.obj", icosphere(1.0, 1));
    const json first = parameters_of(sphere + " --resolution 20 --thickness 0.25 --layers 2");
    const std::string all = run("info --json " + file("p.vdb")).out;
    EXPECT_EQ(parameters_of(sphere + preset(all)), first);
}

TEST_F(Options, AFileOfOptionsServesAllCommands)
{
    const std::string sphere = mesh_file("sphere.obj", icosphere(1.0, 1));
    const std::string some =
        preset(R"({"level_set": {"resolution": 12}, "repair": {"cut_crossings": true}})");
    const json inspection = json::parse(run("inspect --json " + sphere + some).out);
    const json plain = json::parse(run("inspect --json " + sphere + " --resolution 12").out);
    EXPECT_EQ(inspection, plain);
    EXPECT_EQ(run("repair " + sphere + some + "-o " + file("r.obj")).status, ExitCode::success);
}

TEST_F(Options, AFileOfOptionsSaysHowPosesAreMended)
{
    const std::string sphere = mesh_file("sphere.obj", icosphere(1.0, 1));
    const std::string shell = file("s.vdb");
    ASSERT_EQ(run("build " + sphere + kCoarse + " -o " + shell).status, ExitCode::success);
    const std::string pose = "pose " + shell + " " + sphere + " --report - ";
    EXPECT_EQ(run(pose + preset(R"({"pose": {"rounds": 3}})")).status, ExitCode::success);
    expect_refusal(pose + preset(R"({"pose": {"rounds": -1}})"), ExitCode::usage_error,
                   {"preset.json: pose.rounds is -1, must be 0 or more"});
    expect_refusal(pose + preset(R"({"pose": {"round": 3}})"), ExitCode::usage_error,
                   {"preset.json: pose.round is no option"});
    // The file serves `build` too, which has no use for it.
    EXPECT_EQ(
        run("build " + sphere + kCoarse + " -o " + shell + preset(R"({"pose": {"rounds": 3}})"))
            .status,
        ExitCode::success);
}

TEST_F(Options, AFileOfOptionsIsHeldToWhatThereIs)
{
    const std::string build = "build none.obj -o " + file("x.vdb");
    expect_refusal(build + preset(R"({"line_step": {"thicknes": 1}})"), ExitCode::usage_error,
                   {"preset.json: line_step.thicknes is no option"});
    expect_refusal(build + preset(R"({"line_step": {"thickness": -1}})"), ExitCode::usage_error,
                   {"preset.json: line_step.thickness is -1, must be above 0"});
    expect_refusal("repair none.obj -o x.obj" + preset(R"({"colour": 1})"), ExitCode::usage_error,
                   {"preset.json: colour is no option"});
    expect_refusal(build + preset("{"), ExitCode::read_error, {"preset.json"});
    expect_refusal(build + " --options " + file("none.json"), ExitCode::read_error, {"none.json"});
}

TEST_F(Options, AFileOfOptionsMayBeAnything)
{
    const std::string build = "build none.obj -o " + file("x.vdb");
    const auto refused = [&](const std::string& text, int status, const std::string& said) {
        expect_refusal(build + preset(text), status, {"preset.json: " + said});
        EXPECT_LT(read_bytes(folder / "err").size(), 1000u);
    };
    constexpr std::size_t kDeep = 200000, kLarge = 400000;
    std::string objects;
    for (std::size_t i = 0; i < kDeep; ++i)
        objects += R"({"a":)";
    // Copies and texts of such values are recursive.
    refused(std::string(kDeep, '[') + std::string(kDeep, ']'), ExitCode::read_error, "its JSON");
    refused(objects + "1" + std::string(kDeep, '}'), ExitCode::read_error, "its JSON has more");
    const std::string large(kLarge, 'x');
    refused(R"({"line_step": {"thickness": ")" + large + "\"}}", ExitCode::usage_error,
            "line_step.thickness is xxx");
    refused(R"({"line_step": ")" + large + "\"}", ExitCode::usage_error, "line_step is \"xxx");
    refused(R"({"vdb": {"half": [")" + large + "\"]}}", ExitCode::usage_error, "vdb.half is [");
    refused("{\"" + large + "\": 1}", ExitCode::usage_error, "xxx");
    refused("{\"" + large, ExitCode::read_error, "is no JSON");
    refused(R"({"parameters": 3})", ExitCode::usage_error, "parameters is 3, must be an object");
    refused(R"({"": 3})", ExitCode::usage_error, "\"\" is no option");
    refused(R"({"level_set": {"resolutoin": 20}})", ExitCode::usage_error,
            "level_set.resolutoin is no option; near it: resolution");
    refused(R"({"resolution": 20})", ExitCode::usage_error,
            "resolution is no option; near it: wrap.resolution, level_set.resolution");
    refused(R"({"level_set": {"resolution": 20.5}})", ExitCode::usage_error,
            "level_set.resolution is 20.5, must be a whole number");
    expect_refusal("build none.obj -o x.vdb" + preset(R"({"level_set": {"resolution": 20.0}})"),
                   ExitCode::read_error, {"none.obj"});
    // It is read for the plan and again for the run, and a pipe is empty then.
    expect_refusal(build + " --options /dev/fd/3 3</dev/null", ExitCode::read_error,
                   {"not a regular"});
}

TEST_F(Options, UnknownWordsAreNamed)
{
    for (const char* words : {"bogus", "--threads 1 bogus"}) {
        const Outcome result = run(words);
        EXPECT_EQ(result.status, ExitCode::usage_error);
        EXPECT_EQ(result.err.rfind("vdb_shell: bogus is no command\n", 0), 0u) << result.err;
    }
    expect_no_call("bild cube.obj", {"bild is no command; near it: build\n"});
    // The option before what may be its value, with those that may be meant; and nothing is read.
    expect_no_call("build --resolutoin 5 none.obj",
                   {"--resolutoin is no option of build; near it: --resolution\n"});
    expect_no_call("build none.obj other.obj --bogus=3", {"--bogus is no option of build\n"});
    expect_no_call("inspect none.obj --section s.png", {"--section is no option of inspect"});
    expect_no_call("build none.obj --section s.png",
                   {"near it: --section-axis, --section-position\n"});
    expect_no_call("build none.obj other.obj", {"other.obj is one word too many for build\n"});
    expect_no_call("build none.obj -- --layers",
                   {"--layers is one word too many for build; behind --"});
    const Outcome told = run("--errors json build none.obj --layres 2");
    EXPECT_EQ(json::parse(told.err).at("option"), "--layres") << told.err;
    for (const std::string& command :
         {"build cube -o " + file("x.vdb"), std::string("inspect cube")})
        expect_refusal(command, ExitCode::read_error, {"cube: ", ".obj", ".bgeo.sc", ".vdb"});
}

TEST_F(Options, TheToleranceOfDecimationIsRescaledToo)
{
    constexpr double kSmall = 1e-3;
    TriangleMesh mesh = icosphere(1.0, 3);
    const std::string large = mesh_file("large.obj", mesh);
    for (openvdb::Vec3s& p : mesh.points)
        p *= float(kSmall);
    const std::string small = mesh_file("small.obj", mesh);
    const std::string decimate = kCoarse + std::string(" --decimate-to 100 --decimate-tolerance ");
    const json whole = report_of(large + decimate + "0.02").at("decimate").at("triangles");
    EXPECT_EQ(report_of(large + decimate + "0.02 --rescale").at("decimate").at("triangles"), whole);
    EXPECT_EQ(report_of(small + decimate + "0.00002 --rescale").at("decimate").at("triangles"),
              report_of(small + decimate + "0.00002").at("decimate").at("triangles"));
    EXPECT_GT(whole.get<int>(), 100); // the tolerance is what held it back
}

TEST_F(Options, InspectAndRepairTakeHoudinisFiles)
{
    // A box without its lid, clockwise seen from outside.
    write_bytes(
        folder / "box.geo",
        R"(["pointcount",8,"vertexcount",20,"primitivecount",5,"topology",["pointref",["indices",
                [0,1,2,3,7,6,5,4,0,4,5,1,1,5,6,2,2,6,7,3]]],"attributes",["pointattributes",[[
                ["type","numeric","name","P"],["size",3,"storage","fpreal32","values",["size",3,"tuples",
                [[0,0,0],[1,0,0],[1,1,0],[0,1,0],[0,0,1],[1,0,1],[1,1,1],[0,1,1]]]]]]],
                "primitives",[[["type","Polygon_run"],["startvertex",0,"nprimitives",5,"nvertices_rle",[4,5]]]]])");
    const Outcome inspected = run("inspect --json " + file("box.geo"));
    EXPECT_EQ(inspected.status, ExitCode::check_failed) << inspected.err;
    EXPECT_EQ(json::parse(inspected.out).at("boundary_loops").size(), 1u);
    const Outcome repaired = run("repair " + file("box.geo") + " -o " + file("box.obj"));
    EXPECT_EQ(repaired.status, ExitCode::success) << repaired.err;
    EXPECT_EQ(run("inspect " + file("box.obj")).status, ExitCode::success);
}

std::set<std::string> flags_in(const std::string& help)
{
    std::set<std::string> flags;
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("  -", 0) != 0)
            continue;
        // "-o, --output TEXT   Where to": names end where none follows after a comma.
        std::istringstream words(line);
        for (std::string name; words >> name;) {
            const bool is_last = name.back() != ',';
            flags.insert(is_last ? name : name.substr(0, name.size() - 1));
            if (is_last)
                break;
        }
    }
    return flags;
}

TEST_F(Options, TheSchemaHasEveryFlagOfTheHelp)
{
    const json schema = json::parse(run("options --json").out);
    for (const auto& [name, command] : schema.at("commands").items()) {
        std::set<std::string> known{"-h", "--help"};
        for (const json& option : command.at("options")) {
            if (!option.at("shorthand").is_null())
                known.insert(option.at("shorthand").get<std::string>());
            for (const json& other : option.at("names"))
                known.insert(other.get<std::string>());
            if (option.at("flag").is_null())
                continue;
            const auto flag = option.at("flag").get<std::string>();
            known.insert(flag);
            EXPECT_EQ(option.at("negation").is_null(), option.at("type") != "flag") << flag;
            if (!option.at("negation").is_null())
                known.insert(option.at("negation").get<std::string>());
        }
        EXPECT_EQ(flags_in(run(name + " --help").out), known) << name;
    }
    EXPECT_GE(schema.at("commands").size(), 7u);
    EXPECT_EQ(schema.at("options").at(0).at("flag"), "--threads");
}

TEST_F(Options, TheSchemaSaysWhatThereIsToKnow)
{
    const json schema = json::parse(run("options --json").out);
    for (const json& option : schema.at("commands").at("build").at("options"))
        if (option.at("flag") == "--min-quality") {
            EXPECT_EQ(option.at("key"), "grow.min_quality");
            EXPECT_EQ(option.at("type"), "number");
            EXPECT_EQ(option.at("range"), (json{{"at_least", 0.0}, {"below", 1.0}}));
            EXPECT_EQ(option.at("default"), 0.0);
            EXPECT_EQ(option.at("group"), "Growth");
            return;
        }
    FAIL() << "there is no --min-quality";
}

TEST_F(Options, BashCompletesCommandsFlagsAndChoices)
{
    const Outcome script = run("options --complete bash");
    ASSERT_EQ(script.status, ExitCode::success) << script.err;
    write_bytes(folder / "complete.sh", script.out);
    const auto completed = [&](const std::string& words, int at) {
        write_bytes(folder / "ask.sh", "set -eu\n. " + file("complete.sh") + "\nCOMP_WORDS=(" +
                                           words + ")\nCOMP_CWORD=" + std::to_string(at) +
                                           "\n_vdb_shell || true\necho \"${COMPREPLY[@]-}\"\n");
        const std::string line = "bash " + file("ask.sh") + " >" + file("said") + " 2>&1";
        EXPECT_EQ(std::system(line.c_str()), 0) << read_bytes(folder / "said");
        return read_bytes(folder / "said");
    };
    EXPECT_EQ(completed("vdb_shell bu", 1), "build\n");
    EXPECT_EQ(completed("vdb_shell build --thickness-", 2), "--thickness-scale --thickness-grid\n");
    EXPECT_EQ(completed("vdb_shell build --no-fl", 2), "--no-flips\n");
    EXPECT_EQ(completed("vdb_shell build --method ''", 3), "raw certified thickest\n");
    EXPECT_EQ(completed("vdb_shell build --method t", 3), "thickest\n");
    EXPECT_EQ(completed("vdb_shell build " + file("complete"), 2), file("complete.sh") + "\n");
    EXPECT_EQ(completed("vdb_shell check --thick", 2), "\n");
    EXPECT_EQ(completed("vdb_shell check --keep", 2), "--keep-going\n");
    EXPECT_EQ(completed("vdb_shell check --progress j", 3), "json\n");
    expect_refusal("options --complete fish", ExitCode::usage_error, {"fish", "bash"});
}

TEST_F(Options, ABoundThatIsNotMetIsReportedAndTheShellIsWritten)
{
    const std::string box = mesh_file("box.obj", test::box(openvdb::Vec3d(-1), openvdb::Vec3d(1)));
    const std::string build = "build " + box + kCoarse + " --taper -o " + file("b.vdb");
    // Two tets share the right angle at an edge of a box.
    const Outcome missed = run(build + " --want-dihedral 0.8");
    EXPECT_EQ(missed.status, ExitCode::bound_not_met) << missed.err;
    EXPECT_NE(missed.out.find("NOT MET"), std::string::npos) << missed.out;
    EXPECT_NE(missed.out.find("surface-edge"), std::string::npos) << missed.out;
    EXPECT_EQ(run("check " + file("b.vdb")).status, ExitCode::success);
    const Outcome met = run(build + " --want-dihedral 0.78 --want-fill 0.999 --want-tets 12");
    EXPECT_EQ(met.status, ExitCode::success) << met.out << met.err;
}

TEST_F(Options, ContradictoryWishesAreRefusedByNameAndLeaveTheOutputAlone)
{
    const std::string box = mesh_file("box.obj", test::box(openvdb::Vec3d(-1), openvdb::Vec3d(1)));
    ASSERT_EQ(run("build " + box + kCoarse + " -o " + file("b.vdb")).status, ExitCode::success);
    const std::string before = read_bytes(folder / "b.vdb");
    const auto refused = [&](const std::string& wishes, const std::vector<std::string>& words) {
        expect_refusal("build " + box + " " + wishes + " -o " + file("b.vdb"),
                       ExitCode::usage_error, words);
        EXPECT_EQ(read_bytes(folder / "b.vdb"), before) << wishes;
    };
    refused("--for fewest-tets --layers 6", {"--for fewest-tets", "--layers"});
    refused("--for fewest-tets --layers auto", {"--for fewest-tets", "--layers"});
    refused("--for fewest-tets --subdivide 1", {"--for fewest-tets", "--subdivide"});
    refused("--for simulation --no-taper", {"--for simulation", "--no-taper"});
    refused("--for thickness --method raw", {"--for thickness", "--method"});
    refused("--for speed --coarse-from 0", {"--for speed", "--coarse-from"});
    refused("--for speed --side outward", {"--for speed", "--side"});
    refused("--thickest --prism-test twelve-tets", {"--prism-test", "--method certified"});
    refused("--for thickness --taper-tet-cost 4", {"--taper-tet-cost", "--taper"});
    refused("--want-amips 5 --method raw", {"--want", "--method"});
    refused("--want-fill 0.9 --side outward", {"--want-fill", "--side"});
    refused("--enough-fill 0.9 --side outward", {"--enough-fill", "--side"});
    refused("--enough-fill 0.9 --method raw", {"--enough-fill", "--method"});
    refused("--enough-fill 0", {"--enough-fill"});
    refused("--want-dihedral 1.24", {"--want-dihedral"});
    refused("--want-tets 11", {"--want-tets", "12 triangles"});
}

} // namespace
} // namespace vdb_shell::test
