// SPDX-License-Identifier: Apache-2.0

// Takes a solid and a material and leaves stiffness, masses and forces of linear tets. With g_i the
// gradient of the function that is 1 at corner i and 0 at the others, a block of a tet's stiffness
// is V (lambda g_i g_j^T + mu g_j g_i^T + mu (g_i . g_j) I); turning the tet turns the gradients.

#include "elasticity.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

namespace soft_body
{
namespace
{

// Rows of a few dozen additions each; fewer a task cost more than they give.
constexpr int kRowsPerTask = 256;

template <class Work> void for_rows(int rows, const Work& work)
{
    tbb::parallel_for(tbb::blocked_range<int>(0, rows, kRowsPerTask), [&](const auto& range) {
        for (int row = range.begin(); row < range.end(); ++row)
            work(row);
    });
}

/// The tets around each point, in their order: first[i] to first[i + 1] of `around`.
void tets_around(const std::vector<Tet>& tets, std::size_t points, std::vector<int>& first,
                 std::vector<int>& around)
{
    first.assign(points + 1, 0);
    for (const Tet& tet : tets)
        for (int corner : tet)
            ++first[std::size_t(corner) + 1];
    for (std::size_t i = 0; i < points; ++i)
        first[i + 1] += first[i];
    around.resize(4 * tets.size());
    std::vector<int> next(first.begin(), first.end() - 1);
    for (std::size_t t = 0; t < tets.size(); ++t)
        for (int corner : tets[t])
            around[std::size_t(next[std::size_t(corner)]++)] = int(t);
}

BlockMatrix pattern_of(const std::vector<Tet>& tets, const std::vector<int>& first,
                       const std::vector<int>& around)
{
    BlockMatrix pattern;
    pattern.start.push_back(0);
    std::vector<int> near;
    for (std::size_t i = 0; i + 1 < first.size(); ++i) {
        near.clear();
        for (int k = first[i]; k < first[i + 1]; ++k)
            near.insert(near.end(), tets[std::size_t(around[std::size_t(k)])].begin(),
                        tets[std::size_t(around[std::size_t(k)])].end());
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        pattern.column.insert(pattern.column.end(), near.begin(), near.end());
        pattern.start.push_back(int(pattern.column.size()));
    }
    return pattern;
}

/// The rotation nearest to F in the sense of Mueller et al., "A robust method to extract the
/// rotational part of deformations" (2016): turned until the torque of the columns is gone.
Eigen::Matrix3d rotation_near(const Eigen::Matrix3d& deformation, const Eigen::Matrix3d& start)
{
    Eigen::Matrix3d rotation = start;
    for (int round = 0; round < 20; ++round) {
        Eigen::Vector3d turn = Eigen::Vector3d::Zero();
        double along = 0;
        for (int k = 0; k < 3; ++k) {
            turn += rotation.col(k).cross(deformation.col(k));
            along += rotation.col(k).dot(deformation.col(k));
        }
        turn /= std::abs(along) + 1e-9;
        const double angle = turn.norm();
        if (angle < 1e-12)
            break;
        rotation = Eigen::AngleAxisd(angle, turn / angle) * rotation;
    }
    // Thousands of steps turn the last ones' rotations on, and rounding would add up.
    return Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
}

} // namespace

Eigen::Matrix3d& BlockMatrix::at(int row, int col)
{
    const auto begin = column.begin() + start[std::size_t(row)];
    const auto end = column.begin() + start[std::size_t(row) + 1];
    const auto found = std::lower_bound(begin, end, col);
    assert(found != end && *found == col);
    return block[std::size_t(found - column.begin())];
}

const Eigen::Matrix3d& BlockMatrix::at(int row, int col) const
{
    return const_cast<BlockMatrix*>(this)->at(row, col);
}

Points BlockMatrix::operator*(const Points& x) const
{
    Points y(3, rows());
    for_rows(rows(), [&](int row) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (int k = start[std::size_t(row)]; k < start[std::size_t(row) + 1]; ++k)
            sum += block[std::size_t(k)] * x.col(column[std::size_t(k)]);
        y.col(row) = sum;
    });
    return y;
}

Elasticity::Elasticity(const Solid& solid, const Material& material)
    : lambda_(material.young * material.poisson /
              ((1 + material.poisson) * (1 - 2 * material.poisson))),
      mu_(material.young / (2 * (1 + material.poisson))), tets_(solid.tets),
      mass_(Eigen::VectorXd::Zero(solid.points.cols()))
{
    for (const Tet& tet : tets_) {
        Eigen::Matrix3d frame;
        for (int k = 0; k < 3; ++k)
            frame.col(k) = solid.points.col(tet[std::size_t(k) + 1]) - solid.points.col(tet[0]);
        Gradients gradients;
        gradients.rightCols<3>() = frame.inverse().transpose();
        gradients.col(0) = -gradients.rightCols<3>().rowwise().sum();
        gradients_.push_back(gradients);
        volume_.push_back(frame.determinant() / 6);
        for (int corner : tet)
            mass_[corner] += material.density * volume_.back() / 4;
    }
    tets_around(tets_, std::size_t(solid.points.cols()), first_, around_);
    pattern_ = pattern_of(tets_, first_, around_);
}

void Elasticity::add_row(BlockMatrix& matrix, int row,
                         const std::vector<Eigen::Matrix3d>& rotations) const
{
    for (int k = first_[std::size_t(row)]; k < first_[std::size_t(row) + 1]; ++k) {
        const auto t = std::size_t(around_[std::size_t(k)]);
        Gradients g = gradients_[t];
        if (!rotations.empty())
            g = rotations[t] * g;
        const auto i = std::find(tets_[t].begin(), tets_[t].end(), row) - tets_[t].begin();
        for (int j = 0; j < 4; ++j)
            matrix.at(row, tets_[t][std::size_t(j)]) +=
                volume_[t] *
                (lambda_ * g.col(i) * g.col(j).transpose() + mu_ * g.col(j) * g.col(i).transpose() +
                 mu_ * g.col(i).dot(g.col(j)) * Eigen::Matrix3d::Identity());
    }
}

BlockMatrix Elasticity::stiffness(const std::vector<Eigen::Matrix3d>& rotations) const
{
    BlockMatrix matrix = pattern_;
    matrix.block.assign(matrix.column.size(), Eigen::Matrix3d::Zero());
    for_rows(matrix.rows(), [&](int row) { add_row(matrix, row, rotations); });
    return matrix;
}

Eigen::Matrix3d Elasticity::deformation(std::size_t t, const Points& places) const
{
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int k = 0; k < 4; ++k)
        sum += places.col(tets_[t][std::size_t(k)]) * gradients_[t].col(k).transpose();
    return sum;
}

Eigen::Matrix3d Elasticity::stress_of(const Eigen::Matrix3d& strain) const
{
    return lambda_ * strain.trace() * Eigen::Matrix3d::Identity() + 2 * mu_ * strain;
}

Points Elasticity::forces(const Points& places, const std::vector<Eigen::Matrix3d>& rotations) const
{
    Points sum = Points::Zero(3, places.cols());
    for (std::size_t t = 0; t < tets_.size(); ++t) {
        const Eigen::Matrix3d turned_back = rotations[t].transpose() * deformation(t, places);
        const Eigen::Matrix3d strain =
            (turned_back + turned_back.transpose()) / 2 - Eigen::Matrix3d::Identity();
        const Gradients pull = -volume_[t] * rotations[t] * stress_of(strain) * gradients_[t];
        for (int k = 0; k < 4; ++k)
            sum.col(tets_[t][std::size_t(k)]) += pull.col(k);
    }
    return sum;
}

void Elasticity::update_rotations(const Points& places,
                                  std::vector<Eigen::Matrix3d>& rotations) const
{
    rotations.resize(tets_.size(), Eigen::Matrix3d::Identity());
    for_rows(int(tets_.size()), [&](int t) {
        auto& rotation = rotations[std::size_t(t)];
        rotation = rotation_near(deformation(std::size_t(t), places), rotation);
    });
}

std::vector<Eigen::Matrix3d> Elasticity::stress(const Points& displacement) const
{
    std::vector<Eigen::Matrix3d> found;
    for (std::size_t t = 0; t < tets_.size(); ++t) {
        const Eigen::Matrix3d slope = deformation(t, displacement);
        found.push_back(stress_of((slope + slope.transpose()) / 2));
    }
    return found;
}

} // namespace soft_body
