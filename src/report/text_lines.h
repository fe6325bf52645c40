// SPDX-License-Identifier: Apache-2.0
#pragma once

// Lines and figures of the report for people.

#include "core/text_stream.h"

#include "vdb_shell/report/report.h"

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

/// Numbers are in the classic locale: a program that uses the library may have set another, which
/// would put separators into them. Significant digits, so that lengths of any unit can be read.
/// Whole numbers come out whole, whatever the digits.
template <typename T> std::string number(T value, int digits = 4)
{
    OutText out;
    out.imbue(std::locale::classic());
    out << std::setprecision(digits) << value;
    return out.str();
}

/// Fixed decimals, since most fills are close to 1 and differ in the last ones.
inline std::string percent(double share)
{
    OutText out;
    out.imbue(std::locale::classic());
    out << std::fixed << std::setprecision(2) << 100.0 * share << " %";
    return out.str();
}

/// Three of the seven figures: the ends, where trouble shows, and what is usual. The mean and the
/// percentiles are in the JSON.
inline std::string spread(const Spread& values)
{
    return "min " + number(values.min) + ", median " + number(values.median) + ", max " +
           number(values.max);
}

} // namespace vdb_shell
