// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Appends the n - 2 triangles of a polygon, all oriented like it, each of three different corners.
/// Precondition: no corner repeats the one before it, and one comes only once. A convex
/// polygon becomes a fan from its first corner (the first that comes only once). One that is not
/// convex is cut ear by ear in the plane of its Newell normal, which is right when it is planar and
/// simple; what is neither, or has more than kMostEarCorners corners, becomes a fan all the same.
void append_triangles(const std::vector<openvdb::Vec3s>& points,
                      const std::vector<std::uint32_t>& polygon,
                      std::vector<openvdb::Vec3I>& triangles);

/// Cutting ears takes a time that grows with the cube of the corners in the worst case.
constexpr std::size_t kMostEarCorners = 1000;

} // namespace vdb_shell
