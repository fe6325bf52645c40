// SPDX-License-Identifier: Apache-2.0
#include "mesh/exact_volume.h"

#include "support/shapes.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <gtest/gtest.h>

#include <numeric>

namespace vdb_shell::test
{
namespace
{

/// A ball of 1e-10 with one vertex some units away, the first one: about that, determinants of
/// 1e-20 are differences of numbers of 64.
TriangleMesh needle(const openvdb::Vec3s& tip = {-4.0F, 1.875F, -1.96875F})
{
    TriangleMesh mesh = icosphere(1, 0);
    for (openvdb::Vec3s& p : mesh.points)
        p = p * 1e-10F - openvdb::Vec3s(9e-10F);
    mesh.points[mesh.triangles[0][0]] = tip;
    return mesh;
}

int sign_of(const TriangleMesh& mesh)
{
    std::vector<std::uint32_t> all(mesh.triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    return exact::volume_sign(mesh.points, mesh.triangles, all);
}

TEST(ExactVolume, HasTheSignThatDoublesCannotTell)
{
    EXPECT_EQ(sign_of(icosphere(1, 2)), 1);
    EXPECT_EQ(sign_of(reversed(icosphere(1, 2))), -1);
    EXPECT_EQ(sign_of(needle()), 1);
    EXPECT_EQ(sign_of(reversed(needle())), -1);
    // The same triangles twice, turned against each other.
    EXPECT_EQ(sign_of(joined(needle(), reversed(needle()))), 0);
}

TEST(ExactVolume, TellsWhatIsInsideOut)
{
    // In doubles the sign of some of these is the wrong one.
    for (int i = 0; i < 20; ++i) {
        const TriangleMesh mesh = needle({-4.0F, 1.875F - 0.13F * float(i), -1.96875F});
        EXPECT_EQ(check_mesh(mesh).inside_out_components(), 0) << i;
        EXPECT_EQ(check_mesh(reversed(mesh)).inside_out_components(), 1) << i;
    }
}

} // namespace
} // namespace vdb_shell::test
