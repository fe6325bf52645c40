// SPDX-License-Identifier: Apache-2.0
#include "command_fixture.h"
#include "support/shapes.h"
#include "vdb_shell/write/vdb_file.h"

#include <nlohmann/json.hpp>

#include <sys/resource.h>
#include <sys/stat.h>

#include <cstdlib>
#include <thread>

// What the command does with files: nothing is overwritten that was not meant, nothing is lost in
// silence, and the status says what happened.

namespace vdb_shell::test
{
namespace
{

namespace fs = std::filesystem;
using command::ExitCode;

class FilePlans : public Command
{
protected:
    void SetUp() override
    {
        box = mesh_file("b.obj", gridded_box({0, 0, 0}, {1, 1, 1}, 2));
        bytes = read_bytes(folder / "b.obj");
        build = "build " + box + kCoarse + "-q ";
    }
    std::string out(const std::string& name) { return " -o " + file(name); }
    /// The words of a line, as a shell runs it.
    int shell(const std::string& line) { return std::system(line.c_str()); }

    std::string box, bytes, build;
};

TEST_F(FilePlans, NoOutputDestroysAnInputOrAnotherOutput)
{
    ASSERT_EQ(run(build + out("g.vdb")).status, ExitCode::success);
    ASSERT_EQ(run(build + "--points beside" + out("h.vdb")).status, ExitCode::success);
    const std::string grid = read_bytes(folder / "g.vdb"),
                      points = read_bytes(folder / "h.points.vdb");
    fs::create_hard_link(box, folder / "hard.obj");
    fs::create_symlink("b.obj", folder / "soft.obj");
    fs::create_symlink(".", folder / "here");
    write_bytes(folder / "options.json", "{}");
    const std::string refused[] = {
        build + out("a.vtu") + " --report " + box,
        build + out("hard.obj"),
        build + out("soft.obj"),
        build + out("here/b.obj"),
        build + "--thickness-grid " + file("g.vdb") + ":depth" + out("g.vdb"),
        build + "--core " + file("g.vdb") + ":surface" + out("g.vdb"),
        build + "--options " + file("options.json") + " --report " + file("options.json"),
        build + "--remesh-to 50 --remesh-map " + file("m.json") + " --report " + file("m.json"),
        build + out("a.vdb") + out("./a.vdb"),
        build + out("a.vdb") + out("here/a.vdb"),
        build + out("a.vtu") + " --report " + file("a.vtu"),
        build + "--points beside" + out("k.vdb") + out("k.points.vdb"),
        build + out("t.node") + " --report " + file("t.ele"),
        "convert " + file("h.vdb") + out("h.points.vdb"),
        "convert " + file("h.vdb") + out("h.vdb"),
        "inspect " + mesh_file("p.ply", icosphere(1, 1)) + " -o " + file("p.ply"),
        "repair " + box + out("hard.obj"),
        "repair " + box + " --options " + file("options.json") + out("here/options.json")};
    for (const std::string& line : refused) {
        const Outcome result = run(line);
        EXPECT_EQ(result.status, ExitCode::usage_error) << line << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
    EXPECT_EQ(read_bytes(folder / "b.obj"), bytes);
    EXPECT_EQ(read_bytes(folder / "g.vdb"), grid);
    EXPECT_EQ(read_bytes(folder / "h.points.vdb"), points);
    EXPECT_EQ(read_bytes(folder / "options.json"), "{}");
    for (const char* name : {"a.vtu", "a.vdb", "k.vdb", "t.ele", "m.json"})
        EXPECT_FALSE(fs::exists(folder / name)) << name;
}

TEST_F(FilePlans, APointsFileOfAnotherNameIsAnInputToo)
{
    ASSERT_EQ(run(build + "--points beside" + out("a.vdb")).status, ExitCode::success);
    fs::rename(folder / "a.vdb", folder / "b.vdb");
    expect_refusal("convert --points beside " + file("b.vdb") + out("a.vdb"), ExitCode::usage_error,
                   {"a.points.vdb", "input"});
    EXPECT_EQ(run("check " + file("b.vdb")).status, ExitCode::success);
}

TEST_F(FilePlans, AllFilesOfTetGenAreWrittenOnce)
{
    EXPECT_EQ(run(build + out("t.node") + out("t.ele")).status, ExitCode::success);
    for (const char* name : {"t.node", "t.ele", "t.face"})
        EXPECT_TRUE(fs::exists(folder / name)) << name;
}

TEST_F(FilePlans, ExtensionsAreTheSameInCapitals)
{
    EXPECT_EQ(run(build + out("S.VDB") + out("t.ELE")).status, ExitCode::success);
    EXPECT_TRUE(fs::exists(folder / "t.node") && fs::exists(folder / "t.ele"));
    // The files that are written are those that were planned.
    expect_refusal(build + "--no-clobber" + out("t.ELE"), ExitCode::write_error,
                   {"t.node", "exists"});
    const std::string level_set = "build " + file("S.VDB") + kCoarse + "-q ";
    EXPECT_EQ(run(level_set + out("u.vtu")).status, ExitCode::success);
    EXPECT_EQ(run("build " + file("S.VDB") + ":surface" + kCoarse + "-q " + out("v.vtu")).status,
              ExitCode::success);
    EXPECT_EQ(read_bytes(folder / "u.vtu"), read_bytes(folder / "v.vtu"));
    expect_refusal("estimate " + file("S.VDB"), ExitCode::usage_error, {"level set"});
}

TEST_F(FilePlans, AnOutputThatCannotBeWrittenLeavesTheOthersAsTheyWere)
{
    write_bytes(folder / "a.vtu", "old");
    // STL cannot say where a shell stands, which only its writer knows.
    write_mesh(folder / "far.obj", gridded_box({0, 0, 0}, {1, 1, 1}, 2), {{1e6, 0, 0}, 1.0});
    const Outcome result = run("build --recentre " + file("far.obj") + kCoarse + out("a.vtu") +
                               out("a.stl") + " --report " + file("a.json"));
    EXPECT_EQ(result.status, ExitCode::usage_error) << result.err;
    EXPECT_EQ(read_bytes(folder / "a.vtu"), "old");
    EXPECT_FALSE(fs::exists(folder / "a.json"));
}

TEST_F(FilePlans, ExistingFilesAreKeptWhenAsked)
{
    write_bytes(folder / "a.vtu", "old");
    for (const std::string& line :
         {build + out("a.vtu"), build + out("a.node") + " --report " + file("a.vtu"),
          "repair " + box + out("hard.obj")}) {
        write_bytes(folder / "hard.obj", "old");
        expect_refusal(line + " --no-clobber", ExitCode::write_error, {"exists", "--no-clobber"});
    }
    EXPECT_EQ(read_bytes(folder / "a.vtu"), "old");
    EXPECT_FALSE(fs::exists(folder / "a.node"));
    EXPECT_EQ(run(build + "--no-clobber" + out("b.vtu")).status, ExitCode::success);
}

TEST_F(FilePlans, AReadOnlyFileIsRefusedAndAModeKept)
{
    write_bytes(folder / "a.vtu", "old");
    fs::permissions(folder / "a.vtu", fs::perms::owner_read);
    expect_refusal(build + out("a.vtu"), ExitCode::write_error, {"a.vtu", "read-only"});
    fs::permissions(folder / "a.vtu", fs::perms::owner_read | fs::perms::owner_write);
    ASSERT_EQ(run(build + out("a.vtu")).status, ExitCode::success);
    EXPECT_EQ(fs::status(folder / "a.vtu").permissions(),
              fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(FilePlans, DevicesAndFifosAreWrittenInto)
{
    ASSERT_EQ(::mkfifo((folder / "f.vtu").c_str(), 0600), 0);
    std::string read;
    std::thread reader([&] { read = read_bytes(folder / "f.vtu"); });
    const Outcome result = run(build + out("f.vtu") + out("a.vtu") + " --report /dev/null");
    reader.join();
    EXPECT_EQ(result.status, ExitCode::success) << result.err;
    EXPECT_EQ(read, read_bytes(folder / "a.vtu"));
    EXPECT_TRUE(fs::is_fifo(folder / "f.vtu"));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(FilePlans, AReportGoesToStandardOutput)
{
    for (const char* name : {"-", "/dev/stdout"}) {
        const Outcome result = run("build " + box + kCoarse + "--report " + name);
        ASSERT_EQ(result.status, ExitCode::success) << result.err;
        EXPECT_EQ(nlohmann::json::parse(result.out).at("source"), "b.obj");
    }
    EXPECT_FALSE(fs::exists("-"));
    expect_refusal(build + "--report " + file("out"), ExitCode::usage_error, {"standard output"});
}

TEST_F(FilePlans, StandardOutputThatFailsIsAnError)
{
    ASSERT_EQ(run(build + out("s.vdb")).status, ExitCode::success);
    for (const std::string& words :
         {"build " + box + kCoarse, "build -q --report - " + box + kCoarse, "inspect " + box,
          "info " + file("s.vdb"), "check " + file("s.vdb"), std::string("options"),
          std::string("--help"), std::string("--version")}) {
        const std::string line = std::string(VDB_SHELL_COMMAND) + " " + words;
        EXPECT_EQ(WEXITSTATUS(shell(line + " >/dev/full 2>" + file("err"))), ExitCode::write_error)
            << words;
        EXPECT_NE(read_bytes(folder / "err").find("standard output"), std::string::npos) << words;
    }
}

TEST_F(FilePlans, ClosedStreamsEndInNoFile)
{
    const std::string line = std::string(VDB_SHELL_COMMAND) + " build " + box + kCoarse;
    EXPECT_EQ(WEXITSTATUS(shell(line + "--progress" + out("a.vtu") + " <&- >&- 2>&-")),
              ExitCode::write_error);
    ASSERT_EQ(run(build + out("b.vtu")).status, ExitCode::success);
    EXPECT_EQ(read_bytes(folder / "a.vtu"), read_bytes(folder / "b.vtu"));
}

TEST_F(FilePlans, ALimitOnTheSizeOfFilesIsAWriteError)
{
    write_bytes(folder / "a.vtu", "old");
    const std::string line = "ulimit -f 4; exec " + std::string(VDB_SHELL_COMMAND) + " " + build +
                             out("a.vtu") + " 2>" + file("err");
    EXPECT_EQ(WEXITSTATUS(shell("sh -c '" + line + "'")), ExitCode::write_error);
    EXPECT_NE(read_bytes(folder / "err").find("a.vtu: cannot be written: File too large"),
              std::string::npos)
        << read_bytes(folder / "err");
    EXPECT_EQ(read_bytes(folder / "a.vtu"), "old");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 3);
}

TEST_F(FilePlans, AShellWithoutATetOrNotValidIsNoSuccess)
{
    for (const char* options :
         {"--thickness 1e-308", "--thickness-scale 1e-308", "--method raw --step 1e308"})
        expect_refusal(build + options + out("a.vtu"), ExitCode::geometry_error, {"no tet"});
    EXPECT_FALSE(fs::exists(folder / "a.vtu"));
}

TEST_F(FilePlans, NamesThatAreNoUtf8LeaveValidFilesOrAreRefused)
{
    const std::string name = "caf\xe9"; // Latin-1
    fs::copy_file(box, folder / (name + ".obj"));
    const std::string from = "build -q " + file(name + ".obj") + kCoarse;
    ASSERT_EQ(
        run(from + out(name + ".vdb") + out(name + ".geo") + " --report " + file("r.json")).status,
        ExitCode::success);
    EXPECT_NO_THROW(nlohmann::json::parse(read_bytes(folder / "r.json")));
    EXPECT_NO_THROW(nlohmann::json::parse(read_bytes(folder / (name + ".geo"))));
    EXPECT_NO_THROW(nlohmann::json::parse(run("info --json " + file(name + ".vdb")).out));
    EXPECT_NO_THROW(nlohmann::json::parse(run("inspect --json " + file(name + ".obj")).out));
    EXPECT_EQ(run("check " + file(name + ".vdb")).status, ExitCode::success);
    expect_refusal(from + out(name + ".vdb") + out("a.usda"), ExitCode::usage_error,
                   {"a.usda", "UTF-8"});
    EXPECT_EQ(run(from + out("a.vdb") + out(name + ".usda")).status, ExitCode::success);
}

TEST_F(FilePlans, StoredTextThatIsNoJsonIsRefusedByName)
{
    ASSERT_EQ(run(build + out("a.vdb")).status, ExitCode::success);
    ShellFile shell = read_shell_vdb(folder / "a.vdb");
    shell.report_json = "{\"source\": ";
    write_shell_vdb(folder / "b.vdb", shell);
    expect_refusal("info --json " + file("b.vdb"), ExitCode::read_error,
                   {"b.vdb", "report", "JSON"});
}

TEST_F(FilePlans, UnsignedOptionsAreNotNegative)
{
    for (const char* option :
         {"--samples", "--samples-seed", "--perturb-seed", "--ripple-seed", "--decimate-to",
          "--remesh-to", "--max-tets", "--want-tets", "--coarse-from", "--layers"})
        expect_refusal("build " + box + " " + option + " -1" + out("a.vtu"), ExitCode::usage_error,
                       {std::string(option) + " is -1, must be"});
    EXPECT_FALSE(fs::exists(folder / "a.vtu"));
}

TEST_F(FilePlans, WhatCannotBeLookedAtIsToldByName)
{
    // Longer than a file's name can be: asking for it fails, as in a folder without permission.
    const std::string name(300, 'n'), shape = file(name + ".obj");
    expect_refusal(build + "--core " + shape + out("a.vtu"), ExitCode::read_error,
                   {name, "File name too long"});
    ASSERT_EQ(run(build + out("g.vdb")).status, ExitCode::success);
    expect_refusal("pose " + file("g.vdb") + " " + box + " --frame-seconds 1 --mesh-before " +
                       shape + out("a.vtu"),
                   ExitCode::read_error, {name, "File name too long"});
    expect_refusal("join " + file(name + ".json") + out("whole.json"), ExitCode::read_error,
                   {name, "File name too long"});
    // Not told as a file that is not there.
    fs::create_symlink("round.obj", folder / "round.obj");
    expect_refusal("inspect " + file("round.obj"), ExitCode::read_error,
                   {"round.obj", "symbolic links"});
}

TEST_F(FilePlans, LongNamesOfOutputsAreRefusedBeforeTheWork)
{
    const std::string name(260, 'n');
    for (const std::string& words :
         {out(name + ".vtu"), out("a.vtu") + " --report " + file(name + ".json"),
          out("a.vtu") + " --manifest " + file(name + ".json")})
        expect_refusal(build + "--dry-run" + words, ExitCode::write_error,
                       {name, "bytes", "limit is 255"});
    EXPECT_EQ(run(build + out(std::string(250, 'n') + ".vtu")).status, ExitCode::success);
}

TEST_F(FilePlans, AFolderForTemporariesThatIsNoneIsNamed)
{
    ::setenv("TMPDIR", file("none").c_str(), 1);
    expect_refusal("inspect - --input-format obj <" + box, ExitCode::read_error,
                   {"-: standard input", file("none")});
    expect_refusal(build + "--dry-run --report /dev/null", ExitCode::write_error,
                   {"/dev/null", file("none")});
    ::unsetenv("TMPDIR");
}

TEST_F(FilePlans, ACallInAFolderThatIsGoneEndsWithAStatusOfItsOwn)
{
    const std::string begin = "mkdir " + file("d") + " && cd " + file("d") +
                              " && rmdir ../d && " VDB_SHELL_COMMAND " ",
                      end = " >" + file("out") + " 2>" + file("err");
    EXPECT_EQ(WEXITSTATUS(shell(begin + "doctor" + end)), ExitCode::success);
    EXPECT_NE(read_bytes(folder / "out").find("here"), std::string::npos);
    EXPECT_EQ(WEXITSTATUS(shell(begin + "farm --engine slurm" + out("j.sbatch") + " -- " + build +
                                "--voxel-size 0.1 --frames 1" + out("a.#.vtu") + end)),
              ExitCode::read_error);
    EXPECT_NE(read_bytes(folder / "err").find("folder"), std::string::npos);
}

TEST_F(FilePlans, FormatsAreRefusedBeforeTheWork)
{
    expect_refusal("repair " + box + " --dry-run" + out("x.xyz"), ExitCode::usage_error,
                   {"x.xyz", ".obj"});
    expect_refusal("inspect " + box + " --dry-run" + out("x.obj"), ExitCode::usage_error,
                   {"x.obj", ".ply"});
    // As soon as it is known, and before what else there is to say of this surface.
    TriangleMesh open = gridded_box({0, 0, 0}, {1, 1, 1}, 2);
    open.triangles.pop_back();
    write_mesh(folder / "far.obj", open, {{1e6, 0, 0}, 1.0});
    for (const std::string command : {"build", "repair"})
        expect_refusal(command + " --recentre " + file("far.obj") + out("x.stl"),
                       ExitCode::usage_error, {"x.stl", "STL holds float32 only"});
}

TEST_F(FilePlans, VoxelsThatDoNotFitAreRefused)
{
    ASSERT_EQ(run(build + out("g.vdb")).status, ExitCode::success);
    const std::string volumes = "volumes " + file("g.vdb") + out("v.vdb") + " --voxel-size ";
    expect_refusal(volumes + "1e-6", ExitCode::geometry_error, {"voxel size 1e-06", "GiB"});
    expect_refusal(volumes + "1e300", ExitCode::geometry_error, {"voxel size 1e+300", "longest"});
    expect_refusal(volumes + "1e-300", ExitCode::usage_error, {"voxel size 1e-300"});
    EXPECT_FALSE(fs::exists(folder / "v.vdb"));
}

TEST_F(FilePlans, MessagesAboutGridsNameTheirFiles)
{
    const std::string large = mesh_file("large.obj", gridded_box({0, 0, 0}, {1e6, 1e6, 1e6}, 2));
    expect_refusal("build " + large + kCoarse + "-q --half" + out("h.vdb"), ExitCode::usage_error,
                   {"h.vdb: grid \"surface\"", "65504"});
}

} // namespace
} // namespace vdb_shell::test
