// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shell/grow/grow_state.h"

namespace vdb_shell::growth
{

/// A ball that x has to stay in; infinite: no such bound.
struct Ball {
    Vec3d centre;
    double radius;
};

/// Minimum over x of gradient . x - softness * (sum of log(bound(x)) + log(r^2 - |x - c|^2)), the
/// last term only for a ball of finite radius: convex, three unknowns. Damped
/// Newton from `start`, which lies inside every bound that counts; bounds already violated there
/// are left out. A few steps only: the vertex is asked again in the next sweep.
Vec3d barrier_minimum(const std::vector<HalfSpace>& bounds, const Ball& ball, const Vec3d& gradient,
                      double softness, const Vec3d& start);

} // namespace vdb_shell::growth
