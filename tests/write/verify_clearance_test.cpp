// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/write/verify_clearance.h"

#include "support/cancelled.h"
#include "support/cores.h"
#include "support/filled.h"
#include "vdb_shell/obstacles/core_feet.h"
#include "vdb_shell/shell/tessellate.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// A ball's shell that ends at half of the radius, and what a file may say of cores in it.

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using test::ball;

class Clearance : public ::testing::Test
{
protected:
    ShellFile file;
    Clearance()
    {
        file.stack = test::hollow_ball(2);
        file.tets = make_tets(file.stack);
    }

    void claim(double distance, double least)
    {
        file.report_json =
            nlohmann::json{{"cores", {{"distance", distance}, {"least_distance", least}}}}.dump();
    }
    double least_to(const CoreMesh& core) const
    {
        const TriangleMesh surface{file.stack.surface(0), file.stack.triangles()};
        const Cores cores = prepare_cores(surface, "ball", {core}, {});
        return report_cores(file.stack, cores, {}, {}).least_distance;
    }
};

TEST_F(Clearance, HoldsAtTheDistanceThatIsThere)
{
    const CoreMesh core = ball(0.3);
    const double least = least_to(core);
    EXPECT_GT(least, 0.15);
    claim(0, least);
    EXPECT_TRUE(verify_clearance(file, {core}).holds);
    claim(0.1, least);
    EXPECT_TRUE(verify_clearance(file, {core}).holds);
    file.report_json = "{}";
    EXPECT_TRUE(verify_clearance(file, {core}).holds);
}

TEST_F(Clearance, OtherFiguresThanThoseFoundAreRefuted)
{
    const CoreMesh core = ball(0.3);
    claim(0, least_to(core) + 1e-3);
    EXPECT_FALSE(verify_clearance(file, {core}).holds);
    claim(0.25, least_to(core));
    EXPECT_FALSE(verify_clearance(file, {core}).holds);
}

TEST_F(Clearance, ACoreInTheShellIsSeenWhereverItIs)
{
    file.report_json = "{}";
    // Across the inner surface; around all of it, within the tets; wholly within one side.
    for (const CoreMesh& core :
         {ball(0.4, Vec3d(0.2, 0, 0)), ball(0.75), ball(0.05, Vec3d(0.72, 0, 0))}) {
        const Verification found = verify_clearance(file, {core});
        EXPECT_FALSE(found.holds);
        EXPECT_NE(found.detail.find("not certified with them"), std::string::npos) << found.detail;
    }
}

TEST_F(Clearance, ACoreThatCannotBeInsideIsAFailureWithItsReason)
{
    file.report_json = "{}";
    const Verification crossing = verify_clearance(file, {ball(0.3, Vec3d(0.9, 0, 0))});
    EXPECT_FALSE(crossing.holds);
    EXPECT_NE(crossing.detail.find("crosses or touches"), std::string::npos) << crossing.detail;
    EXPECT_FALSE(verify_clearance(file, {ball(0.1, Vec3d(3, 0, 0))}).holds);
}

TEST_F(Clearance, CanBeCancelled)
{
    file.report_json = "{}";
    test::expect_cancelled(
        [&](Interrupter* interrupter) { verify_clearance(file, {ball(0.3)}, interrupter); });
}

} // namespace
} // namespace vdb_shell
