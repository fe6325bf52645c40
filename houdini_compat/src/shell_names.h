// SPDX-License-Identifier: Apache-2.0
#pragma once

// Names in a shell's Houdini geometry; docs/houdini.md says what they hold.

namespace vdb_shell::houdini
{

inline constexpr const char* kSchema = "vdb_shell_schema";
inline constexpr const char* kVertices = "vdb_shell_vertices";
inline constexpr const char* kPrisms = "vdb_shell_prisms";
inline constexpr const char* kTets = "vdb_shell_tets";
inline constexpr const char* kRipples = "vdb_shell_ripples";
inline constexpr const char* kOrientation = "vdb_shell_orientation";
inline constexpr const char* kChecksum = "vdb_shell_checksum";
inline constexpr const char* kParameters = "vdb_shell_parameters";
inline constexpr const char* kReport = "vdb_shell_report";
inline constexpr const char* kCreator = "creator";

inline constexpr const char* kOpposite = "opposite";
inline constexpr const char* kSourceVertex = "source_vertex";
inline constexpr const char* kStopReason = "stop_reason";
inline constexpr const char* kPrism = "prism";
inline constexpr const char* kLayer = "layer";
inline constexpr const char* kSplitOrder = "split_order";

} // namespace vdb_shell::houdini
