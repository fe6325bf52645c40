// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

// Made by docs/scripts/estimate_model.py, of which every second mesh tuned them; docs/farm.md has
// their errors. On one thread, Debian 12:
// - builds: 395 on 2026-11-28, release build, 2 hardware threads (AMD EPYC)
// - poses: 70 on 2026-11-24, development build, 2 hardware threads (AMD EPYC)
// - deformations: 70 on 2026-11-24, development build, 2 hardware threads (AMD EPYC)

namespace vdb_shell::command
{

/// For one; for each triangle up to kCoarseFrom; for each one from there; for each voxel of the
/// surface (area over the square of the voxel size), of deformations for each one of the volume;
/// for each voxel of the solid; for each triangle in each layer after the first.
using CostNumbers = std::array<double, 6>;

inline constexpr double kCoarseFrom = 5000;
/// Processor seconds, bytes.
inline constexpr CostNumbers kSecondsNumbers{0.1282,   8.716e-05, 5.45e-05,
                                             4.29e-07, 8.983e-09, 1.257e-05};
inline constexpr CostNumbers kMemoryNumbers{5.863e+07, 1075, 1141, 114.8, 4.852, 966.3};
inline constexpr CostNumbers kVdbNumbers{7.048e+04, 289.3, 186.3, 30.48, 0.3395, 267.5};
inline constexpr CostNumbers kSpeedSecondsNumbers{0.1176,    2.585e-05, 3.212e-05,
                                                  5.369e-07, 6.68e-09,  1.713e-05};
inline constexpr CostNumbers kSpeedMemoryNumbers{5.817e+07, 1003, 1100, 133.2, 4.341, 882};
inline constexpr CostNumbers kThickestSecondsNumbers{0.1202,    0.0001154, 7.769e-05,
                                                     4.484e-07, 9.366e-09, 2.553e-05};
inline constexpr CostNumbers kThickestMemoryNumbers{5.876e+07, 1177, 1706, 110.7, 4.914, 715.3};
inline constexpr CostNumbers kPoseSecondsNumbers{0.0974,    5.456e-05, 2.158e-05,
                                                 2.416e-06, 0,         1.803e-05};
inline constexpr CostNumbers kPoseMemoryNumbers{7.535e+07, 0, 1882, 183.2, 64.5, 1587};
inline constexpr CostNumbers kPoseVdbNumbers{2.478e+05, 203.2, 175.3, 40.72, 9.667, 164.7};
inline constexpr CostNumbers kDeformSecondsNumbers{0.09121,   2.211e-06, 5.501e-06,
                                                   8.226e-07, 0,         4.259e-06};
inline constexpr CostNumbers kDeformMemoryNumbers{7.215e+07, 0, 1095, 31.87, 0, 1162};
inline constexpr CostNumbers kDeformVdbNumbers{1.042e+05, 2.83, 0, 2.841, 0, 3.646};

} // namespace vdb_shell::command
