// SPDX-License-Identifier: Apache-2.0

// The command `compare`: reads two shells, prints what each is and how far their points lie apart,
// and draws them side by side at one scale.

#include "command/compare_command.h"

#include "vdb_shell/core/atomic_file.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"
#include "vdb_shell/inspect/compare_shells.h"

#include "command/exit_code.h"
#include "command/file_commands.h"
#include "options/parse_json.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <ostream>

namespace vdb_shell::command
{
namespace
{

OptionSections describe(CompareArguments& a)
{
    return {{"", in_group("Output",
                          {option("", a.json, "--json", "Print one JSON object"),
                           option("", a.picture, "--output", "Draw the two side by side: .png")
                               .with_names({"-o"}),
                           no_clobber_option(a.no_clobber)})},
            {"picture", describe(a.drawing)}};
}

} // namespace

BoundOptions add_compare_command(CLI::App& app, CompareArguments& arguments)
{
    app.add_option("first", arguments.first, "A .vdb, .geo, .bgeo or .bgeo.sc that vdb_shell wrote")
        ->required();
    app.add_option("second", arguments.second, "Another one")->required();
    return bind(app, describe(arguments));
}

FilePlan plan_compare(const CompareArguments& arguments)
{
    if (!arguments.picture.empty() && lower_case_extension(arguments.picture) != ".png")
        throw InvalidOption(arguments.picture.string() + ": unknown extension \"" +
                            arguments.picture.extension().string() +
                            "\"; a comparison is drawn "
                            "as .png");
    require_sensible(arguments.drawing);
    FilePlan plan(existing_files(arguments.no_clobber));
    plan.add_input(arguments.first);
    plan.add_input(arguments.second);
    if (!arguments.picture.empty())
        plan.add_output(arguments.picture);
    return plan;
}

int run_compare(const CompareArguments& arguments, Context& context)
{
    const ShellFile first = read_shell(arguments.first), second = read_shell(arguments.second);
    // Refused by the name of its file, and by its depth, before options are compared.
    const std::string which = ": its parameters";
    parse_json(first.parameters_json, arguments.first.string() + which);
    parse_json(second.parameters_json, arguments.second.string() + which);
    const ShellComparison comparison = compare_shells(first, second);
    const auto print = arguments.json ? comparison_json : comparison_text;
    const std::string text = print(comparison, arguments.first.string(), arguments.second.string());
    if (!arguments.picture.empty()) {
        OutputSet files(existing_files(arguments.no_clobber));
        write_picture_pair(arguments.picture, first, second, arguments.drawing, &files);
        files.commit();
    }
    // After the picture is in its place, so that figures are not followed by an error.
    context.out << text;
    return success;
}

} // namespace vdb_shell::command
