// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <optional>
#include <string>

namespace vdb_shell
{

/// Where an output goes when its links have been followed.
struct OutputTarget {
    std::filesystem::path given; ///< as the user named it, for messages
    std::filesystem::path path;  ///< no link any more, unless it is special
    bool special = false;        ///< a character device or a fifo: written into, never replaced
    std::optional<struct stat> existing; ///< what stands there

    std::filesystem::path folder() const;
};

/// Follows links, also one that leads to no file yet. Throws WriteError where no file can be
/// written: a folder, a socket, a block device, a file that may not be written, a folder that is
/// not there or in which nothing can be made.
OutputTarget find_output_target(const std::filesystem::path& path);

[[noreturn]] void refuse_output(const std::filesystem::path& path, const std::string& why);

} // namespace vdb_shell
