// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/describe.h"
#include "vdb_shell/options/option_value.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

// Each field of each stage's options struct is described once, by the stage's describe(). The
// command line, files of options, the rescaling of lengths, the validation, the help page and the
// node in Houdini are made of these descriptions (docs/options.md).

namespace vdb_shell
{

/// What a number counts or measures.
enum class Unit {
    none,
    world_length, ///< a length in the unit of the surface's file: divided where that is rescaled
    voxels,
    radians,
    share, ///< of some whole: 0 to 1, mostly
    count,
    pixels,
    gibibytes,
    seed ///< of a random number generator: any value is as good as another
};
const NameTable<Unit>& names(Unit);

/// The values that a number may have. Each bound may be left out, and may itself be excluded.
struct Range {
    std::optional<double> low, high;
    bool low_excluded = false, high_excluded = false;

    bool holds(double value) const;
    /// "above 0 and at most 1"; empty where everything finite is allowed.
    std::string text() const;

    Range at_most(double bound) const;
    Range below(double bound) const;
};
Range at_least(double bound);
Range above(double bound);

/// One field: what it is called, what it may be, and how to get at it. Points into the struct that
/// was described, which has to outlive it.
struct Option {
    std::string key;                ///< name of the field and in JSON; empty: not in files
    std::string flag;               ///< "--thickness"; empty: cannot be given to the command
    std::string help;               ///< one line for a person
    std::string group;              ///< heading in the help, folder of Houdini's node
    std::vector<std::string> names; ///< further names of the flag: "-o"
    Unit unit = Unit::none;
    Range range;
    std::string needs;         ///< flag without which this one has no meaning (docs/options.md)
    std::string excludes;      ///< flag that sets the same thing in another way
    std::string shorthand;     ///< a flag of its own for one of the choices...
    std::string shorthand_for; ///< ...which is this one
    bool stored = true;        ///< is written to files; off for what does not change the result
    bool required = false;     ///< the command refuses to run without it
    OptionKind kind = OptionKind::flag;
    bool may_be_unset = false;        ///< the field is an optional
    bool repeated = false;            ///< every value given is kept
    std::vector<std::string> choices; ///< for OptionKind::choice
    double largest = 0;               ///< that the field's type holds, for integer and count

    std::function<OptionValue()> get;
    std::function<void(const OptionValue&)> set; ///< unchecked: see assign

    Option& with_names(std::vector<std::string> more);
    Option& in(Unit which);
    Option& within(const Range& which);
    Option& needing(const std::string& other);
    Option& excluding(const std::string& other);
    Option& with_shorthand(const std::string& own_flag, const std::string& choice);
    Option& not_stored();
};

/// Describes `field`. An empty flag leaves it to files and to C++.
template <typename T>
Option option(const std::string& key, T& field, const std::string& flag, const std::string& help)
{
    using Traits = OptionTraits<T>;
    Option o;
    o.key = key;
    o.flag = flag;
    o.help = help;
    o.kind = Traits::kKind;
    o.may_be_unset = Traits::kMayBeUnset;
    o.repeated = Traits::kRepeated;
    o.choices = Traits::choices();
    o.largest = Traits::largest();
    o.get = [&field] { return Traits::get(field); };
    o.set = [&field](const OptionValue& value) { Traits::set(value, field); };
    return o;
}

/// The list, with every option in the group that has none yet.
OptionList in_group(const std::string& group, OptionList options);

/// "above 0", "a whole number, 0 or more", "one of raw, certified, thickest": what to expect.
std::string expectation(const Option& option);

/// The flag that turns a switch off: "--no-half" for "--half", "--clobber" for "--no-clobber".
/// Empty for what takes a value and for what has no flag.
std::string negation_of(const Option& option);

/// Sets the field. Throws InvalidOption "`name` is -1, must be above 0" for a value of another kind
/// or out of range; the field is unchanged then. Whole numbers are taken for numbers.
void assign(Option& option, const OptionValue& value, const std::string& name);

/// The same for what somebody typed. "true" and "false" for flags.
void assign_text(Option& option, const std::string& text, const std::string& name);

/// The option of that flag, or null.
Option* find_by_flag(OptionList& options, const std::string& flag);

/// Throws InvalidOption "`owner`: key is -1, must be above 0" for the first value out of its range.
void require_in_range(const OptionList& options, const std::string& owner);

template <typename Options> void require_in_range(Options options, const std::string& owner)
{
    require_in_range(describe(options), owner);
}

/// Divides every length by `unit`.
void divide_lengths(OptionList& options, double unit);

} // namespace vdb_shell
