// SPDX-License-Identifier: Apache-2.0

// The options of one stage under one name, as JSON nests them. Either name may be empty: a section
// without a key has its options at the top, and an option without a key is not in files.

#include "vdb_shell/options/section.h"

namespace vdb_shell
{

std::string path_of(const OptionSection& section, const Option& option)
{
    if (option.key.empty() || section.key.empty())
        return section.key + option.key;
    return section.key + "." + option.key;
}

void divide_lengths(OptionSections& sections, double unit)
{
    for (OptionSection& section : sections)
        divide_lengths(section.options, unit);
}

} // namespace vdb_shell
