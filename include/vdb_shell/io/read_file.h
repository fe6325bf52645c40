// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace vdb_shell
{

// What the readers of all formats share, this library's and other people's: the bytes of a file,
// and refusals that all read alike.

/// All bytes of a file. Throws ReadError for what does not exist, is no regular file, cannot be
/// read or is empty.
std::string read_whole_file(const std::filesystem::path& path);

/// Throws ReadError "name: what". `name` is the file's; `what` says which element of it is wrong,
/// what stands there and what would be right.
[[noreturn]] void refuse(const std::string& name, const std::string& what);

/// A word of a file in quotes, fit for a message: cut after 40 bytes, with what cannot be printed
/// replaced by question marks.
std::string quoted(std::string_view word);

} // namespace vdb_shell
