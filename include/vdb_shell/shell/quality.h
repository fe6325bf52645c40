// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/shell/tessellate.h"

#include <vector>

namespace vdb_shell
{

/// Order statistics of one measure over all tets. Percentiles are by nearest rank: always one of
/// the values, the same on every machine.
struct Spread {
    double min = 0, p1 = 0, p5 = 0, median = 0, p95 = 0, max = 0, mean = 0;
};

/// Spread of a list of finite values; all zero for an empty one.
Spread spread_of(std::vector<double> values);

/// Angles and aspect do not look at the orientation: an inverted tet has those of its mirror image.
struct QualityReport {
    Spread mean_ratio; ///< 12 (3V)^(2/3) / sum of squared edges; 1 = regular, negative = inverted
    Spread min_dihedral_radians; ///< smallest dihedral angle of each tet
    Spread max_dihedral_radians; ///< largest dihedral angle of each tet
    /// Smallest height / longest edge, scaled to 1 for the regular tet; 0 = flat. (The usual aspect
    /// ratio turned over, so that flat tets have a finite value.)
    Spread aspect;
};

/// Mean ratio of one tet, signed by its orientation (in double; exact signs are count_tet_signs').
double mean_ratio(const openvdb::Vec3d& a, const openvdb::Vec3d& b, const openvdb::Vec3d& c,
                  const openvdb::Vec3d& d);

QualityReport measure_quality(const TetMesh& tets);

} // namespace vdb_shell
