// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry_file.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace vdb_shell::test
{

struct FuzzResult {
    std::size_t inputs = 0, read = 0, refused = 0, shells = 0, surfaces = 0;
    double slowest_seconds = 0;
    /// Largest number of bytes that were allocated at once, less 64 for each byte of the document.
    std::int64_t most_beyond_document = 0;
    std::string wrong; ///< the first thing that must not happen, in words; empty when all is well
};

/// Reads `inputs` damaged files of one form, the same ones for the same seed. Whatever is read must
/// be written again and read back the same; anything else must be refused with ReadError.
FuzzResult fuzz(houdini::Format format, std::size_t inputs, std::uint64_t seed);

} // namespace vdb_shell::test
