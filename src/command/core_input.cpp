// SPDX-License-Identifier: Apache-2.0

// The files of --core: closed surfaces inside, from any format that has triangles or a level set.
// The flag had words before it had files, so a word means what it meant, and a file of such a name
// is given with its folder: ./free.

#include "command/core_input.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"
#include "vdb_shell/field/contour.h"
#include "vdb_shell/field/given_level_set.h"

#include "command/surface_input.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace vdb_shell::command
{

void take_core_files(Option& option, std::vector<std::string>& files)
{
    option.kind = OptionKind::text;
    // A text from now on: words that it had stay allowed, and are told in the help with what they
    // meant.
    option.repeated = true;
    option.help += " (" + option.choices.front() + ", " + option.choices.back() +
                   "). Or FILE: a closed surface inside (or FILE.vdb:GRID, a level set) that the "
                   "shell stays off; once for each. A file of such a name: ./" +
                   option.choices.front();
    // What is one of the option's own words goes through the setter that it had; all else is a
    // file.
    option.set = [words = std::exchange(option.choices, {}), set = option.set,
                  &files](const OptionValue& value) {
        const auto& text = std::get<std::string>(value);
        if (std::find(words.begin(), words.end(), text) != words.end())
            set(value);
        else
            files.push_back(text);
    };
}

std::vector<CoreMesh> read_cores(const std::vector<std::string>& files, const ReadOptions& options,
                                 const Placement& placement)
{
    std::vector<CoreMesh> cores;
    for (const std::string& file : files) {
        const GridName parts = split_grid_name(file);
        const std::filesystem::path path(parts.file);
        // A misspelt word looks like a file.
        std::error_code unknown;
        if (!std::filesystem::exists(path, unknown))
            throw ReadError(file + (unknown ? ": cannot be read: " + unknown.message()
                                            : ": there is no such file; --core takes free, "
                                              "stitched or a file"));
        CoreMesh core{path.filename().string(), {}};
        Placement own;
        if (lower_case_extension(path) == ".vdb") {
            // A level set has a transform of its own, in world space; so its placement is the one
            // that moves nothing.
            core.mesh = contour(*read_level_set(parts.file, parts.grid));
        } else {
            ReadResult read = read_surface(path, options);
            own = read.report.placement;
            core.mesh = std::move(read.mesh);
        }
        // A core is read in a frame of its own, so that the digits of its file count as they do for
        // the surface.
        bring_into(placement, own, core.mesh.points);
        cores.push_back(std::move(core));
    }
    return cores;
}

} // namespace vdb_shell::command
