// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/write/vdb_file.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

/// One thing that a file claims and that was looked at.
struct Verification {
    std::string what; ///< "tets conform", "level set follows the surface", ...
    bool holds = false;
    std::string detail; ///< the figures, or the first offenders by index
};

/// Holds a shell against its own surface and against the figures that it carries: the surface is as
/// sound as its report says, the tets are those of its prisms, conform and have the signs,
/// certificate, volume and fill that the report states, the level set and the depth grid (where the
/// file has them) belong to this surface. Everything is computed afresh from the stored floats.
std::vector<Verification> verify_shell(const ShellFile& file, Interrupter* interrupter = nullptr);

/// 1 for each tet that is positive and overlaps no other, by exact tests of the stored floats; the
/// file's report is not asked.
std::vector<std::uint8_t> certified_tets(const ShellFile& file, Interrupter* interrupter = nullptr);

} // namespace vdb_shell
