// SPDX-License-Identifier: Apache-2.0

// A file that appears whole or not at all is a set of one (output_set.cpp).

#include "vdb_shell/core/atomic_file.h"

#include "core/output_target.h"
#include "vdb_shell/core/output_set.h"

namespace vdb_shell
{

namespace fs = std::filesystem;

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write,
                      OutputSet* with)
{
    write_together(with, [&](OutputSet& set) { set.write(path, write); });
}

void write_stream_atomically(const fs::path& path, const std::function<void(std::ostream&)>& write,
                             OutputSet* with)
{
    write_together(with, [&](OutputSet& set) { set.write_stream(path, write); });
}

void require_writable(const fs::path& path)
{
    find_output_target(path);
}

} // namespace vdb_shell
