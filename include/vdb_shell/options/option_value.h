// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/name_table.h"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace vdb_shell
{

enum class OptionKind { flag, integer, count, number, choice, text };

/// A value of any option; of a choice its name. The first alternative: unset.
using OptionValue =
    std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string>;

/// How a field of type T is read and written as an OptionValue.
template <typename T> struct OptionTraits {
    static constexpr bool kMayBeUnset = false, kRepeated = false;
    static constexpr OptionKind kKind = std::is_same_v<T, bool>       ? OptionKind::flag
                                        : std::is_enum_v<T>           ? OptionKind::choice
                                        : std::is_floating_point_v<T> ? OptionKind::number
                                        : !std::is_integral_v<T>      ? OptionKind::text
                                        : std::is_signed_v<T>         ? OptionKind::integer
                                                                      : OptionKind::count;

    static std::vector<std::string> choices()
    {
        std::vector<std::string> all;
        if constexpr (std::is_enum_v<T>)
            for (const auto& entry : names(T()))
                all.push_back(entry.first);
        return all;
    }

    static double largest()
    {
        if constexpr (std::is_integral_v<T>)
            return static_cast<double>(std::numeric_limits<T>::max());
        return 0;
    }

    static OptionValue get(const T& field)
    {
        if constexpr (kKind == OptionKind::choice)
            return name_in_table(field);
        else if constexpr (kKind == OptionKind::integer)
            return std::int64_t(field);
        else if constexpr (kKind == OptionKind::count)
            return std::uint64_t(field);
        else if constexpr (std::is_same_v<T, std::filesystem::path>)
            return field.string();
        else
            return field;
    }

    static void set(const OptionValue& value, T& field)
    {
        if constexpr (kKind == OptionKind::choice) {
            for (const auto& [name, entry] : names(T()))
                if (name == std::get<std::string>(value))
                    field = entry;
        } else if constexpr (kKind == OptionKind::integer) {
            field = static_cast<T>(std::get<std::int64_t>(value));
        } else if constexpr (kKind == OptionKind::count) {
            field = static_cast<T>(std::get<std::uint64_t>(value));
        } else if constexpr (kKind == OptionKind::text) {
            field = std::get<std::string>(value);
        } else {
            field = std::get<T>(value);
        }
    }
};

template <typename T> struct OptionTraits<std::optional<T>> : OptionTraits<T> {
    static constexpr bool kMayBeUnset = true;

    static OptionValue get(const std::optional<T>& field)
    {
        return field ? OptionTraits<T>::get(*field) : OptionValue();
    }

    static void set(const OptionValue& value, std::optional<T>& field)
    {
        field.reset();
        if (!std::holds_alternative<std::monostate>(value))
            OptionTraits<T>::set(value, field.emplace());
    }
};

/// Grows by one with each value that is set; unset when empty.
template <typename T> struct OptionTraits<std::vector<T>> : OptionTraits<T> {
    static constexpr bool kRepeated = true;

    static OptionValue get(const std::vector<T>& field)
    {
        return field.empty() ? OptionValue() : OptionTraits<T>::get(field.back());
    }

    static void set(const OptionValue& value, std::vector<T>& field)
    {
        OptionTraits<T>::set(value, field.emplace_back());
    }
};

/// For a person: "-1", "0.25", "certified", "unset".
std::string text_of(const OptionValue& value);

} // namespace vdb_shell
