// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// The numbers of the entries that are marked, ascending.
inline std::vector<int> marked(const std::vector<std::uint8_t>& marks)
{
    std::vector<int> numbers;
    for (auto at = marks.begin(); (at = std::find(at, marks.end(), 1)) != marks.end(); ++at)
        numbers.push_back(static_cast<int>(at - marks.begin()));
    return numbers;
}

} // namespace vdb_shell
