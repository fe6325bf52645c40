// SPDX-License-Identifier: Apache-2.0
#pragma once

// Houdini's binary JSON: an opening mark, then values, each a kind and what the kind asks for
// (docs/houdini.md has the table).

#include <cstdint>
#include <string_view>

namespace vdb_shell::houdini
{

inline constexpr std::string_view kBinaryMark = "\x7f"
                                                "NSJb";
inline constexpr std::string_view kSwappedMark = "\x7f"
                                                 "bJSN";

enum class Kind : std::uint8_t {
    null = 0x00,
    boolean = 0x10,
    int8 = 0x11,
    int16 = 0x12,
    int32 = 0x13,
    int64 = 0x14,
    real16 = 0x18,
    real32 = 0x19,
    real64 = 0x1a,
    uint8 = 0x21,
    uint16 = 0x22,
    token_ref = 0x26,
    text = 0x27,
    token_def = 0x2b,
    token_undef = 0x2d,
    no = 0x30,
    yes = 0x31,
    uniform = 0x40,
    list_begin = 0x5b,
    list_end = 0x5d,
    map_begin = 0x7b,
    map_end = 0x7d,
};

/// A length is one byte below kLengths, or a kind of length and the length in 2, 4 or 8 bytes.
inline constexpr std::uint8_t kLengths = 0xf1;
inline constexpr std::uint8_t kLength16 = 0xf2, kLength32 = 0xf4, kLength64 = 0xf8;

} // namespace vdb_shell::houdini
