// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace vdb_shell
{

/// The words between separators, empty ones too.
std::vector<std::string> split_at(char separator, const std::string& text);

/// A function that is linear between given places, and constant before the first and after the
/// last.
struct Ramp {
    std::vector<std::pair<double, double>> knots; ///< place and value, by ascending place

    double at(double place) const;
};

/// "0:1,0.5:0.2,1:0". Throws InvalidOption, opened by `name`, for anything else, for places that do
/// not ascend, and for an empty text.
Ramp ramp_of(const std::string& text, const std::string& name);

} // namespace vdb_shell
