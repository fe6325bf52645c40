// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>

namespace vdb_shell
{

class OutputSet;

/// Writes a file so that it appears whole or not at all: `write` fills a temporary file of the same
/// folder (same extension, for libraries that go by it), which is flushed to disk and renamed over
/// `path`. On any failure the temporary is removed, whatever stood at `path` stays, and WriteError
/// is thrown with the path and the system's reason. With a set the file appears when that is
/// committed, together with the others of the set.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write,
                      OutputSet* with = nullptr);

/// The same for a binary stream; a stream that ends in a failed state is a failure.
void write_stream_atomically(const std::filesystem::path& path,
                             const std::function<void(std::ostream& out)>& write,
                             OutputSet* with = nullptr);

/// Throws WriteError unless a file can be written at `path`: asked before the work begins.
void require_writable(const std::filesystem::path& path);

/// Removes every temporary file that is under way; async-signal-safe, for signal handlers.
void remove_temporaries_on_signal() noexcept;

/// True while files are put in their places, when a handler must not end the process: it is over in
/// milliseconds. Async-signal-safe.
bool files_are_committed_now() noexcept;

/// For a handler that is about to end the process: from then on whoever wants to put files in their
/// places waits for ever. False, and nobody waits, while that is being done already.
/// Async-signal-safe.
bool hold_commits() noexcept;

} // namespace vdb_shell
