// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/name_table.h"

#include <vector>

// What a stage's public header needs to declare describe(), and no more: option.h is for those who
// define or use it.

namespace vdb_shell
{

struct Option;
/// One for each field of an options struct, in the order of the fields.
using OptionList = std::vector<Option>;
struct OptionSection;
/// One for each stage, in the order of the data.
using OptionSections = std::vector<OptionSection>;

} // namespace vdb_shell
