// SPDX-License-Identifier: Apache-2.0
#include "command_fixture.h"

#include "support/files.h"
#include "support/shapes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// `compare`, and pictures in space.

namespace vdb_shell::test
{
namespace
{

using command::ExitCode;

class Compare : public Command
{
protected:
    Compare()
    {
        const std::string mesh = mesh_file("ball.obj", icosphere(1.0, 2));
        EXPECT_EQ(run("build " + mesh + kCoarse + " -q -o " + a).status, ExitCode::success);
        EXPECT_EQ(run("build " + mesh + kCoarse + " -q --thickness 0.25 -o " + b).status,
                  ExitCode::success);
    }

    const std::string a = file("a.vdb"), b = file("b.vdb");
};

TEST_F(Compare, SaysWhatDiffersAndDrawsBoth)
{
    const Outcome text = run("compare " + a + " " + b + " -o " + file("ab.png"));
    ASSERT_EQ(text.status, ExitCode::success) << text.err;
    EXPECT_NE(text.out.find("outer points in the same places"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("thickness: null, 0.25"), std::string::npos) << text.out;
    EXPECT_EQ(read_bytes(file("ab.png")).substr(1, 3), "PNG");
    const Outcome same = run("compare --json " + a + " " + a);
    EXPECT_EQ(nlohmann::json::parse(same.out)["same_bits"], true);
}

TEST_F(Compare, RefusesWhatItCannotReadOrDraw)
{
    expect_no_call("compare " + a, {"second"});
    expect_refusal("compare " + a + " " + file("none.vdb"), ExitCode::read_error, {"none.vdb"});
    expect_refusal("compare " + a + " " + b + " -o " + file("ab.jpg"), ExitCode::usage_error,
                   {"ab.jpg", ".png"});
    expect_refusal("compare " + a + " " + b + " -o " + a, ExitCode::usage_error, {"a.vdb"});
    expect_refusal("compare " + a + " " + b + " --section-axis x", ExitCode::usage_error,
                   {"--section-axis", "--output .png"});
}

TEST_F(Compare, ATurntableIsASequence)
{
    const Outcome turned = run("convert " + a +
                               " --frames 1-4 --picture cut-away --turntable 4 "
                               "--turntable-frame %d --picture-width 64 -o " +
                               file("t.#.png"));
    ASSERT_EQ(turned.status, ExitCode::success) << turned.err;
    EXPECT_NE(read_bytes(file("t.1.png")), read_bytes(file("t.2.png")));
    expect_refusal("convert " + a + " --turntable-frame 1 -o " + file("t.png"),
                   ExitCode::usage_error, {"--turntable-frame", "--turntable"});
    expect_refusal("convert " + a + " --turntable 4 -o " + file("t.png"), ExitCode::usage_error,
                   {"--turntable", "--picture surface cut-away"});
    expect_refusal("convert " + a + " --section-axis view -o " + file("t.png"),
                   ExitCode::usage_error, {"--section-axis view", "cut-away"});
}

} // namespace
} // namespace vdb_shell::test
