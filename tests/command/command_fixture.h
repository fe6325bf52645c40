// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/io/read_mesh.h"

#include "command/exit_code.h"
#include "support/files.h"

#include <gtest/gtest.h>

#include <sys/wait.h>

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
        const Outcome result = run(arguments);
        EXPECT_EQ(result.status, status) << arguments << '\n' << result.err;
        for (const std::string& word : words)
            EXPECT_NE(result.err.find(word), std::string::npos)
                << '"' << word << "\" is not in: " << result.err;
    }

    TemporaryFolder folder;
};

inline constexpr const char* kCoarse = " --resolution 24 --samples 1000 ";

} // namespace vdb_shell::test
