// SPDX-License-Identifier: Apache-2.0
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
