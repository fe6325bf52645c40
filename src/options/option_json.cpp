// SPDX-License-Identifier: Apache-2.0

// Options as JSON: to write what a run used, to set a run up from a file, and to tell other
// programs what options there are. Numbers are written with as many digits as bring the same double
// back. An unknown key is an error, because a key that is spelled wrong would otherwise be an
// option that silently keeps its default; only set_known_from_json() passes over such keys, because
// one file of options serves all commands. Objects keep the order of the descriptions. Trap:
// entries are set one after the other, so when one is refused those before it are set already.

#include "options/option_json.h"

#include "options/near_names.h"
#include "options/parse_json.h"
#include "options/shown_text.h"
#include "vdb_shell/core/error.h"

#include <algorithm>
#include <type_traits>

namespace vdb_shell
{
namespace
{

using nlohmann::ordered_json;

/// For messages. A file of options may have a text of many megabytes.
std::string shown_json(const ordered_json& json)
{
    return shown_in_part(json.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

/// A key in a message. An empty one would not be seen.
std::string shown_key(const std::string& key)
{
    return key.empty() ? "\"\"" : shown_in_part(key);
}

OptionValue value_of(const ordered_json& json, const std::string& name)
{
    if (json.is_null())
        return {};
    if (json.is_boolean())
        return json.get<bool>();
    // The order matters: an unsigned number is an integer for this library too, and one above 2^63
    // is no int64.
    if (json.is_number_unsigned())
        return json.get<std::uint64_t>();
    if (json.is_number_integer())
        return json.get<std::int64_t>();
    if (json.is_number())
        return json.get<double>();
    if (json.is_string())
        return json.get<std::string>();
    throw InvalidOption(name + " is " + shown_json(json) + ", must be a single value");
}

Option* find_by_key(OptionList& options, const std::string& key)
{
    const auto found = std::find_if(options.begin(), options.end(), [&](const Option& o) {
        // Options without a key are not in files, and must not be found by an empty key.
        return !o.key.empty() && o.key == key;
    });
    return found == options.end() ? nullptr : &*found;
}

/// What an object of that section may have.
std::vector<std::string> keys_of(const OptionSection& section)
{
    std::vector<std::string> keys;
    for (const Option& option : section.options)
        if (!option.key.empty())
            keys.push_back(option.key);
    return keys;
}

/// Sections, and options with theirs before them: "level_set.resolution".
std::vector<std::string> all_keys_of(const OptionSections& sections)
{
    std::vector<std::string> keys;
    for (const OptionSection& section : sections) {
        if (!section.key.empty())
            keys.push_back(section.key);
        for (const std::string& key : keys_of(section))
            keys.push_back(section.key.empty() ? key : section.key + "." + key);
    }
    return keys;
}

/// A section that can be off has null for "off" and an object, of any size, for "on". That flag is
/// set before the entries, so that they go into options that exist.
void set_section(const ordered_json& json, OptionSection& section, const std::string& name)
{
    if (section.enable && !json.is_object() && !json.is_null())
        throw InvalidOption(name + ": " + section.key + " is " + shown_json(json) +
                            ", must be an object or null");
    if (section.enable)
        section.enable->set(!json.is_null());
    if (section.enable && json.is_null())
        return;
    if (!json.is_object())
        throw InvalidOption(name + ": " + section.key + " is " + shown_json(json) +
                            ", must be an object");
    for (const auto& entry : json.items()) {
        const std::string full = name + ": " + section.key + "." + shown_key(entry.key());
        Option* option = find_by_key(section.options, entry.key());
        if (!option)
            throw InvalidOption(full + " is no option" +
                                hint_of_near(entry.key(), keys_of(section)));
        assign(*option, value_of(entry.value(), full), full);
    }
}

/// Sets what `key` names; false where nothing has that name.
bool set_entry(const std::string& key, const ordered_json& json, OptionSections& sections,
               const std::string& name)
{
    for (OptionSection& section : sections) {
        if (section.key == key && !key.empty()) {
            set_section(json, section, name);
            return true;
        }
        // Options of a section with a name are only found within its object, so two sections may
        // have options of the same name.
        if (!section.key.empty())
            continue;
        if (Option* option = find_by_key(section.options, key)) {
            std::string place = name;
            place.append(": ").append(key);
            assign(*option, value_of(json, place), place);
            return true;
        }
    }
    return false;
}

/// Each bound has a key that says whether the bound itself is allowed, so that a program that
/// builds a form of the schema needs no further flag.
ordered_json range_json(const Range& range)
{
    ordered_json json = ordered_json::object();
    if (range.low)
        json[range.low_excluded ? "above" : "at_least"] = *range.low;
    if (range.high)
        json[range.high_excluded ? "below" : "at_most"] = *range.high;
    return json;
}

/// These names are read by other programs. There is no default, so that compilers warn of a kind
/// that was forgotten.
const char* type_name(OptionKind kind)
{
    switch (kind) {
    case OptionKind::flag:
        return "flag";
    case OptionKind::integer:
        return "integer";
    case OptionKind::count:
        return "unsigned";
    case OptionKind::number:
        return "number";
    case OptionKind::choice:
        return "choice";
    case OptionKind::text:
        return "text";
    }
    return "";
}

ordered_json option_schema(const OptionSection& section, const Option& option)
{
    const auto or_null = [](const std::string& text) {
        return text.empty() ? ordered_json(nullptr) : ordered_json(text);
    };
    ordered_json json{{"flag", or_null(option.flag)}};
    json["names"] = option.names;
    json["negation"] = or_null(negation_of(option));
    json["key"] = or_null(path_of(section, option));
    json["type"] = type_name(option.kind);
    json["unit"] = name_in_table(option.unit);
    json["range"] = range_json(option.range);
    // This is the value that the option has now: hence the precondition that options have their
    // defaults.
    json["default"] = value_json(option.get());
    json["may_be_unset"] = option.may_be_unset;
    json["repeated"] = option.repeated;
    json["required"] = option.required;
    json["choices"] = option.choices;
    json["needs"] = or_null(option.needs);
    json["excludes"] = or_null(option.excludes);
    json["shorthand"] = or_null(option.shorthand);
    json["shorthand_for"] = or_null(option.shorthand_for);
    json["group"] = option.group;
    json["help"] = option.help;
    return json;
}

} // namespace

ordered_json value_json(const OptionValue& value)
{
    return std::visit(
        [](const auto& held) {
            if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::monostate>)
                return ordered_json(nullptr);
            else
                return ordered_json(held);
        },
        value);
}

ordered_json to_json(const OptionSections& sections)
{
    ordered_json json = ordered_json::object();
    for (const OptionSection& section : sections) {
        if (section.enable && !std::get<bool>(section.enable->get())) {
            json[section.key] = nullptr;
            continue;
        }
        for (const Option& option : section.options)
            // What does not change the result is not written, so runs that differ in nothing else
            // have the same record.
            if (option.stored && !option.key.empty())
                (section.key.empty() ? json[option.key] : json[section.key][option.key]) =
                    value_json(option.get());
    }
    return json;
}

void set_from_json(const ordered_json& json, OptionSections& sections, const std::string& name)
{
    for (const auto& entry : json.items())
        if (!set_entry(entry.key(), entry.value(), sections, name))
            throw InvalidOption(name + ": " + shown_key(entry.key()) + " is no option" +
                                hint_of_near(entry.key(), all_keys_of(sections)));
}

void set_known_from_json(const ordered_json& json, OptionSections& sections,
                         const std::string& name)
{
    for (OptionSection& section : sections) {
        if (!section.key.empty() && !json.contains(section.key))
            continue;
        const ordered_json& object = section.key.empty() ? json : json.at(section.key);
        if (section.enable)
            // Null is "off", as set_section() has it.
            section.enable->set(object.is_object());
        for (Option& option : section.options) {
            if (option.key.empty() || !object.is_object() || !object.contains(option.key))
                continue;
            const std::string full = name + ": " + path_of(section, option);
            assign(option, value_of(object.at(option.key), full), full);
        }
    }
}

ordered_json parse_options(const std::string& text, const std::string& name)
{
    ordered_json json = parse_json(text, name);
    if (!json.is_object())
        throw ReadError(name + ": is no JSON object of options");
    return json;
}

ordered_json schema_json(const OptionSections& sections)
{
    ordered_json json = ordered_json::array();
    for (const OptionSection& section : sections) {
        if (section.enable)
            json.push_back(option_schema(section, *section.enable));
        for (const Option& option : section.options)
            json.push_back(option_schema(section, option));
    }
    return json;
}

} // namespace vdb_shell
