// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "solid.h"

#include <Eigen/Core>

namespace soft_body
{

struct Material {
    double young = 1; ///< Young's modulus, Pa
    double poisson = .4;
    double density = 1; ///< kg/m^3
};

/// A sparse matrix of 3 x 3 blocks, a row and a column a point.
struct BlockMatrix {
    std::vector<int> start;  ///< of each row, and the end of the last
    std::vector<int> column; ///< ascending in a row
    std::vector<Eigen::Matrix3d> block;

    int rows() const { return int(start.size()) - 1; }
    Eigen::Matrix3d& at(int row, int col);
    const Eigen::Matrix3d& at(int row, int col) const;
    /// Same bits for any number of threads: each row is one sum.
    Points operator*(const Points& x) const;
};

/// Linear tets: the displacement is linear and the stress constant in each.
class Elasticity
{
public:
    Elasticity(const Solid& solid, const Material& material);

    /// K of linear elasticity, or with a rotation a tet that of corotated elasticity, R K R^T.
    BlockMatrix stiffness(const std::vector<Eigen::Matrix3d>& rotations = {}) const;
    /// The forces of corotated elasticity on the points at these places. Without strain they are 0,
    /// however the tets are turned.
    Points forces(const Points& places, const std::vector<Eigen::Matrix3d>& rotations) const;
    /// The rotation of each tet between rest and these places; from the ones before, which are near
    /// (identity where empty). Inverted tets too have one, which turns them back.
    void update_rotations(const Points& places, std::vector<Eigen::Matrix3d>& rotations) const;
    /// Stress of each tet by linear elasticity, Pa.
    std::vector<Eigen::Matrix3d> stress(const Points& displacement) const;

    const Eigen::VectorXd& mass() const { return mass_; } ///< lumped, kg a point

private:
    using Gradients = Eigen::Matrix<double, 3, 4>; ///< of a tet's four linear functions
    Eigen::Matrix3d deformation(std::size_t t, const Points& places) const;
    Eigen::Matrix3d stress_of(const Eigen::Matrix3d& strain) const;
    void add_row(BlockMatrix& matrix, int row, const std::vector<Eigen::Matrix3d>& rotations) const;

    double lambda_, mu_; // Lame's, Pa
    std::vector<Tet> tets_;
    std::vector<Gradients> gradients_; // 1/m
    std::vector<double> volume_;       // m^3
    Eigen::VectorXd mass_;
    std::vector<int> first_, around_; // tets around each point
    BlockMatrix pattern_;             // no blocks
};

} // namespace soft_body
