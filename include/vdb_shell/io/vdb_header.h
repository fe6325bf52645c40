// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace vdb_shell
{

/// Holds every byte of a .vdb that OpenVDB's decoder takes for a length, a count, a mask, a place
/// or the header of a codec against the others and against the size of the file. What passes can be
/// opened, all metadata can be read, and grids of floats, of vectors of three floats, of 32-bit
/// whole numbers and of points can be decoded, without a read or write outside of what is there,
/// and without more memory than the file's size justifies (docs/security.md has the argument and
/// the factors). Grids of other types must not be decoded: they are walked up to their transform.
/// Throws ReadError with file, grid, element and place.
void require_whole_vdb(const std::filesystem::path& path);

/// The same for the bytes of a file; `name` opens the messages.
void require_whole_vdb(std::string_view bytes, const std::string& name);

} // namespace vdb_shell
