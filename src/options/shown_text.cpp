// SPDX-License-Identifier: Apache-2.0

// Text that others wrote, made fit for messages and figures. They go to terminals, where control
// characters of a file could do anything: change colours, titles, and what was printed before.

#include "options/shown_text.h"

#include <algorithm>

namespace vdb_shell
{
namespace
{

bool continues_a_character(char c)
{
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

std::string without_control(std::string_view text, bool keep_lines)
{
    std::string shown(text);
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const auto c = static_cast<unsigned char>(shown[i]);
        if ((c < 0x20U && !(keep_lines && c == '\n')) || c == 0x7FU)
            shown[i] = '?';
        // U+0080 to U+009F are control characters as well. In UTF-8 they are 0xC2 and one byte.
        else if (c == 0xC2U && i + 1 < shown.size() &&
                 static_cast<unsigned char>(shown[i + 1]) - 0x80U < 0x20U)
            shown.replace(i, 2, "?");
    }
    return shown;
}

} // namespace

std::string shown(std::string_view text)
{
    return without_control(text, false);
}

std::string shown_lines(std::string_view text)
{
    return without_control(text, true);
}

std::string shown_in_part(std::string_view text, std::size_t most_bytes)
{
    if (text.size() <= most_bytes)
        return shown(text);
    std::size_t end = most_bytes;
    // A character has at most four bytes. What is no UTF-8 is cut anywhere.
    const std::size_t first = std::max<std::size_t>(most_bytes, 3) - 3;
    while (end > first && continues_a_character(text[end]))
        --end;
    return shown(text.substr(0, end)) + "...";
}

} // namespace vdb_shell
