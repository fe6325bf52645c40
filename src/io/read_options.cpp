// SPDX-License-Identifier: Apache-2.0

// The options of reading, described once for the command, files and Houdini (docs/options.md). Both
// ways of moving the object are off unless wanted, so that the coordinates of ordinary files stay
// as they are.

#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/options/option.h"

namespace vdb_shell
{

OptionList describe(ReadOptions& o)
{
    return in_group(
        "Surface",
        {option("weld", o.weld, "--weld", "Merge vertices of equal position"),
         option("recentre", o.recentre, "--recentre",
                "Read the object about a point near its middle, which the files keep: far from the "
                "origin float32 has few digits left")
             .with_names({"--recenter"}),
         option("rescale", o.rescale, "--rescale",
                "Read the object in a power of two near its size, which the files keep: for "
                "microns in metres, and sizes over 1e18")});
}

} // namespace vdb_shell
