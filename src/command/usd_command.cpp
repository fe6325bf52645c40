// SPDX-License-Identifier: Apache-2.0

// The command `usd`: files of one shell in several poses in, one stage with all of them as time
// samples out, at the numbers of their frames.

#include "command/usd_command.h"

#include "vdb_shell/core/output_set.h"
#include "vdb_shell/houdini/geometry_file.h"

#include "command/exit_code.h"

#include <algorithm>
#include <list>
#include <utility>

namespace vdb_shell::command
{

BoundOptions add_usd_command(CLI::App& app, UsdArguments& arguments)
{
    OptionList options = describe(arguments.usd);
    // Other commands write one sample, which has no rate, so the flag is this command's alone.
    for (Option& o : options)
        if (o.key == "frames_per_second")
            o.flag = "--frames-per-second";
    return add_frame_files(app, arguments.frames, "The stage: .usda",
                           {{"usd", std::move(options)}});
}

FilePlan plan_usd(const UsdArguments& arguments)
{
    FilePlan plan = plan_frame_files(arguments.frames, ".usda");
    for (const std::filesystem::path& file : arguments.frames.files)
        if (!houdini::has_geometry_extension(file))
            require_usd_asset(arguments.frames.output, file);
    return plan;
}

int run_usd(const UsdArguments& arguments, Context& context)
{
    const std::vector<std::filesystem::path>& names = arguments.frames.files;
    // Without --frames, or with several files for each, they are counted from 1.
    const bool numbered = context.gathered.size() == names.size();
    // Samples point into it, and a list does not move what it holds.
    std::list<ShellFile> shells;
    std::vector<UsdSample> samples;
    for_each_frame(
        arguments.frames, plan_usd(arguments), context, [&](std::size_t i, ShellFile shell) {
            shells.push_back(std::move(shell));
            // Houdini's geometry has no grids for the stage to refer to.
            const bool volumes = !houdini::has_geometry_extension(names[i]);
            samples.push_back({numbered ? context.gathered[i] : double(i + 1), &shells.back(),
                               volumes ? names[i] : std::filesystem::path()});
        });
    std::sort(samples.begin(), samples.end(),
              [](const UsdSample& a, const UsdSample& b) { return a.time < b.time; });
    OutputSet files(existing_files(arguments.frames.no_clobber));
    write_usd(arguments.frames.output, samples, arguments.usd, &files);
    files.commit();
    return success;
}

} // namespace vdb_shell::command
