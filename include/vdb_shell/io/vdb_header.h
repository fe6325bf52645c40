// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace vdb_shell
{

/// Walks the header, the file's metadata and the table of grids of a .vdb without believing a
/// single length in it, and throws ReadError with the element and its value where the file is none,
/// is cut short, or points outside itself. OpenVDB does not notice a file that ends too early.
void require_whole_vdb(const std::filesystem::path& path);

} // namespace vdb_shell
