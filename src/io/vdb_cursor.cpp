// SPDX-License-Identifier: Apache-2.0

// The wording of what is wrong with a .vdb: the file, then the grid, then the element and its
// place, so that all refusals read alike.

#include "io/vdb_cursor.h"

#include "vdb_shell/io/read_file.h"

namespace vdb_shell
{

void VdbCursor::fail(const std::string& what) const
{
    refuse(name_, what);
}

void VdbCursor::damaged(const std::string& what) const
{
    const std::string grid = grid_.empty() ? "" : "grid " + vdb_shell::quoted(grid_) + ": ";
    fail("the file is truncated or damaged: " + grid + what + " at byte " + std::to_string(at_));
}

void VdbCursor::need(std::uint64_t count, const char* what) const
{
    // A difference, which cannot overflow: the place is never beyond the end.
    if (count > left())
        damaged(std::string(what) + " needs " + std::to_string(count) + " bytes, the file has " +
                std::to_string(size()) + ";");
}

} // namespace vdb_shell
