// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iomanip>
#include <locale>
#include <sstream>
#include <string>

namespace vdb_shell
{

// The longest label and a space after it.
inline constexpr int kLabelWidth = 12;

/// "label       text", one line.
inline void line(std::ostringstream& out, const char* label, const std::string& text)
{
    out << std::left << std::setw(kLabelWidth) << label << text << '\n';
}

/// Significant digits, so that lengths of any unit can be read. Whole numbers come out whole,
/// whatever the digits.
template <typename T> std::string number(T value, int digits = 4)
{
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out << std::setprecision(digits) << value;
    return out.str();
}

/// Fixed decimals, since most fills are close to 1 and differ in the last ones.
inline std::string percent(double share)
{
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out << std::fixed << std::setprecision(2) << 100.0 * share << " %";
    return out.str();
}

} // namespace vdb_shell
