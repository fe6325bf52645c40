// SPDX-License-Identifier: Apache-2.0
#include "command_fixture.h"
#include "support/shapes.h"

#include "command/shell_words.h"
#include "vdb_shell/core/error.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sys/stat.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

// Jobs for a farm, and the manifests of their tasks (docs/farm.md). tests/command/farm_slurm.py has
// a real Slurm run one.

namespace vdb_shell::test
{
namespace
{

using command::ExitCode;
using nlohmann::json;
namespace fs = std::filesystem;

class Farm : public Command
{
protected:
    void spheres(int first, int last)
    {
        for (int frame = first; frame <= last; ++frame)
            mesh_file("s." + std::to_string(frame) + ".obj", icosphere(1.0 + 0.1 * frame, 2));
    }

    std::string farm(const std::string& more = "")
    {
        return "farm --engine slurm -o " + file("j.sbatch") + " --chunk 2 " + more + " -- ";
    }

    std::string build(const std::string& frames, const std::string& more = "")
    {
        return "build " + file("s.#.obj") + " -q --samples 0 --voxel-size 0.1 -o " +
               file("t.#.vtu") + " --frames " + frames + " " + more;
    }

    /// The job's own shell, where no Slurm is; what Slurm would set is given.
    Outcome job(const std::string& words, const std::string& variables = "")
    {
        const std::string line = "env " + variables + " bash " + file("j.sbatch") + " " + words +
                                 " >" + file("out") + " 2>" + file("err");
        const int status = std::system(line.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_bytes(folder / "out"),
                read_bytes(folder / "err")};
    }

    bool there(const std::string& name) { return fs::exists(folder / name); }

    /// The tasks of a call with frames 1 to 3 leave the files that the call leaves: OUTPUT1.vdb ...
    void expect_same_by_tasks(const std::string& call, const std::string& output)
    {
        const auto of_frame = [&](int frame) {
            return folder / (output + std::to_string(frame) + ".vdb");
        };
        ASSERT_EQ(run(call).status, ExitCode::success) << call;
        std::vector<std::string> bytes;
        for (int frame = 1; frame <= 3; ++frame) {
            bytes.push_back(read_bytes(of_frame(frame)));
            fs::remove(of_frame(frame));
        }
        const Outcome written = run(farm() + call);
        ASSERT_EQ(written.status, ExitCode::success) << written.err;
        for (const char* task : {"task 0", "task 1"})
            EXPECT_EQ(job(task).status, ExitCode::success) << task;
        EXPECT_EQ(job("join").status, ExitCode::success);
        for (int frame = 1; frame <= 3; ++frame)
            EXPECT_EQ(read_bytes(of_frame(frame)), bytes[std::size_t(frame - 1)]) << call;
        fs::remove_all(folder / "j.tasks");
    }
};

TEST_F(Farm, TasksDoWhatOneCallDoes)
{
    spheres(1, 5);
    ASSERT_EQ(run(build("1-5")).status, ExitCode::success);
    std::vector<std::string> bytes;
    for (int frame = 1; frame <= 5; ++frame) {
        const fs::path output = folder / ("t." + std::to_string(frame) + ".vtu");
        bytes.push_back(read_bytes(output));
        fs::remove(output);
    }
    const Outcome written =
        run(farm() + build("1-5", "--keep-going --resume --manifest " + file("whole.json")));
    ASSERT_EQ(written.status, ExitCode::success) << written.err;
    EXPECT_NE(written.out.find("5 frames or runs in 3 tasks"), std::string::npos) << written.out;
    EXPECT_FALSE(there("t.1.vtu")) << "the job is written and not run";
    for (const char* task : {"task 2", "task 0"})
        EXPECT_EQ(job(task).status, ExitCode::success) << task;
    const Outcome early = job("join");
    EXPECT_EQ(early.status, ExitCode::check_failed);
    EXPECT_NE(early.out.find("3 of 5 frames done, not done: 3-4"), std::string::npos) << early.out;
    EXPECT_EQ(job("task 1").status, ExitCode::success);
    EXPECT_EQ(job("join").status, ExitCode::success);
    EXPECT_EQ(job("task 3").status, ExitCode::usage_error);
    for (int frame = 1; frame <= 5; ++frame)
        EXPECT_EQ(read_bytes(folder / ("t." + std::to_string(frame) + ".vtu")),
                  bytes[std::size_t(frame - 1)]);
    const Outcome again = run(build("1-5", "--resume --manifest " + file("whole.json")));
    EXPECT_NE(again.err.find("left out: 5"), std::string::npos) << again.err;
}

TEST_F(Farm, VolumesGoThroughPosesThere)
{
    TriangleMesh mesh = icosphere(1.0, 2);
    ASSERT_EQ(
        run("build " + mesh_file("s.obj", mesh) + kCoarse + "-q -o " + file("rest.vdb")).status,
        ExitCode::success);
    for (int frame = 1; frame <= 3; ++frame) {
        const std::string number = std::to_string(frame);
        for (openvdb::Vec3s& p : mesh.points)
            p[0] *= 1.1F;
        ASSERT_EQ(run("pose " + file("rest.vdb") + " " + mesh_file("s" + number + ".obj", mesh) +
                      " -q -o " + file("p." + number + ".vdb"))
                      .status,
                  ExitCode::success);
    }
    const std::string deform = "deform " + file("rest.vdb") + " --grid depth --posed " +
                               file("p.#.vdb") + " -q --frames 1-3 -o " + file("d.#.vdb");
    const std::string volumes =
        "volumes " + file("p.#.vdb") + " --volumes depth,rest --frames 1-3 -o " + file("v.#.vdb");
    expect_same_by_tasks(deform, "d.");
    expect_same_by_tasks(volumes, "v.");
    // The model knows deform, so the job has its limits.
    ASSERT_EQ(run(farm() + deform).status, ExitCode::success);
    EXPECT_NE(read_bytes(folder / "j.sbatch").find("#SBATCH --mem="), std::string::npos);
}

TEST_F(Farm, AJoinTellsWhatFailedAndWhatIsGone)
{
    spheres(1, 4);
    write_bytes(folder / "s.2.obj", "v 0 0 zero\n");
    ASSERT_EQ(run(farm() + build("1-4")).status, ExitCode::success);
    EXPECT_EQ(job("join").status, ExitCode::read_error) << "no task has run";
    EXPECT_EQ(job("task 0").status, ExitCode::read_error) << "a task passes the status on";
    EXPECT_EQ(job("task 1").status, ExitCode::success);
    fs::remove(folder / "t.3.vtu");
    write_bytes(folder / "t.4.vtu", "short");
    const Outcome joined = job("join");
    EXPECT_EQ(joined.status, ExitCode::read_error);
    for (const std::string& words :
         {std::string("frame 2: status 3, "), file("s.2.obj"),
          "frame 3: missing: " + file("t.3.vtu"), "frame 4: missing: " + file("t.4.vtu"),
          std::string("1 of 4 frames done, not done: 2-4")})
        EXPECT_NE(joined.out.find(words), std::string::npos) << words << '\n' << joined.out;
    const json noted = json::parse(read_bytes(folder / "j.tasks" / "call-0.json"));
    EXPECT_EQ(noted.at("steps").size(), 4u);
    expect_refusal("join " + file("none.json") + " -o " + file("w.json"), ExitCode::read_error,
                   {"none.json"});
    expect_refusal("join " + file("s.2.obj") + " -o " + file("w.json"), ExitCode::read_error,
                   {"s.2.obj", "no manifest"});
    expect_refusal("join " + file("none.json") + " --expect 1-4y2 -o " + file("w.json"),
                   ExitCode::usage_error, {"--expect", "character 4"});
}

TEST_F(Farm, AListOfCallsIsAJob)
{
    spheres(1, 4);
    mesh_file("it's one.obj", icosphere(1.0, 2));
    const std::string options = " -q --samples 0 --voxel-size 0.1 ";
    write_bytes(
        folder / "list.txt",
        "# two assets and a sequence\n\nvdb_shell build '" + file("s.1.obj") + "'" + options +
            "-o " + file("one.vtu") + "\n" +
            json({"build", file("it's one.obj"), "-q", "--samples", "0", "-o", file("two.vtu")})
                .dump() +
            "\n" + build("2-4") + "\n");
    const std::string list =
        "farm --engine slurm -o " + file("j.sbatch") + " --chunk 2 --calls " + file("list.txt");
    const Outcome written = run(list);
    ASSERT_EQ(written.status, ExitCode::success) << written.err;
    EXPECT_NE(written.out.find("5 frames or runs in 3 tasks"), std::string::npos) << written.out;
    for (const char* task : {"task 0", "task 1", "task 2"})
        EXPECT_EQ(job(task).status, ExitCode::success) << task;
    for (const char* name : {"one.vtu", "two.vtu", "t.2.vtu", "t.3.vtu", "t.4.vtu"})
        EXPECT_TRUE(there(name)) << name;
    const Outcome joined = job("join");
    EXPECT_EQ(joined.status, ExitCode::success) << joined.out;
    EXPECT_NE(joined.out.find("3 of 3 calls are whole"), std::string::npos) << joined.out;

    const auto refuse = [&](const std::string& text, int status,
                            const std::vector<std::string>& words) {
        write_bytes(folder / "list.txt", text);
        expect_refusal(list, status, words);
    };
    const std::string one = "build " + file("s.1.obj") + " -o " + file("one.vtu") + "\n";
    refuse(one + "build " + file("s.2.obj") + " -o " + file(".") + "/one.vtu\n",
           ExitCode::usage_error, {"one.vtu", "by call 1 and by call 2"});
    refuse(one + "convert " + file("one.vtu") + " -o " + file("t.ele") + "\n",
           ExitCode::usage_error, {"one.vtu", "written by call 1 and read by call 2"});
    refuse(one + "build 's.obj\n", ExitCode::usage_error, {"list.txt: line 2", "quote"});
    refuse(one + "[\"build\", 3]\n", ExitCode::usage_error, {"list.txt: line 2", "JSON"});
    refuse(one + "build " + file("s.1.obj") + " --thickness -1 -o " + file("t.vtu"),
           ExitCode::usage_error, {"list.txt: line 2", "--thickness is -1"});
    refuse("# nothing\n", ExitCode::usage_error, {"there is no call in it"});
}

TEST_F(Farm, WhatWouldFailOnTheFarmIsRefusedHere)
{
    spheres(1, 3);
    const struct {
        std::string words;
        int status;
        std::vector<std::string> says;
    } kCases[] = {
        {farm() + build("1-3", "--ouch"), ExitCode::usage_error, {"the call", "--ouch"}},
        {farm() + build("1-3y"), ExitCode::usage_error, {"the call", "at character 4"}},
        {farm() + build("1-3", "--threads 2"), ExitCode::usage_error, {"--cpus"}},
        {farm() + build("1-3", "--no-clobber"), ExitCode::usage_error, {"--no-clobber"}},
        {farm() + build("1-3", "-o " + file("a.vtu")), ExitCode::usage_error, {"a.vtu", "token"}},
        {farm() + build("1-3", "-o " + file("no/a.#.vtu")), ExitCode::write_error, {"no/a.1.vtu"}},
        {farm() + "build " + file("s.#.obj") + " -o " + file("a.#.vtu") + " --frames 1-3",
         ExitCode::usage_error,
         {"--voxel-size"}},
        {farm() + "build " + file("s.1.obj") + " -o " + file("a.vtu"),
         ExitCode::usage_error,
         {"no --frames"}},
        {farm() + "build - --input-format obj -o " + file("a.#.vtu") + " --frames 1",
         ExitCode::usage_error,
         {"standard input"}},
        {farm() + "info x.vdb", ExitCode::usage_error, {"`info` is not for a farm"}},
        {farm() + "build --help", ExitCode::usage_error, {"--help"}},
        {farm() + build("1-3", "--core \"$(printf 'a\\nb')\""),
         ExitCode::usage_error,
         {"line break"}},
        {farm("--name 'a b'") + build("1-3"), ExitCode::usage_error, {"\"a b\""}},
        {"farm --engine pbs -o " + file("j") + " -- " + build("1-3"),
         ExitCode::usage_error,
         {"--engine is pbs", "slurm"}},
        {"farm --engine slurm -o " + file("j"), ExitCode::usage_error, {"--calls"}},
    };
    for (const auto& [words, status, says] : kCases)
        expect_refusal(words, status, says);
    EXPECT_FALSE(there("j.sbatch"));
    EXPECT_FALSE(there("j"));
}

TEST_F(Farm, AsManyTasksRunAtOnceAsIsSaid)
{
    spheres(1, 5);
    const auto array_of = [&](const std::string& more) {
        EXPECT_EQ(run(farm(more) + build("1-5")).status, ExitCode::success);
        const std::string text = read_bytes(folder / "j.sbatch"), begin = "#SBATCH --array=";
        const std::size_t at = text.find(begin);
        EXPECT_NE(at, std::string::npos);
        return text.substr(at + begin.size(), text.find('\n', at) - at - begin.size());
    };
    EXPECT_EQ(array_of("--at-once 2"), "0-2%2");
    EXPECT_EQ(array_of("--at-once 0"), "0-2");
    EXPECT_EQ(array_of(""), "0-2");
    expect_refusal(farm("--at-once -1") + build("1-5"), ExitCode::usage_error, {"--at-once is -1"});
}

TEST_F(Farm, AKilledTaskGoesBackIntoTheQueueAsOftenAsIsSaid)
{
    spheres(1, 3);
    const auto program = [&](const std::string& name, const std::string& script) {
        write_bytes(folder / name, "#!/bin/sh\n" + script + "\n");
        fs::permissions(folder / name, fs::perms::owner_all);
    };
    program("killed", "kill -9 $$");
    program("stopped", "exit 143");
    program("scontrol", "echo \"$@\" >>" + file("asked"));
    // How often the queue is asked, of a task that ends so after each start.
    const auto asked = [&](const std::string& how, const std::string& more, int status) {
        fs::remove(folder / "asked");
        EXPECT_EQ(run(farm("--program " + file(how) + " " + more) + build("1-3")).status,
                  ExitCode::success);
        for (int restarts = 0; restarts < 5; ++restarts)
            EXPECT_EQ(job("", "PATH=" + folder.path().string() +
                                  ":\"$PATH\" SLURM_ARRAY_JOB_ID=5 SLURM_ARRAY_TASK_ID=1 "
                                  "SLURM_RESTART_COUNT=" +
                                  std::to_string(restarts))
                          .status,
                      status);
        return there("asked") ? read_bytes(folder / "asked") : "";
    };
    const std::string once = "requeue 5_1\n";
    EXPECT_EQ(asked("killed", "--retries 3", 137), once + once + once);
    EXPECT_EQ(asked("killed", "", 137), once + once);
    EXPECT_EQ(asked("killed", "--retries 0", 137), "");
    EXPECT_EQ(asked("stopped", "--retries 3", 143), "");
    expect_refusal(farm("--retries -1") + build("1-3"), ExitCode::usage_error, {"--retries is -1"});
}

TEST_F(Farm, MessagesAndManifestsLieInTheFolderThatIsSaid)
{
    spheres(1, 3);
    ASSERT_EQ(run(farm("--directory \"" + file("it's here") + "\"") + build("1-3")).status,
              ExitCode::success);
    EXPECT_FALSE(there("it's here")) << "the job is written and not run";
    for (const char* task : {"task 0", "task 1"})
        EXPECT_EQ(job(task).status, ExitCode::success) << task;
    EXPECT_EQ(job("join").status, ExitCode::success);
    for (const char* name : {"0-0.json", "0-1.json", "call-0.json"})
        EXPECT_TRUE(there(std::string("it's here/") + name)) << name;
    EXPECT_FALSE(there("j.tasks"));
    // Slurm's own messages go there too.
    write_bytes(folder / "sbatch", "#!/bin/sh\necho \"$@\" >>" + file("asked") + "\necho 5\n");
    fs::permissions(folder / "sbatch", fs::perms::owner_all);
    EXPECT_EQ(job("submit", "PATH=" + folder.path().string() + ":\"$PATH\"").status,
              ExitCode::success);
    for (const char* log : {"%a.log", "join.log"})
        EXPECT_NE(read_bytes(folder / "asked").find("--output=" + file("it's here/") + log),
                  std::string::npos)
            << log;
    for (const std::string engine : {"tops", "openjd"}) {
        ASSERT_EQ(run("farm --engine " + engine + " -o " + file("j.json") + " --directory " +
                      file("logs") + " -- " + build("1-3"))
                      .status,
                  ExitCode::success);
        const std::string text = read_bytes(folder / "j.json");
        EXPECT_NE(text.find(file("logs")), std::string::npos) << engine;
        EXPECT_EQ(text.find("j.tasks"), std::string::npos) << engine;
    }
}

TEST_F(Farm, AnotherJobMayMakeTheFramesFirst)
{
    spheres(1, 1);
    spheres(3, 3);
    const Outcome missing = run(farm("--no-clobber") + build("1-3"));
    EXPECT_EQ(missing.status, ExitCode::success);
    EXPECT_NE(missing.err.find("not there yet: 1 of 3, the first of them " + file("s.2.obj")),
              std::string::npos)
        << missing.err;
    expect_refusal(farm("--no-clobber") + build("1-3"), ExitCode::write_error, {"j.sbatch"});
}

TEST_F(Farm, OtherEnginesAreWrittenTheSameCalls)
{
    spheres(1, 5);
    const auto job = [&](const std::string& engine, const std::string& more = "") {
        const Outcome result = run("farm --engine " + engine + " -o " + file("j.json") +
                                   " --chunk 2 " + more + " -- " + build("1-5"));
        EXPECT_EQ(result.status, ExitCode::success) << result.err;
        return json::parse(read_bytes(folder / "j.json"));
    };
    const json list = job("tops");
    ASSERT_EQ(list.at("tasks").size(), 3u);
    const json words = list.at("tasks").at(1).at(0);
    EXPECT_EQ(words.at(0), "vdb_shell");
    EXPECT_NE(std::find(words.begin(), words.end(), "3-4"), words.end()) << words;
    EXPECT_NE(std::find(words.begin(), words.end(), file("s.#.obj")), words.end()) << words;
    const json steps = job("openjd").at("steps");
    ASSERT_EQ(steps.size(), 2u);
    const json space = steps.at(0).at("parameterSpace").at("taskParameterDefinitions").at(0);
    EXPECT_EQ(space.at("range"), json({"1-2", "3-4", "5"}));
    const json chunked = job("openjd", "--task-chunking");
    EXPECT_EQ(chunked.at("extensions"), json::array({"TASK_CHUNKING"}));
    const std::string openjd = "farm --engine openjd -o " + file("o.json");
    expect_refusal(openjd + " --submit -- " + build("1-5"), ExitCode::usage_error,
                   {"--submit needs --engine slurm"});
    expect_refusal(farm("--task-chunking") + build("1-5"), ExitCode::usage_error,
                   {"--task-chunking needs --engine openjd"});
    expect_refusal(openjd + " -- " + build("1-5", "-o " + file("{{x}}.#.vtu")),
                   ExitCode::usage_error, {"{{x}}", "Open Job Description"});
    EXPECT_FALSE(there("o.json"));
}

TEST_F(Farm, NamesThatAreNoUtf8AreRefusedWhereAJobIsJson)
{
    mesh_file("s.1.obj", icosphere(1.0, 2));
    fs::rename(folder / "s.1.obj", folder / "caf\xe9.1.obj");
    const std::string call =
        " -- build " + file("caf\xe9.#.obj") + " --voxel-size 0.1 --frames 1 -o " + file("t.#.vtu");
    for (const std::string engine : {"tops", "openjd"})
        expect_refusal("farm --engine " + engine + " -o " + file("j.json") + call,
                       ExitCode::usage_error, {"caf\xe9.#.obj", "no UTF-8"});
    EXPECT_EQ(run("farm --engine slurm -o " + file("j.sbatch") + call).status, ExitCode::success);
}

TEST_F(Farm, AJoinTakesFilesAndNothingElse)
{
    spheres(1, 1);
    fs::create_directories(folder / "parts" / "x.json");
    fs::create_symlink("nowhere", folder / "parts" / "d.json");
    ASSERT_EQ(::mkfifo(file("parts/f.json").c_str(), 0600), 0);
    ASSERT_EQ(run(build("1", "--manifest " + file("parts/m.json"))).status, ExitCode::success);
    const std::string whole = " --expect 1 -o " + file("w.json");
    const Outcome joined = run("join " + file("parts") + whole);
    EXPECT_EQ(joined.status, ExitCode::success) << joined.err;
    expect_refusal("join " + file("parts/f.json") + whole, ExitCode::read_error,
                   {"f.json", "not a regular file"});
    // What a file says goes to a terminal.
    json noted = json::parse(read_bytes(folder / "parts" / "m.json"));
    noted["steps"][0]["status"] = 3;
    noted["steps"][0]["error"] = "\x1b[2J";
    write_bytes(folder / "parts" / "m.json", noted.dump());
    EXPECT_EQ(run("join " + file("parts") + whole).out.find('\x1b'), std::string::npos);
    write_bytes(folder / "parts" / "foreign.json", "{}");
    expect_refusal("join " + file("parts") + whole, ExitCode::read_error,
                   {"foreign.json: is no manifest"});
}

TEST_F(Farm, LimitsAndNamesHaveAnEnd)
{
    spheres(1, 3);
    expect_refusal(farm("--memory 1e300") + build("1-3"), ExitCode::usage_error,
                   {"--memory is 1e300"});
    expect_refusal(farm("--minutes 1e300") + build("1-3"), ExitCode::usage_error,
                   {"--minutes is 1e300"});
    // Without a pattern, so that a text of them names each.
    std::string frames = "1";
    for (int frame = 2; frame < 45; ++frame)
        frames += "," + std::to_string(10000 * frame * frame * frame);
    const std::string openjd = "farm --engine openjd -o " + file("o.json") + " --chunk ";
    expect_refusal(openjd + "44 -- " + build(frames), ExitCode::usage_error,
                   {"manifest", "limit of 255", "--chunk"});
    EXPECT_FALSE(there("o.json"));
    EXPECT_EQ(run(openjd + "10 -- " + build(frames)).status, ExitCode::success);
}

TEST_F(Farm, WithoutSlurmNothingIsSubmitted)
{
    spheres(1, 3);
    const std::string path = "env PATH=" + file("empty") + " ";
    const std::string line = path + std::string(VDB_SHELL_COMMAND) + " " + farm("--submit") +
                             build("1-3") + " 2>" + file("err");
    const int status = std::system(line.c_str());
    EXPECT_EQ(WEXITSTATUS(status), ExitCode::program_failed);
    EXPECT_NE(read_bytes(folder / "err").find("no Slurm there"), std::string::npos);
    EXPECT_FALSE(there("j.sbatch"));
}

/// What a shell makes of the line.
std::string printed(const std::string& line)
{
    std::string text;
    if (std::FILE* pipe = ::popen(line.c_str(), "r")) {
        for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe))
            text += static_cast<char>(c);
        ::pclose(pipe);
    }
    return text;
}

TEST(ShellWords, AShellReadsAWordAsItWas)
{
    for (const std::string word :
         {"plain",    "",   "a b",  "it's",       "$HOME", "`id`",   "$(id)", "a\"b",
          "a\\b",     "*",  "~",    "#a",         "a;b",   "{1..3}", "!x",    "-",
          "\xc3\xa9", "''", "a\tb", "s.####.obj", "%04d",  "$F4"}) {
        EXPECT_EQ(printed("printf %s " + command::quoted(word)), word);
        EXPECT_EQ(printed("bash -c " + command::quoted("printf %s " + command::quoted(word))),
                  word);
        EXPECT_EQ(command::split_words("x " + command::quoted(word) + " y", "here"),
                  (std::vector<std::string>{"x", word, "y"}));
    }
    EXPECT_EQ(command::split_words(R"( a\ b "c \" \d" 'e'f  )", "here"),
              (std::vector<std::string>{"a b", R"(c " \d)", "ef"}));
    EXPECT_THROW(command::split_words("a 'b", "here"), InvalidOption);
}

} // namespace
} // namespace vdb_shell::test
