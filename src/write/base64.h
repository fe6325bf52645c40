// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace vdb_shell
{

/// Base 64 of `size` bytes; padded to whole groups.
inline std::string base64(const unsigned char* bytes, std::size_t size)
{
    static constexpr char kDigits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((size + 2) / 3 * 4);
    for (std::size_t i = 0; i < size; i += 3) {
        const std::size_t left = size - i;
        const std::uint32_t group = (std::uint32_t(bytes[i]) << 16) |
                                    (left > 1 ? std::uint32_t(bytes[i + 1]) << 8 : 0u) |
                                    (left > 2 ? std::uint32_t(bytes[i + 2]) : 0u);
        text += kDigits[group >> 18];
        text += kDigits[(group >> 12) & 63u];
        text += left > 1 ? kDigits[(group >> 6) & 63u] : '=';
        text += left > 2 ? kDigits[group & 63u] : '=';
    }
    return text;
}

} // namespace vdb_shell
