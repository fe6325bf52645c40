// SPDX-License-Identifier: Apache-2.0

#include "volume/ramp.h"

#include "vdb_shell/core/error.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace vdb_shell
{
namespace
{

/// By from_chars, which does not ask the locale: a decimal comma would be a separator here.
double number_of(const std::string& word, const std::string& where)
{
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
        throw InvalidOption(where + ": \"" + word + "\" is no number");
    return value;
}

} // namespace

std::vector<std::string> split_at(char separator, const std::string& text)
{
    std::vector<std::string> words;
    // Up to and including the end, so that a separator at the end is followed by an empty word:
    // "a," is two words, and an empty text one. Both are refused by who reads the words.
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(separator, begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return words;
}

double Ramp::at(double place) const
{
    if (place <= knots.front().first)
        return knots.front().second;
    for (std::size_t i = 1; i < knots.size(); ++i)
        if (place <= knots[i].first) {
            const auto &low = knots[i - 1], &high = knots[i];
            const double share = (place - low.first) / (high.first - low.first);
            return low.second + share * (high.second - low.second);
        }
    return knots.back().second;
}

Ramp ramp_of(const std::string& text, const std::string& name)
{
    Ramp ramp;
    for (const std::string& word : split_at(',', text)) {
        const std::vector<std::string> parts = split_at(':', word);
        if (parts.size() != 2)
            throw InvalidOption(
                std::string(name).append(": \"").append(word).append("\" is no place:value"));
        ramp.knots.emplace_back(number_of(parts[0], name), number_of(parts[1], name));
        if (ramp.knots.size() > 1 &&
            // Equal places are refused too: Ramp::at divides by the difference.
            !(ramp.knots[ramp.knots.size() - 2].first < ramp.knots.back().first))
            throw InvalidOption(name + ": place " + parts[0] + " is not beyond the one before it");
    }
    return ramp;
}

} // namespace vdb_shell
