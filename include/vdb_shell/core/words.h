// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

namespace vdb_shell
{

// What names of files, keys and magic words are told apart by.

/// Letters of ASCII made small; other bytes stay.
inline std::string lower_case(std::string text)
{
    // The cast is needed: tolower is undefined for negative values, and names may have any bytes.
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// As std::filesystem tells it, with its dot, made small: ".obj" of "A.OBJ", ".sc" of "a.bgeo.sc".
inline std::string lower_case_extension(const std::filesystem::path& path)
{
    return lower_case(path.extension().string());
}

inline bool begins_with(std::string_view text, std::string_view start)
{
    return text.substr(0, start.size()) == start;
}

} // namespace vdb_shell
