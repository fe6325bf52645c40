// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"
#include "vdb_shell/write/vdb_file.h"

#include "support/files.h"
#include "support/grids.h"
#include "support/shapes.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/points/PointDataGrid.h>
#include <openvdb/points/PointGroup.h>
#include <tbb/global_control.h>

#include <set>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;
using openvdb::points::PointDataGrid;
using test::hand_made_file;
using test::hand_made_shell;
using test::HandMade;
using test::same_bits;
using test::TemporaryFolder;

HandMade small_shell()
{
    return hand_made_shell(test::icosphere(1.0, 2), 0.6, {3, 17});
}

void expect_same_shell(const ShellFile& read, const ShellFile& written)
{
    EXPECT_EQ(read.stack.skin, written.stack.skin);
    ASSERT_EQ(read.stack.layers.size(), written.stack.layers.size());
    for (std::size_t k = 0; k < written.stack.layers.size(); ++k) {
        const PrismShell &found = read.stack.layers[k], &expected = written.stack.layers[k];
        EXPECT_TRUE(same_bits(found.outer, expected.outer));
        EXPECT_TRUE(same_bits(found.inner, expected.inner));
        EXPECT_TRUE(same_bits(found.triangles, expected.triangles));
        EXPECT_TRUE(same_bits(found.stop, expected.stop));
        EXPECT_TRUE(same_bits(read.stack.splits[k].order, written.stack.splits[k].order));
        EXPECT_EQ(read.stack.splits[k].ripples, written.stack.splits[k].ripples);
    }
    EXPECT_TRUE(same_bits(read.tets.points, written.tets.points));
    EXPECT_TRUE(same_bits(read.tets.tets, written.tets.tets));
    EXPECT_TRUE(same_bits(read.tets.prism, written.tets.prism));
    EXPECT_TRUE(same_bits(read.tets.prism_layer, written.tets.prism_layer));
    EXPECT_TRUE(same_bits(read.tets.source_vertex, written.tets.source_vertex));
    EXPECT_TRUE(same_bits(read.tets.layer, written.tets.layer));
    EXPECT_EQ(read.parameters_json, written.parameters_json);
    EXPECT_EQ(read.report_json, written.report_json);
    EXPECT_TRUE(test::same_grid(*read.surface, *written.surface));
    EXPECT_TRUE(test::same_grid(*read.depth, *written.depth));
}

TEST(VdbFile, ReadsBackBitForBit)
{
    const TemporaryFolder folder;
    ShellFile file = hand_made_file(small_shell(), 0.1);
    file.stack.splits[0].ripples = 7;
    for (const PointPlacement points : {PointPlacement::same_file, PointPlacement::beside}) {
        write_shell_vdb(folder / "shell.vdb", file, {points});
        expect_same_shell(read_shell_vdb(folder / "shell.vdb"), file);
    }
}

TEST(VdbFile, KeepsNegativeZeroAndTinyAndHugeCoordinates)
{
    const TemporaryFolder folder;
    HandMade made = hand_made_shell(test::box({0, 0, 0}, {1, 1, 1}), 0.5, {0});
    // Zeros of both signs in one voxel, a denormal, and a pinned pillar whose ends differ in sign.
    made.shell.outer[0] = made.tets.points[0] = {-0.0f, 0.0f, 1e-42f};
    made.shell.inner[0] = {0.0f, -0.0f, 1e-42f};
    made.shell.outer[1] = made.tets.points[1] = {3e37f, -3e37f, 0.0f};
    ShellFile file = hand_made_file(hand_made_shell(test::box({0, 0, 0}, {1, 1, 1}), 0.5), 0.2);
    file.stack = one_layer(made.shell, made.split);
    file.tets = made.tets;
    write_shell_vdb(folder / "shell.vdb", file);
    expect_same_shell(read_shell_vdb(folder / "shell.vdb"), file);
}

TEST(VdbFile, ReadsBackAShellWithoutTets)
{
    const TemporaryFolder folder;
    const TriangleMesh surface = test::unit_tetrahedron();
    const HandMade made = hand_made_shell(surface, 0.5, {0, 1, 2, 3});
    ASSERT_TRUE(made.tets.tets.empty());
    const ShellFile file = hand_made_file(made, 0.2);
    write_shell_vdb(folder / "shell.vdb", file);
    expect_same_shell(read_shell_vdb(folder / "shell.vdb"), file);
}

TEST(VdbFile, ReadsBackTetsThatLeavePointsOut)
{
    const TemporaryFolder folder;
    // All around vertex 0 is pinned: no tet has it as a corner.
    const TriangleMesh surface = test::icosphere(1.0, 1);
    std::set<std::uint32_t> pinned;
    for (const openvdb::Vec3I& t : surface.triangles)
        if (t[0] == 0 || t[1] == 0 || t[2] == 0)
            pinned.insert({t[0], t[1], t[2]});
    HandMade made = hand_made_shell(surface, 0.6, pinned);
    TetMesh& tets = made.tets;
    tets.points.erase(tets.points.begin());
    tets.source_vertex.erase(tets.source_vertex.begin());
    tets.layer.erase(tets.layer.begin());
    for (openvdb::Vec4I& tet : tets.tets)
        for (int corner = 0; corner < 4; ++corner) {
            ASSERT_NE(tet[corner], 0u);
            --tet[corner];
        }
    const ShellFile file = hand_made_file(made, 0.2);
    write_shell_vdb(folder / "shell.vdb", file);
    expect_same_shell(read_shell_vdb(folder / "shell.vdb"), file);
    const ShellInfo info = read_shell_info(folder / "shell.vdb");
    EXPECT_EQ(info.points, info.tet_points + 1);
}

TEST(VdbFile, WritesWhatWasReadToTheSameBytes)
{
    const TemporaryFolder folder;
    write_shell_vdb(folder / "shell.vdb", hand_made_file(small_shell(), 0.1));
    write_shell_vdb(folder / "again.vdb", read_shell_vdb(folder / "shell.vdb"));
    EXPECT_EQ(test::read_bytes(folder / "shell.vdb"), test::read_bytes(folder / "again.vdb"));
}

TEST(VdbFile, HasTheSameBytesForAnyNumberOfThreads)
{
    const TemporaryFolder folder;
    const HandMade made = hand_made_shell(test::icosphere(1.0, 4), 0.4);
    std::set<std::string> contents;
    for (const std::size_t threads : {1u, 2u, 7u}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        write_shell_vdb(folder / "shell.vdb", hand_made_file(made, 0.03));
        contents.insert(test::read_bytes(folder / "shell.vdb"));
    }
    EXPECT_EQ(contents.size(), 1u);
}

TEST(VdbFile, LeavesTheGridsOfTheCallerAlone)
{
    const TemporaryFolder folder;
    ShellFile file = hand_made_file(small_shell(), 0.1);
    file.surface->setName("mine");
    file.surface->setSaveFloatAsHalf(true);
    const std::size_t metadata = file.surface->metaCount();
    write_shell_vdb(folder / "shell.vdb", file);
    EXPECT_EQ(file.surface->getName(), "mine");
    EXPECT_EQ(file.surface->metaCount(), metadata);
    EXPECT_TRUE(test::same_grid(*read_shell_vdb(folder / "shell.vdb").surface, *file.surface));
}

TEST(VdbFile, PutsPointsBesideOnRequest)
{
    const TemporaryFolder folder;
    const ShellFile file = hand_made_file(small_shell(), 0.1);
    write_shell_vdb(folder / "a.vdb", file, {PointPlacement::beside});
    openvdb::io::File volumes((folder / "a.vdb").string());
    volumes.open(false);
    const openvdb::GridPtrVecPtr grids = volumes.readAllGridMetadata();
    for (const openvdb::GridBase::Ptr& grid : *grids)
        EXPECT_FALSE(grid->isType<PointDataGrid>()) << grid->getName();
    volumes.close();
    EXPECT_EQ(read_shell_info(folder / "a.vdb").points_at, folder / "a.points.vdb");

    // Both renamed together still belong together; alone, the first is no whole shell.
    fs::rename(folder / "a.vdb", folder / "b.vdb");
    fs::rename(folder / "a.points.vdb", folder / "b.points.vdb");
    expect_same_shell(read_shell_vdb(folder / "b.vdb"), file);
    fs::remove(folder / "b.points.vdb");
    EXPECT_THROW(read_shell_vdb(folder / "b.vdb"), ReadError);
}

TEST(VdbFile, RefusesPointsOfAnotherShell)
{
    const TemporaryFolder folder;
    write_shell_vdb(folder / "a.vdb", hand_made_file(small_shell(), 0.1), {PointPlacement::beside});
    write_shell_vdb(folder / "b.vdb",
                    hand_made_file(hand_made_shell(test::icosphere(1.0, 2), 0.5, {3, 17}), 0.1),
                    {PointPlacement::beside});
    fs::copy_file(folder / "b.points.vdb", folder / "a.points.vdb",
                  fs::copy_options::overwrite_existing);
    try {
        read_shell_vdb(folder / "a.vdb");
        FAIL();
    } catch (const ReadError& error) {
        EXPECT_NE(std::string(error.what()).find("another shell"), std::string::npos);
    }
}

TEST(VdbFile, TellsItsMetadataWithoutReadingGrids)
{
    const TemporaryFolder folder;
    const HandMade made = small_shell();
    write_shell_vdb(folder / "shell.vdb", hand_made_file(made, 0.1));
    const ShellInfo info = read_shell_info(folder / "shell.vdb");
    EXPECT_EQ(info.schema, 1);
    EXPECT_EQ(std::size_t(info.vertices), made.shell.outer.size());
    EXPECT_EQ(std::size_t(info.points), made.tets.points.size());
    EXPECT_EQ(std::size_t(info.prisms), made.shell.triangles.size());
    EXPECT_EQ(std::size_t(info.tets), made.tets.tets.size());
    EXPECT_EQ(info.parameters_json, "{\"rho\": 0.9}");
    EXPECT_EQ(info.grids.size(), 5u);
    EXPECT_EQ(info.points_at, folder / "shell.vdb");
    EXPECT_NE(info.orientation.find("det"), std::string::npos);
}

TEST(VdbFile, UsesOnlyAttributesThatHoudiniKeeps)
{
    const TemporaryFolder folder;
    write_shell_vdb(folder / "shell.vdb", hand_made_file(small_shell(), 0.1));
    openvdb::io::File file((folder / "shell.vdb").string());
    file.open(false);
    const std::set<std::string> kept{"int32", "float", "vec3s"};
    for (const char* name : {"shell_points", "shell_prisms", "shell_tets"}) {
        const auto grid = openvdb::gridPtrCast<PointDataGrid>(file.readGrid(name));
        ASSERT_TRUE(grid);
        const auto& attributes = grid->tree().cbeginLeaf()->attributeSet();
        for (const auto& [attribute, position] : attributes.descriptor().map()) {
            if (openvdb::points::isGroup(*attributes.getConst(position)))
                continue;
            const std::string type = attributes.getConst(position)->type().first;
            EXPECT_EQ(kept.count(type), 1u) << name << ' ' << attribute << ' ' << type;
            EXPECT_EQ(attribute.find_first_of("|:"), std::string::npos) << attribute;
        }
    }
}

TEST(VdbFile, GroupsAreTheLayersAndThePins)
{
    const TemporaryFolder folder;
    const HandMade made = small_shell();
    write_shell_vdb(folder / "shell.vdb", hand_made_file(made, 0.1));
    openvdb::io::File file((folder / "shell.vdb").string());
    file.open(false);
    const auto grid = openvdb::gridPtrCast<PointDataGrid>(file.readGrid("shell_points"));
    const auto count = [&](const char* group) {
        return openvdb::points::pointCount(
            grid->tree(),
            openvdb::points::GroupFilter(group, grid->tree().cbeginLeaf()->attributeSet()));
    };
    EXPECT_EQ(count("outer"), made.shell.outer.size());
    EXPECT_EQ(count("inner"), made.shell.outer.size() - 2);
    EXPECT_EQ(count("pinned"), 2u);
}

TEST(VdbFile, RefusesWhatCouldNotBeReadBack)
{
    const TemporaryFolder folder;
    const ShellFile good = hand_made_file(small_shell(), 0.1);
    const auto refused = [&](auto spoil) {
        ShellFile bad = good;
        spoil(bad);
        EXPECT_THROW(write_shell_vdb(folder / "bad.vdb", bad), InvalidOption);
    };
    refused([](ShellFile& f) { f.surface.reset(); });
    refused([](ShellFile& f) { f.depth.reset(); });
    refused([](ShellFile& f) { f.stack.layers[0].stop.pop_back(); });
    refused([](ShellFile& f) { f.stack.layers[0].triangles[5][1] = 100000; });
    refused([](ShellFile& f) { f.stack.splits[0].order[0] = {0, 1, 1}; });
    refused([](ShellFile& f) { f.tets.points[4][0] += 1.0f; });
    refused([](ShellFile& f) { f.tets.tets[2][3] = std::uint32_t(f.tets.points.size()); });
    refused([](ShellFile& f) {
        PrismShell& layer = f.stack.layers[0];
        layer.inner[0][2] = f.tets.points[layer.outer.size()][2] = std::nanf("");
    });
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(VdbFile, KeepsTheOldFileWhenThePointsCannotBeWritten)
{
    const TemporaryFolder folder;
    const ShellFile file = hand_made_file(small_shell(), 0.1);
    test::write_bytes(folder / "a.vdb", "old");
    fs::create_directory(folder / "a.points.vdb");
    EXPECT_THROW(write_shell_vdb(folder / "a.vdb", file, {PointPlacement::beside}), WriteError);
    EXPECT_EQ(test::read_bytes(folder / "a.vdb"), "old");
}

TEST(ReadFloatGrid, FindsByNameOrAlone)
{
    const TemporaryFolder folder;
    openvdb::initialize();
    const auto one = openvdb::FloatGrid::create(0.25f);
    one->setName("thickness");
    one->tree().setValueOn({1, 2, 3}, 0.5f);
    one->setSaveFloatAsHalf(true);
    const auto other = test::empty_grid("double", "precise");
    openvdb::io::File((folder / "t.vdb").string()).write(openvdb::GridPtrVec{one, other});
    EXPECT_EQ(read_float_grid(folder / "t.vdb", "")->tree().getValue({1, 2, 3}), 0.5f);
    EXPECT_EQ(read_float_grid(folder / "t.vdb", "thickness")->background(), 0.25f);
    const auto message = [&](const char* name) {
        try {
            read_float_grid(folder / "t.vdb", name);
        } catch (const ReadError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(message("precise").find("not a float grid"), std::string::npos) << message("precise");
    EXPECT_NE(message("missing").find("\"precise\" (double, "), std::string::npos)
        << message("missing");
}

TEST(ReadFloatGrid, AsksForANameAmongSeveral)
{
    const TemporaryFolder folder;
    write_shell_vdb(folder / "shell.vdb", hand_made_file(small_shell(), 0.1));
    EXPECT_THROW(read_float_grid(folder / "shell.vdb", ""), ReadError);
    EXPECT_EQ(read_float_grid(folder / "shell.vdb", "depth")->getName(), "depth");
}

} // namespace
} // namespace vdb_shell
