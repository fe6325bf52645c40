// SPDX-License-Identifier: Apache-2.0

// Takes a matrix of blocks and leaves solutions and the largest eigenvalue. Nothing here depends on
// the number of threads: products are sums by rows, inner products are made by one thread.

#include "solve.h"

#include <cmath>
#include <memory>

namespace soft_body
{
namespace
{

double dot(const Points& a, const Points& b)
{
    return a.cwiseProduct(b).sum();
}

} // namespace

void clear_held(Points& x, const Held& held)
{
    for (Eigen::Index i = 0; i < x.cols(); ++i)
        if (held[std::size_t(i)])
            x.col(i).setZero();
}

Precondition divide_by_diagonal(const BlockMatrix& matrix, const Held& held)
{
    auto inverse = std::make_shared<Points>(3, matrix.rows());
    for (int i = 0; i < matrix.rows(); ++i)
        inverse->col(i) = matrix.at(i, i).diagonal().cwiseInverse();
    clear_held(*inverse, held);
    return [inverse](const Points& residual) { return inverse->cwiseProduct(residual); };
}

Solved conjugate_gradients(const BlockMatrix& matrix, const Held& held, const Points& right,
                           const Precondition& precondition, Points start, const Stop& stop)
{
    Solved solved{std::move(start), 0, false};
    Points residual = right - matrix * solved.x;
    clear_held(residual, held);
    Points wanted = right;
    clear_held(wanted, held);
    const double limit = stop.tolerance * wanted.norm();
    Points direction = precondition(residual);
    double rho = dot(residual, direction);
    while (residual.norm() > limit && solved.steps < stop.most_steps) {
        Points image = matrix * direction;
        clear_held(image, held);
        const double length = rho / dot(direction, image);
        solved.x += length * direction;
        residual -= length * image;
        const Points next = precondition(residual);
        const double next_rho = dot(residual, next);
        direction = next + next_rho / rho * direction;
        rho = next_rho;
        ++solved.steps;
    }
    solved.converged = residual.norm() <= limit;
    return solved;
}

double largest_eigenvalue(const BlockMatrix& stiffness, const Eigen::VectorXd& mass,
                          const Held& held)
{
    // Of M^-1/2 K M^-1/2, which is symmetric: its Rayleigh quotients only grow.
    Eigen::RowVectorXd root = mass.cwiseSqrt().cwiseInverse().transpose();
    Points x(3, mass.size());
    for (Eigen::Index i = 0; i < x.cols(); ++i)
        for (int k = 0; k < 3; ++k)
            x(k, i) = std::sin(1.0 + 12.9898 * double(3 * i + k)); // in no eigenvector's way
    clear_held(x, held);
    double found = 0, before = 0;
    for (int step = 0; step < 100000; ++step) {
        x /= x.norm();
        Points image = stiffness * Points(x.array().rowwise() * root.array());
        image.array().rowwise() *= root.array();
        clear_held(image, held);
        found = dot(x, image);
        x = image;
        if (step % 100 == 99) {
            if (found - before < 1e-6 * found)
                break;
            before = found;
        }
    }
    return found;
}

} // namespace soft_body
