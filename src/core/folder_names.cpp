// SPDX-License-Identifier: Apache-2.0

// Takes: a folder. Gives: the names in it, by the system's own calls.

#include "core/folder_names.h"

#include <dirent.h>

#include <cerrno>
#include <memory>

namespace vdb_shell
{

std::vector<std::string> names_in(const std::filesystem::path& folder, std::error_code& error)
{
    std::vector<std::string> names;
    error.clear();
    const std::unique_ptr<DIR, int (*)(DIR*)> open(::opendir(folder.c_str()), ::closedir);
    if (!open) {
        error.assign(errno, std::generic_category());
        return names;
    }
    while (true) {
        errno = 0;
        const dirent* const entry = ::readdir(open.get());
        if (!entry) {
            error.assign(errno, std::generic_category());
            return names;
        }
        const std::string name = entry->d_name;
        if (name != "." && name != "..")
            names.push_back(name);
    }
}

} // namespace vdb_shell
