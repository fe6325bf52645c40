// SPDX-License-Identifier: Apache-2.0
#include "growth/other_components.h"

#include "core/counter_random.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{

using openvdb::Vec3d;
using namespace vdb_shell;
using namespace vdb_shell::growth;

/// Small octahedra in random places, and large ones around many of them.
TriangleMesh crowd(int small, int large)
{
    const CounterRandom random(7);
    TriangleMesh all;
    for (int i = 0; i < small + large; ++i) {
        Vec3d place;
        for (int k = 0; k < 3; ++k)
            place[k] = random.unit(std::uint64_t(3 * i + k));
        const TriangleMesh one = test::icosphere(i < small ? 0.01 : 0.2, 0);
        all = test::joined(all, test::translated(one, place));
    }
    return all;
}

/// Every inner point somewhere, so that components are swept over and lie in prisms.
void scatter(GrowState& s, const CounterRandom& random)
{
    for (std::size_t v = 0; v < s.b.size(); ++v) {
        Vec3d step;
        for (std::size_t k = 0; k < 3; ++k)
            step[int(k)] = random.unit(3 * v + k) - 0.5;
        s.b[v] = rounded(s.a[v] + 0.1 * step);
    }
    std::vector<FloatBox> boxes;
    for (int f = 0; f < s.mesh->face_count(); ++f)
        boxes.push_back(float_box_of(inner_corners(s, f)));
    s.inner_tree.build(std::move(boxes));
}

TEST(OtherComponents, AreFoundInTheTreesAsOneByOne)
{
    const TriangleMesh mesh = crowd(300, 20);
    const Connectivity connectivity = connect(mesh.points.size(), mesh.triangles);
    GrowState s = make_state(
        connectivity, mesh.points,
        std::vector<double>(mesh.points.size(), std::numeric_limits<double>::infinity()));
    scatter(s, CounterRandom(11));
    int held = 0, swallowed = 0;
    for (int f = 0; f < connectivity.face_count(); ++f) {
        const bool found = holds_component(s, f);
        EXPECT_EQ(found, holds_component(s, f, WitnessSearch::one_by_one)) << "face " << f;
        held += found;
    }
    const CounterRandom random(13);
    for (int v = 0; v < connectivity.vertices; ++v) {
        Vec3d step;
        for (int k = 0; k < 3; ++k)
            step[k] = random.unit(std::uint64_t(3 * v + k)) - 0.5;
        const Vec3d x = rounded(s.b[v] + 0.3 * step);
        const bool found = swallows_component(s, v, x);
        EXPECT_EQ(found, swallows_component(s, v, x, WitnessSearch::one_by_one)) << "vertex " << v;
        swallowed += found;
    }
    EXPECT_GT(held, 10);
    EXPECT_LT(held, connectivity.face_count() - 10);
    EXPECT_GT(swallowed, 10);
    EXPECT_LT(swallowed, connectivity.vertices - 10);
}

} // namespace
