// SPDX-License-Identifier: Apache-2.0

// Takes a solid and leaves its places at the times of frames. With stiffness K at the places of a
// step's beginning and damping b, the new velocities v + d solve
// (M + (h^2 + h b) K) d = h (weight + elastic forces - (h + b) K v).

#include "motion.h"

#include <cmath>

namespace soft_body
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
// Well below what a picture shows; the motion's own error is that of its step.
constexpr double kTolerance = 1e-5;

double foot_at(double time, double height, const MotionOptions& options)
{
    // Whole periods, so that the foot stops where it began.
    const double until = std::floor(options.frequency * options.seconds / 2) / options.frequency;
    return time < until ? options.shake * height * std::sin(2 * kPi * options.frequency * time) : 0;
}

class Stepper
{
public:
    Stepper(const Elasticity& elasticity, const Held& held, int up, double step, double damping)
        : elasticity_(elasticity), held_(held), weight_(weight(elasticity.mass(), up)), step_(step),
          damping_(damping)
    {
    }

    /// One step in which held points get the velocity `foot`; the steps of conjugate gradients.
    int advance(Points& places, Points& velocity, const Eigen::Vector3d& foot)
    {
        elasticity_.update_rotations(places, rotations_);
        BlockMatrix matrix = elasticity_.stiffness(rotations_);
        const Points drag = matrix * velocity;
        const Points right =
            step_ * (weight_ + elasticity_.forces(places, rotations_) - (step_ + damping_) * drag);
        for (Eigen::Matrix3d& block : matrix.block)
            block *= step_ * (step_ + damping_);
        for (int i = 0; i < matrix.rows(); ++i)
            matrix.at(i, i).diagonal().array() += elasticity_.mass()[i];
        Points start = Points::Zero(3, places.cols());
        for (Eigen::Index i = 0; i < start.cols(); ++i)
            if (held_[std::size_t(i)])
                start.col(i) = foot - velocity.col(i);
        const Solved solved =
            conjugate_gradients(matrix, held_, right, divide_by_diagonal(matrix, held_),
                                std::move(start), {kTolerance});
        velocity += solved.x;
        places += step_ * velocity;
        return solved.steps;
    }

private:
    const Elasticity& elasticity_;
    const Held& held_;
    Points weight_;
    double step_, damping_;
    std::vector<Eigen::Matrix3d> rotations_;
};

} // namespace

void move(const Solid& solid, const Elasticity& elasticity, const Held& held, int up,
          const MotionOptions& options, const std::function<void(const Frame&)>& frame)
{
    require_held(solid, held);
    const double step = 1.0 / (options.frames_per_second * options.steps_per_frame);
    const double height = solid.points.row(up).maxCoeff() - solid.points.row(up).minCoeff();
    const int sideways = up == 0 ? 1 : 0;
    Stepper stepper(elasticity, held, up, step, options.damping);
    Points places = solid.points, velocity = Points::Zero(3, places.cols());
    frame({0, 0, places, 0});
    const int frames = int(std::lround(options.seconds * options.frames_per_second));
    for (int number = 1; number <= frames; ++number) {
        int steps = 0;
        for (int k = 0; k < options.steps_per_frame; ++k) {
            const double time = step * ((number - 1) * options.steps_per_frame + k);
            Eigen::Vector3d foot = Eigen::Vector3d::Zero();
            foot[sideways] =
                (foot_at(time + step, height, options) - foot_at(time, height, options)) / step;
            steps += stepper.advance(places, velocity, foot);
        }
        frame({number, double(number) / options.frames_per_second, places, steps});
    }
}

} // namespace soft_body
