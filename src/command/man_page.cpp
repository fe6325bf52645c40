// SPDX-License-Identifier: Apache-2.0

// Makes vdb_shell.1 in the macros of man(7). A line that begins with a dot or an apostrophe would
// be a request, a backslash an escape, and a bare dash a hyphen that cannot be pasted into a shell.

#include "command/man_page.h"

#include "command/help.h"
#include "core/text_stream.h"

namespace vdb_shell::command
{
namespace
{

std::string escaped(const std::string& text)
{
    std::string out;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n'))
            out += "\\&";
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
    }
    return out;
}

void write_option(std::ostream& out, const Option& option)
{
    out << ".TP\n\\fB" << escaped(option.flag);
    for (const std::string& name : option.names)
        out << "\\fR, \\fB" << escaped(name);
    if (const std::string negation = negation_of(option); !negation.empty())
        out << "\\fR, \\fB" << escaped(negation);
    out << "\\fR";
    if (option.kind == OptionKind::flag) {
        out << (std::get<bool>(option.get()) ? " [on]" : "");
    } else {
        out << " \\fI" << (option.kind == OptionKind::text ? "text" : "value") << "\\fR";
        const std::string value = text_of(option.get());
        // The default, where it says something: most texts have an empty one.
        if (option.kind != OptionKind::text && value != "unset")
            out << " [" << escaped(value) << ']';
    }
    out << '\n' << escaped(option.help) << ".\n";
    const auto words = [](const std::string& opening, const std::string& rest) {
        return rest.empty() ? "" : opening + escaped(rest) + ".\n";
    };
    std::string choices;
    for (const std::string& choice : option.choices)
        choices += (choices.empty() ? "" : ", ") + choice;
    out << words("One of ", choices) << words("Needs ", option.needs)
        << words("Excludes ", option.excludes);
    if (!option.shorthand.empty())
        out << words("", option.shorthand + " is the same as " + option.flag + " " +
                             option.shorthand_for);
}

void write_options(std::ostream& out, const CommandEntry& command)
{
    std::string group;
    for (const BoundOption& bound : command.bound->options) {
        if (bound.option.flag.empty())
            continue;
        // Options come group by group, as in the help, so a heading stands where the group changes.
        if (bound.option.group != group)
            out << ".SS " << escaped(command.name.empty() ? "" : command.name + ": ")
                << escaped(group = bound.option.group) << '\n';
        write_option(out, bound.option);
    }
}

void write_examples(std::ostream& out, const std::string& command)
{
    for (const Example& example : examples_of(command))
        out << ".TP\n"
            << escaped(example.does) << "\n\\fBvdb_shell " << escaped(example.words) << "\\fR\n";
}

} // namespace

std::string man_page(const std::vector<CommandEntry>& commands)
{
    OutText out;
    out << ".TH VDB_SHELL 1 \"\" \"vdb_shell " VDB_SHELL_VERSION "\" \"User commands\"\n"
           ".SH NAME\nvdb_shell \\- thick shells of prisms and tets from triangle surfaces\n"
           ".SH SYNOPSIS\n\\fBvdb_shell\\fR [\\fIoptions\\fR] \\fIcommand\\fR [\\fIoptions\\fR] "
           "\\fIfiles\\fR\n.SH EXAMPLES\n";
    write_examples(out, "");
    out << ".SH COMMANDS\n";
    for (const CommandEntry& command : commands)
        if (!command.name.empty())
            out << ".TP\n\\fB" << escaped(command.name) << "\\fR\n"
                << escaped(command.help) << ".\n";
    out << ".SH OPTIONS OF EVERY COMMAND\n";
    for (const CommandEntry& command : commands) {
        if (!command.name.empty()) {
            out << ".SH OPTIONS OF " << escaped(command.name) << '\n';
            write_examples(out, command.name);
        }
        write_options(out, command);
    }
    out << ".SH EXIT STATUS\n"
           "0 done; 1 a fault of our own; 2 wrong use; 3 an input that cannot be read; 4 a surface "
           "that cannot be worked with; 5 an output that cannot be written; 6 a wanted bound was "
           "not met; 7 not valid, or something stands in the way; 8 an outside program failed; 9 "
           "out of memory; 128 and a signal's number. With \\-\\-frames, the status of the first "
           "frame that failed.\n"
           ".SH ENVIRONMENT\n.TP\n\\fBNO_COLOR\\fR\nNo colours are used, whether it is set or "
           "not.\n"
           ".TP\n\\fBPATH\\fR\nWhere gmsh and tetgen are looked for (\\-\\-core\\-fill).\n"
           ".TP\n\\fBTMPDIR\\fR\nWhere standard input and the files of outside programs are put "
           "meanwhile.\n";
    return out.str();
}

} // namespace vdb_shell::command
