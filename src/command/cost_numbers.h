// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

// Made by docs/scripts/estimate_model.py, of which every second mesh tuned them; docs/farm.md has
// their errors. On one thread, Debian 12, release build:
// - builds: 146 on 2026-11-23, a machine with 2 hardware threads (AMD EPYC)

namespace vdb_shell::command
{

/// For one; for each triangle up to 5000; for each one from there; for each voxel of the surface
/// (area over the square of the voxel size); for each voxel of the solid; for each triangle in each
/// layer after the first.
using CostNumbers = std::array<double, 6>;

inline constexpr double kCoarseFrom = 5000;
/// Processor seconds, bytes.
inline constexpr CostNumbers kSecondsNumbers{0.1397,    0.0001199, 5.697e-05,
                                             7.166e-07, 2.379e-08, 1.154e-05};
inline constexpr CostNumbers kMemoryNumbers{5.428e+07, 1369, 1502, 185, 4.4, 1161};
inline constexpr CostNumbers kVdbNumbers{8.287e+04, 284.7, 199.9, 28.71, 0.425, 299.3};

inline constexpr CostNumbers kPoseSecondsNumbers{};
inline constexpr CostNumbers kPoseMemoryNumbers{};
inline constexpr CostNumbers kPoseVdbNumbers{};
inline constexpr CostNumbers kDeformSecondsNumbers{};
inline constexpr CostNumbers kDeformMemoryNumbers{};
inline constexpr CostNumbers kDeformVdbNumbers{};

} // namespace vdb_shell::command
