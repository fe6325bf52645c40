// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/write/vdb_file.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vdb_shell
{

/// What a shell is, measured on it; nothing is taken from its report. Lengths and volumes are in
/// the file's unit.
struct ShellFigures {
    std::size_t vertices = 0, triangles = 0, layers = 0, tets = 0, core_tets = 0;
    std::size_t pinned = 0;                              ///< vertices without a pillar
    double tets_per_triangle = 0;                        ///< without those of a core
    double solid_volume = 0, shell_volume = 0, fill = 0; ///< fill: of the one in the other
    double mean_thickness = 0, largest_thickness = 0;    ///< of the vertices' pillars
    double least_dihedral_radians = 0, sliver_share = 0; ///< below kSliverRadians
    double median_amips = 0;                             ///< 3 for regular tets
    bool tapered = false, posed = false;
    std::string checksum; ///< of all arrays (checksum_of)
};
ShellFigures shell_figures(const ShellFile& file);

/// Between points of the same number.
struct PointChange {
    double mean = 0, largest = 0; ///< the file's unit
    std::size_t at = 0;           ///< the vertex that has moved most
};

struct ShellComparison {
    ShellFigures first, second;
    bool same_bits = false;      ///< every array of the shells, in the coordinates of their files
    bool same_triangles = false; ///< of the surface; else nothing below says anything
    bool same_tets = false;      ///< the same corners in the same order
    std::optional<PointChange> outer, inner; ///< of the outermost and of the innermost surface
    /// Options that differ: place in the JSON, value of the first, of the second; a value that one
    /// of them does not have is empty.
    std::vector<std::array<std::string, 3>> options;
};

/// Deterministic. Throws ReadError for parameters that are not JSON, its message opened by
/// "parameters".
ShellComparison compare_shells(const ShellFile& first, const ShellFile& second);

/// As columns for people, and as JSON; `first` and `second` are what the shells are called.
std::string comparison_text(const ShellComparison& comparison, const std::string& first,
                            const std::string& second);
std::string comparison_json(const ShellComparison& comparison, const std::string& first,
                            const std::string& second);

} // namespace vdb_shell
