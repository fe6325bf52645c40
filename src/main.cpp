// SPDX-License-Identifier: Apache-2.0

// The program: words to runs of commands, exceptions to exit statuses, and nothing else. The number
// of threads is limited by TBB for the whole process, which changes the time and no byte of any
// result. Messages go to standard error, so that figures on standard output can be piped.

#include "vdb_shell/core/error.h"

#include "command/call.h"
#include "command/error_status.h"
#include "command/exit_code.h"
#include "command/run_steps.h"
#include "command/signals.h"

#include <CLI/CLI.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace
{

using namespace vdb_shell;
using namespace vdb_shell::command;

/// Known before the words are parsed, for they may be the error.
MessageFormat format_in(const std::vector<std::string>& words)
{
    for (std::size_t i = 0; i < words.size(); ++i)
        if (words[i] == "--errors=json" ||
            (words[i] == "--errors" && i + 1 < words.size() && words[i + 1] == "json"))
            return MessageFormat::json;
    return MessageFormat::text;
}

int run(const std::vector<std::string>& words, Context& context)
{
    Call call;
    try {
        call.parse(words);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0 && context.format == MessageFormat::json)
            throw InvalidOption(error.what());
        return call.end(error);
    }
    const GlobalArguments& global = call.global();
    context.level = global.log_level;
    context.format = global.errors;
    // The limit holds as long as this object lives, that is until run() returns.
    std::unique_ptr<tbb::global_control> limit;
    if (global.threads > 0)
        limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      std::size_t(global.threads));
    // Not earlier: while words are parsed there is nothing to stop or to tidy up, and the default
    // action is right.
    catch_signals();

    const std::vector<Step> steps = plan_steps(words, global, context);
    if (!global.dry_run)
        return run_steps(steps, global, context);
    print_steps(steps, context.out);
    const auto misses = [](const Step& step) { return !step.missing.empty(); };
    return !global.keep_going && std::any_of(steps.begin(), steps.end(), misses) ? read_error
                                                                                 : success;
}

/// What was printed has to have arrived: a full disk or a closed stream shows here at the latest. A
/// status that tells something already stays as it is.
int finished(int status, const Context& context)
{
    errno = 0;
    std::cout.flush();
    if (!std::cout) {
        context.say(LogLevel::error,
                    std::string("standard output cannot be written") +
                        (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
        return status == success ? write_error : status;
    }
    // It came while files were put in their places, and had to wait.
    return caught_signal() ? signal_base + caught_signal() : status;
}

} // namespace

int main(int argc, char** argv)
{
    end_uncaught_exceptions();
    occupy_standard_streams();
    Context context{std::cout, std::cerr, LogLevel::info, MessageFormat::text, std::nullopt};
    try {
        const std::vector<std::string> words = words_of({argv + 1, argv + argc});
        context.format = format_in(words);
        return finished(run(words, context), context);
        // Everything that is thrown ends here, so that temporary files are removed while the stack
        // unwinds; an exception that leaves main may end the process without doing so.
    } catch (const std::exception& error) {
        context.say(error);
        return status_of(error);
    }
}
