// SPDX-License-Identifier: Apache-2.0
#include "growth/violations.h"

#include "core/marked.h"
#include "growth/diagonals.h"
#include "growth/half_full_sphere.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

using namespace vdb_shell;
using namespace vdb_shell::growth;
using openvdb::Vec3d;

std::vector<std::uint8_t> marks_of(const std::vector<int>& numbers, std::size_t count)
{
    std::vector<std::uint8_t> marks(count, 0);
    for (const int i : numbers)
        marks[std::size_t(i)] = 1;
    return marks;
}

TEST(Violations, FewFacesFailWhereTheyFailAmongAll)
{
    for (const bool twelve : {true, false}) {
        test::HalfFullSphere sphere(0.1);
        GrowState& s = sphere.s;
        s.twelve = twelve;
        order_by_length(s);
        const std::size_t count = s.mesh->faces.size();
        violating_faces(s, std::vector<std::uint8_t>(count, 1), true);
        // One inner point goes through the surface on the far side, two others a little.
        const std::vector<int> moved{3, 100, 200};
        s.b[3] = rounded(-0.6 * s.a[3]);
        s.b[100] = rounded(0.9 * s.b[100]);
        s.b[200] = rounded(s.b[200] + Vec3d(0.05, -0.05, 0.02));
        const std::vector<int> changed = faces_around(s, moved);
        s.inner_tree.index_parents();
        const std::vector<int> few = violating_among(s, changed);
        EXPECT_EQ(few, marked(violating_faces(s, marks_of(changed, count), false)));
        // Those that a changed face touches are among them.
        EXPECT_FALSE(std::includes(changed.begin(), changed.end(), few.begin(), few.end()));
        EXPECT_EQ(free_corners_of(s, few), marked(free_corners_of(s, marks_of(few, count))));
    }
}

TEST(Violations, AMoveIsFeltByTheFacesAroundItAndAComponentByThePrismsThatItComesInto)
{
    const TriangleMesh ball = test::icosphere(1.0, 3);
    const TriangleMesh mesh =
        test::joined(ball, test::translated(test::icosphere(0.1, 1), Vec3d(3, 0, 0)));
    const Connectivity connectivity = connect(mesh.points.size(), mesh.triangles);
    GrowState s = make_state(connectivity, mesh.points,
                             std::vector<double>(mesh.points.size(), test::kInfinity));
    for (std::size_t v = 0; v < s.b.size(); ++v)
        s.b[v] = rounded(v < ball.points.size() ? 0.5 * s.a[v] : s.a[v] - Vec3d(0, 0, 1e-3));
    const auto expect_both = [&](const std::vector<int>& moved) {
        const std::vector<int> faces = faces_around(s, moved);
        EXPECT_EQ(faces, marked(faces_around(s, marks_of(moved, s.b.size()))));
        return faces;
    };
    const int witness = static_cast<int>(ball.points.size());
    ASSERT_EQ(s.witness, (std::vector<int>{0, witness}));
    EXPECT_EQ(expect_both({5, 6, witness + 1}), faces_at(connectivity, {5, 6, witness + 1}));
    // Into the middle of a prism of the other component, which its faces do not touch.
    const int host = 77;
    Vec3d middle(0.0);
    for (int k = 0; k < 3; ++k) {
        const int v = connectivity.corner(host, k);
        middle += (s.a[v] + s.b[v]) / 6.0;
    }
    s.b[witness] = rounded(middle);
    const std::vector<int> felt = expect_both({witness});
    EXPECT_TRUE(std::binary_search(felt.begin(), felt.end(), host));
    EXPECT_LT(felt.size(), ball.triangles.size() / 8);
}

} // namespace
