// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/resample/coarsen.h"

#include "resample/edge_collapse.h"
#include "support/shapes.h"
#include "support/stacks.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <tbb/global_control.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;

int euler_characteristic(const TriangleMesh& mesh)
{
    // Of a closed mesh, three edges to two triangles.
    const auto triangles = static_cast<int>(mesh.triangles.size());
    return static_cast<int>(mesh.points.size()) - triangles / 2;
}

void expect_closed_like(const TriangleMesh& coarse, const TriangleMesh& fine)
{
    const MeshCheck check = check_mesh(coarse);
    EXPECT_TRUE(check.closed() && check.manifold());
    EXPECT_EQ(check.inconsistent_edges.count, 0U);
    EXPECT_EQ(check.duplicate_triangles.count, 0U);
    EXPECT_EQ(check.degenerate_triangles.count, 0U);
    EXPECT_EQ(euler_characteristic(coarse), euler_characteristic(fine));
}

TEST(Coarsen, LeavesAClosedSurfaceOfSomeOfThePointsAndTheSameGenus)
{
    const TriangleMesh fine = test::torus(2.0, 0.8, 48, 24);
    const Coarsened coarse = coarsen(fine, 300);
    EXPECT_LE(coarse.mesh.triangles.size(), 300U);
    EXPECT_GE(coarse.mesh.triangles.size(), 290U);
    expect_closed_like(coarse.mesh, fine);
    ASSERT_EQ(coarse.from.size(), coarse.mesh.points.size());
    EXPECT_TRUE(std::is_sorted(coarse.from.begin(), coarse.from.end()));
    for (std::size_t v = 0; v < coarse.from.size(); ++v)
        EXPECT_EQ(coarse.mesh.points[v], fine.points[coarse.from[v]]);
    const double volume = signed_volume(fine.points, fine.triangles);
    EXPECT_NEAR(signed_volume(coarse.mesh.points, coarse.mesh.triangles), volume, 0.08 * volume);
}

TEST(Coarsen, TakesWhatIsFlatFirstAndKeepsEdgesSharp)
{
    const TriangleMesh fine = test::gridded_box(Vec3d(0.0), Vec3d(3.0, 2.0, 1.0), 12);
    const Coarsened coarse = coarsen(fine, fine.triangles.size() / 8);
    EXPECT_LE(coarse.mesh.triangles.size(), fine.triangles.size() / 8);
    expect_closed_like(coarse.mesh, fine);
    EXPECT_NEAR(signed_volume(coarse.mesh.points, coarse.mesh.triangles), 6.0, 1e-6);
}

TEST(Coarsen, MakesNoSliversOfWhatIsFlat)
{
    const TriangleMesh fine = test::gridded_box(Vec3d(0.0), Vec3d(1.0), 16);
    const Coarsened coarse = coarsen(fine, 200);
    EXPECT_LE(coarse.mesh.triangles.size(), 200U);
    EXPECT_GE(coarse.mesh.triangles.size(), 190U);
    for (const openvdb::Vec3I& t : coarse.mesh.triangles) {
        const Vec3d p(coarse.mesh.points[t[0]]), q(coarse.mesh.points[t[1]]),
            r(coarse.mesh.points[t[2]]);
        const double longest =
            std::max({(q - p).lengthSqr(), (r - q).lengthSqr(), (p - r).lengthSqr()});
        EXPECT_LE(longest / (q - p).cross(r - p).length(), 8.0 + 1e-6);
    }
}

TEST(Coarsen, KeepsTheSidesOfAThinWallApart)
{
    // A ball with a round cavity that comes close to its surface in one place.
    const TriangleMesh cavity =
        test::translated(test::reversed(test::icosphere(0.5, 4)), Vec3d(0.497, 0, 0));
    const TriangleMesh fine = test::joined(test::icosphere(1.0, 4), cavity);
    const std::size_t wanted = fine.triangles.size() / 16;
    CollapseLimits limits;
    limits.fewest_triangles = wanted;
    ASSERT_FALSE(check_mesh(collapse_edges(fine, limits).mesh).embedded());
    const Coarsened coarse = coarsen(fine, wanted);
    EXPECT_TRUE(coarse.embedded);
    EXPECT_LE(coarse.mesh.triangles.size(), 2 * wanted);
    EXPECT_TRUE(check_mesh(coarse.mesh).embedded());
}

TEST(Coarsen, SaysThatAWallWasTooThin)
{
    const TriangleMesh fine =
        test::joined(test::icosphere(1.0, 4), test::reversed(test::icosphere(0.999, 4)));
    const std::size_t wanted = fine.triangles.size() / 16;
    const Coarsened coarse = coarsen(fine, wanted);
    EXPECT_FALSE(coarse.embedded);
    EXPECT_LE(coarse.mesh.triangles.size(), 2 * wanted);
    EXPECT_FALSE(check_mesh(coarse.mesh).embedded());
}

TEST(Coarsen, EndsWhereNothingIsLeftToCollapse)
{
    const TriangleMesh tetrahedron = test::unit_tetrahedron();
    EXPECT_EQ(coarsen(tetrahedron, 0).mesh.triangles, tetrahedron.triangles);
    const TriangleMesh box = test::box(Vec3d(0.0), Vec3d(1.0));
    expect_closed_like(coarsen(box, 0).mesh, box);
    EXPECT_EQ(coarsen(TriangleMesh(), 10).mesh.points.size(), 0U);
}

TEST(Coarsen, IsTheSameForAnyNumberOfThreads)
{
    const TriangleMesh fine = test::bumpy_sphere();
    const Coarsened many = coarsen(fine, fine.triangles.size() / 8);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    const Coarsened one = coarsen(fine, fine.triangles.size() / 8);
    EXPECT_EQ(many.from, one.from);
    EXPECT_EQ(many.mesh.triangles, one.mesh.triangles);
}

TEST(Coarsen, CanBeCancelled)
{
    const TriangleMesh fine = test::icosphere(1.0, 2);
    test::expect_cancelled([&](Interrupter* interrupter) { coarsen(fine, 100, interrupter); });
}

} // namespace
