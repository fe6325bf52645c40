// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/plane_sides.h"

#include "core/orient3d_filter.h"
#include "core/two_targets.h"

#include <cstring>

namespace vdb_shell::growth
{
namespace
{

using FourDoubles __attribute__((vector_size(32))) = double;
using FourWords __attribute__((vector_size(32))) = long long;
constexpr std::size_t kLanes = 4;

} // namespace

VDB_SHELL_TWO_TARGETS void PlaneSides::compute()
{
    const std::size_t blocks = (points_ + kLanes - 1) / kLanes;
    for (std::size_t i = points_; i < blocks * kLanes; ++i)
        x_[i] = y_[i] = z_[i] = 0;
    for (std::size_t k = 0; k < planes_; ++k) {
        const openvdb::Vec3d &a = plane_[k][0], u = plane_[k][1] - a, w = plane_[k][2] - a;
        const double xy = u[0] * w[1], yx = u[1] * w[0], yz = u[1] * w[2], zy = u[2] * w[1],
                     zx = u[2] * w[0], xz = u[0] * w[2];
        const double nx = yz - zy, ny = zx - xz, nz = xy - yx;
        const double sx = std::abs(yz) + std::abs(zy), sy = std::abs(zx) + std::abs(xz),
                     sz = std::abs(xy) + std::abs(yx);
        for (std::size_t block = 0; block < blocks; ++block) {
            FourDoubles x, y, z;
            std::memcpy(&x, &x_[block * kLanes], sizeof x);
            std::memcpy(&y, &y_[block * kLanes], sizeof y);
            std::memcpy(&z, &z_[block * kLanes], sizeof z);
            x -= a[0], y -= a[1], z -= a[2];
            const FourDoubles det = z * nz + x * nx + y * ny;
            const FourDoubles permanent =
                (z < 0 ? -z : z) * sz + (x < 0 ? -x : x) * sx + (y < 0 ? -y : y) * sy;
            const FourDoubles bound = exact::kOrientError * permanent + exact::kUnderflowGuard;
            const FourWords side = (det < -bound) - (det > bound);
            std::memcpy(&side_[k][block * kLanes], &side, sizeof side);
        }
    }
}

} // namespace vdb_shell::growth
