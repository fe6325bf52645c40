// SPDX-License-Identifier: Apache-2.0

// The command `page`: files of one shell in several poses in, one page with all of them out.

#include "command/page_command.h"

#include "vdb_shell/core/output_set.h"
#include "vdb_shell/write/html_page.h"

#include "command/exit_code.h"

namespace vdb_shell::command
{

BoundOptions add_page_command(CLI::App& app, PageArguments& arguments)
{
    return add_frame_files(app, arguments, "The page: .html");
}

FilePlan plan_page(const PageArguments& arguments)
{
    return plan_frame_files(arguments, ".html");
}

int run_page(const PageArguments& arguments, Context& context)
{
    // Takes what it needs of a shell at once, so that only one is in memory.
    HtmlPage page;
    for_each_frame(arguments, plan_page(arguments), context,
                   [&](std::size_t i, const ShellFile& shell) {
                       page.add(arguments.files[i].stem().string(), shell);
                   });
    OutputSet files(existing_files(arguments.no_clobber));
    page.write(arguments.output, &files);
    files.commit();
    return success;
}

} // namespace vdb_shell::command
