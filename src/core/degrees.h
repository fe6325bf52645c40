// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/math/Math.h>

namespace vdb_shell
{

/// Code and options have radians throughout, reports have degrees (docs/conventions.md).
inline double degrees(double radians)
{
    return radians * 180.0 / openvdb::math::pi<double>();
}

} // namespace vdb_shell
