// SPDX-License-Identifier: Apache-2.0
#include "resample/simplify.h"

#include "vdb_shell/mesh/check_mesh.h"

#include "field/marching_tets.h"
#include "resample/sound.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

namespace vdb_shell::test
{
namespace
{

/// Single voxels that are hardly inside, each the smallest component that marching tets make, in a
/// row of different places: in floats their shapes are not all the same.
TriangleMesh surfaces_of_single_voxels(int along)
{
    const auto grid = openvdb::FloatGrid::create(1.0F);
    for (int i = 0; i < along; ++i) {
        const openvdb::Coord middle(3 * i, 2 * i * i, 7 * i);
        openvdb::CoordBBox around(middle, middle);
        around.expand(1);
        grid->denseFill(around, 1.0F);
        grid->tree().setValueOn(middle, -1e-3F);
    }
    const IndexSurface surface = marching_tets(*grid);
    TriangleMesh mesh;
    mesh.points.assign(surface.points.begin(), surface.points.end());
    mesh.triangles = surface.triangles;
    return mesh;
}

TEST(Simplify, TurnsNoComponentInsideOut)
{
    const TriangleMesh mesh = surfaces_of_single_voxels(100);
    ASSERT_EQ(expect_sound(mesh).components.size(), 100U);
    const Simplified simple = simplify(mesh, {0.5, 6.0}, nullptr);
    EXPECT_LT(simple.mesh.triangles.size(), mesh.triangles.size() / 3);
    const MeshCheck check = expect_sound(simple.mesh);
    EXPECT_EQ(check.components.size(), 100U);
    EXPECT_EQ(check.inside_out_components(), 0U);
}

} // namespace
} // namespace vdb_shell::test
