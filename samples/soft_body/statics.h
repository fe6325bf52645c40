// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "solve.h"

namespace soft_body
{

/// Standard gravity, m/s^2.
inline constexpr double kGravity = 9.80665;

/// Points at most `share` of the solid's height above its lowest one. `up`: 0 x, 1 y, 2 z.
Held hold_foot(const Points& points, int up, double share = .1);

/// Those of them that lie on the surface. Meshes of one surface hold the same points, whatever is
/// inside.
Held hold_skin(const Solid& solid, int up);

/// The same triangles of the surface held on the refined solid: midpoints of edges of triangles
/// with three held corners. `parents` as refine gives them.
Held hold_midpoints(const Solid& coarse, const Held& held,
                    const std::vector<std::array<int, 2>>& parents);

/// Points of the innermost surface. Throws vdb_shell::GeometryError where layers are not known.
Held hold_inner(const Solid& solid);

/// Throws vdb_shell::GeometryError naming a point when a part of the solid has no held point.
void require_held(const Solid& solid, const Held& held);

/// The weight of each point, N.
Points weight(const Eigen::VectorXd& mass, int up);

struct Deflection {
    Points displacement; ///< m
    double compliance;   ///< work of the weight, f . u, J
    int steps;           ///< of conjugate gradients with a diagonal preconditioner
    bool converged;
};
Deflection deflect(const Solid& solid, const Elasticity& elasticity, const Held& held, int up);

/// Compliances of the solid and of refinements of it, and where they lead; foot held, or its skin
/// alone. With the skin, the coarse displacements are among the fine ones, so compliances only
/// grow.
struct Convergence {
    std::vector<double> compliances;
    double limit;
};
Convergence converge(const Solid& solid, const Material& material, int up, int refinements = 2,
                     bool skin_alone = false);

/// Richardson's extrapolation: three values whose differences shrink by a factor q each time have
/// the limit c_2 + (c_2 - c_1) / (q - 1). The factor is taken as at least 1.5 and at most 4, the
/// one of smooth solutions; of two values alone as 4, of one there is nothing to tell it from.
double extrapolate(const std::vector<double>& compliances);

} // namespace soft_body
