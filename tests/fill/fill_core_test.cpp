// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/fill/fill_core.h"

#include "support/files.h"
#include "support/filled.h"
#include "support/stacks.h"
#include "vdb_shell/shell/tessellate.h"

#include "fill/outside_program.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <sstream>

// Cores of the real programs, where they are installed, and of programs that do it wrong.

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;
using openvdb::Vec3s;
using openvdb::Vec4I;

/// Programs of the test's own in front of PATH, which is as it was afterwards.
class ProgramsOnPath
{
public:
    ProgramsOnPath() : before_(std::getenv("PATH")) { set(folder_.path().string()); }
    ~ProgramsOnPath() { set(before_); }
    ProgramsOnPath(const ProgramsOnPath&) = delete;
    ProgramsOnPath& operator=(const ProgramsOnPath&) = delete;

    void add(const std::string& name, const std::string& script)
    {
        test::write_bytes(folder_ / name, "#!/bin/sh\n" + script + "\n");
        fs::permissions(folder_ / name, fs::perms::owner_all);
    }
    fs::path file(const std::string& name) const { return folder_ / name; }

private:
    static void set(const std::string& path) { ::setenv("PATH", path.c_str(), 1); }
    test::TemporaryFolder folder_;
    std::string before_;
};

CoreFillOptions by(CoreFillProgram program)
{
    CoreFillOptions options;
    options.program = program;
    return options;
}

void expect_one_solid(const ShellStack& stack, const CoreFillOptions& options)
{
    const TetMesh tets = make_tets(stack);
    const CoreFill made = fill_core(stack, tets, options);
    EXPECT_EQ(made.report.certificate.failures(), std::vector<std::string>{});
    EXPECT_EQ(made.report.tets, made.core.tets.size());
    EXPECT_GT(made.report.tets, 0U);
    const double solid = signed_volume(stack.surface(0), stack.triangles());
    EXPECT_NEAR(tet_volume(joined_tets(tets, made.core)), solid, 1e-12 * solid);
    EXPECT_NEAR(tet_volume(tets) + made.report.volume, solid, 1e-12 * solid);
    EXPECT_GT(made.report.min_dihedral_radians, 0);
}

class WithProgram : public ::testing::TestWithParam<CoreFillProgram>
{
protected:
    void SetUp() override
    {
        if (fill::find_program(name_in_table(GetParam())).empty())
            GTEST_SKIP() << name_in_table(GetParam()) << " is not installed";
    }
};
INSTANTIATE_TEST_SUITE_P(, WithProgram,
                         ::testing::Values(CoreFillProgram::gmsh, CoreFillProgram::tetgen),
                         [](const auto& test) { return name_in_table(test.param); });

TEST_P(WithProgram, FillsABallExactly)
{
    expect_one_solid(test::hollow_ball(2), by(GetParam()));
}

TEST_P(WithProgram, FillsWhatHasNoShellAtAll)
{
    expect_one_solid(test::empty_shell(test::icosphere(1, 1)), by(GetParam()));
}

/// Two balls, and one with a cavity, which is not filled.
TEST_P(WithProgram, FillsSeveralVoidsAndNoCavity)
{
    TriangleMesh mesh =
        test::joined(test::icosphere(1, 2), test::translated(test::icosphere(0.5, 1), {3, 0, 0}));
    mesh = test::joined(mesh, test::reversed(test::icosphere(0.3, 1)));
    // The cavity's shell lies around it.
    PrismShell shell = test::radial_shell(mesh, [](std::size_t) { return 0.0; });
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        const bool second = mesh.points[v][0] > 2;
        const Vec3s centre(second ? 3.0f : 0.0f, 0, 0);
        const float factor = second ? 0.5f : mesh.points[v].length() < 0.4f ? 1.4f : 0.8f;
        shell.inner[v] = centre + (mesh.points[v] - centre) * factor;
    }
    const PrismSplit split = split_prisms(shell, {});
    const ShellStack stack = one_layer(shell, split);
    test::expect_certified(stack, PrismTest::twelve_tets);
    expect_one_solid(stack, by(GetParam()));
}

/// What surfaces inside enclose stays empty, and all their triangles are faces of the core.
TEST_P(WithProgram, LeavesHolesEmpty)
{
    const ShellStack stack = test::hollow_ball(2);
    const TetMesh tets = make_tets(stack);
    const TriangleMesh holes =
        test::joined(test::translated(test::icosphere(0.1, 1), {0.15, 0, 0}),
                     test::translated(test::icosphere(0.1, 1), {-0.15, 0, 0}));
    const CoreFill made = fill_core(stack, tets, by(GetParam()), nullptr, holes);
    EXPECT_EQ(made.report.certificate.failures(), std::vector<std::string>{});
    const double solid = signed_volume(stack.surface(0), stack.triangles()) -
                         signed_volume(holes.points, holes.triangles);
    EXPECT_NEAR(tet_volume(joined_tets(tets, made.core)), solid, 1e-12 * solid);
    // They are found again in what was made, and without them nothing is proven.
    const TriangleMesh found = holes_of_core(stack, tets, made.core);
    EXPECT_EQ(found.points, holes.points);
    EXPECT_EQ(found.triangles.size(), holes.triangles.size());
    EXPECT_NEAR(signed_volume(found.points, found.triangles),
                signed_volume(holes.points, holes.triangles), 1e-9);
    EXPECT_TRUE(certify_core(stack, tets, made.core, found).certified());
    EXPECT_FALSE(certify_core(stack, tets, made.core).certified());
}

TEST_P(WithProgram, FillsATaperedShellWhoseInnerSurfaceSharesPoints)
{
    expect_one_solid(test::pinched_rod(), by(GetParam()));
}

TEST_P(WithProgram, SmallerTetsOnDemand)
{
    const ShellStack stack = test::hollow_ball(2);
    const TetMesh tets = make_tets(stack);
    CoreFillOptions fine = by(GetParam());
    fine.edge_length = 0.06;
    const std::size_t coarse = fill_core(stack, tets, by(GetParam())).report.tets;
    EXPECT_GT(fill_core(stack, tets, fine).report.tets, 3 * coarse);
}

TEST_P(WithProgram, GivesTheSameTwice)
{
    const ShellStack stack = test::hollow_ball(2);
    const TetMesh tets = make_tets(stack);
    const CoreTets first = fill_core(stack, tets, by(GetParam())).core;
    const CoreTets second = fill_core(stack, tets, by(GetParam())).core;
    EXPECT_EQ(first.points, second.points);
    EXPECT_EQ(first.tets, second.tets);
}

TEST_P(WithProgram, NothingIsLeftToFillWhereTheShellIsSolid)
{
    const ShellStack stack = test::coned(test::octahedron(), Vec3s(0));
    const CoreFill made = fill_core(stack, make_tets(stack), by(GetParam()));
    EXPECT_EQ(made.report.void_triangles, 0U);
    EXPECT_TRUE(made.core.empty());
    EXPECT_TRUE(made.report.certificate.certified());
}

/// A program under TetGen's name that copies files which the test has made.
class Pretended : public ::testing::Test
{
protected:
    /// Tets from the triangles of the void to a point in the middle, as a program sees them.
    Pretended()
    {
        const VoidSurface surface = void_surface(stack, tets);
        // The inner points of a ball follow each other, and all of them bound the void.
        const auto first = std::uint32_t(stack.surface(0).size());
        points.assign(surface.points.begin() + first, surface.points.end());
        const auto apex = std::uint32_t(points.size());
        points.emplace_back(0.01f, 0.02f, 0.03f);
        for (const openvdb::Vec3I& t : surface.triangles)
            corners.emplace_back(t[0] - first, t[2] - first, t[1] - first, apex);
    }

    void put_files()
    {
        std::ostringstream node, ele;
        node << std::setprecision(17) << points.size() << " 3 0 0\n";
        for (std::size_t i = 0; i < points.size(); ++i)
            node << i << ' ' << points[i][0] << ' ' << points[i][1] << ' ' << points[i][2] << '\n';
        ele << corners.size() << " 4 0\n";
        for (std::size_t t = 0; t < corners.size(); ++t)
            ele << t << ' ' << corners[t][0] << ' ' << corners[t][1] << ' ' << corners[t][2] << ' '
                << corners[t][3] << '\n';
        test::write_bytes(programs.file("node"), node.str());
        test::write_bytes(programs.file("ele"), ele.str());
    }

    std::string message()
    {
        const std::string folder = programs.file("").string();
        programs.add("tetgen", before + "/bin/cp '" + folder +
                                   "node' \"${2%.poly}.1.node\" && /bin/cp '" + folder +
                                   "ele' \"${2%.poly}.1.ele\"");
        try {
            made = fill_core(stack, tets, by(CoreFillProgram::tetgen));
        } catch (const ProgramError& error) {
            return error.what();
        }
        return "taken";
    }

    void expect_refused(const std::vector<std::string>& words)
    {
        const std::string text = message();
        for (const std::string& word : words)
            EXPECT_NE(text.find(word), std::string::npos) << '"' << word << "\" not in: " << text;
    }

    ShellStack stack = test::hollow_ball();
    TetMesh tets = make_tets(stack);
    ProgramsOnPath programs;
    std::vector<Vec3s> points;
    std::vector<Vec4I> corners;
    std::string before; ///< of the script
    CoreFill made;
};

TEST_F(Pretended, SoundTetsAreTakenWhoeverMadeThem)
{
    put_files();
    EXPECT_EQ(message(), "taken");
    EXPECT_EQ(made.core.tets.size(), 80U);
    EXPECT_EQ(made.core.points, std::vector<Vec3s>{points.back()});
}

TEST_F(Pretended, TetsTurnedRoundAsAWholeAreTakenToo)
{
    for (Vec4I& t : corners)
        std::swap(t[0], t[1]);
    put_files();
    EXPECT_EQ(message(), "taken");
}

/// Three tets instead of one, with a corner in the middle of a triangle of the void.
TEST_F(Pretended, ACutTriangleIsMadeWholeByATetBehindIt)
{
    const Vec4I t = corners[3];
    const auto middle = std::uint32_t(points.size());
    points.push_back((points[t[0]] + points[t[1]] + points[t[2]]) / 3.0f);
    corners[3] = Vec4I(t[0], t[1], middle, t[3]);
    corners.emplace_back(t[1], t[2], middle, t[3]);
    corners.emplace_back(t[2], t[0], middle, t[3]);
    put_files();
    EXPECT_EQ(message(), "taken");
    EXPECT_EQ(made.core.tets.size(), 83U);
    EXPECT_EQ(made.report.moved_points, 1U);
}

/// The two tets at an edge are cut by a point on it.
TEST_F(Pretended, ACutEdgeIsMadeWholeByTwoTets)
{
    const Vec4I t = corners[3];
    const std::uint32_t a = t[0], b = t[1], middle = std::uint32_t(points.size());
    points.push_back((points[a] + points[b]) * 0.5f);
    std::vector<Vec4I> cut;
    for (const Vec4I& tet : corners) {
        Vec4I first = tet, second = tet;
        bool has_a = false, has_b = false;
        for (int k = 0; k < 3; ++k) {
            has_a |= tet[k] == a;
            has_b |= tet[k] == b;
            first[k] = tet[k] == a ? middle : tet[k];
            second[k] = tet[k] == b ? middle : tet[k];
        }
        if (has_a && has_b)
            cut.insert(cut.end(), {first, second});
        else
            cut.push_back(tet);
    }
    corners = cut;
    put_files();
    EXPECT_EQ(message(), "taken");
    EXPECT_EQ(made.core.tets.size(), 84U);
}

TEST_F(Pretended, LostTetsAreRefused)
{
    corners.resize(40);
    put_files();
    expect_refused({"do not fit", "missing_triangles", "stray_faces"});
}

TEST_F(Pretended, ASingleTetTheOtherWayRoundIsTurnedAsItsNeighbours)
{
    std::swap(corners[7][0], corners[7][1]);
    put_files();
    EXPECT_EQ(message(), "taken");
}

TEST_F(Pretended, APointThatTurnsTetsOverIsMovedIfThatHelps)
{
    points.back() = Vec3s(5, 5, 5);
    put_files();
    EXPECT_EQ(message(), "taken");
    EXPECT_EQ(made.report.moved_points, 1U);
}

TEST_F(Pretended, ATetThatIsThereTwiceIsRefused)
{
    corners.push_back(corners.front());
    put_files();
    expect_refused({"crowded_faces"});
    corners.pop_back();
    // Of a corner that is there twice.
    corners.emplace_back(0, 1, 2, 0);
    put_files();
    EXPECT_EQ(message(), "taken") << "what hangs on no triangle is left out";
    EXPECT_EQ(made.core.tets.size(), 80U);
}

TEST_F(Pretended, APointOfTheSurfaceThatMovedIsRefused)
{
    points[4][0] += 1e-6f;
    put_files();
    expect_refused({"another point 4"});
    points.resize(10);
    for (Vec4I& t : corners)
        t = Vec4I(0, 1, 2, 3);
    put_files();
    expect_refused({"10 points of the 42"});
}

TEST_F(Pretended, FilesThatAreNotWholeAreRefused)
{
    put_files();
    const std::string ele = test::read_bytes(programs.file("ele"));
    test::write_bytes(programs.file("ele"), ele.substr(0, ele.size() / 2));
    expect_refused({"void.1.ele", "ends early"});
    test::write_bytes(programs.file("ele"), "garbage");
    expect_refused({"void.1.ele", "no number"});
    test::write_bytes(programs.file("ele"), "1 4 0\n0 1 2 3 4000000000\n");
    expect_refused({"corner 4000000000 of 43 points"});
    test::write_bytes(programs.file("ele"), "1 10 0\n");
    expect_refused({"another kind"});
    test::write_bytes(programs.file("node"), "4000000000 3 0 0\n0 1 2 3\n");
    expect_refused({"void.1.node", "ends early"});
}

TEST_F(Pretended, AProgramThatWritesNothingOrFailsIsRefused)
{
    put_files();
    before = "exit 0\n";
    expect_refused({"void.1.node", "was not written"});
    before = "echo a facet crosses another; exit 1\n";
    expect_refused({"status 1", "it said: a facet crosses another"});
}

TEST_F(Pretended, NoTemporaryFileIsLeft)
{
    const test::TemporaryFolder temporary;
    ::setenv("TMPDIR", temporary.path().c_str(), 1);
    put_files();
    EXPECT_EQ(message(), "taken");
    before = "exit 1\n";
    EXPECT_NE(message(), "taken");
    ::unsetenv("TMPDIR");
    EXPECT_TRUE(fs::is_empty(temporary.path()));
}

TEST(FillCore, AMissingProgramIsNamed)
{
    const ProgramsOnPath nothing;
    for (const CoreFillProgram program : {CoreFillProgram::gmsh, CoreFillProgram::tetgen}) {
        const ShellStack stack = test::hollow_ball();
        try {
            fill_core(stack, make_tets(stack), by(program));
            FAIL() << "accepted";
        } catch (const ProgramError& error) {
            EXPECT_NE(std::string(error.what()).find("no program " + name_in_table(program)),
                      std::string::npos);
        }
    }
    EXPECT_NO_THROW(require_program({}));
}

TEST(FillCore, CanBeCancelled)
{
    ProgramsOnPath programs;
    programs.add("gmsh", "exec /bin/sleep 60");
    const ShellStack stack = test::hollow_ball();
    const TetMesh tets = make_tets(stack);
    test::expect_cancelled([&](Interrupter* interrupter) {
        fill_core(stack, tets, by(CoreFillProgram::gmsh), interrupter);
    });
}

} // namespace
} // namespace vdb_shell
