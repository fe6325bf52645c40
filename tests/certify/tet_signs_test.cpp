// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/certify/tet_signs.h"
#include "vdb_shell/shell/tessellate.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3s;
using openvdb::Vec4I;

TetMesh mesh_of(std::vector<Vec3s> points, std::vector<Vec4I> tets)
{
    TetMesh mesh;
    mesh.points = std::move(points);
    mesh.tets = std::move(tets);
    return mesh;
}

TEST(TetSigns, TellsPositiveInvertedAndFlatApart)
{
    const TetMesh mesh =
        mesh_of({Vec3s(0, 0, 0), Vec3s(1, 0, 0), Vec3s(0, 1, 0), Vec3s(0, 0, 1), Vec3s(1, 1, 0)},
                {Vec4I(0, 1, 2, 3), Vec4I(0, 2, 1, 3), Vec4I(0, 1, 2, 4), Vec4I(1, 2, 0, 3)});
    const TetSigns signs = count_tet_signs(mesh);
    EXPECT_EQ(signs.tets, 4U);
    EXPECT_EQ(signs.inverted.count, 1U);
    EXPECT_EQ(signs.inverted.first, std::vector<std::uint32_t>{1});
    EXPECT_EQ(signs.flat.count, 1U);
    EXPECT_EQ(signs.flat.first, std::vector<std::uint32_t>{2});
    EXPECT_DOUBLE_EQ(tet_volume(mesh), 1.0 / 6);
}

TEST(TetSigns, IsExactWhereOneFloatStepDecides)
{
    // d lies on the plane x + y + z = 1 but for one unit in the last place of its z.
    const float z = 0.25f;
    const std::vector<Vec3s> base{Vec3s(1, 0, 0), Vec3s(0, 1, 0), Vec3s(0, 0, 1)};
    auto sign_at = [&](float height) {
        std::vector<Vec3s> points = base;
        points.emplace_back(0.5f, 0.25f, height);
        const TetSigns signs = count_tet_signs(mesh_of(points, {Vec4I(0, 1, 2, 3)}));
        return signs.inverted.count ? -1 : signs.flat.count ? 0 : 1;
    };
    EXPECT_EQ(sign_at(std::nextafter(z, 1.0f)), 1);
    EXPECT_EQ(sign_at(z), 0);
    EXPECT_EQ(sign_at(std::nextafter(z, 0.0f)), -1);
}

TEST(TetSigns, ListsOnlyTheFirstOffenders)
{
    const TetMesh mesh = mesh_of({Vec3s(0, 0, 0), Vec3s(1, 0, 0), Vec3s(0, 1, 0), Vec3s(0, 0, 1)},
                                 std::vector<Vec4I>(100, Vec4I(0, 2, 1, 3)));
    const TetSigns signs = count_tet_signs(mesh);
    EXPECT_EQ(signs.inverted.count, 100U);
    EXPECT_EQ(signs.inverted.first, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7}));
}

} // namespace
