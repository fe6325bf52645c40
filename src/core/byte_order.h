// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>

namespace vdb_shell
{

/// Whether numbers lie in memory with their least byte first. C++17 has no name for it.
inline bool little_endian_machine()
{
    const std::uint16_t one = 1;
    unsigned char first = 0;
    std::memcpy(&first, &one, 1);
    return first == 1;
}

} // namespace vdb_shell
