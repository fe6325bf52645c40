// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/shell/tessellate.h"

#include <array>
#include <cstddef>
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
    /// 3 / mean ratio: 3 for the regular tet, larger for every other. Of positive tets alone.
    Spread amips;
    Spread edge_ratio;        ///< longest edge / shortest edge; of tets whose edges have length
    std::size_t slivers = 0;  ///< tets with a dihedral angle under kSliverRadians
    std::size_t sofa_bad = 0; ///< tets that SOFA's mesh checks warn of (TetShape::sofa_bad)
};

/// 5 degrees: tets under it are what shape.md counts.
constexpr double kSliverRadians = 0.087266462599716474;
/// SOFA's rule, as its mesh checks state it: 20 and 160 degrees, and edges of 1 to 10.
constexpr double kSofaSmallRadians = 0.3490658503988659;
constexpr double kSofaLargeRadians = 2.7925268031909272;
constexpr double kSofaEdgeRatio = 10;

/// All figures of one tet. AMIPS and edge ratio are infinite where their divisor is not positive.
struct TetShape {
    double mean_ratio, min_dihedral_radians, max_dihedral_radians, aspect, amips, edge_ratio;

    bool sofa_bad() const
    {
        return min_dihedral_radians < kSofaSmallRadians ||
               max_dihedral_radians > kSofaLargeRadians || edge_ratio > kSofaEdgeRatio;
    }
};
TetShape shape_of(const std::array<openvdb::Vec3d, 4>& corners);
/// Of tet t.
TetShape shape_of(const TetMesh& tets, std::size_t t);

/// Mean ratio of one tet, signed by its orientation (in double; exact signs are count_tet_signs').
double mean_ratio(const openvdb::Vec3d& a, const openvdb::Vec3d& b, const openvdb::Vec3d& c,
                  const openvdb::Vec3d& d);
/// Of tet t.
double mean_ratio(const TetMesh& tets, std::size_t t);

QualityReport measure_quality(const TetMesh& tets);

} // namespace vdb_shell
