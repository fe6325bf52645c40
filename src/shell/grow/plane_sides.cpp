// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/plane_sides.h"

#include "core/lanes.h"
#include "core/orient3d_filter.h"

#include <cstring>

namespace vdb_shell::growth
{
namespace
{

using FourWords __attribute__((vector_size(32))) = unsigned long long;

} // namespace

VDB_SHELL_TWO_TARGETS void PlaneSides::compute()
{
    const std::size_t blocks = (points_ + kDoubleLanes - 1) / kDoubleLanes;
    for (std::size_t i = points_; i < blocks * kDoubleLanes; ++i)
        x_[i] = y_[i] = z_[i] = 0;
    for (std::size_t k = 0; k < planes_; ++k) {
        const openvdb::Vec3d &a = plane_[k][0], u = plane_[k][1] - a, w = plane_[k][2] - a;
        const double xy = u[0] * w[1], yx = u[1] * w[0], yz = u[1] * w[2], zy = u[2] * w[1],
                     zx = u[2] * w[0], xz = u[0] * w[2];
        const double nx = yz - zy, ny = zx - xz, nz = xy - yx;
        const double sx = std::abs(yz) + std::abs(zy), sy = std::abs(zx) + std::abs(xz),
                     sz = std::abs(xy) + std::abs(yx);
        // A bit a point: on the plus side in the lower half of a word, on the minus side above.
        constexpr FourWords kPlus{1, 2, 4, 8}, kMinus = kPlus << kMostPoints;
        FourWords sides{};
        for (std::size_t block = 0; block < blocks; ++block) {
            DoubleLanes x, y, z;
            std::memcpy(&x, &x_[block * kDoubleLanes], sizeof x);
            std::memcpy(&y, &y_[block * kDoubleLanes], sizeof y);
            std::memcpy(&z, &z_[block * kDoubleLanes], sizeof z);
            x -= a[0], y -= a[1], z -= a[2];
            const DoubleLanes det = z * nz + x * nx + y * ny;
            const DoubleLanes permanent =
                (z < 0 ? -z : z) * sz + (x < 0 ? -x : x) * sx + (y < 0 ? -y : y) * sy;
            const DoubleLanes bound = exact::kOrientError * permanent + exact::kUnderflowGuard;
            const FourWords side =
                ((FourWords)(det > bound) & kPlus) | ((FourWords)(det < -bound) & kMinus);
            sides |= side << (kDoubleLanes * block);
        }
        const unsigned long long all = sides[0] | sides[1] | sides[2] | sides[3];
        plus_[k] = static_cast<std::uint32_t>(all);
        minus_[k] = static_cast<std::uint32_t>(all >> kMostPoints);
    }
}

} // namespace vdb_shell::growth
