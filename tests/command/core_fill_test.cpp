// SPDX-License-Identifier: Apache-2.0
#include "support/shapes.h"

#include "command/command_fixture.h"

#include <cstdlib>

// --core-fill, as a user meets it.

namespace vdb_shell
{
namespace
{

using test::kCoarse;

class CoreFillCommand : public test::Command
{
protected:
    ~CoreFillCommand() override { ::setenv("PATH", path.c_str(), 1); }

    /// A program of that name, and no other on PATH.
    void pretend(const std::string& name, const std::string& script)
    {
        const std::filesystem::path program = folder / "bin" / name;
        std::filesystem::create_directories(program.parent_path());
        test::write_bytes(program, "#!/bin/sh\n" + script + "\n");
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        ::setenv("PATH", program.parent_path().c_str(), 1);
    }

    std::string path = std::getenv("PATH");
    std::string ball = mesh_file("ball.obj", test::icosphere(1, 2));
    std::string words = "build " + ball + kCoarse + "-q --thickness-scale 0.5 --core-fill tetgen ";
};

TEST_F(CoreFillCommand, AMissingProgramIsNamedBeforeTheWork)
{
    ::setenv("PATH", folder.path().c_str(), 1);
    expect_refusal(words + "-o " + file("out.vdb"), command::program_failed,
                   {"--core-fill tetgen", "no program tetgen", "PATH"});
    expect_refusal("build " + file("none.obj") + " --core-fill gmsh -o " + file("out.vdb"),
                   command::program_failed, {"no program gmsh"});
}

TEST_F(CoreFillCommand, AFailureLeavesTheOldOutputAsItIs)
{
    test::write_bytes(folder / "out.vdb", "old");
    pretend("tetgen", "echo two facets cross; exit 3");
    expect_refusal(words + "-o " + file("out.vdb"), command::program_failed,
                   {"status 3", "it said: two facets cross"});
    pretend("tetgen", "exec /bin/sleep 60");
    expect_refusal(words + "--core-fill-seconds 0.2 -o " + file("out.vdb"), command::program_failed,
                   {"time limit"});
    EXPECT_EQ(test::read_bytes(folder / "out.vdb"), "old");
}

TEST_F(CoreFillCommand, RefusesWhatContradictsItBeforeTheWork)
{
    pretend("tetgen", "exit 1");
    for (const std::string wrong : {"--side both", "--method raw", "--allow-self-intersections"})
        expect_refusal(words + wrong + " -o " + file("out.vdb"), command::usage_error,
                       {"--core-fill is not for"});
}

} // namespace
} // namespace vdb_shell
