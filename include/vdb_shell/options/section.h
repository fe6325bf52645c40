// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/option.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vdb_shell
{

/// The options of one stage, and the name of their object in JSON.
struct OptionSection {
    std::string key; ///< empty: the options stand by themselves
    OptionList options;
    /// For a stage that is off by default: the flag that switches it on. JSON has null while off.
    std::optional<Option> enable{};
};

/// "line_step.thickness".
std::string path_of(const OptionSection& section, const Option& option);

void divide_lengths(OptionSections& sections, double unit);

/// A section of options that exist only once a flag of the given name has switched the stage on.
/// What is set before that is kept until then. `described` has to outlive the section.
template <typename Options>
OptionSection optional_section(const std::string& key, std::optional<Options>& described,
                               const std::string& flag, const std::string& help)
{
    // The fields to set exist in any case; they are copied to where they count.
    auto held = std::make_shared<Options>(described.value_or(Options{}));
    OptionSection section{key, describe(*held)};
    for (Option& o : section.options) {
        o.needs = flag;
        o.get = [get = o.get, held] { return get(); };
        o.set = [set = o.set, held, &described](const OptionValue& value) {
            set(value);
            if (described)
                described = *held;
        };
    }
    Option enable;
    enable.flag = flag;
    enable.help = help;
    enable.get = [&described] { return OptionValue(described.has_value()); };
    enable.set = [&described, held](const OptionValue& value) {
        described.reset();
        if (std::get<bool>(value))
            described = *held;
    };
    section.enable = enable;
    return section;
}

} // namespace vdb_shell
