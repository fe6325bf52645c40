// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/lines.h"

#include "shell/grow/candidates.h"
#include "shell/grow/sweep.h"

#include <algorithm>

namespace vdb_shell::growth
{
namespace
{

// Shares of the diagonal.
constexpr double kFirstStep = 2e-3;
constexpr double kMostStep = 1e-2;
constexpr double kLeastStep = 2e-4; ///< below it a vertex sleeps
constexpr int kMostRounds = 400;

struct Lines {
    std::vector<double> length, step;
};

bool awake(const GrowState& s, const Lines& lines, int v)
{
    return !s.pinned[v] && lines.step[v] >= kLeastStep * s.diagonal && lines.length[v] < s.cap[v];
}

double next_length(const GrowState& s, const Lines& lines, int v)
{
    return std::min(lines.length[v] + lines.step[v], s.cap[v]);
}

/// Notes what the sweep did; returns the number of vertices still awake.
int update_steps(const GrowState& s, const std::vector<std::uint8_t>& moved, Lines& lines)
{
    int awake_count = 0;
    for (int v = 0; v < s.mesh->vertices; ++v) {
        if (!awake(s, lines, v))
            continue;
        if (moved[v])
            lines.length[v] = next_length(s, lines, v);
        lines.step[v] =
            moved[v] ? std::min(2 * lines.step[v], kMostStep * s.diagonal) : 0.5 * lines.step[v];
        awake_count += awake(s, lines, v);
    }
    return awake_count;
}

} // namespace

void lengthen_lines(GrowState& s, const Directions& directions, const StageProgress& progress)
{
    Lines lines{std::vector<double>(s.b.size()),
                std::vector<double>(s.b.size(), kFirstStep * s.diagonal)};
    for (int v = 0; v < s.mesh->vertices; ++v)
        lines.length[v] = (s.b[v] - s.a[v]).length();
    SweepScratch scratch;
    int awake_count = s.mesh->vertices;
    for (int round = 0; awake_count > 0 && round < kMostRounds; ++round) {
        progress.stop_if_interrupted(0);
        for (int v = 0; v < s.mesh->vertices; ++v)
            s.reach[v] = awake(s, lines, v) ? 1.01 * lines.step[v] + s.rounding : 0;
        rebuild_candidates(s);
        sweep(s, scratch, [&](int v, Vec3d& x) {
            if (!awake(s, lines, v))
                return false;
            x = end_within_cap(s, v, directions.inward[v], next_length(s, lines, v));
            return move_allowed(s, v, x);
        });
        awake_count = update_steps(s, scratch.moved, lines);
    }
}

} // namespace vdb_shell::growth
