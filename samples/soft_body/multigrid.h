// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "solve.h"

#include <Eigen/SparseCholesky>

namespace soft_body
{

/// A V-cycle over solids that were refined from each other, for conjugate gradients on the finest:
/// a sweep of Gauss and Seidel on the way down, one in the opposite order on the way up, Cholesky
/// on the coarsest.
class Multigrid
{
public:
    /// Throws vdb_shell::GeometryError where the matrix is singular on the free points.
    Multigrid(const BlockMatrix& coarsest, const Held& held);
    /// `parents` as refine gives them.
    void add_finer(BlockMatrix matrix, Held held, std::vector<std::array<int, 2>> parents);
    Points operator()(const Points& residual) const { return cycle(levels_.size(), residual); }
    /// Displacements on the finest but one, carried to the finest.
    Points prolongate(const Points& coarse) const;
    const BlockMatrix& finest() const { return levels_.back().matrix; }

private:
    struct Level {
        BlockMatrix matrix;
        Held held;
        std::vector<std::array<int, 2>> parents;
        std::vector<Eigen::Matrix3d> inverse; // of the diagonal blocks
        Points prolongate(const Points& coarse) const;
        Points restrict(const Points& fine) const; // its transpose
        void relax(int row, Points& x, const Points& right) const;
    };
    Points cycle(std::size_t level, const Points& residual) const;
    Points solve_coarsest(const Points& residual) const;

    std::vector<Level> levels_; // without the coarsest
    Held coarsest_held_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky_;
};

} // namespace soft_body
