// SPDX-License-Identifier: Apache-2.0
#include "shapes/bones.h"
#include "shapes/creature.h"
#include "shapes/simple_shapes.h"
#include "support/files.h"

#include "core/grid_instances.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/mesh/normals.h"
#include "vdb_shell/obstacles/cores.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace vdb_shell::samples
{
namespace
{

namespace fs = std::filesystem;
constexpr double kPi = 3.14159265358979323846;

fs::path committed(const std::string& name)
{
    return fs::path(VDB_SHELL_SAMPLE_MESHES) / (name + ".obj");
}

struct Sample {
    const char* name;
    PolygonMesh (*make)();
    int euler;
    double volume;           ///< of the exact shape; 0: not known
    double volume_tolerance; ///< relative, from the chords that replace arcs
    std::size_t components = 1;
};

// GoogleTest would print the bytes, addresses included.
void PrintTo(const Sample& sample, std::ostream* out)
{
    *out << sample.name;
}

PolygonMesh make_sphere()
{
    return sphere(32, 16);
}
PolygonMesh make_box()
{
    return box(8);
}
PolygonMesh make_torus()
{
    return torus(48, 24);
}
PolygonMesh make_bracket()
{
    return bracket(32, 8);
}
PolygonMesh make_creature()
{
    openvdb::initialize();
    return join_into_quads(creature());
}

PolygonMesh make_bones()
{
    return creature_bones();
}

const std::vector<Sample>& all_samples()
{
    const double fillet = (1 - kPi / 4) * 0.15 * 0.15, hole = kPi * 0.28 * 0.28 * 0.2;
    static const std::vector<Sample> samples{
        {"sphere", make_sphere, 2, 4.0 / 3.0 * kPi, 0.02},
        {"box", make_box, 2, 2.0 * 1.2 * 0.8, 1e-6},
        {"torus", make_torus, 0, 2 * kPi * kPi * 0.35 * 0.35, 0.02},
        {"bracket", make_bracket, 0, 1.6 * 0.2 + 1.0 * 0.2 + fillet - hole, 0.002},
        {"creature", make_creature, 2, 0, 0},
        {"creature_bones", make_bones, 2, 0, 0, 14}};
    return samples;
}

class SampleMesh : public testing::TestWithParam<Sample>
{
};

/// Faces have to be the same to the letter. Coordinates may differ in the last decimals: sines and
/// OpenVDB's own arithmetic are not rounded alike on every processor and maths library.
void expect_same_obj(const std::string& made, const std::string& kept)
{
    std::istringstream made_lines(made), kept_lines(kept);
    std::string a, b;
    for (int line = 1; std::getline(kept_lines, b); ++line) {
        ASSERT_TRUE(std::getline(made_lines, a)) << "ends before line " << line;
        if (b.rfind("v ", 0) != 0) {
            ASSERT_EQ(a, b) << "line " << line;
            continue;
        }
        std::istringstream made_words(a.substr(2)), kept_words(b.substr(2));
        for (int k = 0; k < 3; ++k) {
            double x = NAN, y = NAN;
            made_words >> x;
            kept_words >> y;
            ASSERT_NEAR(x, y, 1e-5) << "line " << line;
        }
    }
    EXPECT_FALSE(std::getline(made_lines, a)) << "goes on with: " << a;
}

TEST_P(SampleMesh, IsMadeAgainAsItIsKept)
{
    const test::TemporaryFolder folder;
    write_obj(folder / "again.obj", GetParam().make());
    expect_same_obj(test::read_bytes(folder / "again.obj"),
                    test::read_bytes(committed(GetParam().name)));
}

TEST_P(SampleMesh, IsClosedManifoldOutwardAndEmbedded)
{
    const ReadResult read = read_mesh(committed(GetParam().name));
    EXPECT_TRUE(read.report.skipped_faces.empty());
    EXPECT_EQ(read.report.welded_vertices, 0U);
    EXPECT_EQ(read.report.unused_vertices, 0U);
    const MeshCheck check = check_mesh(read.mesh);
    EXPECT_TRUE(check.closed());
    EXPECT_TRUE(check.manifold());
    EXPECT_TRUE(check.embedded()) << check.self_intersections.count;
    EXPECT_EQ(check.inconsistent_edges.count, 0U);
    EXPECT_EQ(check.degenerate_triangles.count, 0U);
    EXPECT_EQ(check.inside_out_components(), 0U);
    ASSERT_EQ(check.components.size(), GetParam().components);
    for (const Component& component : check.components) {
        EXPECT_EQ(component.euler, GetParam().euler);
        EXPECT_EQ(component.nesting_depth, 0);
    }
    EXPECT_GT(check.volume, 0.0);
    if (GetParam().volume > 0) {
        EXPECT_NEAR(check.volume / GetParam().volume, 1.0, GetParam().volume_tolerance);
    }
}

TEST_P(SampleMesh, HasADirectionAtEveryVertex)
{
    const TriangleMesh mesh = read_mesh(committed(GetParam().name)).mesh;
    const std::vector<double> visibility = visibility_of(mesh, pseudo_normals(mesh));
    EXPECT_GT(*std::min_element(visibility.begin(), visibility.end()), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Each, SampleMesh, testing::ValuesIn(all_samples()),
                         [](const auto& param) { return std::string(param.param.name); });

TEST(Creature, ReachesItsFieldsZeroAndMixesTrianglesWithQuads)
{
    const PolygonMesh mesh = make_creature();
    for (const openvdb::Vec3d& p : mesh.points)
        ASSERT_LT(std::abs(creature_field(p)), 1e-3) << p;
    const auto quads = static_cast<std::size_t>(
        std::count_if(mesh.faces.begin(), mesh.faces.end(),
                      [](const Polygon& face) { return face.size() == 4; }));
    EXPECT_GE(mesh.faces.size(), 3000U);
    EXPECT_LE(mesh.faces.size(), 6000U);
    EXPECT_GT(quads, mesh.faces.size() / 4);
    EXPECT_LT(quads, mesh.faces.size() * 3 / 4);
}

TEST(Creature, HasItsBonesInside)
{
    const TriangleMesh skin = read_mesh(committed("creature")).mesh;
    const TriangleMesh bones = read_mesh(committed("creature_bones")).mesh;
    const Cores cores = prepare_cores(skin, "creature", {{"bones", bones}}, {});
    EXPECT_EQ(cores.kept_out.triangles, bones.triangles);
}

TEST(Creature, IsTheSameForAnyNumberOfThreads)
{
    const test::TemporaryFolder folder;
    std::vector<std::string> bytes;
    for (const std::size_t threads : {1, 2, 7}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        write_obj(folder / "creature.obj", make_creature());
        bytes.push_back(test::read_bytes(folder / "creature.obj"));
    }
    EXPECT_EQ(bytes[1], bytes[0]);
    EXPECT_EQ(bytes[2], bytes[0]);
}

} // namespace
} // namespace vdb_shell::samples
