// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/repair/repair_mesh.h"

#include <gtest/gtest.h>

#include <cstring>

// What every repair has to keep to.

namespace vdb_shell::test
{

inline bool same_bits(const openvdb::Vec3s& a, const openvdb::Vec3s& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Every triangle that claims to come from the input has its corners there, bit for bit, in the
/// same cyclic order, or in the other one where it was turned; no input triangle comes twice.
/// Returns how many do.
inline std::size_t expect_kept(const TriangleMesh& input, const RepairResult& result)
{
    std::vector<char> seen(input.triangles.size());
    std::size_t kept = 0, turned = 0;
    EXPECT_EQ(result.source_triangle.size(), result.mesh.triangles.size());
    for (std::size_t t = 0; t < result.source_triangle.size(); ++t) {
        const std::uint32_t source = result.source_triangle[t];
        if (source == kNoSource)
            continue;
        ++kept;
        EXPECT_FALSE(seen.at(source)) << source;
        seen[source] = 1;
        bool forward = false, backward = false;
        for (int shift = 0; shift < 3; ++shift) {
            bool same = true, mirrored = true;
            for (int k = 0; k < 3; ++k) {
                const openvdb::Vec3s& in = input.points[input.triangles[source][k]];
                const openvdb::Vec3I& out = result.mesh.triangles[t];
                same = same && same_bits(in, result.mesh.points[out[(k + shift) % 3]]);
                mirrored = mirrored && same_bits(in, result.mesh.points[out[(5 - k + shift) % 3]]);
            }
            forward |= same;
            backward |= mirrored;
        }
        EXPECT_TRUE(forward || backward) << "triangle " << source;
        turned += !forward;
    }
    EXPECT_LE(turned, result.report.turned.count);
    EXPECT_EQ(kept, result.report.kept_triangles);
    return kept;
}

inline void expect_sound(const RepairReport& report)
{
    EXPECT_NO_THROW(require_usable(report.after, {}, "repaired")) << repair_text(report);
}

} // namespace vdb_shell::test
