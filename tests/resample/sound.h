// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/check_mesh.h"

#include <gtest/gtest.h>

namespace vdb_shell::test
{

/// Closed, manifold, embedded, outside out, and no triangle without an area or twice.
inline MeshCheck expect_sound(const TriangleMesh& mesh)
{
    const MeshCheck check = check_mesh(mesh);
    EXPECT_TRUE(check.closed() && check.manifold() && check.embedded());
    EXPECT_EQ(check.inconsistent_edges.count + check.degenerate_triangles.count +
                  check.duplicate_triangles.count,
              0U);
    EXPECT_GT(check.volume, 0);
    return check;
}

} // namespace vdb_shell::test
