// SPDX-License-Identifier: Apache-2.0

// From what was thrown to the status of the process, and to its parts for programs. Messages of
// this project have fixed forms, "FILE: ELEMENT ...: what" and "OPTION is VALUE, must be LIMIT", so
// the parts are taken out of them; a message of another form is left whole.

#include "command/error_status.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/fill/fill_core.h"

#include "command/exit_code.h"
#include "command/signals.h"

#include <array>
#include <filesystem>
#include <new>

namespace vdb_shell::command
{
namespace
{

/// Takes what stands before `end` off the front; nothing where `end` is not there.
std::string take_before(std::string& text, const std::string& end)
{
    const std::size_t at = text.find(end);
    if (at == std::string::npos)
        return "";
    std::string taken = text.substr(0, at);
    text.erase(0, at + end.size());
    return taken;
}

/// "line 12" of "line 12 has two words".
std::string element_at(const std::string& text)
{
    static const std::array<const char*, 13> kinds{
        "line ",      "vertex ", "point ", "triangle ", "face ",    "facet ", "byte ",
        "primitive ", "edge ",   "tet ",   "prism ",    "element ", "grid "};
    for (const std::string kind : kinds) {
        if (text.rfind(kind, 0) != 0)
            continue;
        // Grids have names, all else has numbers.
        const bool quoted = text[kind.size()] == '"';
        const std::size_t end = quoted ? text.find('"', kind.size() + 1) + 1
                                       : text.find_first_not_of("0123456789", kind.size());
        if (end > kind.size())
            return text.substr(0, end);
    }
    return "";
}

} // namespace

const char* code_of(int status)
{
    switch (status) {
    case usage_error:
        return "usage";
    case read_error:
        return "read";
    case geometry_error:
        return "geometry";
    case write_error:
        return "write";
    case bound_not_met:
        return "bound";
    case check_failed:
        return "check";
    case program_failed:
        return "program";
    case out_of_memory:
        return "memory";
    default:
        return status > signal_base ? "stopped" : "internal";
    }
}

/// The kinds do not derive from one another, so the order of the tests does not matter.
int status_of(const std::exception& error)
{
    if (dynamic_cast<const Cancelled*>(&error))
        // Nothing but a signal asks stages to stop, so a stop without one is a fault of ours.
        return caught_signal() ? signal_base + caught_signal() : internal_error;
    if (dynamic_cast<const InvalidOption*>(&error))
        return usage_error;
    if (dynamic_cast<const ReadError*>(&error))
        return read_error;
    if (dynamic_cast<const GeometryError*>(&error))
        return geometry_error;
    if (dynamic_cast<const WriteError*>(&error))
        return write_error;
    if (dynamic_cast<const ProgramError*>(&error))
        return program_failed;
    if (dynamic_cast<const std::bad_alloc*>(&error))
        return out_of_memory;
    return internal_error;
}

std::string message_of(const std::exception& error)
{
    return dynamic_cast<const std::bad_alloc*>(&error) ? "out of memory" : error.what();
}

/// Front to back: the file, then the element, or else the option with its value and limit. What no
/// form fits stays in the message alone.
ErrorFacts facts_of(const std::exception& error)
{
    ErrorFacts facts;
    facts.code = code_of(status_of(error));
    std::string rest = message_of(error);
    const std::string first = rest.substr(0, rest.find(": "));
    // Formats go by extensions, so files have one; "line 3" and "--layers" have none.
    if (first.size() < rest.size() && std::filesystem::path(first).has_extension()) {
        facts.file = first;
        rest.erase(0, first.size() + 2);
    }
    facts.element = element_at(rest);
    const std::size_t is = rest.find(" is "), must = rest.find(", must be ");
    // "vertex 7 is not finite, must be ..." would look like an option, so elements come first.
    if (facts.element.empty() && is < must && must != std::string::npos) {
        facts.option = take_before(rest, " is ");
        facts.value = take_before(rest, ", must be ");
        facts.limit = rest;
    } else if (rest.rfind("--", 0) == 0) {
        facts.option = rest.substr(0, rest.find_first_of(" :,"));
    }
    return facts;
}

} // namespace vdb_shell::command
