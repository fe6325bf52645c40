// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/mesh/placement.h"
#include "vdb_shell/obstacles/cores.h"
#include "vdb_shell/options/option.h"

#include <string>
#include <vector>

namespace vdb_shell::command
{

/// Makes the option take files beside its own words: what is none of them goes into `files`.
void take_core_files(Option& option, std::vector<std::string>& files);

/// The surfaces of the files, meshes or level sets, in the frame of the surface that gets the
/// shell. Throws ReadError, and GeometryError for a grid that is no level set.
std::vector<CoreMesh> read_cores(const std::vector<std::string>& files, const ReadOptions& options,
                                 const Placement& placement);

} // namespace vdb_shell::command
