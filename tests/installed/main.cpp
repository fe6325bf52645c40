// SPDX-License-Identifier: Apache-2.0
#include <vdb_shell/mesh/triangle_mesh.h>

int main()
{
    const vdb_shell::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                              {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    const double six_volumes =
        6 * vdb_shell::signed_volume(tetrahedron.points, tetrahedron.triangles);
    return six_volumes > 0.999 && six_volumes < 1.001 ? 0 : 1;
}
