// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/io/read_mesh.h"

#include "command/exit_code.h"
#include "support/files.h"

#include <gtest/gtest.h>

#include <sys/wait.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

// Runs the real command as a user would.

namespace vdb_shell::test
{

struct Outcome {
    int status = -1;
    std::string out, err;
};

class Command : public ::testing::Test
{
protected:
    Outcome run(const std::string& arguments)
    {
        const std::string line = std::string(VDB_SHELL_COMMAND) + " " + arguments + " >" +
                                 (folder / "out").string() + " 2>" + (folder / "err").string();
        const int status = std::system(line.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_bytes(folder / "out"),
                read_bytes(folder / "err")};
    }

    std::string file(const std::string& name) { return (folder / name).string(); }

    std::string mesh_file(const std::string& name, const TriangleMesh& mesh)
    {
        write_mesh(folder / name, mesh);
        return file(name);
    }

    /// The command fails with this status, says all of `words`, and prints one line.
    void expect_refusal(const std::string& arguments, int status,
                        const std::vector<std::string>& words)
    {
        expect_lines(arguments, status, words, 1);
    }

    /// The same of a call that is no call of this command: a second line points to the help.
    void expect_no_call(const std::string& arguments, const std::vector<std::string>& words)
    {
        expect_lines(arguments, command::usage_error, words, 2);
    }

    TemporaryFolder folder;

private:
    void expect_lines(const std::string& arguments, int status,
                      const std::vector<std::string>& words, std::ptrdiff_t lines)
    {
        const Outcome result = run(arguments);
        const std::string& said = result.err;
        EXPECT_EQ(result.status, status) << arguments << '\n' << said;
        for (const std::string& word : words)
            EXPECT_NE(said.find(word), std::string::npos)
                << '"' << word << "\" is not in: " << said;
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), lines) << arguments << '\n' << said;
        EXPECT_TRUE(!said.empty() && said.back() == '\n') << arguments << '\n' << said;
    }
};

inline constexpr const char* kCoarse = " --resolution 24 --samples 1000 ";

} // namespace vdb_shell::test
