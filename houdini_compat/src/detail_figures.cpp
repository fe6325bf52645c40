// SPDX-License-Identifier: Apache-2.0

// Takes texts, counts and a report, gives detail attributes. A report is for people, and may be of
// another version: what it does not have is left out.

#include "detail_figures.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace vdb_shell::houdini
{
namespace
{

using nlohmann::json;

/// Only figures for people can be too large; counts of elements have been bounded by
/// require_consistent.
std::int32_t as_int32(std::size_t value)
{
    constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
    return static_cast<std::int32_t>(std::min(value, kMost));
}

} // namespace

void add_text(HoudiniGeometry& geometry, const char* name, const std::string& text)
{
    geometry.detail_attributes.push_back({name, 1, "", Strings{{text}, {0}}});
}

void add_count(HoudiniGeometry& geometry, const char* name, std::size_t count)
{
    geometry.detail_attributes.push_back({name, 1, "", std::vector<std::int32_t>{as_int32(count)}});
}

void add_figures(HoudiniGeometry& geometry, const std::string& report_json)
{
    const json report = json::parse(report_json, nullptr, /*allow_exceptions=*/false);
    const auto figure = [&](const char* pointer) -> const json* {
        const json::json_pointer place(pointer);
        return !report.is_discarded() && report.contains(place) ? &report.at(place) : nullptr;
    };
    static constexpr std::array<std::array<const char*, 2>, 7> kReals{
        {{"solid_volume", "/volume/solid"},
         {"shell_volume", "/volume/shell"},
         {"fill", "/volume/fill"},
         {"covered_share", "/coverage/covered_share"},
         {"overlap_share", "/coverage/overlap_share"},
         {"min_quality", "/quality/mean_ratio/min"},
         {"median_quality", "/quality/mean_ratio/median"}}};
    for (const auto& [name, pointer] : kReals)
        if (const json* value = figure(pointer); value && value->is_number())
            geometry.detail_attributes.push_back(
                {name, 1, "", std::vector<double>{value->get<double>()}});
    static constexpr std::array<std::array<const char*, 2>, 3> kCounts{
        {{"pinned_vertices", "/prisms/pinned_vertices"},
         {"inverted_tets", "/tets/inverted"},
         {"certified", "/certificate/certified"}}};
    for (const auto& [name, pointer] : kCounts) {
        const json* value = figure(pointer);
        if (value && value->is_boolean())
            add_count(geometry, name, value->get<bool>() ? 1 : 0);
        else if (value && value->is_number_unsigned())
            add_count(geometry, name, value->get<std::size_t>());
    }
}

} // namespace vdb_shell::houdini
