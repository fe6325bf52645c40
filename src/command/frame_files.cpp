// SPDX-License-Identifier: Apache-2.0

// Takes names of files, gives the shells in them one after the other.

#include "command/frame_files.h"

#include "vdb_shell/core/error.h"

#include "command/file_commands.h"
#include "command/signals.h"

#include <CLI/CLI.hpp>

#include <utility>

namespace vdb_shell::command
{

BoundOptions add_frame_files(CLI::App& app, FrameFiles& arguments, const std::string& output_help,
                             OptionSections more)
{
    app.add_option("files", arguments.files,
                   "Files of a shell that vdb_shell wrote, .vdb .geo .bgeo .bgeo.sc: one, or one "
                   "for each pose; with --frames a name with a token")
        ->required();
    Option output = option("", arguments.output, "--output", output_help).with_names({"-o"});
    output.required = true;
    OptionSections sections{
        {"", in_group("Options", {output, no_clobber_option(arguments.no_clobber)})}};
    for (OptionSection& section : more)
        sections.push_back(std::move(section));
    return bind(app, std::move(sections));
}

FilePlan plan_frame_files(const FrameFiles& arguments, const std::string& extension)
{
    require_extension(arguments.output, extension);
    FilePlan plan(existing_files(arguments.no_clobber));
    for (const std::filesystem::path& file : arguments.files)
        plan.add_input(file);
    plan.add_output(arguments.output);
    return plan;
}

void for_each_frame(const FrameFiles& arguments, FilePlan plan, Context& context,
                    const std::function<void(std::size_t, ShellFile)>& use)
{
    const SignalInterrupter interrupter(context);
    for (std::size_t i = 0; i < arguments.files.size(); ++i) {
        if (caught_signal())
            throw Cancelled();
        const std::filesystem::path& file = arguments.files[i];
        // Throws where the output would replace it.
        add_points_file(plan, file);
        use(i, read_shell(file));
    }
}

} // namespace vdb_shell::command
