// SPDX-License-Identifier: Apache-2.0

// Takes the matrices of a solid and its refinements and leaves an approximate inverse of the
// finest. The steps down and up are transposes of each other, so that it is symmetric, as conjugate
// gradients need it.

#include "multigrid.h"

#include <vdb_shell/core/error.h>

#include <Eigen/LU>

namespace soft_body
{
namespace
{

/// Held points keep a row of the identity.
std::vector<Eigen::Triplet<double>> free_entries(const BlockMatrix& matrix, const Held& held)
{
    std::vector<Eigen::Triplet<double>> entries;
    for (int row = 0; row < matrix.rows(); ++row)
        for (int k = matrix.start[std::size_t(row)]; k < matrix.start[std::size_t(row) + 1]; ++k) {
            const int col = matrix.column[std::size_t(k)];
            const bool free = !held[std::size_t(row)] && !held[std::size_t(col)];
            if (!free && row != col)
                continue;
            const Eigen::Matrix3d block =
                free ? matrix.block[std::size_t(k)] : Eigen::Matrix3d::Identity();
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    entries.emplace_back(3 * row + i, 3 * col + j, block(i, j));
        }
    return entries;
}

} // namespace

Multigrid::Multigrid(const BlockMatrix& coarsest, const Held& held) : coarsest_held_(held)
{
    const auto entries = free_entries(coarsest, held);
    const Eigen::Index size = 3 * Eigen::Index(coarsest.rows());
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    cholesky_.compute(matrix);
    if (cholesky_.info() != Eigen::Success)
        throw vdb_shell::GeometryError("the solid cannot carry a load: its stiffness is singular");
}

void Multigrid::add_finer(BlockMatrix matrix, Held held, std::vector<std::array<int, 2>> parents)
{
    Level level{std::move(matrix), std::move(held), std::move(parents), {}};
    for (int i = 0; i < level.matrix.rows(); ++i)
        level.inverse.push_back(level.matrix.at(i, i).inverse());
    levels_.push_back(std::move(level));
}

Points Multigrid::Level::prolongate(const Points& coarse) const
{
    Points fine(3, matrix.rows());
    fine.leftCols(coarse.cols()) = coarse;
    for (std::size_t i = 0; i < parents.size(); ++i)
        fine.col(coarse.cols() + Eigen::Index(i)) =
            (coarse.col(parents[i][0]) + coarse.col(parents[i][1])) / 2;
    clear_held(fine, held);
    return fine;
}

Points Multigrid::Level::restrict(const Points& fine) const
{
    const Eigen::Index old = fine.cols() - Eigen::Index(parents.size());
    Points coarse = fine.leftCols(old);
    for (std::size_t i = 0; i < parents.size(); ++i)
        for (int parent : parents[i])
            coarse.col(parent) += fine.col(old + Eigen::Index(i)) / 2;
    return coarse;
}

void Multigrid::Level::relax(int row, Points& x, const Points& right) const
{
    if (held[std::size_t(row)])
        return;
    Eigen::Vector3d rest = right.col(row);
    for (int k = matrix.start[std::size_t(row)]; k < matrix.start[std::size_t(row) + 1]; ++k)
        rest -= matrix.block[std::size_t(k)] * x.col(matrix.column[std::size_t(k)]);
    x.col(row) += inverse[std::size_t(row)] * rest;
}

Points Multigrid::prolongate(const Points& coarse) const
{
    return levels_.back().prolongate(coarse);
}

Points Multigrid::solve_coarsest(const Points& residual) const
{
    Points right = residual;
    clear_held(right, coarsest_held_);
    const Eigen::VectorXd x =
        cholesky_.solve(Eigen::Map<const Eigen::VectorXd>(right.data(), right.size()));
    return Eigen::Map<const Points>(x.data(), 3, residual.cols());
}

Points Multigrid::cycle(std::size_t level, const Points& residual) const
{
    if (level == 0)
        return solve_coarsest(residual);
    const Level& here = levels_[level - 1];
    Points x = Points::Zero(3, residual.cols());
    for (int row = 0; row < here.matrix.rows(); ++row)
        here.relax(row, x, residual);
    Points left = residual - here.matrix * x;
    clear_held(left, here.held);
    x += here.prolongate(cycle(level - 1, here.restrict(left)));
    for (int row = here.matrix.rows(); row-- > 0;)
        here.relax(row, x, residual);
    return x;
}

} // namespace soft_body
