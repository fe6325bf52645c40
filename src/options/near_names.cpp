// SPDX-License-Identifier: Apache-2.0

// What a misspelt option may have meant.

#include "options/near_names.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <utility>

namespace vdb_shell
{
namespace
{

constexpr std::size_t kMost = 4;
/// The name may come from a file and have any size; no option is longer.
constexpr std::size_t kLongestName = 80;

/// Letters to put in, leave out, replace or exchange with the next one: the optimal string
/// alignment distance.
std::size_t edits_between(const std::string& a, const std::string& b)
{
    // Rows of the table for all of b and the first i - 2, i - 1 and i letters of a.
    std::array<std::vector<std::size_t>, 3> row;
    row.fill(std::vector<std::size_t>(b.size() + 1));
    std::iota(row[1].begin(), row[1].end(), 0);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[2][0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = row[1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[2][j] = std::min({row[1][j] + 1, row[2][j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[2][j] = std::min(row[2][j], row[0][j - 2] + 1);
        }
        std::rotate(row.begin(), row.begin() + 1, row.end());
    }
    return row[1][b.size()];
}

/// Whether one of its words begins with that.
bool has_word(const std::string& name, const std::string& begin)
{
    for (std::size_t at = name.find(begin); at != std::string::npos; at = name.find(begin, at + 1))
        if (at == 0 || std::string("-_.").find(name[at - 1]) != std::string::npos)
            return true;
    return false;
}

} // namespace

std::vector<std::string> near_names(const std::string& name, const std::vector<std::string>& names)
{
    const std::string bare = name.substr(std::min(name.find_first_not_of('-'), name.size()));
    if (bare.empty() || bare.size() > kLongestName)
        return {};
    // A letter in three may be wrong; of shorter names everything would be near.
    const std::size_t most_edits = bare.size() / 3;
    std::vector<std::pair<std::size_t, std::string>> near;
    for (const std::string& other : names) {
        const std::size_t edits = edits_between(name, other);
        if (edits <= most_edits)
            near.emplace_back(edits, other);
        else if (bare.size() > 2 && has_word(other, bare))
            near.emplace_back(most_edits + 1, other);
    }
    std::stable_sort(near.begin(), near.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::string> nearest;
    for (std::size_t i = 0; i < std::min(near.size(), kMost); ++i)
        nearest.push_back(near[i].second);
    return nearest;
}

std::string hint_of_near(const std::string& name, const std::vector<std::string>& names)
{
    std::string hint;
    for (const std::string& near : near_names(name, names))
        hint += (hint.empty() ? "; near it: " : ", ") + near;
    return hint;
}

} // namespace vdb_shell
