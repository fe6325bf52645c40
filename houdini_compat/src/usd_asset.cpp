// SPDX-License-Identifier: Apache-2.0

// Takes the paths of a stage and of its volume; leaves the name by which the one finds the other. A
// stage is UTF-8 text, while a path is any bytes: one that is no UTF-8 would make a stage that USD
// cannot open, and is refused.

#include "usd_asset.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/usd_file.h"

#include <nlohmann/json.hpp>

#include <system_error>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

/// The library of JSON looks at every byte of a text that it writes.
bool is_utf8(const std::string& text)
{
    try {
        return !nlohmann::json(text).dump().empty();
    } catch (const nlohmann::json::type_error&) {
        return false;
    }
}

} // namespace

std::string relative_asset(const fs::path& path, const fs::path& volume)
{
    // Without touching the disk: neither file has to exist yet, and symbolic links stay as the user
    // wrote them.
    std::error_code gone, volume_gone;
    const fs::path folder = fs::absolute(path, gone).lexically_normal().parent_path();
    const fs::path target = fs::absolute(volume, volume_gone).lexically_normal();
    if (gone || volume_gone)
        throw WriteError(path.string() +
                         ": cannot be written: the folder that it is named from "
                         "is gone: " +
                         (gone ? gone : volume_gone).message());
    const fs::path relative = target.lexically_relative(folder);
    // No relative path leads from one root to another; only an absolute one is left.
    if (relative.empty())
        return target.generic_string();
    const bool upwards = *relative.begin() == "..";
    // Without "./" in front USD would look for the name along its own search paths first.
    return (upwards ? "" : "./") + relative.generic_string();
}

void require_usd_asset(const fs::path& path, const fs::path& volume)
{
    if (!is_utf8(relative_asset(path, volume)))
        throw InvalidOption(path.string() + ": USD is UTF-8 and cannot name the volume " +
                            volume.string() + ", whose path is in another encoding; rename it");
}

} // namespace vdb_shell
