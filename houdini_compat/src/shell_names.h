// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

// Names and places in a shell's Houdini geometry; docs/houdini.md says what they hold.

namespace vdb_shell::houdini
{

/// Tells Houdini that these integers are names and not amounts: a blend of two of them would mean
/// nothing.
inline constexpr const char* kIndex = "nonarithmetic_integer";

inline constexpr const char* kSchema = "vdb_shell_schema";
inline constexpr const char* kVertices = "vdb_shell_vertices";
inline constexpr const char* kPrisms = "vdb_shell_prisms";
inline constexpr const char* kTets = "vdb_shell_tets";
inline constexpr const char* kLayers = "vdb_shell_layers";
inline constexpr const char* kSkin = "vdb_shell_skin";
inline constexpr const char* kTapered = "vdb_shell_tapered";
inline constexpr const char* kPosed = "vdb_shell_posed";
inline constexpr const char* kCorePointCount = "vdb_shell_core_points";
inline constexpr const char* kCoreTetCount = "vdb_shell_core_tets";
inline constexpr const char* kInputPointCount = "vdb_shell_input_points";
inline constexpr const char* kRest = "rest";
inline constexpr const char* kVelocity = "v";
inline constexpr const char* kRipples = "vdb_shell_ripples";
inline constexpr const char* kOrigin = "vdb_shell_origin";
inline constexpr const char* kUnit = "vdb_shell_unit";
inline constexpr const char* kOrientation = "vdb_shell_orientation";
inline constexpr const char* kChecksum = "vdb_shell_checksum";
inline constexpr const char* kDigests = "vdb_shell_digests";
inline constexpr const char* kDigestCount = "vdb_shell_digest_count";
inline constexpr const char* kParameters = "vdb_shell_parameters";
inline constexpr const char* kReport = "vdb_shell_report";
inline constexpr const char* kCreator = "creator";

inline constexpr const char* kOpposite = "opposite";
inline constexpr const char* kSourceVertex = "source_vertex";
inline constexpr const char* kStopReason = "stop_reason";
inline constexpr const char* kOuterStop = "stop_reason_outer"; ///< of the pillars above the skin
inline constexpr const char* kPrism = "prism";
inline constexpr const char* kLayer = "layer";
inline constexpr const char* kSplitOrder = "split_order";
inline constexpr const char* kSurface = "surface";
inline constexpr const char* kCollapsed = "collapsed";
inline constexpr const char* kCorePoints = "core_points";
inline constexpr const char* kCoreTets = "core_tets";
inline constexpr const char* kInputPoints = "input_points";

/// Shells of one layer below the surface say nothing of layers: their files are of schema 1.
inline bool layered(std::size_t layers, std::size_t skin)
{
    return layers > 1 || skin > 0;
}

/// The surfaces that a file has triangles of: the outermost, the skin where it lies between, the
/// innermost.
inline std::vector<std::size_t> shown_surfaces(std::size_t layers, std::size_t skin)
{
    if (skin > 0 && skin < layers)
        return {0, skin, layers};
    return {0, layers};
}

/// The layer whose prisms a surface's triangles stand for: the one below, above the innermost.
inline std::size_t layer_at(std::size_t surface, std::size_t layers)
{
    return surface < layers ? surface : layers - 1;
}

} // namespace vdb_shell::houdini
