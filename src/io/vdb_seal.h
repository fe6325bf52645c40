// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/vdb_archive.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace vdb_shell
{

/// The entry of the file's metadata with the digests. A line each: a name, the digest of what that
/// part of the file means (write/grid_digest.h) and, for the metadata and for each grid, 16 digits
/// that seal_vdb fills in.
inline constexpr const char* kDigestsKey = "vdb_shell_digests";
/// How many digests there are: of a file whose digests are lost it tells that it had some.
inline constexpr const char* kDigestCountKey = "vdb_shell_digest_count";
inline constexpr std::string_view kUnsealed = "0000000000000000";

/// Makes a .vdb tell damage of any of its bytes: fills in the digests of the bytes of each part
/// where the entry above has room for them, and puts a digest of all bytes in place of the random
/// UUID. So a program that writes the file anew, which draws another UUID, lifts the seal.
/// Precondition: `written` is what write_vdb_archive said of that file. Throws std::runtime_error
/// when the file cannot be read or written.
void seal_vdb(const std::filesystem::path& path, const VdbArchive& written);

/// False where the bytes have no seal. Throws ReadError with the part that differs where they are
/// not those that were sealed; a changed seal differs as well.
bool check_seal(std::string_view bytes, const std::string& name);

} // namespace vdb_shell
