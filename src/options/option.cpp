// SPDX-License-Identifier: Apache-2.0

// What the descriptions of options can do: take values of any source, refuse the wrong ones in one
// wording, and name what would be right. A value that was taken is of the option's kind, within its
// range and within the type of its field; when one is refused, the field keeps what it had. The
// command line, JSON and callers in C++ are all tested by the same function, allowed(). Texts are
// read and written in the classic locale, so that a decimal comma of the system changes nothing.
// Trap: numbers in messages have six digits; files keep all digits by option_json.cpp.

#include "vdb_shell/options/option.h"

#include "core/text_stream.h"
#include "options/shown_text.h"
#include "vdb_shell/core/error.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>
#include <utility>

namespace vdb_shell
{
namespace
{

std::string text_of_number(double value)
{
    OutText out;
    out.imbue(std::locale::classic());
    out << value;
    return out.str();
}

std::string joined(const std::vector<std::string>& words)
{
    std::string all;
    for (const std::string& word : words)
        all += (all.empty() ? "" : ", ") + word;
    return all;
}

[[noreturn]] void refuse(const Option& option, const std::string& name, const std::string& value,
                         const std::string& expected)
{
    // Without an expectation it is the kind that was wrong, and the message tells all that is
    // allowed.
    const bool of_kind = expected.empty();
    // "0,1" and "inf" are above 0 for anybody who reads it.
    const bool of_number =
        of_kind && option.kind == OptionKind::number && !option.range.text().empty();
    throw InvalidOption(name + " is " + shown_in_part(value) + ", must be " +
                        (of_number ? "a finite number, " : "") +
                        (of_kind ? expectation(option) : expected));
}

/// The range of whole numbers where the type of the field is narrower than it. All digits of the
/// bound, since six of them are no limit that could be kept.
std::string range_in_type(const Option& option)
{
    std::string range = option.range.text();
    if (option.range.high && *option.range.high <= option.largest)
        return range;
    // 2^64 - 1 is no double: the next one is 2^64, which would wrap around.
    const auto largest = option.largest < std::ldexp(1.0, 63)
                             ? static_cast<std::uint64_t>(option.largest)
                         : option.kind == OptionKind::integer ? std::uint64_t(INT64_MAX)
                                                              : UINT64_MAX;
    return (range.empty() ? "" : range + " and ") + "at most " + std::to_string(largest);
}

/// What a value of the right kind is expected to be.
std::string expected_range(const Option& option, const OptionValue& value)
{
    const auto* integer = std::get_if<std::int64_t>(&value);
    const auto* count = std::get_if<std::uint64_t>(&value);
    // Too large is met by the bound of the type alone.
    if ((integer && static_cast<double>(*integer) > option.largest) ||
        (count && static_cast<double>(*count) > option.largest))
        return range_in_type(option);
    if (integer && static_cast<double>(*integer) < -option.largest && !option.range.low)
        return std::to_string(-static_cast<std::int64_t>(option.largest)) + " or more";
    const auto* number = std::get_if<double>(&value);
    // Infinity is "0 or more" for anybody who reads it, so the message has to say that it must be
    // finite. Between two bounds that goes without saying.
    const bool bounded = option.range.low && option.range.high;
    if (number && !std::isfinite(*number) && !bounded && !option.range.text().empty())
        return "finite and " + option.range.text();
    return option.range.text();
}

/// Whether a double is a whole number that each type of whole numbers holds. Above 2^53 doubles are
/// whole, but they stand for their neighbours as well.
bool is_whole(double value)
{
    return std::abs(value) <= std::ldexp(1.0, 53) && std::trunc(value) == value;
}

/// The value as the kind that the option has, or unset where the kinds do not fit. JSON and callers
/// write 2 for 2.0, so whole numbers are taken for numbers (above 2^53 the nearest double).
/// Programs without whole numbers write 2.0 for 2, so that is taken too; 2.5 is not, since it would
/// lose its half in silence. Texts are never parsed here: that is left to parsed_as().
OptionValue converted(OptionKind kind, const OptionValue& value)
{
    if (const auto* integer = std::get_if<std::int64_t>(&value)) {
        if (kind == OptionKind::number)
            return static_cast<double>(*integer);
        if (kind == OptionKind::count && *integer >= 0)
            return static_cast<std::uint64_t>(*integer);
        return kind == OptionKind::integer ? value : OptionValue();
    }
    if (const auto* count = std::get_if<std::uint64_t>(&value)) {
        if (kind == OptionKind::number)
            return static_cast<double>(*count);
        if (kind == OptionKind::integer && *count <= std::uint64_t(INT64_MAX))
            return static_cast<std::int64_t>(*count);
        return kind == OptionKind::count ? value : OptionValue();
    }
    if (std::holds_alternative<bool>(value))
        return kind == OptionKind::flag ? value : OptionValue();
    if (const auto* number = std::get_if<double>(&value)) {
        if ((kind == OptionKind::integer || kind == OptionKind::count) && is_whole(*number))
            return converted(kind, static_cast<std::int64_t>(*number));
        return kind == OptionKind::number ? value : OptionValue();
    }
    return kind == OptionKind::choice || kind == OptionKind::text ? value : OptionValue();
}

/// Whether a value, which has to be of the right kind already, is one of the choices or within the
/// range.
bool allowed(const Option& option, const OptionValue& value)
{
    if (option.kind == OptionKind::choice)
        return std::count(option.choices.begin(), option.choices.end(),
                          std::get<std::string>(value)) > 0;
    if (const auto* number = std::get_if<double>(&value))
        return option.range.holds(*number);
    if (const auto* integer = std::get_if<std::int64_t>(&value))
        // The field may be narrower than the value that came in, as an int is. Without this test a
        // large number would wrap around when it is set.
        return std::abs(static_cast<double>(*integer)) <= option.largest &&
               option.range.holds(static_cast<double>(*integer));
    if (const auto* count = std::get_if<std::uint64_t>(&value))
        return static_cast<double>(*count) <= option.largest &&
               option.range.holds(static_cast<double>(*count));
    return true;
}

/// Whether the text is a whole number of any size.
bool is_whole_number(const std::string& text)
{
    const std::size_t first = text.find_first_not_of("+-");
    return first != std::string::npos && first <= 1 &&
           text.find_first_not_of("0123456789", first) == std::string::npos;
}

/// The number that the text is, or unset where it is none of that type, or one that the type cannot
/// hold.
template <typename Number> OptionValue parsed(const std::string& text)
{
    InText in(text);
    in.imbue(std::locale::classic());
    Number number{};
    in >> std::noskipws >> number;
    // All of the text has to be the number: "2mm" and " 2" are refused.
    return in && in.peek() == std::istringstream::traits_type::eof() ? OptionValue(number)
                                                                     : OptionValue();
}

OptionValue parsed_as(OptionKind kind, const std::string& text)
{
    if (kind == OptionKind::flag)
        return text == "true" || text == "false" ? OptionValue(text == "true") : OptionValue();
    if (kind == OptionKind::integer)
        return parsed<std::int64_t>(text);
    if (kind == OptionKind::number)
        return parsed<double>(text);
    // Streams take -1 for the largest of the unsigned numbers, as C does, so a minus sign is
    // refused before the stream sees it.
    if (kind == OptionKind::count)
        return text.rfind('-', 0) == 0 ? OptionValue() : parsed<std::uint64_t>(text);
    return text;
}

} // namespace

const NameTable<Unit>& names(Unit)
{
    // These names are in the schema that programs read, so they must stay what they are.
    static const NameTable<Unit> table{
        {"none", Unit::none},     {"world length", Unit::world_length},
        {"voxels", Unit::voxels}, {"radians", Unit::radians},
        {"share", Unit::share},   {"count", Unit::count},
        {"pixels", Unit::pixels}, {"GiB", Unit::gibibytes},
        {"seed", Unit::seed}};
    return table;
}

std::string text_of(const OptionValue& value)
{
    if (std::holds_alternative<std::monostate>(value))
        return "unset";
    if (const auto* flag = std::get_if<bool>(&value))
        return *flag ? "true" : "false";
    if (const auto* integer = std::get_if<std::int64_t>(&value))
        return std::to_string(*integer);
    if (const auto* count = std::get_if<std::uint64_t>(&value))
        return std::to_string(*count);
    if (const auto* number = std::get_if<double>(&value))
        return text_of_number(*number);
    return std::get<std::string>(value);
}

bool Range::holds(double value) const
{
    // Comparisons are written so that no bound holds for what is not a number; infinity is refused
    // even where there is no bound.
    const bool over = !low || (low_excluded ? value > *low : value >= *low);
    const bool under = !high || (high_excluded ? value < *high : value <= *high);
    return std::isfinite(value) && over && under;
}

std::string Range::text() const
{
    // People read "0 to 1" as a range that holds both of its ends, so only such a range is written
    // so.
    if (low && high && !low_excluded && !high_excluded)
        return text_of_number(*low) + " to " + text_of_number(*high);
    std::string text;
    if (low)
        text = low_excluded ? "above " + text_of_number(*low) : text_of_number(*low) + " or more";
    if (high)
        text += (text.empty() ? "" : " and ") +
                std::string(high_excluded ? "less than " : "at most ") + text_of_number(*high);
    return text;
}

Range Range::at_most(double bound) const
{
    Range range = *this;
    range.high = bound;
    range.high_excluded = false;
    return range;
}

Range Range::below(double bound) const
{
    Range range = at_most(bound);
    range.high_excluded = true;
    return range;
}

Range at_least(double bound)
{
    Range range;
    range.low = bound;
    return range;
}

Range above(double bound)
{
    Range range = at_least(bound);
    range.low_excluded = true;
    return range;
}

Option& Option::with_names(std::vector<std::string> more)
{
    names = std::move(more);
    return *this;
}

Option& Option::in(Unit which)
{
    unit = which;
    return *this;
}

Option& Option::within(const Range& which)
{
    range = which;
    return *this;
}

Option& Option::needing(const std::string& other)
{
    needs = other;
    return *this;
}

Option& Option::excluding(const std::string& other)
{
    excludes = other;
    return *this;
}

Option& Option::with_shorthand(const std::string& own_flag, const std::string& choice)
{
    shorthand = own_flag;
    shorthand_for = choice;
    return *this;
}

Option& Option::not_stored()
{
    stored = false;
    return *this;
}

OptionList in_group(const std::string& group, OptionList options)
{
    for (Option& o : options)
        // An option that names its own group keeps it.
        if (o.group.empty())
            o.group = group;
    return options;
}

std::string negation_of(const Option& option)
{
    if (option.kind != OptionKind::flag || option.flag.empty())
        return "";
    return option.flag.rfind("--no-", 0) == 0 ? "--" + option.flag.substr(5)
                                              : "--no-" + option.flag.substr(2);
}

std::string expectation(const Option& option)
{
    std::string range = option.range.text();
    switch (option.kind) {
    case OptionKind::flag:
        return "true or false";
    case OptionKind::choice:
        return "one of " + joined(option.choices);
    case OptionKind::text:
        return "a text";
    case OptionKind::number:
        return range.empty() ? "a finite number" : range;
    case OptionKind::integer:
        return "a whole number" + (range.empty() ? "" : ", " + range);
    case OptionKind::count:
        return "a whole number, " + (range.empty() ? "0 or more" : range);
    }
    return range;
}

void assign(Option& option, const OptionValue& value, const std::string& name)
{
    if (std::holds_alternative<std::monostate>(value)) {
        // Only a field that is an optional can hold nothing.
        if (!option.may_be_unset)
            refuse(option, name, "null", "");
        option.set(value);
        return;
    }
    // All tests come before the field is set, so a refused value changes nothing.
    const OptionValue fitting = converted(option.kind, value);
    if (std::holds_alternative<std::monostate>(fitting))
        refuse(option, name, text_of(value), "");
    if (!allowed(option, fitting))
        refuse(option, name, text_of(value), expected_range(option, fitting));
    option.set(fitting);
}

void assign_text(Option& option, const std::string& text, const std::string& name)
{
    // A text comes from a person, so it is parsed as the option's own kind, and not guessed from
    // its looks.
    const OptionValue value = parsed_as(option.kind, text);
    if (std::holds_alternative<std::monostate>(value)) {
        // A whole number that no type holds meets the bound of the option's.
        const bool whole = option.kind == OptionKind::integer || option.kind == OptionKind::count;
        refuse(option, name, text,
               whole && is_whole_number(text) && text.front() != '-' ? range_in_type(option) : "");
    }
    if (!allowed(option, value))
        refuse(option, name, text, expected_range(option, value));
    option.set(value);
}

Option* find_by_flag(OptionList& options, const std::string& flag)
{
    const auto found = std::find_if(options.begin(), options.end(),
                                    [&](const Option& o) { return o.flag == flag; });
    return found == options.end() ? nullptr : &*found;
}

void require_in_range(const OptionList& options, const std::string& owner)
{
    for (const Option& o : options) {
        const OptionValue value = o.get();
        // For structs that were filled in C++, where nothing was tested on the way.
        if (!std::holds_alternative<std::monostate>(value) && !allowed(o, value))
            refuse(o, owner + ": " + o.key, text_of(value), expected_range(o, value));
    }
}

void divide_lengths(OptionList& options, double unit)
{
    for (Option& o : options) {
        const OptionValue value = o.get();
        // Lengths in voxels, and shares of lengths, do not change with the unit. An optional length
        // that is unset stays so.
        if (o.unit == Unit::world_length && std::holds_alternative<double>(value))
            o.set(std::get<double>(value) / unit);
    }
}

} // namespace vdb_shell
