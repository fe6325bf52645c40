// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/vdb_conventions.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/write/vdb_file.h"

#include "command/command_fixture.h"
#include "command/exit_code.h"
#include "support/files.h"
#include "support/filled.h"
#include "support/grids.h"
#include "support/shapes.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>

#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <set>

// A file that keeps every rule, then one change for each way to break one.

namespace vdb_shell::test
{
namespace
{

using namespace openvdb;
using points::PointDataGrid;

PointDataGrid::Ptr make_points(const char* name)
{
    const std::vector<Vec3s> places{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    auto grid = point_grid(places, 0.5);
    grid->setName(name);
    append_attribute<std::int32_t>(grid->tree(), "tet", 0, 4);
    append_attribute<Vec3s>(grid->tree(), "N", Vec3s(0, 0, 1));
    append_group(grid->tree(), "outer");
    grid->insertMeta("global:count", Int32Metadata(3));
    grid->insertMeta("global:size[0]", FloatMetadata(1));
    grid->insertMeta("global:size[1]", FloatMetadata(2));
    grid->insertMeta("group_viewport", StringMetadata("outer"));
    return grid;
}

/// Grids that keep every rule, and so does the file's metadata.
struct Scene {
    FloatGrid::Ptr surface, density;
    GridBase::Ptr velocity;
    PointDataGrid::Ptr points, more_points;
    GridPtrVec extra;
    MetaMap metadata;

    Scene()
    {
        initialize();
        surface = sphere_level_set(1.0f, 0.25f);
        surface->setName("surface");
        surface->insertMeta("dict_report", StringMetadata("{\"fill\": 0.5}"));
        surface->insertMeta("is_closed", BoolMetadata(true));
        surface->insertMeta("value_type", StringMetadata("float"));
        density = FloatGrid::create(0.0f);
        density->setName("density");
        density->setGridClass(GRID_FOG_VOLUME);
        density->setSaveFloatAsHalf(true);
        density->tree().setValue(Coord(1, 2, 3), 65504.0f);
        velocity = empty_grid("vec3s", "v");
        velocity->setGridClass(GRID_STAGGERED);
        velocity->setVectorType(VEC_CONTRAVARIANT_RELATIVE);
        velocity->insertMeta("gravity", Vec3SMetadata(Vec3s(0, -9.81f, 0)));
        points = make_points("points");
        more_points = make_points("more_points");
        metadata.insertMeta("creator", StringMetadata("a test"));
        metadata.insertMeta("frame", Int32Metadata(7));
    }

    void write(const std::filesystem::path& path) const
    {
        GridPtrVec all{surface, density, velocity, points, more_points};
        all.insert(all.end(), extra.begin(), extra.end());
        io::File(path.string()).write(all, metadata);
    }
};

struct Wrong {
    std::string rule, grid, element;
    std::function<void(Scene&)> change;
};

Metadata::Ptr half_vector()
{
    // Of a type that no table of Houdini has.
    auto unknown = std::make_shared<UnknownMetadata>("vec2h");
    unknown->setValue({1, 2, 3, 4});
    return unknown;
}

std::vector<Wrong> wrong_names_and_classes()
{
    return {
        {"creator", "", "creator", [](Scene& s) { s.metadata.removeMeta("creator"); }},
        {"name", "", "", [](Scene& s) { s.more_points->setName(""); }},
        {"name", "two words", "", [](Scene& s) { s.more_points->setName("two words"); }},
        {"name", "a*", "", [](Scene& s) { s.more_points->setName("a*"); }},
        {"unique-name", "points", "", [](Scene& s) { s.more_points->setName("points"); }},
        {"name-for-class", "surface", "", [](Scene& s) { s.surface->setGridClass(GRID_UNKNOWN); }},
        {"name-for-class", "density", "", [](Scene& s) { s.density->setGridClass(GRID_UNKNOWN); }},
        {"type", "inside", "", [](Scene& s) { s.extra.push_back(empty_grid("mask", "inside")); }},
        {"class", "v", "class",
         [](Scene& s) { s.velocity->insertMeta("class", StringMetadata("Staggered")); }},
        {"level-set", "whole", "",
         [](Scene& s) {
             s.extra.push_back(empty_grid("int32", "whole"));
             s.extra[0]->setGridClass(GRID_LEVEL_SET);
         }},
        {"level-set", "surface", "",
         [](Scene& s) { s.surface->tree().root().setBackground(0.0f, false); }},
        {"level-set", "surface", "",
         [](Scene& s) {
             s.surface->setTransform(math::Transform::createLinearTransform(
                 Mat4d(1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)));
         }},
        {"fog-volume", "density", "",
         [](Scene& s) { s.density->tree().root().setBackground(1.0f, false); }},
        {"fog-volume", "whole", "",
         [](Scene& s) {
             s.extra.push_back(empty_grid("bool", "whole"));
             s.extra[0]->setGridClass(GRID_FOG_VOLUME);
         }},
        {"staggered", "speed", "",
         [](Scene& s) {
             s.extra.push_back(empty_grid("float", "speed"));
             s.extra[0]->setGridClass(GRID_STAGGERED);
         }},
        {"vector-type", "surface", "vector_type",
         [](Scene& s) { s.surface->setVectorType(VEC_COVARIANT); }},
        {"vector-type", "v", "vector_type",
         [](Scene& s) { s.velocity->insertMeta("vector_type", StringMetadata("sideways")); }},
        {"vector-meaning", "v", "vector_type",
         [](Scene& s) { s.velocity->setVectorType(VEC_COVARIANT); }},
        {"vector-meaning", "gradient", "vector_type",
         [](Scene& s) { s.extra.push_back(empty_grid("vec3d", "gradient")); }},
        {"vector-meaning", "N", "vector_type",
         [](Scene& s) { s.extra.push_back(empty_grid("vec3s", "N")); }},
        {"half", "whole", "is_saved_as_half_float",
         [](Scene& s) {
             s.extra.push_back(empty_grid("int32", "whole"));
             s.extra[0]->setSaveFloatAsHalf(true);
         }},
        {"half-range", "density", "is_saved_as_half_float",
         [](Scene& s) { s.density->tree().setValue(Coord(1, 2, 3), 65536.0f); }},
    };
}

std::vector<Wrong> wrong_metadata()
{
    return {
        {"own-metadata", "v", "is_local_space",
         [](Scene& s) { s.velocity->insertMeta("is_local_space", Int32Metadata(1)); }},
        {"value-type", "surface", "value_type",
         [](Scene& s) { s.surface->insertMeta("value_type", StringMetadata("double")); }},
        {"metadata-type", "v", "size",
         [](Scene& s) { s.velocity->insertMeta("size", *half_vector()); }},
        {"metadata-type", "", "size",
         [](Scene& s) { s.metadata.insertMeta("size", *half_vector()); }},
        {"metadata-name", "v", "my size",
         [](Scene& s) { s.velocity->insertMeta("my size", Int32Metadata(1)); }},
        {"metadata-name", "", "2d",
         [](Scene& s) { s.metadata.insertMeta("2d", Int32Metadata(1)); }},
        {"metadata-clash", "v", "is_closed",
         [](Scene& s) { s.velocity->insertMeta("is_closed", FloatMetadata(1)); }},
        {"is-bool", "v", "is_open",
         [](Scene& s) { s.velocity->insertMeta("is_open", Int32Metadata(1)); }},
        {"dictionary", "v", "dict_a",
         [](Scene& s) { s.velocity->insertMeta("dict_a", StringMetadata("[1, 2]")); }},
        {"dictionary", "v", "dict_a",
         [](Scene& s) { s.velocity->insertMeta("dict_a", Int32Metadata(1)); }},
        {"global-metadata", "v", "global:a",
         [](Scene& s) { s.velocity->insertMeta("global:a", Int32Metadata(1)); }},
        {"global-metadata", "points", "global:a",
         [](Scene& s) { s.points->insertMeta("global:a", Vec3IMetadata(Vec3i(1, 2, 3))); }},
        {"metadata-name", "points", "global:a b",
         [](Scene& s) { s.points->insertMeta("global:a b", Int32Metadata(1)); }},
        {"global-tuple", "points", "global:size[3]",
         [](Scene& s) { s.points->insertMeta("global:size[3]", FloatMetadata(1)); }},
        {"global-tuple", "points", "global:size[x]",
         [](Scene& s) { s.points->insertMeta("global:size[x]", FloatMetadata(1)); }},
        {"viewport-group", "points", "group_viewport",
         [](Scene& s) { s.points->insertMeta("group_viewport", StringMetadata("none")); }},
    };
}

std::vector<Wrong> wrong_points()
{
    return {
        {"attribute-type", "points", "Alpha",
         [](Scene& s) { append_attribute<std::uint8_t>(s.points->tree(), "Alpha", 0); }},
        {"attribute-name", "points", "a|b",
         [](Scene& s) { append_attribute<float>(s.points->tree(), "a|b", 0.0f); }},
        {"attribute-name", "points", "2nd",
         [](Scene& s) { append_attribute<float>(s.points->tree(), "2nd", 0.0f); }},
        {"attribute-stride", "points", "uv",
         [](Scene& s) { append_attribute<Vec3s>(s.points->tree(), "uv", Vec3s(0.0f), 2); }},
        {"attribute-clash", "points", "id",
         [](Scene& s) {
             append_attribute<std::int32_t>(s.points->tree(), "id", 0);
             append_attribute<float>(s.more_points->tree(), "id", 0.0f);
         }},
        {"integer-vector", "points", "cell",
         [](Scene& s) {
             append_attribute<Vec3i>(s.points->tree(), "cell", Vec3i(0, (1 << 24) + 1, 0));
         }},
        {"position", "points", "P", [](Scene& s) { rename_attribute(s.points->tree(), "P", "Q"); }},
        {"role", "points", "Cd",
         [](Scene& s) { append_attribute<float>(s.points->tree(), "Cd", 0.0f); }},
        {"group-name", "points", "no:group",
         [](Scene& s) { append_group(s.points->tree(), "no:group"); }},
    };
}

std::vector<Wrong> all_wrong()
{
    std::vector<Wrong> all = wrong_names_and_classes();
    for (const auto& more : {wrong_metadata(), wrong_points()})
        all.insert(all.end(), more.begin(), more.end());
    return all;
}

TEST(VdbConventions, AFileThatKeepsThemAllHasNoViolation)
{
    const TemporaryFolder folder;
    Scene().write(folder / "good.vdb");
    for (const VdbViolation& violation : check_vdb_conventions(folder / "good.vdb"))
        ADD_FAILURE() << to_text(violation);
}

TEST(VdbConventions, EachWrongFileIsFoundOutAndNothingElseInIt)
{
    const TemporaryFolder folder;
    for (const Wrong& wrong : all_wrong()) {
        Scene scene;
        wrong.change(scene);
        scene.write(folder / "wrong.vdb");
        const auto found = check_vdb_conventions(folder / "wrong.vdb");
        ASSERT_FALSE(found.empty()) << wrong.rule << ", " << wrong.grid << ", " << wrong.element;
        for (const VdbViolation& violation : found) {
            EXPECT_EQ(violation.rule, wrong.rule) << to_text(violation);
            EXPECT_EQ(violation.grid, wrong.grid) << to_text(violation);
            EXPECT_EQ(violation.element, wrong.element) << to_text(violation);
            EXPECT_FALSE(violation.detail.empty());
        }
    }
}

TEST(VdbConventions, AFileWithoutGridsIsOne)
{
    const TemporaryFolder folder;
    openvdb::initialize();
    MetaMap metadata;
    metadata.insertMeta("creator", StringMetadata("a test"));
    io::File((folder / "none.vdb").string()).write(GridPtrVec(), metadata);
    const auto found = check_vdb_conventions(folder / "none.vdb");
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].rule, "no-grids");
}

TEST(VdbConventions, EveryRuleHasAFileThatBreaksIt)
{
    std::set<std::string> broken{"no-grids"};
    for (const Wrong& wrong : all_wrong())
        broken.insert(wrong.rule);
    const auto& rules = vdb_convention_rules();
    EXPECT_EQ(broken, std::set<std::string>(rules.begin(), rules.end()));
}

TEST(VdbConventions, TheyHoldForEveryFileThatWeWrite)
{
    const TemporaryFolder folder;
    const std::vector<HandMade> shells{hand_made_shell(icosphere(1.0, 2), 0.7),
                                       hand_made_shell(unit_tetrahedron(), 0.5, {0, 2}),
                                       hand_made_shell(unit_tetrahedron(), 0.5, {0, 1, 2, 3})};
    for (const HandMade& made : shells) {
        for (const PointPlacement points : {PointPlacement::same_file, PointPlacement::beside}) {
            for (const bool half : {false, true}) {
                write_shell_vdb(folder / "shell.vdb", hand_made_file(made, 0.1), {points, half});
                auto found = check_vdb_conventions(folder / "shell.vdb");
                if (points == PointPlacement::beside)
                    for (const auto& more : check_vdb_conventions(folder / "shell.points.vdb"))
                        found.push_back(more);
                for (const VdbViolation& violation : found)
                    ADD_FAILURE() << to_text(violation);
            }
        }
    }
}

/// Of every other kind, as the command writes them.
class WrittenFiles : public Command
{
protected:
    /// Runs the call, which writes the file, and holds that against the rules.
    void write(const std::string& call, const std::string& name, const std::string& more = "")
    {
        const Outcome made = run(call + " -o " + file(name) + " " + more);
        ASSERT_EQ(made.status, command::success) << call << '\n' << made.err;
        expect_kept(name);
    }

    void expect_kept(const std::string& name)
    {
        for (const VdbViolation& violation : check_vdb_conventions(folder / name))
            ADD_FAILURE() << name << ": " << to_text(violation);
    }

    /// Writes a shell of the mesh, as the options say.
    ShellInfo built(const std::string& mesh, const std::string& name, const std::string& options)
    {
        write("build " + mesh + " --resolution 24 --samples 0 -q " + options, name);
        return read_shell_info(folder / name);
    }

    static std::size_t count_of(const ShellInfo& info, const std::string& grid)
    {
        return std::size_t(std::count(info.grids.begin(), info.grids.end(), grid));
    }

    const TriangleMesh sphere = icosphere(1.0, 2);
    const std::string ball = mesh_file("ball.obj", sphere);
};

TEST_F(WrittenFiles, OfShellsOfEveryKindKeepThem)
{
    const ShellInfo both = built(ball, "both.vdb", "--layers 2 --side both");
    EXPECT_EQ(both.layers, 4);
    EXPECT_EQ(both.skin, 2);
    const ShellInfo tapered = built(ball, "tapered.vdb", "--layers 2 --taper");
    EXPECT_TRUE(tapered.tapered);
    EXPECT_EQ(tapered.layers, 2);
    const std::string core = mesh_file("core.obj", icosphere(0.4, 1));
    built(ball, "cores.vdb", "--core " + core + " --core-distance 0.05");
    EXPECT_FALSE(read_shell_vdb(folder / "cores.vdb").core_feet.empty());
    EXPECT_GT(built(ball, "remeshed.vdb", "--remesh-to 200").input_points, 0);
    const std::string far = mesh_file("far.obj", translated(sphere, {1000, 0, 0}));
    EXPECT_NE(built(far, "far.vdb", "--recentre --rescale").placement.origin, Vec3d(0));
    const ShellInfo halves = built(ball, "two.vdb", "--layers 2 --half --points beside");
    EXPECT_EQ(halves.points_at, folder / "two.points.vdb");
    expect_kept("two.points.vdb");

    // The outside programs that fill a void may not be there.
    const ShellStack hollow = hollow_ball();
    ShellFile filled = hand_made_file({hollow.layers[0], hollow.splits[0], make_tets(hollow)}, 0.1);
    filled.core = cone_core(hollow, filled.tets, Vec3s(0.01F, 0.02F, 0.03F));
    write_shell_vdb(folder / "filled.vdb", filled);
    EXPECT_GT(read_shell_info(folder / "filled.vdb").core_tets, 0);
    expect_kept("filled.vdb");
}

TEST_F(WrittenFiles, OfPosesAndVolumesKeepThem)
{
    // u and v are x and y, so that texture coordinates can be asked for.
    std::string text;
    for (const Vec3s& p : sphere.points)
        for (const char* const kind : {"v", "vt"})
            text += std::string(kind) + " " + std::to_string(p[0]) + " " + std::to_string(p[1]) +
                    (kind[1] ? "" : " " + std::to_string(p[2])) + "\n";
    for (const Vec3I& t : sphere.triangles) {
        text += "f";
        for (int k = 0; k < 3; ++k)
            text += " " + std::to_string(t[k] + 1) + "/" + std::to_string(t[k] + 1);
        text += "\n";
    }
    const std::string textured = file("textured.obj"), rest = file("rest.vdb");
    write_bytes(textured, text);
    built(textured, "rest.vdb", "--layers 2");
    const auto stretched = [&](float factor, const char* name) {
        TriangleMesh skin = read_mesh(folder / "textured.obj").mesh;
        for (Vec3s& p : skin.points)
            p[0] *= factor;
        return mesh_file(name, skin);
    };
    const std::string long_ball = stretched(1.5F, "long.obj"),
                      longer = stretched(1.6F, "longer.obj");
    write("pose " + rest + " " + long_ball + " -q --mesh-after " + longer, "posed.vdb");
    const ShellInfo posed = read_shell_info(folder / "posed.vdb");
    EXPECT_TRUE(posed.posed);
    EXPECT_EQ(count_of(posed, "rest") + count_of(posed, "v"), 2u);

    write("volumes " + rest + " --volumes rest,depth,thickness,uvw,prism,nearest,layer,density " +
              "--texture-from " + textured,
          "coordinates.vdb");
    write("volumes " + rest + " --volumes depth,density --half", "half.vdb");
    const std::string to_pose = " --posed " + file("posed.vdb") + " -q --velocity";
    write("deform " + file("coordinates.vdb") + to_pose, "deformed.vdb");
    write("deform " + rest + " --grid shell_tets" + to_pose, "points.vdb");
    write("map " + file("half.vdb") + " --shell " + rest + " --mesh " + textured + " -q",
          "mapped.vdb");
}

TEST(VdbConventions, WhatCannotBeReadIsSaid)
{
    const TemporaryFolder folder;
    EXPECT_THROW(check_vdb_conventions(folder / "none.vdb"), ReadError);
    write_bytes(folder / "text.vdb", "not a volume at all");
    EXPECT_THROW(check_vdb_conventions(folder / "text.vdb"), ReadError);
    Scene().write(folder / "good.vdb");
    const std::string bytes = read_bytes(folder / "good.vdb");
    write_bytes(folder / "short.vdb", bytes.substr(0, bytes.size() / 2));
    EXPECT_THROW(check_vdb_conventions(folder / "short.vdb"), ReadError);
}

TEST(HalfFloats, RoundVolumesAndLeaveTheShellExact)
{
    const TemporaryFolder folder;
    const HandMade made = hand_made_shell(icosphere(1.0, 2), 0.7);
    const ShellFile exact = hand_made_file(made, 0.1);
    write_shell_vdb(folder / "half.vdb", exact, {PointPlacement::same_file, true});
    write_shell_vdb(folder / "full.vdb", exact);
    const ShellFile read = read_shell_vdb(folder / "half.vdb");
    EXPECT_TRUE(same_bits(read.stack.layers.front().inner, made.shell.inner));
    EXPECT_TRUE(same_bits(read.tets.tets, made.tets.tets));
    EXPECT_TRUE(read.surface->saveFloatAsHalf() && read.depth->saveFloatAsHalf());
    EXPECT_FALSE(exact.surface->saveFloatAsHalf()) << "the caller's grid was changed";
    EXPECT_TRUE(read.depth->tree().hasSameTopology(exact.depth->tree()));
    for (const auto& [rounded, full] :
         {std::pair(read.surface, exact.surface), std::pair(read.depth, exact.depth)}) {
        std::size_t differ = 0;
        for (auto value = full->cbeginValueOn(); value; ++value) {
            const double stored = rounded->tree().getValue(value.getCoord());
            // Half floats have eleven bits, subnormal ones end at 2^-24.
            EXPECT_NEAR(stored, *value, std::ldexp(std::abs(*value), -11) + std::ldexp(1.0, -25));
            differ += stored != double(*value);
        }
        EXPECT_GT(differ, 0u) << "nothing was rounded";
    }
    EXPECT_LT(std::filesystem::file_size(folder / "half.vdb"),
              std::filesystem::file_size(folder / "full.vdb"));
    const auto thickness = read_float_grid(folder / "half.vdb", "depth");
    EXPECT_TRUE(same_grid(*thickness, *read.depth));
}

TEST(HalfFloats, AreRefusedForDistancesBeyondThem)
{
    const TemporaryFolder folder;
    ShellFile file = hand_made_file(hand_made_shell(icosphere(1.0, 1), 0.7), 0.1);
    file.surface->tree().setValue(Coord(0), -65536.0f);
    EXPECT_NO_THROW(write_shell_vdb(folder / "full.vdb", file));
    try {
        write_shell_vdb(folder / "half.vdb", file, {PointPlacement::same_file, true});
        ADD_FAILURE() << "written";
    } catch (const InvalidOption& error) {
        for (const char* word : {"surface", "65536", "65504"})
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "half.vdb"));
}

/// The program's exit status; what it printed in `out`.
int run_check_vdb(const std::string& arguments, const std::filesystem::path& out)
{
    const std::string line =
        std::string(VDB_SHELL_CHECK_VDB) + " " + arguments + " >" + out.string() + " 2>&1";
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(CheckVdb, ExitStatusAndNames)
{
    const TemporaryFolder folder;
    const std::filesystem::path out = folder / "out";
    const std::string good = (folder / "good.vdb").string(),
                      wrong = (folder / "wrong.vdb").string();
    Scene().write(good);
    Scene scene;
    append_attribute<float>(scene.points->tree(), "a|b", 0.0f);
    scene.write(wrong);
    EXPECT_EQ(run_check_vdb(good, out), command::success);
    EXPECT_EQ(run_check_vdb(wrong + " " + good, out), command::check_failed);
    const std::string text = read_bytes(out);
    for (const char* word : {"\"points\"", "\"a|b\"", "attribute-name", "good.vdb: keeps"})
        EXPECT_NE(text.find(word), std::string::npos) << word << " is not in " << text;
    EXPECT_EQ(run_check_vdb((folder / "none.vdb").string(), out), command::read_error);
    EXPECT_EQ(run_check_vdb("", out), command::usage_error);
    EXPECT_EQ(run_check_vdb("--help", out), command::success);
}

} // namespace
} // namespace vdb_shell::test
