// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "elasticity.h"

#include <functional>

namespace soft_body
{

/// 1 for each point whose displacement is given: solvers leave it as it is.
using Held = std::vector<char>;

/// An approximate inverse, symmetric and positive on the free points, 0 on the held ones.
using Precondition = std::function<Points(const Points& residual)>;

Precondition divide_by_diagonal(const BlockMatrix& matrix, const Held& held);

struct Stop {
    double tolerance = 1e-6; ///< of the residual's norm over that of the right side
    int most_steps = 100000;
};

struct Solved {
    Points x;
    int steps = 0;
    bool converged = false;
};

/// Conjugate gradients from `start`, which has the displacements of held points.
Solved conjugate_gradients(const BlockMatrix& matrix, const Held& held, const Points& right,
                           const Precondition& precondition, Points start, const Stop& stop = {});

/// The largest eigenvalue of M^-1 K on the free points, 1/s^2: power iteration until a hundred
/// steps change it by less than a millionth.
double largest_eigenvalue(const BlockMatrix& stiffness, const Eigen::VectorXd& mass,
                          const Held& held);

/// Sets the columns of held points to 0.
void clear_held(Points& x, const Held& held);

} // namespace soft_body
