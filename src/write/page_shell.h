// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/write/vdb_file.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// What a page draws of a shell, the same in all frames. Points are numbered as ShellPoints::id,
/// then the core's own.
struct PageShell {
    /// Per vertex that is drawn, which of the shell's it is; empty where all of them are.
    std::vector<std::uint32_t> from;
    std::vector<std::uint32_t> triangles; ///< three vertices each
    std::vector<std::uint32_t> surfaces;  ///< by surface and vertex: the point
    std::vector<std::uint32_t> tets;      ///< four points each, the core's last
    std::vector<std::uint32_t> prism;     ///< per tet: its triangle; of the core's tets none
    std::vector<std::uint8_t> layer;      ///< per tet; kCoreLayer
    std::vector<std::uint32_t> vertex;    ///< per point but the core's: vertex that is drawn
    std::vector<std::uint8_t> surface;    ///< per point but the core's
    std::size_t core_points = 0;

    std::size_t vertices() const { return from.empty() ? all_vertices : from.size(); }
    std::size_t all_vertices = 0; ///< of the shell
    bool coarser() const { return !from.empty(); }
};

/// Precondition: require_consistent_core. Of more prisms than `most_prisms` about that many are
/// left, between pillars of the shell; a core is left out then.
PageShell page_shell(const ShellFile& file, std::size_t most_prisms);

/// Where the points of a frame are, and what is told of them. Whole numbers are shares: 65535 of a
/// coordinate is the upper end of the box, of a thickness the largest one, 255 of an angle that of
/// a regular tet.
struct PageFrame {
    static constexpr std::size_t kAngleBins = 36, kThicknessBins = 32;
    static constexpr double kLargestDegrees = 72; ///< of the bins; a regular tet has 70.5

    Bounds box;
    double thickest = 0;                       ///< world units
    std::vector<std::uint16_t> positions;      ///< three a point
    std::vector<std::uint16_t> thickness;      ///< per vertex that is drawn
    std::vector<std::uint8_t> angles;          ///< per tet that is drawn: its least dihedral angle
    std::vector<std::size_t> angle_counts;     ///< tets of the whole shell, by bins of two degrees
    std::vector<std::size_t> thickness_counts; ///< of its vertices, by shares of the largest
};
/// Precondition: the shell is that of `shown` in this or another pose.
PageFrame page_frame(const PageShell& shown, const ShellFile& file);

} // namespace vdb_shell
