// SPDX-License-Identifier: Apache-2.0
#include "growth/lines.h"

#include "growth/sweep.h"

#include <algorithm>

namespace vdb_shell::growth
{
namespace
{

// Shares of the diagonal.
constexpr double kFirstStep = 1e-3;
constexpr double kMostStep = 1e-2;
constexpr double kLeastStep = 2e-4; ///< below it a vertex sleeps
constexpr int kMostRounds = 400;
constexpr int kFirstRounds = 3;      ///< while the steps find their length
constexpr double kShareOfRoom = 0.9; ///< to keep off the walls

struct Lines {
    std::vector<double> length, step;
};

bool awake(const GrowState& s, const Lines& lines, int v)
{
    return !s.pinned[v] && lines.step[v] >= kLeastStep * s.diagonal && lines.length[v] < s.cap[v];
}

/// The share of the way to x at which the first wall is met; may be over 1.
double room_to_walls(const Walls& w, int v, const Vec3d& b, const Vec3d& x)
{
    double room = 2;
    all_walls_of(w, v, [&](const Wall& wall, double sign) {
        const double here = sign * wall.value(b), there = sign * wall.value(x);
        if (there < here)
            room = std::min(room, here / (here - there));
        return true;
    });
    return room;
}

/// A step along the line, or as much of it as walls leave room for.
bool propose_longer(const GrowState& s, const Walls& w, const Lines& lines, const Directions& d,
                    int v, Vec3d& x)
{
    const double length = lines.length[v], step = std::min(lines.step[v], s.cap[v] - length);
    x = end_within_cap(s, v, d.inward[v], length + step);
    const double room = kShareOfRoom * room_to_walls(w, v, s.b[v], x);
    if (room < 1)
        x = end_within_cap(s, v, d.inward[v], length + room * step);
    return move_allowed_between(s, w, v, x);
}

/// Notes how far each vertex came; returns the number of vertices still awake.
int update_steps(const GrowState& s, Lines& lines)
{
    int awake_count = 0;
    for (int v = 0; v < s.mesh->vertices; ++v) {
        if (!awake(s, lines, v))
            continue;
        const double length = (s.b[v] - s.a[v]).length(), gain = length - lines.length[v];
        lines.length[v] = length;
        lines.step[v] = gain > 0.5 * lines.step[v]
                            ? std::min(2 * lines.step[v], kMostStep * s.diagonal)
                            : 0.5 * lines.step[v];
        awake_count += awake(s, lines, v);
    }
    return awake_count;
}

} // namespace

void lengthen_lines(GrowState& s, const Directions& directions, double least_gain,
                    const StageProgress& progress)
{
    Lines lines{std::vector<double>(s.b.size()),
                std::vector<double>(s.b.size(), kFirstStep * s.diagonal)};
    for (int v = 0; v < s.mesh->vertices; ++v)
        lines.length[v] = (s.b[v] - s.a[v]).length();
    Walls walls;
    std::vector<std::uint8_t> still(s.b.size());
    int awake_count = s.mesh->vertices;
    double fill = fill_of(s);
    for (int round = 0; awake_count > 0 && round < kMostRounds; ++round) {
        progress.stop_if_interrupted(0);
        for (int v = 0; v < s.mesh->vertices; ++v) {
            still[v] = !awake(s, lines, v);
            s.reach[v] = still[v] ? 0 : 1.01 * lines.step[v] + s.rounding;
        }
        raise_walls(s, still, walls);
        sweep(s, walls, still,
              [&](int v, Vec3d& x) { return propose_longer(s, walls, lines, directions, v, x); });
        awake_count = update_steps(s, lines);
        const double gain = fill_of(s) - fill;
        fill += gain;
        if (round >= kFirstRounds && gain < least_gain)
            break;
    }
}

} // namespace vdb_shell::growth
