// SPDX-License-Identifier: Apache-2.0

// The options of a USD stage. They say what the numbers mean and change none of them: a stage with
// another axis or unit has the same coordinates, and the program that opens it does the turning.
// The rate of frames has no flag here, since most commands write one sample; `usd`, which writes
// several, gives it one.

#include "vdb_shell/houdini/usd_file.h"
#include "vdb_shell/options/option.h"

namespace vdb_shell
{

OptionList describe(UsdOptions& o)
{
    return in_group("Output", {option("up_axis", o.up_axis, "--up-axis", "What a .usda says is up")
                                   .needing("--output .usda"),
                               option("meters_per_unit", o.meters_per_unit, "--metres-per-unit",
                                      "What a .usda says a world unit is")
                                   .needing("--output .usda")
                                   .with_names({"--meters-per-unit"})
                                   .within(above(0)),
                               option("frames_per_second", o.frames_per_second, "",
                                      "What a .usda of several frames says of their rate")
                                   .within(above(0))});
}

} // namespace vdb_shell
