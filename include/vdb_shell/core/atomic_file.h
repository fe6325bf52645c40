// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>

namespace vdb_shell
{

/// Writes a file so that it appears whole or not at all: `write` fills a temporary file of the same
/// folder (same extension, for libraries that go by it), which is flushed to disk and renamed over
/// `path`. On any failure the temporary is removed, whatever stood at `path` stays, and WriteError
/// is thrown with the path and the system's reason.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for a binary stream; a stream that ends in a failed state is a failure.
void write_stream_atomically(const std::filesystem::path& path,
                             const std::function<void(std::ostream& out)>& write);

/// Throws WriteError unless a file can be made in the folder of `path`: asked before the work
/// begins.
void require_writable(const std::filesystem::path& path);

/// Removes every temporary file that is under way; async-signal-safe, for signal handlers.
void remove_temporaries_on_signal() noexcept;

} // namespace vdb_shell
