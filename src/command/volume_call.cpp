// SPDX-License-Identifier: Apache-2.0

#include "command/volume_call.h"

#include "vdb_shell/core/output_set.h"
#include "vdb_shell/io/volume_file.h"
#include "vdb_shell/options/option.h"

#include <nlohmann/json.hpp>

#include <ostream>

// What `deform` and `map` share: where results go, which files a call has, and the order in which
// they are written and told.
namespace vdb_shell::command
{

OptionSection output_options(VolumeCall& call, const std::string& help)
{
    Option output = option("", call.output, "--output", help).with_names({"-o"});
    output.required = true;
    return {"", in_group("Output",
                         {output,
                          option("", call.report, "--report",
                                 "Write all figures as JSON; - is standard output, in place of the "
                                 "text"),
                          option("", call.quiet, "--quiet", "Print no figures").with_names({"-q"}),
                          no_clobber_option(call.no_clobber)})};
}

FilePlan plan_volume_call(const VolumeCall& call, const std::vector<std::filesystem::path>& inputs)
{
    require_extension(call.output, ".vdb");
    FilePlan plan(existing_files(call.no_clobber));
    plan.add_input(call.volume);
    for (const std::filesystem::path& input : inputs)
        plan.add_input(input);
    plan.add_output(call.output);
    if (!call.report.empty() && !is_standard_output(call.report))
        plan.add_output(call.report);
    return plan;
}

void write_results(const VolumeCall& call, const std::vector<GridBasePtr>& volumes,
                   const nlohmann::json& report, const std::string& text, Context& context)
{
    OutputSet files(existing_files(call.no_clobber));
    write_volumes(call.output, volumes, &files);
    // Names of grids may be no UTF-8, which JSON has to be.
    const std::string json =
        report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
    const bool to_output = is_standard_output(call.report);
    if (!call.report.empty() && !to_output)
        files.write_stream(call.report, [&](std::ostream& out) { out << json; });
    files.commit();
    // A report on standard output was asked for by name, so --quiet does not take it away.
    if (to_output || !call.quiet)
        context.out << (to_output ? json : text);
}

} // namespace vdb_shell::command
