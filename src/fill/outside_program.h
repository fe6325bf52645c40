// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vdb_shell::fill
{

/// A new folder of an unguessable name, readable by this user alone, that is removed with all that
/// is in it when the object goes.
class TemporaryFolder
{
public:
    /// Throws WriteError.
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// The program of that name in the folders of PATH, or an empty path.
std::filesystem::path find_program(const std::string& name);

/// Runs a program to its end, without a shell: words are passed on as they are. It has no input,
/// `folder` for its home, and its output goes to a file there. Returns that output. Throws
/// ProgramError, with the last line of it, where the program cannot be started, ends with another
/// status than 0 or by a signal, or takes longer than `seconds`, after which it is killed with all
/// that it started; Cancelled, likewise.
std::string run_program(const std::filesystem::path& program, const std::vector<std::string>& words,
                        const std::filesystem::path& folder, double seconds,
                        Interrupter* interrupter);

/// The last line that is not blank; empty where there is none.
std::string last_line(const std::string& text);

} // namespace vdb_shell::fill
