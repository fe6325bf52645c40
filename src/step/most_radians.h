// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vdb_shell
{

/// What angles in the options of line stepping have to be below: a little less than a right angle,
/// whose cosine is well above 0 and whose tangent is finite.
constexpr double kMostRadians = 1.5;

} // namespace vdb_shell
