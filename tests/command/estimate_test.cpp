// SPDX-License-Identifier: Apache-2.0
#include "command_fixture.h"
#include "support/shapes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

// What a build would cost, held against a build (docs/farm.md has the model and its errors).

namespace vdb_shell::test
{
namespace
{

using command::ExitCode;
using nlohmann::json;

// The address sanitizer keeps freed memory for a while, so that a peak is no longer what a build
// needs.
#if defined(__SANITIZE_ADDRESS__)
#define VDB_SHELL_FREED_MEMORY_IS_KEPT
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define VDB_SHELL_FREED_MEMORY_IS_KEPT
#endif
#endif

class Estimate : public Command
{
protected:
    json estimate(const std::string& words)
    {
        const Outcome result = run("--threads 1 estimate --report - " + words);
        EXPECT_EQ(result.status, ExitCode::success) << result.err;
        return json::parse(result.out);
    }

    json of(const std::string& words) { return estimate(words).at("meshes").at(0); }
};

TEST_F(Estimate, ItIsNearWhatABuildTakes)
{
    const std::string sphere = mesh_file("s.obj", icosphere(1.0, 4));
    const std::string options =
        sphere + " --resolution 128 -o " + file("s.vdb") + " -o " + file("s.vtu") + " --layers 2";
    const json guess = of(options);
    EXPECT_FALSE(std::filesystem::exists(folder / "s.vdb"));
    ASSERT_EQ(run("build " + options + " --report " + file("s.json")).status, ExitCode::success);
    const json report = json::parse(read_bytes(folder / "s.json"));
    EXPECT_EQ(guess.at("triangles"), report.at("mesh").at("triangles"));
    EXPECT_DOUBLE_EQ(guess.at("voxel_size").get<double>(),
                     report.at("field").at("voxel_size").get<double>());
    double peak = 0;
    for (const json& stage : report.at("stages"))
        peak = std::max(peak, stage.at("peak_memory_bytes").get<double>());
    EXPECT_LT(guess.at("memory_bytes").get<double>(), 2 * peak);
#if !defined(VDB_SHELL_FREED_MEMORY_IS_KEPT)
    EXPECT_GT(guess.at("memory_bytes").get<double>(), peak / 2);
#endif
    const double disk = double(std::filesystem::file_size(folder / "s.vdb")) +
                        double(std::filesystem::file_size(folder / "s.vtu"));
    EXPECT_LT(guess.at("disk_bytes").get<double>(), 3 * disk);
    EXPECT_GT(guess.at("disk_bytes").get<double>(), disk / 3);
}

TEST_F(Estimate, MoreWorkCostsMore)
{
    const std::string sphere = mesh_file("s.obj", icosphere(1.0, 3));
    const json base = of(sphere);
    const auto seconds = [&](const std::string& more) {
        return of(sphere + " " + more).at("seconds").get<double>();
    };
    const double plain = base.at("seconds").get<double>();
    EXPECT_GT(seconds("--subdivide 1"), plain);
    EXPECT_LT(seconds("--decimate-to 100"), plain);
    EXPECT_GT(seconds("--resolution 512"), plain);
    EXPECT_GT(seconds("--layers 4"), plain);
    EXPECT_LT(json::parse(run("--threads 2 estimate " + sphere + " --report -").out)
                  .at("seconds")
                  .get<double>(),
              plain);
    const std::string large = mesh_file("large.obj", icosphere(1.0, 5));
    const auto processor = [&](const std::string& more) {
        return of(large + " " + more).at("cpu_seconds").get<double>();
    };
    EXPECT_LT(processor("--for speed"), processor(""));
    EXPECT_EQ(processor("--for speed"), processor("--prism-test chosen-tets --enough-fill .95"));
    EXPECT_EQ(processor("--prism-test chosen-tets"), processor("")) << "as long or less";
    EXPECT_GT(processor("--thickest"), processor(""));
    EXPECT_GT(processor("--thickest --layers 3"), processor("--thickest"));
    EXPECT_EQ(base.at("disk_bytes"), 0) << "nothing would be written";
    for (const char* extension : {".vdb", ".vtu", ".obj"}) {
        std::string capitals = extension;
        std::transform(capitals.begin(), capitals.end(), capitals.begin(),
                       [](unsigned char c) { return char(std::toupper(c)); });
        const json bytes = of(sphere + " -o " + file("t") + extension).at("disk_bytes");
        EXPECT_GT(bytes, 0);
        EXPECT_EQ(of(sphere + " -o " + file("T") + capitals).at("disk_bytes"), bytes);
    }
    EXPECT_EQ(of(sphere + " --subdivide 2").at("triangles"), 20 * 64 * 16);
    // Lengths of a surface in a unit of its own are in that of its file.
    const std::string small = mesh_file("small.obj", icosphere(1e-3, 3));
    EXPECT_NEAR(of(small + " --rescale").at("voxel_size").get<double>(),
                1e-3 * base.at("voxel_size").get<double>(), 1e-9);
}

TEST_F(Estimate, WhatItDoesNotKnowIsSaid)
{
    const std::string sphere = mesh_file("s.obj", icosphere(1.0, 2));
    EXPECT_EQ(of(sphere).at("not_counted"), json::array());
    EXPECT_EQ(of(sphere + " --side both --taper").at("not_counted"), json({"--side", "--taper"}));
    EXPECT_EQ(of(sphere + " --thickest").at("not_counted"), json::array());
    EXPECT_EQ(of(sphere + " --method raw").at("not_counted"), json({"--method raw"}));
    const std::string plate = mesh_file("plate.obj", needled_plate(100));
    const json beside = of(plate).at("not_counted");
    ASSERT_EQ(beside.size(), 1u);
    EXPECT_NE(std::string(beside[0]).find("needles"), std::string::npos) << beside;
    EXPECT_EQ(of(plate + " --remesh-to 1000").at("not_counted"), json({"--remesh"}));
    const Outcome text = run("estimate " + sphere + " " + sphere + " --wrap");
    EXPECT_NE(text.out.find("s.obj: 320 triangles"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("not counted: --wrap"), std::string::npos) << text.out;
    const json two = estimate(sphere + " " + sphere);
    EXPECT_EQ(two.at("seconds").get<double>(),
              2 * two.at("meshes").at(0).at("seconds").get<double>());
    ASSERT_EQ(run("build " + sphere + kCoarse + "-q -o " + file("s.vdb")).status,
              ExitCode::success);
    expect_refusal("estimate " + file("s.vdb"), ExitCode::usage_error, {"s.vdb", "level set"});
    expect_refusal("estimate " + file("none.obj"), ExitCode::read_error, {"none.obj"});
    expect_refusal("estimate " + sphere + " --thickness -1", ExitCode::usage_error,
                   {"--thickness"});
}

TEST_F(Estimate, ItsReportIsAnOutputAsOthersAre)
{
    const std::string sphere = mesh_file("s.obj", icosphere(1.0, 2));
    write_bytes(folder / "r.json", "old");
    expect_refusal("estimate " + sphere + " --no-clobber --report " + file("r.json"),
                   ExitCode::write_error, {"r.json", "--no-clobber"});
    EXPECT_EQ(read_bytes(folder / "r.json"), "old");
    std::filesystem::rename(folder / "s.obj", folder / "caf\xe9.obj");
    EXPECT_EQ(of(file("caf\xe9.obj")).at("triangles"), 320);
    EXPECT_EQ(run("estimate " + file("caf\xe9.obj") + " --report " + file("r.json")).status,
              ExitCode::success);
    EXPECT_EQ(json::parse(read_bytes(folder / "r.json")).at("meshes").size(), 1u);
}

TEST_F(Estimate, WholeCallsStandBehindTwoDashes)
{
    const TriangleMesh sphere = icosphere(1.0, 4);
    const std::string rest = file("rest.vdb"), posed = mesh_file("p.1.obj", sphere);
    mesh_file("p.2.obj", sphere);
    ASSERT_EQ(run("build " + posed + " --resolution 64 -q -o " + rest).status, ExitCode::success);
    const std::string pose =
        "pose " + rest + " " + file("p.#.obj") + " --frames 1-2 -o " + file("q.#.vdb");
    const json frames = estimate("-- " + pose);
    const json& one = frames.at("meshes").at(0);
    EXPECT_EQ(one.at("command"), "pose");
    EXPECT_EQ(one.at("frames"), 2);
    EXPECT_EQ(one.at("triangles"), sphere.triangles.size());
    EXPECT_EQ(one.at("not_counted"), json::array());
    EXPECT_NEAR(frames.at("seconds").get<double>(), 2 * one.at("seconds").get<double>(), 1e-9);
    EXPECT_NEAR(frames.at("disk_bytes").get<double>(), 2 * one.at("disk_bytes").get<double>(), 2);
    ASSERT_EQ(run(pose + " -q").status, ExitCode::success);
    const double disk = double(std::filesystem::file_size(folder / "q.1.vdb"));
    EXPECT_LT(one.at("disk_bytes").get<double>(), 3 * disk);
    EXPECT_GT(one.at("disk_bytes").get<double>(), disk / 3);
    // Without a .vdb no volumes are made.
    const json tets = of("-- pose " + rest + " " + posed + " -o " + file("q.vtu"));
    EXPECT_LT(tets.at("seconds").get<double>(), one.at("seconds").get<double>());

    const std::string deform =
        "deform " + rest + " --grid depth --posed " + file("q.1.vdb") + " -o " + file("d.vdb");
    const json carried = of("-- " + deform);
    EXPECT_EQ(carried.at("command"), "deform");
    ASSERT_EQ(run(deform + " -q").status, ExitCode::success);
    const double volume = double(std::filesystem::file_size(folder / "d.vdb"));
    EXPECT_LT(carried.at("disk_bytes").get<double>(), 3 * volume);
    EXPECT_GT(carried.at("disk_bytes").get<double>(), volume / 3);
    EXPECT_EQ(of("-- deform " + file("q.1.vdb") + " --grid rest --posed " + file("q.1.vdb") +
                 " -o " + file("d.vdb"))
                  .at("not_counted"),
              json({"grid rest (vec3s)"}));
    // A build behind -- is what it is without.
    EXPECT_EQ(of("-- build " + posed + " --layers 2").at("cpu_seconds"),
              of(posed + " --layers 2").at("cpu_seconds"));

    expect_refusal("estimate pose " + rest + " " + posed + " -o " + file("q.vdb"),
                   ExitCode::usage_error, {"behind --"});
    expect_refusal("estimate -- pose " + rest + " --nonsense", ExitCode::usage_error,
                   {"the call behind --"});
    expect_refusal("estimate -- pose " + rest + " " + file("none.obj") + " -o " + file("q.vdb"),
                   ExitCode::read_error, {"none.obj"});
}

TEST_F(Estimate, AJobAsksForWhatItSays)
{
    mesh_file("s.1.obj", icosphere(1.0, 2));
    mesh_file("s.2.obj", icosphere(1.0, 2));
    const std::string call =
        " -- build " + file("s.#.obj") + " --frames 1-2 --voxel-size 0.1 -o " + file("t.#.vdb");
    const auto job = [&](const std::string& more, const std::string& behind) {
        const Outcome result =
            run("farm --engine slurm -o " + file("j") + " " + more + call + behind);
        EXPECT_EQ(result.status, ExitCode::success) << result.err;
        return read_bytes(folder / "j");
    };
    const std::string both = job("", "");
    EXPECT_NE(both.find("#SBATCH --array=0-0\n"), std::string::npos) << "ten minutes hold both";
    EXPECT_NE(both.find("#SBATCH --mem="), std::string::npos);
    EXPECT_NE(both.find("#SBATCH --time=5\n"), std::string::npos);
    const std::string given = job("--memory 1.5 --minutes 7 --chunk 1", "");
    EXPECT_NE(given.find("#SBATCH --array=0-1\n"), std::string::npos);
    EXPECT_NE(given.find("#SBATCH --mem=1536M\n#SBATCH --time=7\n"), std::string::npos) << given;
    const std::string unknown = job("", " --taper");
    EXPECT_EQ(unknown.find("#SBATCH --mem="), std::string::npos) << unknown;
    ASSERT_EQ(run("build " + file("s.1.obj") + kCoarse + "-q -o " + file("rest.vdb")).status,
              ExitCode::success);
    const Outcome poses =
        run("farm --engine slurm -o " + file("j") + " -- pose " + file("rest.vdb") + " " +
            file("s.#.obj") + " --frames 1-2 -o " + file("t.#.vdb"));
    EXPECT_EQ(poses.status, ExitCode::success) << poses.err;
    EXPECT_NE(read_bytes(folder / "j").find("#SBATCH --mem="), std::string::npos);
}

} // namespace
} // namespace vdb_shell::test
