// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <charconv>
#include <string>
#include <type_traits>
#include <vector>

// Values as USD's text format has them.

namespace vdb_shell
{

template <typename Integer, typename = std::enable_if_t<std::is_integral_v<Integer>>>
std::string usd_value(Integer value)
{
    return std::to_string(value);
}

inline std::string usd_value(double value)
{
    char digits[32];
    return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

/// The fewest digits that give the float again, also to a parser that goes through a double: there
/// rounding twice can end at the neighbour.
inline std::string usd_value(float value)
{
    char digits[32];
    char* const end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    double read = 0.0;
    std::from_chars(digits, end, read);
    return float(read) == value ? std::string(digits, std::size_t(end - digits))
                                : usd_value(double(value));
}

template <typename T> std::string usd_tuple(const T& value, int size)
{
    std::string text = "(";
    for (int i = 0; i < size; ++i)
        text += (i ? ", " : "") + usd_value(value[i]);
    return text + ")";
}

inline std::string usd_value(const openvdb::Vec3s& value)
{
    return usd_tuple(value, 3);
}
inline std::string usd_value(const openvdb::Vec3I& value)
{
    return usd_tuple(value, 3);
}
inline std::string usd_value(const openvdb::Vec4I& value)
{
    return usd_tuple(value, 4);
}

template <typename T> std::string usd_array(const std::vector<T>& values)
{
    std::string text = "[";
    for (std::size_t i = 0; i < values.size(); ++i)
        text += (i ? ", " : "") + usd_value(values[i]);
    return text + "]";
}

/// An asset path between its delimiters, which are longer for a path that has one in it.
inline std::string usd_asset(const std::string& path)
{
    if (path.find('@') == std::string::npos)
        return "@" + path + "@";
    std::string escaped;
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (path.compare(i, 3, "@@@") == 0) {
            escaped += "\\@@@";
            i += 2;
        } else {
            escaped += path[i];
        }
    }
    return "@@@" + escaped + "@@@";
}

} // namespace vdb_shell
