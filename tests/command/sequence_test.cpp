// SPDX-License-Identifier: Apache-2.0
#include "command_fixture.h"
#include "support/shapes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sys/resource.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

// Frames, the manifest and what a host is told: docs/frames.md.

namespace vdb_shell::test
{
namespace
{

using command::ExitCode;
using nlohmann::json;
namespace fs = std::filesystem;

class Sequence : public Command
{
protected:
    /// Spheres of several sizes, so that a resolution would mean another voxel size for each.
    void spheres(int first, int last)
    {
        for (int frame = first; frame <= last; ++frame)
            mesh_file("s.000" + std::to_string(frame) + ".obj", icosphere(1.0 + 0.1 * frame, 2));
    }

    std::string build(const std::string& frames, const std::string& more = "")
    {
        return "build " + file("s.####.obj") + " -q -o " + file("t.####.vtu") + kCoarse +
               "--frames " + frames + " " + more;
    }

    std::string bytes(const std::string& name) { return read_bytes(folder / name); }
    bool there(const std::string& name) { return fs::exists(folder / name); }
};

TEST_F(Sequence, ADryRunTellsFramesAndFilesAndTouchesNone)
{
    write_bytes(folder / "s.0001.obj", "no mesh at all");
    write_bytes(folder / "s.0003.obj", "");
    const Outcome plan = run(build("1-4x2", "--dry-run"));
    EXPECT_EQ(plan.status, ExitCode::success) << plan.err;
    EXPECT_EQ(plan.out, "frame 1: reads " + file("s.0001.obj") + ", writes " + file("t.0001.vtu") +
                            "\nframe 3: reads " + file("s.0003.obj") + ", writes " +
                            file("t.0003.vtu") + "\n2 frames: 1,3\n");
    EXPECT_FALSE(there("t.0001.vtu"));
    // A single call has a plan too.
    const Outcome single =
        run("build " + file("s.0001.obj") + " -o " + file("t.ele") + " --dry-run");
    EXPECT_EQ(single.status, ExitCode::success) << single.err;
    EXPECT_NE(single.out.find(file("t.node")), std::string::npos) << single.out;
    expect_refusal(build("1-3", "--dry-run"), ExitCode::read_error, {"no input for frames 2: "});
    const Outcome missing =
        run("build " + file("none.obj") + " -o " + file("t.ele") + " --dry-run");
    EXPECT_EQ(missing.status, ExitCode::read_error) << missing.err;
    EXPECT_NE(missing.out.find("MISSING " + file("none.obj")), std::string::npos) << missing.out;
}

TEST_F(Sequence, EveryTokenAndEveryFrameIsACallOfItsOwn)
{
    spheres(1, 2);
    const std::string options = " --samples 1000 --voxel-size 0.08 -q";
    ASSERT_EQ(run("build " + file("s.0002.obj") + options + " -o " + file("alone.vtu")).status,
              ExitCode::success);
    for (const auto& [in, out] :
         std::vector<std::pair<std::string, std::string>>{{"s.%04d.obj", "%02d.vtu"},
                                                          {"s.'$F4'.obj", "'$F2'.vtu"},
                                                          {"s.@@@@.obj", "@@.vtu"},
                                                          {"s.####.obj", "'${F2}'.vtu"}}) {
        fs::remove(folder / "02.vtu");
        const Outcome result = run("--frames 1-2 build " + file(in) + options + " -o " + file(out));
        EXPECT_EQ(result.status, ExitCode::success) << in << result.err;
        EXPECT_EQ(bytes("02.vtu"), bytes("alone.vtu")) << in;
    }
}

TEST_F(Sequence, AllFramesHaveTheVoxelsOfTheFirst)
{
    spheres(1, 3);
    ASSERT_EQ(run("build " + file("s.000#.obj") + " -o " + file("t.#.vdb") + kCoarse +
                  "-q --frames 2,1,3 ")
                  .status,
              ExitCode::success);
    const auto voxel = [&](const std::string& name) {
        return json::parse(run("info --json " + file(name)).out)
            .at("report")
            .at("field")
            .at("voxel_size")
            .get<double>();
    };
    ASSERT_EQ(run("build " + file("s.0002.obj") + " -q -o " + file("alone.vdb") + kCoarse).status,
              ExitCode::success);
    for (const char* name : {"t.1.vdb", "t.2.vdb", "t.3.vdb"})
        EXPECT_EQ(voxel(name), voxel("alone.vdb")) << name;
}

TEST_F(Sequence, MissingFramesAreToldBeforeTheWork)
{
    spheres(1, 2);
    spheres(5, 5);
    expect_refusal(build("1-6"), ExitCode::read_error, {"frames 3-4,6", "s.0003.obj"});
    EXPECT_FALSE(there("t.0001.vtu"));
    const Outcome kept = run(build("1-6", "--keep-going"));
    EXPECT_EQ(kept.status, ExitCode::read_error);
    for (const char* name : {"t.0001.vtu", "t.0002.vtu", "t.0005.vtu"})
        EXPECT_TRUE(there(name)) << name;
    for (const char* words :
         {"frame 3: ", "frame 4: ", "frame 6: ", "3 of 6 frames done, failed: 3-4,6"})
        EXPECT_NE(kept.err.find(words), std::string::npos) << words << '\n' << kept.err;
}

TEST_F(Sequence, AFrameThatFailsEndsTheCallUnlessItIsToGoOn)
{
    spheres(1, 4);
    TriangleMesh open = icosphere(1.0, 2);
    open.triangles.pop_back();
    mesh_file("s.0002.obj", open);
    write_bytes(folder / "s.0003.obj", "v 0 0 zero\n");
    const Outcome stopped = run(build("1-4", "--frames-at-once 1"));
    EXPECT_EQ(stopped.status, ExitCode::geometry_error);
    EXPECT_NE(stopped.err.find("1 of 4 frames done, failed: 2, not begun: 2"), std::string::npos)
        << stopped.err;
    EXPECT_FALSE(there("t.0004.vtu"));
    const Outcome kept = run(build("1-4", "--keep-going"));
    EXPECT_EQ(kept.status, ExitCode::geometry_error);
    EXPECT_TRUE(there("t.0004.vtu"));
    EXPECT_NE(kept.err.find("failed: 2-3"), std::string::npos) << kept.err;
    EXPECT_EQ(run(build("4-1", "--keep-going")).status, ExitCode::read_error) << "frame 3 is first";
}

TEST_F(Sequence, PlansThatContradictThemselvesAreRefused)
{
    spheres(1, 3);
    const std::string input = "build " + file("s.####.obj") + kCoarse;
    expect_refusal(input + "--frames 1-3 -o " + file("t.vtu"), ExitCode::usage_error,
                   {"t.vtu", "by frame 1 and by frame 2", "frame token"});
    expect_refusal(input + "--frames 1-3 -o " + file("t.#.vtu") + " --report " + file("r.json"),
                   ExitCode::usage_error, {"r.json", "frame token"});
    expect_refusal("repair " + file("s.0001.obj") + " --frames 1 -o " + file("s.000#.obj"),
                   ExitCode::usage_error, {"is the input"});
    for (const std::string& other :
         {file("s.####.obj") + " --frames 1-2 -o " + file("s.'$F'.obj"),
          file("s.'$F'.obj") + " --frames 2 -o " + file("s.0001.####.obj")})
        EXPECT_EQ(run("repair " + other).status, ExitCode::success) << other;
    // What one frame writes another one reads.
    fs::rename(folder / "s.2.obj", folder / "s.11.obj");
    expect_refusal("repair " + file("s.#.obj") + " --frames 1,11 -o " + file("s.#1.obj"),
                   ExitCode::usage_error, {"s.11.obj", "written by frame 1", "read by frame 11"});
    expect_refusal(input + "--frames 1-3 -o " + file("t.#.vtu") + " --manifest " + file("m.#.json"),
                   ExitCode::usage_error, {"m.#.json", "one manifest"});
    expect_refusal(input + "--frames 1-10y2 -o " + file("t.#.vtu"), ExitCode::usage_error,
                   {"--frames", "at character 5"});
    expect_refusal(input + "-o " + file("t.vtu") + " --keep-going", ExitCode::usage_error,
                   {"--keep-going needs --frames"});
}

TEST_F(Sequence, WithoutFramesATokenIsAPartOfTheName)
{
    const std::string sphere = mesh_file("take#2 100%.obj", icosphere(1.0, 2));
    const Outcome result = run("build '" + sphere + "'" + kCoarse + "-q -o " + file("t.vtu"));
    EXPECT_EQ(result.status, ExitCode::success) << result.err;
    expect_refusal("build '" + sphere + "'" + kCoarse + "-o " + file("t.####.vtu"),
                   ExitCode::usage_error, {"t.####.vtu", "\"####\"", "--frames"});
    expect_refusal("build " + file("s.####.obj") + kCoarse + "-o " + file("t.vtu"),
                   ExitCode::usage_error, {"no such file", "--frames"});
}

TEST_F(Sequence, FramesAtOnceGiveTheSameBytesAndTheirTextInOrder)
{
    spheres(1, 6);
    const std::string input = "build " + file("s.####.obj") + kCoarse + "--frames 6-1 --report - ";
    const std::string quiet = " --log-level warning";
    const Outcome one = run(input + "-o " + file("a.#.vtu") + " --frames-at-once 1" + quiet);
    const Outcome many = run(input + "-o " + file("b.#.vtu") + " --frames-at-once 4" + quiet);
    ASSERT_EQ(one.status, ExitCode::success) << one.err;
    ASSERT_EQ(many.status, ExitCode::success) << many.err;
    EXPECT_EQ(one.err + many.err, "");
    for (int frame = 1; frame <= 6; ++frame)
        EXPECT_EQ(bytes("a." + std::to_string(frame) + ".vtu"),
                  bytes("b." + std::to_string(frame) + ".vtu"));
    const auto sources = [](const std::string& out) {
        std::vector<std::string> found;
        for (std::size_t at = 0; (at = out.find("\"source\": \"", at)) != std::string::npos; ++at)
            found.push_back(out.substr(at + 11, 10));
        return found;
    };
    EXPECT_EQ(sources(many.out).size(), 6u);
    EXPECT_EQ(sources(one.out), sources(many.out));
}

TEST_F(Sequence, ResumeLeavesOutWhatIsUpToDate)
{
    spheres(1, 4);
    const std::string call = build("1-4", "--resume --manifest " + file("m.json"));
    ASSERT_EQ(run(call).status, ExitCode::success);
    const std::string first = bytes("m.json");
    const Outcome again = run(call);
    EXPECT_EQ(again.status, ExitCode::success);
    EXPECT_NE(again.err.find("0 of 4 frames done, left out: 4"), std::string::npos) << again.err;
    EXPECT_EQ(bytes("m.json"), first);
    // An input that changed, an output that was damaged without a change of its size, one that is
    // gone.
    mesh_file("s.0002.obj", icosphere(0.7, 2));
    std::string damaged = bytes("t.0003.vtu");
    const std::string sound = damaged;
    damaged[damaged.size() / 2] ^= 1;
    write_bytes(folder / "t.0003.vtu", damaged);
    const std::string lost = bytes("t.0004.vtu");
    fs::remove(folder / "t.0004.vtu");
    const Outcome stale = run(call);
    EXPECT_NE(stale.err.find("3 of 4 frames done, left out: 1"), std::string::npos) << stale.err;
    EXPECT_EQ(bytes("t.0003.vtu"), sound);
    EXPECT_EQ(bytes("t.0004.vtu"), lost);
    const Outcome other = run(call + " --split index");
    EXPECT_NE(other.err.find("4 of 4 frames done"), std::string::npos) << other.err;
    expect_refusal("check " + file("x.#.vdb") + " --frames 1 --keep-going --manifest " +
                       file("m.json"),
                   ExitCode::read_error, {"m.json", "manifest of `build`"});
    expect_refusal(build("1-4", "--resume"), ExitCode::usage_error, {"--resume needs --manifest"});
    expect_refusal(call + " --no-clobber", ExitCode::write_error, {});
}

TEST_F(Sequence, ResumeKnowsAllDigitsOfAnOption)
{
    spheres(1, 1);
    const std::string call = build("1", "--resume --manifest " + file("m.json") + " --thickness ");
    ASSERT_EQ(run(call + "0.1234561").status, ExitCode::success);
    EXPECT_NE(run(call + "0.1234561").err.find("left out: 1"), std::string::npos);
    const Outcome other = run(call + "0.1234564");
    EXPECT_NE(other.err.find("1 of 1 frames done"), std::string::npos) << other.err;
}

TEST_F(Sequence, AManifestMayBeAnything)
{
    spheres(1, 1);
    const std::string call = build("1", "--manifest " + file("m.json"));
    ASSERT_EQ(run(call).status, ExitCode::success);
    const json sound = json::parse(bytes("m.json"));
    const auto refused = [&](const std::string& text, const std::string& said) {
        write_bytes(folder / "m.json", text);
        expect_refusal(call, ExitCode::read_error, {"m.json: " + said});
        EXPECT_EQ(bytes("m.json"), text);
    };
    // A number that wraps would be another frame, or a success.
    for (const auto& [place, value, said] : std::vector<std::tuple<std::string, json, std::string>>{
             {"/steps/0/frame", 4294967297, "frame is 4294967297, must be a whole number, "},
             {"/steps/0/frame", 1.5, "frame is 1.5, "},
             {"/steps/0/status", 4294967296, "status is 4294967296, "},
             {"/steps/0/outputs/0/bytes", -1, "bytes is -1, must be a whole number, 0 to "},
             {"/schema", 4294967297, "schema is 4294967297, "},
             {"/schema", 2, "schema is 2, must be 1"}}) {
        json wrong = sound;
        wrong[json::json_pointer(place)] = value;
        refused(wrong.dump(), said);
    }
    constexpr std::size_t kDeep = 200000;
    refused(R"({"schema": )" + std::string(kDeep, '[') + std::string(kDeep, ']') + "}", "its JSON");
    refused("[1]", "is no manifest of vdb_shell");
    fs::remove(folder / "m.json");
    ASSERT_EQ(::mkfifo(file("m.json").c_str(), 0600), 0);
    expect_refusal(call, ExitCode::read_error, {"m.json", "not a regular file"});
}

TEST_F(Sequence, ResumeGivesWhatOneCallGives)
{
    // The first frame fixes the voxels of the others: once it can be built, they are stale.
    spheres(1, 3);
    const std::string good = bytes("s.0001.obj");
    write_bytes(folder / "s.0001.obj", "v 0 0 zero\n");
    const std::string call = build("1-3", "--keep-going --resume --manifest " + file("m.json"));
    EXPECT_EQ(run(call).status, ExitCode::read_error);
    write_bytes(folder / "s.0001.obj", good);
    const Outcome resumed = run(call);
    EXPECT_NE(resumed.err.find("3 of 3 frames done"), std::string::npos) << resumed.err;
    const std::string after = bytes("t.0003.vtu");
    ASSERT_EQ(run(build("1-3")).status, ExitCode::success);
    EXPECT_EQ(bytes("t.0003.vtu"), after);
}

TEST_F(Sequence, ProcessesShareAManifest)
{
    spheres(1, 8);
    const std::string command = std::string(VDB_SHELL_COMMAND) + " ";
    const std::string line = command + build("1-8x2", "--manifest " + file("m.json")) + " & " +
                             command + build("2-8x2", "--manifest " + file("m.json")) +
                             "; status=$?; wait; exit $status";
    ASSERT_EQ(std::system(("{ " + line + "; } 2>" + file("err")).c_str()), 0) << bytes("err");
    const json noted = json::parse(bytes("m.json"));
    ASSERT_EQ(noted.at("steps").size(), 8u);
    for (int frame = 1; frame <= 8; ++frame)
        EXPECT_EQ(noted.at("steps").at(std::size_t(frame - 1)).at("frame"), frame);
}

TEST_F(Sequence, KilledAndResumedNothingIsLostOrDoneTwice)
{
    spheres(1, 8);
    const std::string one_call = build("1-8");
    ASSERT_EQ(run(one_call).status, ExitCode::success);
    std::vector<std::string> whole;
    for (int frame = 1; frame <= 8; ++frame) {
        whole.push_back(bytes("t.000" + std::to_string(frame) + ".vtu"));
        fs::remove(folder / ("t.000" + std::to_string(frame) + ".vtu"));
    }
    const std::string call =
        build("1-8", "--frames-at-once 1 --resume --manifest " + file("m.json"));
    const std::string script = std::string(VDB_SHELL_COMMAND) + " " + call +
                               " 2>/dev/null & pid=$!; until grep -q '\"frame\": 3' " +
                               file("m.json") +
                               " 2>/dev/null; do sleep 0.01; done; kill -9 $pid; "
                               "wait $pid";
    EXPECT_NE(std::system(("{ " + script + "; } 2>/dev/null").c_str()), 0);
    const json noted = json::parse(bytes("m.json"));
    const std::size_t done = noted.at("steps").size();
    ASSERT_LT(done, 8u) << "it was not killed in the middle";
    const auto first_written = fs::last_write_time(folder / "t.0001.vtu");
    const Outcome resumed = run(call);
    EXPECT_EQ(resumed.status, ExitCode::success) << resumed.err;
    EXPECT_NE(resumed.err.find(std::to_string(8 - done) +
                               " of 8 frames done, left out: " + std::to_string(done)),
              std::string::npos)
        << resumed.err;
    EXPECT_EQ(fs::last_write_time(folder / "t.0001.vtu"), first_written);
    for (int frame = 1; frame <= 8; ++frame)
        EXPECT_EQ(bytes("t.000" + std::to_string(frame) + ".vtu"), whole[std::size_t(frame - 1)]);
    for (const auto& entry : fs::directory_iterator(folder / ""))
        EXPECT_NE(entry.path().filename().string().rfind(".vdb_shell-", 0), 0u) << entry.path();
}

TEST_F(Sequence, CommandsThatGatherFramesTellAllThatAreMissing)
{
    spheres(1, 1);
    ASSERT_EQ(
        run("build " + file("s.0001.obj") + " -q" + kCoarse + "-o " + file("t.0001.vdb")).status,
        ExitCode::success);
    fs::copy_file(folder / "t.0001.vdb", folder / "t.0003.vdb");
    for (const std::string& words :
         {"page --frames 1-4 " + file("t.####.vdb") + " -o " + file("t.html"),
          "usd --frames 1-4 " + file("t.####.vdb") + " -o " + file("t.usda"),
          "page " + file("t.0001.vdb") + " " + file("t.0002.vdb") + " " + file("t.0003.vdb") + " " +
              file("t.0004.vdb") + " -o " + file("t.html")})
        expect_refusal(words, ExitCode::read_error,
                       {"t.0002.vdb: there is no such file", "t.0004.vdb", "2 of 4"});
    EXPECT_FALSE(there("t.html") || there("t.usda"));
}

TEST_F(Sequence, AFrameIsPlannedWithTheParserOfItsOwnCommand)
{
    const auto user_seconds = [] {
        struct rusage used {
        };
        ::getrusage(RUSAGE_CHILDREN, &used);
        return double(used.ru_utime.tv_sec) + 1e-6 * double(used.ru_utime.tv_usec);
    };
    const auto seconds_of = [&](const std::string& words) {
        const double before = user_seconds();
        EXPECT_EQ(run(words).status, ExitCode::success);
        return user_seconds() - before;
    };
    const std::string options = "--dry-run --keep-going";
    const double many = seconds_of(build("1-500", options));
    // `inspect` has a tenth of the options. With those of all commands both took the same time.
    EXPECT_LT(seconds_of("inspect " + file("s.####.obj") + " --frames 1-500 " + options),
              0.5 * many);
}

} // namespace
} // namespace vdb_shell::test
