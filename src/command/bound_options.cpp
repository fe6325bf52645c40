// SPDX-License-Identifier: Apache-2.0

// Takes described options; gives the flags of one command, and sets the fields from a file of
// options and from the flags. CLI11 does the splitting into words, the help and what is required;
// all values are converted here, by the same code that reads the file, so a flag and a key accept
// the same things and refuse them in the same words. The order in apply() is what users see:
// defaults, then the file, then the flags.

#include "command/bound_options.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"
#include "vdb_shell/io/read_file.h"
#include "vdb_shell/pose/pose_shell.h"

#include "command/build_command.h"
#include "core/text_stream.h"
#include "options/option_json.h"
#include "options/shown_text.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

namespace vdb_shell::command
{
namespace
{

constexpr const char* kPresetFlag = "--options";
constexpr const char* kPurposeFlag = "--for";

/// The groups of the help in the order in which the stages run; a group that is not listed here
/// comes after them, so that a new one is never lost.
std::vector<std::string> groups_of(const std::vector<BoundOption>& options)
{
    std::vector<std::string> groups{"Options",   "Output", "Surface", "Wrap",   "Resampling",
                                    "Level set", "Lines",  "Growth",  "Layers", "Tets"};
    for (const BoundOption& bound : options)
        if (std::find(groups.begin(), groups.end(), bound.option.group) == groups.end())
            groups.push_back(bound.option.group);
    return groups;
}

/// CLI11 takes names as one text with commas; `!` before a name makes it the negation of the flag.
/// Short names come first, as people expect them in the help.
std::string names_for_parser(const Option& option)
{
    std::string names;
    for (const std::string& name : option.names)
        if (name.rfind("--", 0) != 0)
            names += name + ",";
    names += option.flag;
    for (const std::string& name : option.names)
        if (name.rfind("--", 0) == 0)
            names += "," + name;
    const std::string negation = negation_of(option);
    return negation.empty() ? names : names + ",!" + negation;
}

/// The words that CLI11 has for its own types.
const char* type_in_help(OptionKind kind)
{
    switch (kind) {
    case OptionKind::flag:
        return "";
    case OptionKind::integer:
        return "INT";
    case OptionKind::count:
        return "UINT";
    case OptionKind::number:
        return "FLOAT";
    case OptionKind::choice:
        return "NAME";
    case OptionKind::text:
        return "TEXT";
    }
    return "";
}

/// What stands behind the flag: "FLOAT=0.9 Needs: --repair".
std::string usage_of(const BoundOption& bound)
{
    const Option& option = bound.option;
    std::string usage = type_in_help(option.kind);
    if (option.kind != OptionKind::flag && option.kind != OptionKind::text &&
        !std::holds_alternative<std::monostate>(bound.default_value))
        usage += "=" + text_of(bound.default_value);
    const auto add = [&](const std::string& more) { usage += (usage.empty() ? "" : " ") + more; };
    if (option.repeated)
        add("...");
    if (option.required)
        add("REQUIRED");
    if (!option.needs.empty())
        add("Needs: " + option.needs);
    if (!option.excludes.empty())
        add("Excludes: " + option.excludes);
    return usage;
}

std::string help_of(const BoundOption& bound)
{
    std::string help = bound.option.help;
    // CLI11 shows a flag without a value. What is on already can only be turned off, which nobody
    // would guess.
    if (bound.option.kind == OptionKind::flag && std::get<bool>(bound.default_value))
        help += " [on]";
    std::string choices;
    for (const std::string& choice : bound.option.choices)
        choices += (choices.empty() ? " (" : ", ") + choice;
    return choices.empty() ? help : help + choices + ")";
}

/// Tells CLI11 of the flag, and keeps what it hands back: its words are asked for by apply().
void add_to_parser(CLI::App& app, BoundOption& bound)
{
    const Option& option = bound.option;
    const std::string names = names_for_parser(option), help = help_of(bound);
    // CLI11 only stores the words. They are converted by apply(), when the file of options has been
    // read: conversion while parsing would be overwritten by the file.
    bound.given =
        option.kind == OptionKind::flag
            ? app.add_flag(names, help)
            : app.add_option(names, CLI::callback_t([](const CLI::results_t&) { return true; }),
                             help);
    if (option.kind == OptionKind::flag)
        // `--half --no-half` means the last one, as with most programs: a script can add a flag to
        // a line that it does not know.
        bound.given->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    if (option.repeated)
        bound.given->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    const std::string usage = usage_of(bound);
    if (!usage.empty())
        bound.given->option_text(usage);
    bound.given->required(option.required)->group(option.group);
    if (option.shorthand.empty())
        return;
    const std::string shorthand_help = "Same as " + option.flag + " " + option.shorthand_for;
    bound.shorthand_given = app.add_flag(option.shorthand, shorthand_help)
                                ->group(option.group)
                                ->option_text("Excludes: " + option.flag);
}

/// Null where this command has no such flag.
BoundOption* find(BoundOptions& bound, const std::string& flag)
{
    const auto found = std::find_if(bound.options.begin(), bound.options.end(),
                                    [&](const BoundOption& b) { return b.option.flag == flag; });
    return found == bound.options.end() ? nullptr : &*found;
}

/// On the command line; what a file of options says does not count.
bool was_given(const BoundOption& bound)
{
    return (bound.given && bound.given->count() > 0) ||
           (bound.shorthand_given && bound.shorthand_given->count() > 0);
}

/// Of what `info --json` prints.
nlohmann::ordered_json parameters_in(const nlohmann::ordered_json& json, const std::string& name)
{
    const nlohmann::ordered_json& parameters = json.at("parameters");
    if (!parameters.is_object())
        throw InvalidOption(name + ": parameters is " +
                            shown_in_part(parameters.dump(
                                -1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) +
                            ", must be an object");
    return parameters;
}

/// Sets what a text of JSON says, from a file or of a purpose. `name` opens messages.
void set_from_text(BoundOptions& bound, const std::string& text, const std::string& name)
{
    nlohmann::ordered_json json = parse_options(text, name);
    // `info --json` prints the options beside the report, and what it prints can be given as the
    // file.
    if (json.contains("parameters"))
        json = parameters_in(json, name);
    // One file serves all commands: what it says has to be an option of `build`, or of how `pose`
    // mends, and what this command has no use for is left aside. Reading it into arguments of both
    // first is what finds misspelt keys; without that every unknown key would look like one of
    // another command.
    BuildArguments all;
    PoseOptions pose;
    OptionSections sections = describe(all);
    sections.push_back({"pose", vdb_shell::describe(pose)});
    set_from_json(json, sections, name);
    set_known_from_json(json, bound.sections, name);
}

/// What was given on the command line wins over all that was set before.
void set_given(BoundOption& bound)
{
    Option& option = bound.option;
    const bool by_shorthand = bound.shorthand_given && bound.shorthand_given->count() > 0;
    // The two may say different things, and nothing tells which was meant.
    if (by_shorthand && bound.given->count() > 0)
        throw InvalidOption(option.shorthand + " excludes " + option.flag);
    if (by_shorthand)
        assign_text(option, option.shorthand_for, option.shorthand);
    // CLI11 has settled here which of the flag and its negations came last.
    else if (option.kind == OptionKind::flag)
        option.set(bound.given->as<bool>());
    else
        for (const std::string& text : bound.given->results())
            // --layers auto for --layers-auto.
            assign_text(option,
                        option.flag + "-" + text == option.shorthand ? option.shorthand_for : text,
                        option.flag);
}

/// Of two flags that say the same thing in different ways the one that was given holds, whatever
/// the file of options says: the other one goes back to its default. The file itself may name both.
void settle_exclusions(BoundOptions& bound)
{
    for (BoundOption& one : bound.options) {
        BoundOption* other =
            one.option.excludes.empty() ? nullptr : find(bound, one.option.excludes);
        // `excludes` may name an option of `build` that this command does not have.
        if (!other)
            continue;
        if (was_given(one) && was_given(*other))
            throw InvalidOption(one.option.flag + " excludes " + other->option.flag);
        if (was_given(one))
            other->option.set(other->default_value);
        if (was_given(*other))
            one.option.set(one.default_value);
    }
}

/// One of Option::needs; an option that this command does not have is not missed.
bool is_there(BoundOptions& bound, const std::string& needed)
{
    InText words(needed);
    std::string flag;
    words >> flag;
    const BoundOption* other = find(bound, flag);
    if (!other)
        return true;
    const std::vector<std::string> values{std::istream_iterator<std::string>(words), {}};
    const auto one_of_them = [&](const std::string& value) {
        return std::find(values.begin(), values.end(), value) != values.end();
    };
    if (values.empty())
        // It may also come from the file, which shows only in the value: it is no longer the
        // default.
        return was_given(*other) || !(other->option.get() == other->default_value);
    // The value itself, or the extension of a file.
    // The field of an option that can be given several times does not show what was given; there
    // the words are asked.
    if (!other->option.repeated) {
        const std::string text = text_of(other->option.get());
        return one_of_them(text) || one_of_them(lower_case_extension(text));
    }
    const std::vector<std::string> files = other->given->results();
    return std::any_of(files.begin(), files.end(), [&](const std::string& file) {
        return one_of_them(lower_case_extension(file));
    });
}

/// `needs` as Option has it: "--repair", "--output .png", or several of them with " or " between,
/// one of which is enough.
bool has_what_it_needs(BoundOptions& bound, const std::string& needs)
{
    const std::string separator = " or ";
    for (std::size_t begin = 0; begin < needs.size();) {
        const std::size_t end = std::min(needs.find(separator, begin), needs.size());
        if (is_there(bound, needs.substr(begin, end - begin)))
            return true;
        begin = end + separator.size();
    }
    return needs.empty();
}

void require_needs(BoundOptions& bound)
{
    for (const BoundOption& one : bound.options) {
        // A flag that is turned off asks for nothing.
        const bool asks = was_given(one) && one.option.get() != OptionValue(false);
        if (asks && !has_what_it_needs(bound, one.option.needs))
            throw InvalidOption(one.option.flag + " needs " + one.option.needs);
    }
}

} // namespace

std::vector<std::string> flags_of(const Option& option)
{
    std::vector<std::string> flags = option.names;
    flags.insert(flags.begin(), option.flag);
    if (const std::string negation = negation_of(option); !negation.empty())
        flags.push_back(negation);
    if (!option.shorthand.empty())
        flags.push_back(option.shorthand);
    return flags;
}

std::vector<std::string> flags_of(const BoundOptions& bound)
{
    std::vector<std::string> all;
    for (const BoundOption& one : bound.options) {
        if (one.option.flag.empty())
            continue;
        const std::vector<std::string> flags = flags_of(one.option);
        all.insert(all.end(), flags.begin(), flags.end());
    }
    return all;
}

BoundOptions bind(CLI::App& app, OptionSections sections)
{
    BoundOptions bound;
    for (const OptionSection& section : sections) {
        if (section.enable)
            bound.options.push_back({*section.enable, section.enable->get()});
        for (const Option& option : section.options)
            bound.options.push_back({option, option.get()});
    }
    // The fields still have their defaults at this point, and get() has copied them; afterwards
    // nothing else remembers what the default was.
    bound.sections = std::move(sections);
    // CLI11 shows groups in the order in which it meets them.
    for (const std::string& group : groups_of(bound.options))
        for (BoundOption& option : bound.options)
            if (option.option.group == group && !option.option.flag.empty())
                add_to_parser(app, option);
    return bound;
}

void apply(BoundOptions& bound)
{
    // Exclusions and needs are settled last, because both depend on what the file and the flags
    // have set together.
    BoundOption* purpose = find(bound, kPurposeFlag);
    // The purpose comes before everything, also before a file of options, as it is the most general
    // of what can be said.
    if (purpose && was_given(*purpose)) {
        Purpose wanted = Purpose::any;
        Option parsed = purpose_option(wanted);
        assign_text(parsed, purpose->given->results().back(), kPurposeFlag);
        set_from_text(bound, options_for(wanted), kPurposeFlag);
    }
    const BoundOption* preset = find(bound, kPresetFlag);
    if (preset && was_given(*preset)) {
        const std::string file = preset->given->results().back();
        // Whole and not from a pipe: it is read for the plan, and again for each frame.
        set_from_text(bound, read_whole_file(file), file);
    }
    for (BoundOption& option : bound.options)
        if (was_given(option))
            set_given(option);
    settle_exclusions(bound);
    require_needs(bound);
}

Option purpose_option(Purpose& purpose)
{
    Option o =
        option("", purpose, kPurposeFlag,
               "What the shell is made for: a set of options, over which --options and flags "
               "win");
    o.group = "Options";
    return o;
}

Option preset_option(std::filesystem::path& preset)
{
    Option o = option("", preset, kPresetFlag,
                      "File of options as JSON, or what `info --json` prints; flags win over it");
    o.group = "Options";
    return o;
}

} // namespace vdb_shell::command
