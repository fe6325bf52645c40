// SPDX-License-Identifier: Apache-2.0
#include "command_fixture.h"
#include "support/shapes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

// What a host, a pipe or a person who is stuck is told: docs/frames.md.

namespace vdb_shell::test
{
namespace
{

using command::ExitCode;
using nlohmann::json;
using openvdb::Vec3d;
namespace fs = std::filesystem;

class ForPrograms : public Command
{
protected:
    void spheres(int last)
    {
        for (int frame = 1; frame <= last; ++frame)
            mesh_file("s.000" + std::to_string(frame) + ".obj", icosphere(1.0, 2));
    }

    std::string build(const std::string& frames, const std::string& more = "")
    {
        return "build " + file("s.####.obj") + " -q -o " + file("t.####.vtu") + kCoarse +
               "--frames " + frames + " " + more;
    }

    std::string bytes(const std::string& name) { return read_bytes(folder / name); }

    /// The objects of that event on standard error, one a line.
    static std::vector<json> events(const std::string& err, const std::string& event)
    {
        std::vector<json> found;
        std::istringstream lines(err);
        for (std::string line; std::getline(lines, line);)
            if (const json object = json::parse(line); object.at("event") == event)
                found.push_back(object);
        return found;
    }
};

TEST_F(ForPrograms, ProgressForProgramsGrowsAndEndsAtOne)
{
    spheres(3);
    for (const char* frames : {"1", "1-3", "1-3 --frames-at-once 3"}) {
        const Outcome result = run(build(frames, "--errors json --progress json"));
        ASSERT_EQ(result.status, ExitCode::success) << result.err;
        double share = 0;
        const std::vector<json> lines = events(result.err, "progress");
        ASSERT_GT(lines.size(), 5u);
        for (const json& line : lines) {
            EXPECT_GE(line.at("share").get<double>(), share);
            share = line.at("share").get<double>();
        }
        EXPECT_EQ(share, 1.0) << frames;
        EXPECT_EQ(lines.back().at("stage"), "done");
        EXPECT_FALSE(events(result.err, "message").empty());
    }
    // A word behind --progress is its style only if it is one.
    EXPECT_EQ(
        run("build --progress " + file("s.0001.obj") + " -q" + kCoarse + "-o " + file("t.vtu"))
            .err.find("vdb_shell: read\n"),
        0u);
}

TEST_F(ForPrograms, ProgressSaysThatAFrameFailed)
{
    spheres(2);
    write_bytes(folder / "s.0001.obj", "no mesh\n");
    const Outcome result =
        run(build("1-2", "--keep-going --errors json --progress json --log-level error"));
    EXPECT_EQ(result.status, ExitCode::read_error);
    const std::vector<json> lines = events(result.err, "progress");
    ASSERT_FALSE(lines.empty());
    EXPECT_EQ(lines.back().at("stage"), "done");
    std::size_t failed = 0;
    for (const json& line : lines)
        if (line.at("stage") == "failed") {
            ++failed;
            EXPECT_EQ(line.at("frame"), 1);
            EXPECT_EQ(line.at("share"), 0.5);
        }
    EXPECT_EQ(failed, 1u);
    EXPECT_EQ(events(result.err, "message").size(), 1u) << "the count, as something failed";
}

TEST_F(ForPrograms, ErrorsForProgramsHaveTheirParts)
{
    write_bytes(folder / "s.0001.obj", "v 0 0 0\nv 0 0 zero\n");
    const std::string options = std::string(kCoarse) + "-q --errors json -o ";
    const auto error = [&](const std::string& arguments) {
        const Outcome result = run(arguments);
        const std::vector<json> found = events(result.err, "error");
        EXPECT_EQ(found.size(), 1u) << result.err;
        EXPECT_EQ(found.at(0).at("status"), result.status);
        return found.at(0);
    };
    const json read = error("build " + file("s.0001.obj") + options + file("t.vtu"));
    EXPECT_EQ(read.at("code"), "read");
    EXPECT_EQ(read.at("file"), file("s.0001.obj"));
    EXPECT_EQ(read.at("element"), "vertex 1");
    const json of_frame = error(build("1", "--errors json"));
    EXPECT_EQ(of_frame.at("frame"), 1);
    const json option =
        error("build " + file("s.0001.obj") + options + file("t.vtu") + " --thickness -1");
    EXPECT_EQ(option.at("code"), "usage");
    EXPECT_EQ(option.at("option"), "--thickness");
    EXPECT_EQ(option.at("value"), "-1");
    EXPECT_EQ(option.at("limit"), "above 0");
    EXPECT_EQ(error("build --errors json --no-such-flag").at("code"), "usage");
}

TEST_F(ForPrograms, WishesThatAreNotMetAndInvalidShellsAreErrorsToo)
{
    // No tet in the corner of a box is so regular.
    const std::string build = "build " + mesh_file("b.obj", box(Vec3d(0.0), Vec3d(1.0))) + kCoarse +
                              "--want-amips 3.0001 -q -o " + file("b.vtu");
    const Outcome unmet = run("--errors json " + build);
    EXPECT_EQ(unmet.status, ExitCode::bound_not_met);
    const std::vector<json> found = events(unmet.err, "error");
    ASSERT_EQ(found.size(), 1u) << unmet.err;
    EXPECT_EQ(found[0].at("status"), unmet.status);
    EXPECT_EQ(found[0].at("code"), "bound");
    EXPECT_EQ(found[0].at("file"), "b.obj");
    EXPECT_EQ(run(build).err.rfind("vdb_shell: b.obj: wanted amips", 0), 0u) << run(build).err;
}

TEST_F(ForPrograms, ASurfaceComesFromStandardInput)
{
    const std::string sphere = mesh_file("s.obj", icosphere(1.0, 2));
    const std::string options = std::string(kCoarse) + "-q -o ";
    ASSERT_EQ(run("build " + sphere + options + file("file.vtu")).status, ExitCode::success);
    const Outcome piped =
        run("build - --input-format obj" + options + file("piped.vtu") + " <" + sphere);
    EXPECT_EQ(piped.status, ExitCode::success) << piped.err;
    EXPECT_EQ(bytes("piped.vtu"), bytes("file.vtu"));
    EXPECT_EQ(run("inspect - --input-format obj <" + sphere).status, ExitCode::success);
    expect_refusal("build -" + options + file("t.vtu") + " <" + sphere, ExitCode::usage_error,
                   {"--input-format"});
    expect_refusal("build " + sphere + " --input-format ply" + options + file("t.vtu"),
                   ExitCode::usage_error, {"--input-format is for standard input"});
    expect_refusal("build - --input-format ply" + options + file("t.vtu") + " <" + sphere,
                   ExitCode::read_error, {"-: "});
    expect_refusal("build - --input-format obj" + options + file("t.vtu") + " </dev/null",
                   ExitCode::read_error, {"standard input is empty"});
    expect_refusal("build - --input-format obj --frames 1-2" + options + file("t.#.vtu"),
                   ExitCode::usage_error, {"read once"});
    expect_refusal("build - --input-format obj --manifest " + file("m.json") + options +
                       file("t.vtu"),
                   ExitCode::usage_error, {"read once"});
}

TEST_F(ForPrograms, ResultsGoIntoAPipeWhoseNameHasAnExtension)
{
    const std::string sphere = mesh_file("s.obj", icosphere(1.0, 2));
    const std::string call = "build " + sphere + kCoarse + "-q -o ";
    ASSERT_EQ(run(call + file("file.vtu")).status, ExitCode::success);
    fs::create_symlink("/dev/fd/3", folder / "pipe.vtu");
    const Outcome result =
        run(call + file("pipe.vtu") + " 3>&1 | cat >" + file("piped.vtu") + " #");
    EXPECT_EQ(result.status, ExitCode::success) << result.err;
    EXPECT_EQ(bytes("piped.vtu"), bytes("file.vtu"));
    EXPECT_TRUE(fs::is_symlink(folder / "pipe.vtu"));
}

TEST_F(ForPrograms, TheDoctorSaysWhatAFileNeeds)
{
    const std::string sphere = mesh_file("s.obj", icosphere(1.0, 2));
    const Outcome machine = run("doctor");
    EXPECT_EQ(machine.status, ExitCode::success) << machine.err;
    for (const char* word : {"OpenVDB ", "oneTBB ", "threads ", "gmsh ", "tetgen "})
        EXPECT_NE(machine.out.find(word), std::string::npos) << word;
    EXPECT_NE(run("doctor " + sphere).out.find("inspect says"), std::string::npos);
    ASSERT_EQ(run("build " + sphere + kCoarse + "-q -o " + file("s.vdb")).status,
              ExitCode::success);
    const Outcome shell = run("doctor " + file("s.vdb"));
    EXPECT_NE(shell.out.find("read it as a shell"), std::string::npos) << shell.out;
    EXPECT_NE(shell.out.find("\"surface\", Tree_float_5_4_3, level set"), std::string::npos);
    ASSERT_EQ(
        run("volumes " + file("s.vdb") + " --volumes density,prism -o " + file("v.vdb")).status,
        ExitCode::success);
    const Outcome volumes = run("doctor " + file("v.vdb"));
    EXPECT_NE(volumes.out.find("deform and map read it"), std::string::npos) << volumes.out;
    EXPECT_NE(volumes.out.find("--thickness-grid"), std::string::npos) << volumes.out;
    EXPECT_EQ(volumes.out.find("no command"), std::string::npos) << volumes.out;
    write_bytes(folder / "s.xyz", "0 0 0\n");
    EXPECT_EQ(run("doctor " + file("s.xyz")).status, ExitCode::read_error);
    expect_refusal("doctor " + file("none.obj"), ExitCode::read_error, {"none.obj"});
}

TEST_F(ForPrograms, ThePageForManHasEveryFlag)
{
    const std::string page = run("options --man").out;
    const json schema = json::parse(run("options --json").out);
    for (const auto& [name, command] : schema.at("commands").items())
        for (const json& option : command.at("options")) {
            if (option.at("flag").is_null())
                continue;
            std::string flag;
            for (const char c : option.at("flag").get<std::string>())
                flag += c == '-' ? std::string("\\-") : std::string(1, c);
            EXPECT_NE(page.find("\\fB" + flag), std::string::npos) << name << flag;
        }
    EXPECT_EQ(page.rfind(".TH VDB_SHELL 1", 0), 0u);
    const Outcome version = run("--version");
    EXPECT_EQ(version.out.rfind("vdb_shell ", 0), 0u);
    EXPECT_NE(version.out.find("\nOpenVDB "), std::string::npos);
}

} // namespace
} // namespace vdb_shell::test
