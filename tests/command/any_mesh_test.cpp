// SPDX-License-Identifier: Apache-2.0
#include "command_fixture.h"
#include "support/faulty_shapes.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/write/vdb_file.h"

#include <nlohmann/json.hpp>
#include <openvdb/points/PointConversion.h>

#include <array>
#include <charconv>
#include <fstream>
#include <sstream>

// Coordinates of any size and place, and surfaces of any kind: what inspect, build, --repair,
// --wrap and --mend make of them.

namespace vdb_shell::test
{
namespace
{

using command::ExitCode;
using nlohmann::json;
using openvdb::Vec3d;

std::string digits(double value)
{
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    return {text.data(), end};
}

/// The points as text of doubles, at origin + unit * point.
std::string placed_points(const TriangleMesh& mesh, const Vec3d& origin, double unit,
                          const char* before)
{
    std::string text;
    for (const openvdb::Vec3s& p : mesh.points) {
        text += before;
        for (int axis = 0; axis < 3; ++axis)
            text += digits(origin[axis] + unit * double(p[axis])) + (axis < 2 ? " " : "\n");
    }
    return text;
}

std::string faces(const TriangleMesh& mesh, const char* before, std::uint32_t base)
{
    std::string text;
    for (const openvdb::Vec3I& t : mesh.triangles)
        text += std::string(before) + std::to_string(t[0] + base) + " " +
                std::to_string(t[1] + base) + " " + std::to_string(t[2] + base) + "\n";
    return text;
}

std::string counts(const TriangleMesh& mesh, const char* between)
{
    return std::to_string(mesh.points.size()) + between + std::to_string(mesh.triangles.size());
}

/// The file's text in the format of the extension.
std::string mesh_text(const std::string& extension, const TriangleMesh& mesh, const Vec3d& origin,
                      double unit)
{
    if (extension == ".obj")
        return placed_points(mesh, origin, unit, "v ") + faces(mesh, "f ", 1);
    const std::string body = placed_points(mesh, origin, unit, "") + faces(mesh, "3 ", 0);
    if (extension == ".off")
        return "OFF\n" + counts(mesh, " ") + " 0\n" + body;
    return "ply\nformat ascii 1.0\nelement vertex " +
           counts(mesh, "\nproperty double x\nproperty double y\nproperty double z\nelement "
                        "face ") +
           "\nproperty list uchar int vertex_indices\nend_header\n" + body;
}

class AnyMesh : public Command
{
protected:
    std::string placed_file(const std::string& name, const TriangleMesh& mesh, const Vec3d& origin,
                            double unit = 1)
    {
        std::ofstream(folder / name)
            << mesh_text(std::filesystem::path(name).extension().string(), mesh, origin, unit);
        return file(name);
    }
    json report(const std::string& name) { return json::parse(read_bytes(folder / name)); }
};

TEST_F(AnyMesh, KeepsItsShapeFarFromTheOriginWhenRecentred)
{
    const TriangleMesh sphere = icosphere(1.0, 3);
    const double volume = signed_volume(sphere.points, sphere.triangles);
    for (const char* extension : {".obj", ".ply", ".off"})
        for (const double far : {1e6, 1e7, 1e8}) {
            SCOPED_TRACE(std::string(extension) + " at " + digits(far));
            const Vec3d origin(far, -far, 0.5 * far + 0.3);
            const std::string path = placed_file(std::string("far") + extension, sphere, origin);
            ReadOptions options;
            options.recentre = true;
            const ReadResult read = read_mesh(path, options);
            EXPECT_EQ(read.report.placement.unit, 1.0);
            EXPECT_NEAR(signed_volume(read.mesh.points, read.mesh.triangles), volume,
                        1e-5 * volume);
            for (std::size_t v = 0; v < sphere.points.size(); ++v) {
                const Vec3d there = read.report.placement.in_file(read.mesh.points[v]);
                EXPECT_LT((there - (origin + Vec3d(sphere.points[v]))).length(), 1e-6 + 1e-15 * far)
                    << v;
            }
            EXPECT_LT(read.report.largest_rounding, 1e-6);
            if (far < 1e8)
                EXPECT_GT(read_mesh(path).report.largest_rounding, 1e-2);
            else
                EXPECT_THROW(read_mesh(path), ReadError);
        }
}

TEST_F(AnyMesh, FarFromTheOriginIsRefusedByNameUnlessRecentred)
{
    const std::string far = placed_file("far.obj", icosphere(1.0, 3), Vec3d(1e6, 2e6, 0));
    const Outcome looked = run("inspect " + far);
    EXPECT_EQ(looked.status, ExitCode::check_failed);
    EXPECT_NE(looked.out.find("--recentre keeps the digits that the file has"), std::string::npos)
        << looked.out;
    // Before it is refused, what reading has lost is told.
    const Outcome refused = run("build " + far + kCoarse);
    EXPECT_EQ(refused.status, ExitCode::geometry_error);
    for (const char* said : {"far.obj: rounding", "voxel index", "over the limit", "--recentre"})
        EXPECT_NE(refused.err.find(said), std::string::npos) << refused.err;
    expect_refusal("build " + placed_file("farther.obj", icosphere(1.0, 3), Vec3d(1e8, 2e8, 5e7)) +
                       kCoarse,
                   ExitCode::read_error, {"farther.obj", "--recentre"});
    EXPECT_EQ(run("inspect --recentre " + far).status, ExitCode::success);
}

TEST_F(AnyMesh, FilesOfARecentredShellStandWhereTheMeshStood)
{
    const TriangleMesh sphere = icosphere(1.0, 2);
    const Vec3d origin(1e7, -2e7, 3e6 + 0.25);
    const std::string far = placed_file("far.obj", sphere, origin);
    const Outcome built =
        run("build --recentre " + far + kCoarse + "-o " + file("s.vdb") + " -o " + file("s.node") +
            " -o " + file("inner.obj") + " -o " + file("s.bgeo") + " --report " + file("s.json"));
    ASSERT_EQ(built.status, ExitCode::success) << built.err;
    EXPECT_EQ(run("check " + file("s.vdb")).status, ExitCode::success);
    EXPECT_EQ(run("check " + file("s.bgeo")).status, ExitCode::success);
    const auto there = report("s.json")["read"]["placement"]["origin"];
    openvdb::initialize();
    const auto grid = read_float_grid(folder / "s.vdb", "surface");
    const openvdb::BBoxd box = grid->transform().indexToWorld(grid->evalActiveVoxelBoundingBox());
    EXPECT_LT((box.getCenter() - origin).length(), 0.2) << box;
    const ShellFile shell = read_shell_vdb(folder / "s.vdb");
    EXPECT_EQ(shell.placement.origin, Vec3d(there[0], there[1], there[2]));
    EXPECT_EQ(grid->transform().voxelSize(), shell.surface->transform().voxelSize());
    std::istringstream nodes(read_bytes(folder / "s.node"));
    std::string comment;
    std::getline(nodes, comment);
    std::size_t count = 0, skip = 0, index = 0;
    nodes >> count >> skip >> skip >> skip;
    ASSERT_EQ(count, shell.tets.points.size());
    for (std::size_t i = 0; i < count; ++i) {
        Vec3d p;
        nodes >> index >> p[0] >> p[1] >> p[2] >> skip >> skip;
        EXPECT_EQ(p, shell.placement.in_file(shell.tets.points[i])) << i;
    }
    ReadOptions recentred;
    recentred.recentre = true;
    EXPECT_LT(read_mesh(folder / "inner.obj", recentred).report.largest_rounding, 1e-6);
    // What was read back is written to the same places.
    ASSERT_EQ(run("convert " + file("s.bgeo") + " -o " + file("again.node")).status,
              ExitCode::success);
    EXPECT_EQ(read_bytes(folder / "again.node"), read_bytes(folder / "s.node"));
    ASSERT_EQ(run("convert " + file("s.vdb") + " -o " + file("third.node")).status,
              ExitCode::success);
    EXPECT_EQ(read_bytes(folder / "third.node"), read_bytes(folder / "s.node"));
}

TEST_F(AnyMesh, StlCannotSayWhereAShellStands)
{
    const std::string far = placed_file("far.obj", icosphere(1.0, 2), Vec3d(1e7, 0, 0));
    expect_refusal("build --recentre " + far + kCoarse + "-o " + file("inner.stl"),
                   ExitCode::usage_error, {"inner.stl", "float32"});
}

TEST_F(AnyMesh, MicronsInMetresAndTheOrbitOfTheMoonAreRescaled)
{
    for (const double unit : {3e-6, 1e9, 1e17}) {
        SCOPED_TRACE(digits(unit));
        const std::string mesh = placed_file("s.obj", icosphere(1.0, 2), Vec3d(0.0), unit);
        const Outcome built =
            run("build --rescale " + mesh + kCoarse + "--thickness " + digits(0.2 * unit) + " -o " +
                file("s.vdb") + " -o " + file("s.node") + " --report " + file("s.json"));
        ASSERT_EQ(built.status, ExitCode::success) << built.err;
        const json figures = report("s.json");
        EXPECT_EQ(figures["certificate"]["certified"], true);
        const double scale = figures["read"]["placement"]["unit"];
        EXPECT_LE(double(figures["lines"]["length"]["max"]) * scale, 0.2001 * unit);
        EXPECT_EQ(run("check " + file("s.vdb")).status, ExitCode::success);
        const ShellFile shell = read_shell_vdb(folder / "s.vdb");
        EXPECT_EQ(shell.placement.unit, scale);
        // A power of two, so nothing is rounded on the way back.
        for (std::size_t v = 0; v < shell.stack.surface(0).size(); ++v)
            EXPECT_NEAR(shell.placement.in_file(shell.stack.surface(0)[v]).length(), unit,
                        1e-6 * unit);
    }
    const std::string tiny = placed_file("tiny.obj", icosphere(1.0, 2), Vec3d(0.0), 3e-6);
    expect_refusal("build " + tiny + kCoarse, ExitCode::geometry_error, {"--rescale"});
    EXPECT_NE(run("inspect " + tiny).out.find("--rescale"), std::string::npos);
}

TEST_F(AnyMesh, SizesBeyondTheBroadPhaseAreRefusedByNameUnlessRescaled)
{
    const std::string huge = placed_file("huge.obj", icosphere(1.0, 2), Vec3d(0.0), 3e18);
    expect_refusal("build " + huge + kCoarse, ExitCode::read_error,
                   {"huge.obj", "vertex 0 (line 1)", "1e+18", "--rescale"});
    EXPECT_EQ(run("build --rescale " + huge + kCoarse).status, ExitCode::success);
}

/// What each way must come to. `repaired`: exit status of build --repair.
struct Expected {
    const char* name;
    TriangleMesh mesh;
    const char* finding; ///< of inspect; empty: none in the way
    int plain, repaired;
};

TEST_F(AnyMesh, EveryKindOfSurfaceIsBuiltOrRefusedByNameWrappedAndMended)
{
    const TriangleMesh nested = joined(icosphere(1.0, 2), reversed(icosphere(0.5, 2)));
    const std::vector<Expected> kinds{
        {"tetrahedron", unit_tetrahedron(), "", ExitCode::success, ExitCode::success},
        {"touching", touching_spheres(2, 0), "non_manifold_vertices", ExitCode::geometry_error,
         ExitCode::success},
        {"nested", nested, "", ExitCode::success, ExitCode::success},
        {"moebius", moebius_strip(24, 3), "one_sided_pieces", ExitCode::geometry_error,
         ExitCode::geometry_error},
        {"klein", klein_bottle(24, 12), "one_sided_pieces", ExitCode::geometry_error,
         ExitCode::geometry_error}};
    for (const Expected& kind : kinds) {
        SCOPED_TRACE(kind.name);
        const std::string mesh = mesh_file(std::string(kind.name) + ".obj", kind.mesh);
        const Outcome looked = run("inspect --json " + mesh);
        const bool sound = *kind.finding == '\0';
        EXPECT_EQ(looked.status, sound ? ExitCode::success : ExitCode::check_failed);
        EXPECT_EQ(json::parse(looked.out)["usable"], sound);
        EXPECT_NE(looked.out.find(kind.finding), std::string::npos) << looked.out;
        const auto expect = [&](const std::string& flags, int status) {
            const Outcome built =
                run("build " + mesh + kCoarse + flags + " --report " + file("r.json"));
            EXPECT_EQ(built.status, status) << flags << '\n' << built.err;
            if (status == ExitCode::success && built.status == status)
                EXPECT_EQ(report("r.json")["certificate"]["certified"], true) << flags;
            else
                EXPECT_NE(built.err.find(kind.name), std::string::npos) << built.err;
        };
        expect("", kind.plain);
        expect("--repair", kind.repaired);
        expect("--wrap --wrap-resolution 24", ExitCode::success);
        expect("--mend --wrap-resolution 24", ExitCode::success);
        // As little as makes it usable.
        EXPECT_EQ(report("r.json")["mend"].back()["tried"], sound ? "as-it-is"
                                                            : kind.repaired == ExitCode::success
                                                                ? "repair"
                                                                : "wrap");
    }
}

} // namespace
} // namespace vdb_shell::test
