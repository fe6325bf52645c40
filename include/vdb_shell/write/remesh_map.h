// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/resample/remesh.h"

#include <filesystem>

namespace vdb_shell
{
class OutputSet;

/// Writes where each vertex of the surface before remeshing lies on the one after, and the other
/// way round. By extension: .json, an object of columns for each way; .csv, a row for each vertex.
/// Throws InvalidOption for another extension (asked before the work by require_map_extension),
/// WriteError.
void write_remesh_map(const std::filesystem::path& path, const RemeshMap& map,
                      OutputSet* with = nullptr);

void require_map_extension(const std::filesystem::path& path);

} // namespace vdb_shell
