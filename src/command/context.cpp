// SPDX-License-Identifier: Apache-2.0

// Every line that goes to standard error, but for what a signal handler has to say.

#include "command/context.h"

#include "command/error_status.h"
#include "command/progress.h"
#include "options/shown_text.h"

#include <nlohmann/json.hpp>

namespace vdb_shell::command
{
namespace
{

using nlohmann::ordered_json;

/// Names of files may be no UTF-8, which JSON has to be.
std::string one_line(const ordered_json& json)
{
    return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

/// Keys that the message does not have are left out and not empty, so that a reader can ask whether
/// they are there.
void say_error(const Context& to, int status, const ErrorFacts& facts, const std::string& message)
{
    if (to.format == MessageFormat::text)
        return to.say(LogLevel::error, message);
    if (to.progress)
        to.progress->clear_line();
    ordered_json json{{"event", "error"}, {"code", facts.code}, {"status", status}};
    if (to.frame)
        json["frame"] = *to.frame;
    for (const auto& [key, value] : {std::pair("file", &facts.file),
                                     {"option", &facts.option},
                                     {"element", &facts.element},
                                     {"value", &facts.value},
                                     {"limit", &facts.limit}})
        if (!value->empty())
            json[key] = *value;
    json["message"] = message;
    to.err << one_line(json);
}

} // namespace

const NameTable<LogLevel>& names(LogLevel)
{
    static const NameTable<LogLevel> table{
        {"error", LogLevel::error}, {"warning", LogLevel::warning}, {"info", LogLevel::info}};
    return table;
}

const NameTable<MessageFormat>& names(MessageFormat)
{
    static const NameTable<MessageFormat> table{{"text", MessageFormat::text},
                                                {"json", MessageFormat::json}};
    return table;
}

void Context::say(LogLevel of, const std::string& text) const
{
    if (of > level)
        return;
    if (progress)
        progress->clear_line();
    // At once as a whole: frames that run at the same time may share the stream.
    if (format == MessageFormat::text) {
        // Messages quote files, whose control characters are not for the terminal.
        err << "vdb_shell: " + (frame ? "frame " + std::to_string(*frame) + ": " : "") +
                   shown_lines(text) + '\n';
        return;
    }
    ordered_json json{{"event", "message"}, {"level", name_in_table(of)}};
    if (frame)
        json["frame"] = *frame;
    json["message"] = text;
    err << one_line(json);
}

void Context::say(const std::exception& error) const
{
    say_error(*this, status_of(error), facts_of(error), message_of(error));
}

void Context::say_failed(ExitCode status, const std::string& file, const std::string& what) const
{
    ErrorFacts facts;
    facts.code = code_of(status);
    facts.file = file;
    say_error(*this, status, facts, file + ": " + what);
}

} // namespace vdb_shell::command
