// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "field/winding_number.h"

#include <vector>

namespace vdb_shell
{

/// The winding number at many points, by threads; near points cost little more together than one.
/// What is far from a cube of points is summed up once, at 4^3 places of the cube, and interpolated
/// (a fast multipole method without expansions: W. Fong and E. Darve, "The black-box fast multipole
/// method", 2009). In the order of `points`. To the far dipoles' error it adds a few thousandths of
/// a turn. Same bits for any number of threads. Throws Cancelled where a stage is told to stop.
std::vector<float> turns_at(const WindingNumber& winding,
                            const std::vector<openvdb::Vec3d>& points);

} // namespace vdb_shell
