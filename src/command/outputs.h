// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/certify/overlaps.h"
#include "vdb_shell/houdini/usd_file.h"
#include "vdb_shell/options/section.h"
#include "vdb_shell/write/picture.h"
#include "vdb_shell/write/surface_file.h"
#include "vdb_shell/write/vdb_file.h"

#include "command/file_plan.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace vdb_shell::command
{

/// Files to write, the format of each by its extension.
struct Outputs {
    std::vector<std::filesystem::path> paths;
    VdbWriteOptions vdb;
    PictureOptions picture;
    UsdOptions usd;
    SurfaceFileOptions surface_file;
    bool no_clobber = false;
};

/// -o and the options of single formats.
OptionSections describe(Outputs& outputs);

/// Adds all files that will be written, also those beside the ones that were named. Throws
/// InvalidOption for an unknown extension, and what FilePlan throws: tested before any work is
/// done.
void add_outputs(FilePlan& plan, const Outputs& outputs);

/// True when some output needs the grids of the file.
bool wants_vdb(const Outputs& outputs);

/// True when some output has tets, beside which the flags of certified ones can stand.
bool wants_flags(const Outputs& outputs);

/// Those flags of a shell of so many tets. `overlaps`: those of its report; they are looked for
/// only where the certificate fails, so where there are none each tet is certified with the shell.
std::vector<std::uint8_t> certified_flags(const std::optional<Overlaps>& overlaps,
                                          std::size_t tets);

/// Writes every output into the set; a .usda refers to the first .vdb among them. `file.surface`
/// and `file.depth` may be null unless wants_vdb(); `certified` may be empty unless wants_flags().
void write_outputs(const Outputs& outputs, const ShellFile& file,
                   const std::vector<std::uint8_t>& certified, OutputSet& files);

} // namespace vdb_shell::command
