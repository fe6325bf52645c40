// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/field/given_level_set.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/field/contour.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/resample/surface_distance.h"

#include "support/files.h"
#include "support/grids.h"
#include "support/shapes.h"
#include "support/sphere_field.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/tools/GridTransformer.h>

#include <cmath>
#include <limits>

namespace vdb_shell::test
{
namespace
{

using openvdb::FloatGrid;
using openvdb::GridBase;
using openvdb::Vec3d;

constexpr double kVoxel = 0.05;

class GivenLevelSet : public ::testing::Test
{
protected:
    std::filesystem::path write(const openvdb::GridPtrVec& grids)
    {
        openvdb::initialize();
        const auto path = folder / "in.vdb";
        openvdb::io::File file(path.string());
        file.write(grids);
        file.close();
        return path;
    }

    template <typename Kind>
    void expect_refusal(const std::filesystem::path& path, const std::string& name,
                        const std::vector<std::string>& words)
    {
        try {
            read_level_set(path, name);
            FAIL() << "nothing was thrown";
        } catch (const Kind& error) {
            for (const std::string& word : words)
                EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
                    << '"' << word << "\" is not in: " << error.what();
        }
    }

    TemporaryFolder folder;
};

TEST_F(GivenLevelSet, TheOnlyLevelSetNeedsNoName)
{
    auto fog = FloatGrid::create(0.0f);
    fog->setName("density");
    fog->setGridClass(openvdb::GRID_FOG_VOLUME);
    const auto field = sphere_field(0.3);
    const auto path = write({fog, field});
    const auto read = read_level_set(path, "");
    EXPECT_EQ(read->getName(), "surface");
    EXPECT_EQ(read->activeVoxelCount(), field->activeVoxelCount());
    EXPECT_EQ(read_level_set(path, "surface")->activeVoxelCount(), field->activeVoxelCount());
}

TEST_F(GivenLevelSet, HalfFloatsAreFloats)
{
    const auto field = sphere_field(0.3);
    field->setSaveFloatAsHalf(true);
    const auto read = read_level_set(write({field}), "");
    const TriangleMesh mesh = contour(*read);
    EXPECT_NEAR(signed_volume(mesh.points, mesh.triangles), 4.0 / 3.0 * M_PI, 0.1);
}

TEST_F(GivenLevelSet, AmbiguousMissingAndWrongGridsAreRefusedByName)
{
    const auto a = sphere_field(0.3), b = a->deepCopy();
    a->setName("hull");
    b->setName("core");
    const auto vectors = empty_grid("vec3s", "velocity");
    const auto path = write({a, b, vectors});
    expect_refusal<ReadError>(path, "", {"in.vdb", "2 float level sets", "hull", "core"});
    expect_refusal<ReadError>(path, "shell", {"in.vdb", "no grid \"shell\"", "hull"});
    expect_refusal<ReadError>(path, "velocity", {"in.vdb", "\"velocity\"", "vec3s", "floats"});
    EXPECT_EQ(read_level_set(path, "core")->getName(), "core");
    expect_refusal<ReadError>(folder / "none.vdb", "", {"none.vdb"});
    write_bytes(folder / "text.vdb", "not a volume");
    expect_refusal<ReadError>(folder / "text.vdb", "", {"text.vdb"});
}

TEST_F(GivenLevelSet, AFogVolumeIsRefusedByItsClass)
{
    const auto fog = sphere_field(0.3);
    fog->setName("density");
    fog->setGridClass(openvdb::GRID_FOG_VOLUME);
    expect_refusal<GeometryError>(write({fog}), "",
                                  {"in.vdb", "\"density\"", "class is fog volume"});
    fog->setGridClass(openvdb::GRID_UNKNOWN);
    expect_refusal<GeometryError>(write({fog}), "density", {"\"density\"", "class is unknown"});
}

TEST_F(GivenLevelSet, AFrustumIsRefusedByItsTransform)
{
    const auto field = sphere_field(0.3);
    field->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(Vec3d(-30), Vec3d(30)), 0.5, 2.0, kVoxel));
    expect_refusal<GeometryError>(write({field}), "",
                                  {"in.vdb", "transform", "NonlinearFrustumMap"});
}

TEST_F(GivenLevelSet, ValuesThatAreNoLevelSetAreRefused)
{
    const auto field = sphere_field(0.3);
    field->tree().setValue({3, 4, 5}, std::numeric_limits<float>::quiet_NaN());
    expect_refusal<GeometryError>(write({field}), "", {"voxel [3, 4, 5]", "nan"});

    auto outside = FloatGrid::create(1.0f);
    outside->setName("surface");
    outside->setGridClass(openvdb::GRID_LEVEL_SET);
    outside->tree().setValue({0, 0, 0}, 0.5f);
    expect_refusal<GeometryError>(write({outside}), "", {"\"surface\"", "1 active ones is inside"});
}

std::string hindrance(const FloatGrid& field, const LevelSetOptions& options = {})
{
    return why_not_steppable(field, contour(field), options);
}

TEST(WhyNotSteppable, NothingWhenTheBandIsDeepOrComplete)
{
    EXPECT_EQ(hindrance(*sphere_field(1.0)), "");
    LevelSetOptions thin;
    thin.interior_depth = 0.2;
    EXPECT_EQ(hindrance(*sphere_field(0.3), thin), "");
    const auto turned = sphere_field(1.0);
    turned->transform().postRotate(0.5, openvdb::math::X_AXIS);
    EXPECT_EQ(hindrance(*turned), "");
}

TEST(WhyNotSteppable, NamesWhatIsMissing)
{
    EXPECT_NE(hindrance(*sphere_field(0.3)).find("voxels deep"), std::string::npos);
    LevelSetOptions finer;
    finer.voxel_size = 0.02;
    EXPECT_NE(hindrance(*sphere_field(1.0), finer).find("voxel size is 0.05"), std::string::npos);
    const auto flat = sphere_field(1.0);
    flat->transform().postScale(Vec3d(1, 1, 2));
    EXPECT_NE(hindrance(*flat).find("no cubes"), std::string::npos);
    // In voxels, as some tools have it.
    const auto scaled = sphere_field(1.0);
    scaled->transform().postScale(Vec3d(2));
    const std::string slope = hindrance(*scaled);
    EXPECT_NE(slope.find("band outside is 1.5"), std::string::npos) << slope;
}

TEST_F(GivenLevelSet, TheCowsLevelSetGivesTheCowBackToWithinAVoxelButForItsTips)
{
    VDB_SHELL_NEEDS_REAL_MESHES();
    const TriangleMesh cow = read_mesh(real_meshes() / "paper" / "cow.obj").mesh;
    LevelSetOptions options;
    options.resolution = 128;
    options.interior_depth = 3 * resolve_voxel_size(cow, options);
    const openvdb::FloatGrid::Ptr field = mesh_to_level_set(cow, options);
    const double voxel = field->voxelSize()[0];
    // The zero surface that the values themselves have, trilinear between them.
    const auto fine = openvdb::FloatGrid::create(field->background());
    fine->setTransform(openvdb::math::Transform::createLinearTransform(voxel / 3));
    fine->setGridClass(openvdb::GRID_LEVEL_SET);
    openvdb::tools::resampleToMatch<openvdb::tools::BoxSampler>(*field, *fine);
    ContourOptions every_facet;
    every_facet.adaptivity = 0;
    const TriangleMesh zero = contour(*fine, every_facet), surface = contour(*field);
    const auto voxels = [&](const TriangleMesh& from, const TriangleMesh& to) {
        return surface_distance(from, to, voxel / 2).max / voxel;
    };
    // What contouring and simplification cost.
    EXPECT_LT(voxels(surface, zero), 0.5);
    EXPECT_LT(voxels(zero, surface), 0.5);
    EXPECT_LT(voxels(surface, cow), 1.0);
    // What the level set has lost before: horn tips and ears thinner than a voxel.
    const double lost = voxels(cow, zero);
    EXPECT_GT(lost, 1.0);
    EXPECT_NEAR(voxels(cow, surface), lost, 0.5);
    EXPECT_LT(surface_distance(cow, surface, voxel / 2).mean / voxel, 0.1);
}

} // namespace
} // namespace vdb_shell::test
