// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "statics.h"

#include <functional>

namespace soft_body
{

/// The body is let go without strain, its held points are shaken sideways for the first half of the
/// time and then stand still.
struct MotionOptions {
    double seconds = 2;
    int frames_per_second = 24;
    int steps_per_frame = 5;
    double shake = .06;     ///< how far, share of the height
    double frequency = 2.5; ///< of the shaking, 1/s
    double damping = .004;  ///< of strain rates: force K v times this, s
};

struct Frame {
    int number;     ///< from 0, the rest shape
    double seconds; ///< of the motion
    Points places;
    int steps; ///< of conjugate gradients since the frame before
};

/// Backward Euler's steps with corotated elasticity, each one linear: stiffness and rotations are
/// those of its beginning. Calls `frame` with each frame.
void move(const Solid& solid, const Elasticity& elasticity, const Held& held, int up,
          const MotionOptions& options, const std::function<void(const Frame&)>& frame);

} // namespace soft_body
