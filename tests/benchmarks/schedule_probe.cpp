// SPDX-License-Identifier: Apache-2.0

// What each number of GrowthSchedule is good for: grows the shells of meshes with one number halved
// or doubled, the others as they are.
//
//   schedule_probe [--only NAME,...] [--largest TRIANGLES] MESH...
//
// Left out are the numbers that growth does not read with its defaults: those of Method::thickest,
// of min_quality, and of the report of stops. One line a shell: mesh, triangles, name of the number
// ("default" first), factor, fill, seconds of CPU time, separated by tabs. Meshes of more triangles
// than --largest (15,000) have the first line alone. docs/scripts/schedule.py makes the tables of
// docs/growth.md from it.

#include <vdb_shell/io/read_mesh.h>
#include <vdb_shell/pipeline.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <iostream>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

using namespace vdb_shell;

namespace
{

struct Number {
    const char* name;
    void (*multiply)(GrowthSchedule&, double factor);
};

/// Counts are rounded, and at least 1. A share below 1 goes no farther than halfway to 1: at 1 some
/// phases would not end.
template <auto Group, auto Member> void multiply(GrowthSchedule& schedule, double factor)
{
    auto& value = schedule.*Group.*Member;
    using T = std::remove_reference_t<decltype(value)>;
    if constexpr (std::is_integral_v<T>)
        value = std::max(T{1}, static_cast<T>(std::lround(factor * value)));
    else
        value = value < T{1} ? std::min(static_cast<T>(factor * value), (1 + value) / 2)
                             : static_cast<T>(factor * value);
}

#define VDB_SHELL_NUMBER(group, Type, member)                                                      \
    Number                                                                                         \
    {                                                                                              \
#group "." #member, multiply < &GrowthSchedule::group, &Type::member>                      \
    }

const Number kNumbers[] = {
    VDB_SHELL_NUMBER(initial, InitialSchedule, poor_visibility),
    VDB_SHELL_NUMBER(initial, InitialSchedule, smoothing_passes),
    VDB_SHELL_NUMBER(initial, InitialSchedule, smoothing_cosine),
    VDB_SHELL_NUMBER(initial, InitialSchedule, kept_visibility),
    VDB_SHELL_NUMBER(initial, InitialSchedule, kept_visibility_share),
    VDB_SHELL_NUMBER(initial, InitialSchedule, share_of_half_ray),
    VDB_SHELL_NUMBER(initial, InitialSchedule, thin_share),
    VDB_SHELL_NUMBER(initial, InitialSchedule, shrink_factor),
    VDB_SHELL_NUMBER(planar, PlanarSchedule, parallel_weight),
    VDB_SHELL_NUMBER(planar, PlanarSchedule, staying_weight),
    VDB_SHELL_NUMBER(planar, PlanarSchedule, most_rounds),
    VDB_SHELL_NUMBER(planar, PlanarSchedule, most_steps),
    VDB_SHELL_NUMBER(planar, PlanarSchedule, least_gain),
    VDB_SHELL_NUMBER(planar, PlanarSchedule, least_visibility),
    VDB_SHELL_NUMBER(planar, PlanarSchedule, kept_visibility_share),
    VDB_SHELL_NUMBER(restarts, RestartSchedule, least_gain_of_void),
    VDB_SHELL_NUMBER(restarts, RestartSchedule, most),
    VDB_SHELL_NUMBER(restarts, RestartSchedule, before_others_from),
    VDB_SHELL_NUMBER(restarts, RestartSchedule, most_before_others),
    VDB_SHELL_NUMBER(restarts, RestartSchedule, weight_decrease),
    VDB_SHELL_NUMBER(restarts, RestartSchedule, factor_on_move),
    VDB_SHELL_NUMBER(restarts, RestartSchedule, large_enough),
    VDB_SHELL_NUMBER(lines, LineSchedule, thin_start),
    VDB_SHELL_NUMBER(lines, LineSchedule, nearly_full),
    VDB_SHELL_NUMBER(lines, LineSchedule, least_gain),
    VDB_SHELL_NUMBER(lines, LineSchedule, first_step),
    VDB_SHELL_NUMBER(lines, LineSchedule, longest_step),
    VDB_SHELL_NUMBER(lines, LineSchedule, shortest_step),
    VDB_SHELL_NUMBER(lines, LineSchedule, most_rounds),
    VDB_SHELL_NUMBER(lines, LineSchedule, first_rounds),
    VDB_SHELL_NUMBER(lines, LineSchedule, share_of_room),
    VDB_SHELL_NUMBER(pins, PinSchedule, lengths),
    VDB_SHELL_NUMBER(pins, PinSchedule, longest),
    VDB_SHELL_NUMBER(pins, PinSchedule, shortest_share),
    VDB_SHELL_NUMBER(pins, PinSchedule, share_of_visibility),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, coarsest_triangles),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, most_coarsest_triangles),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, greatest_ratio),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, end_weight),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, end_gain_of_void),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, wanted_fill),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, wanted_gain_of_void),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, coarsest_weight_decrease),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, weight_decrease),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, first_weight_over_void),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, one_round_triangles),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, cost_share),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, nearest_tolerance),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, fair_passes),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, level_void_share),
    VDB_SHELL_NUMBER(multilevel, MultilevelSchedule, least_visibility),
    VDB_SHELL_NUMBER(mend, MendSchedule, first_cut),
    VDB_SHELL_NUMBER(mend, MendSchedule, greatest_cut),
    VDB_SHELL_NUMBER(mend, MendSchedule, cut_growth),
    VDB_SHELL_NUMBER(mend, MendSchedule, last_cut_growth),
    VDB_SHELL_NUMBER(mend, MendSchedule, moving_rounds),
    VDB_SHELL_NUMBER(mend, MendSchedule, first_sweeps),
    VDB_SHELL_NUMBER(mend, MendSchedule, sweeps),
    VDB_SHELL_NUMBER(mend, MendSchedule, room),
    VDB_SHELL_NUMBER(mend, MendSchedule, longest_move),
    VDB_SHELL_NUMBER(mend, MendSchedule, room_in_roundings),
    VDB_SHELL_NUMBER(mend, MendSchedule, longest_move_in_roundings),
    VDB_SHELL_NUMBER(mend, MendSchedule, weight_of_staying),
    VDB_SHELL_NUMBER(mend, MendSchedule, weight_of_staying_across),
    VDB_SHELL_NUMBER(mend, MendSchedule, newton_steps),
    VDB_SHELL_NUMBER(mend, MendSchedule, least_loss),
    VDB_SHELL_NUMBER(mend, MendSchedule, tries_back),
    VDB_SHELL_NUMBER(groups, GroupSchedule, radius),
    VDB_SHELL_NUMBER(groups, GroupSchedule, barrier_weight),
    VDB_SHELL_NUMBER(groups, GroupSchedule, least_void),
    VDB_SHELL_NUMBER(groups, GroupSchedule, least_gain),
    VDB_SHELL_NUMBER(groups, GroupSchedule, sweeps),
    VDB_SHELL_NUMBER(groups, GroupSchedule, least_void_of_solid),
    VDB_SHELL_NUMBER(groups, GroupSchedule, cuts),
    VDB_SHELL_NUMBER(groups, GroupSchedule, halvings),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, first_weight),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, first_weight_three),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, most_weight_over_void),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, least_weight),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, weight_decrease),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, weight_decrease_prolonged),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, weight_decrease_stale),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, stale_gain),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, settled_weight),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, least_gain),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, enough_fill),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, most_rounds),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, twelve_rounds_before_three),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, weight_decrease_thickest_prolonged),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, sweeps),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, planes_weight),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, plane_range),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, cap_factor),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, halvings),
    VDB_SHELL_NUMBER(barrier, BarrierSchedule, shortest_move),
    VDB_SHELL_NUMBER(radius, TrustRadiusSchedule, first_edge_share),
    VDB_SHELL_NUMBER(radius, TrustRadiusSchedule, short_from_fill),
    VDB_SHELL_NUMBER(radius, TrustRadiusSchedule, short_first_share),
    VDB_SHELL_NUMBER(radius, TrustRadiusSchedule, short_first_inner_edges),
    VDB_SHELL_NUMBER(radius, TrustRadiusSchedule, factor_on_move),
    VDB_SHELL_NUMBER(radius, TrustRadiusSchedule, kept_share),
    VDB_SHELL_NUMBER(radius, TrustRadiusSchedule, shortest),
    VDB_SHELL_NUMBER(radius, TrustRadiusSchedule, longest),
    VDB_SHELL_NUMBER(active, ActiveSetSchedule, resting_move),
    VDB_SHELL_NUMBER(active, ActiveSetSchedule, resting_pillar_share),
    VDB_SHELL_NUMBER(active, ActiveSetSchedule, patience),
    VDB_SHELL_NUMBER(active, ActiveSetSchedule, period),
    VDB_SHELL_NUMBER(active, ActiveSetSchedule, gain_per_vertex),
    VDB_SHELL_NUMBER(active, ActiveSetSchedule, full_size),
    VDB_SHELL_NUMBER(active, ActiveSetSchedule, gain_of_void),
    VDB_SHELL_NUMBER(active, ActiveSetSchedule, gain_of_all),
    VDB_SHELL_NUMBER(active, ActiveSetSchedule, gain_of_all_thickest),
    VDB_SHELL_NUMBER(active, ActiveSetSchedule, gain_share_to_go_on),
    VDB_SHELL_NUMBER(active, ActiveSetSchedule, gain_share_in_round),
};

#undef VDB_SHELL_NUMBER

/// What growth is given, by the stages before it with their defaults.
struct Input {
    std::string name;
    TriangleMesh mesh;
    Directions directions;
    LineLengths lengths;
};

Input input_of(const std::filesystem::path& file)
{
    Input input{file.stem().string(), read_mesh(file.string()).mesh, {}, {}};
    const auto level_set = mesh_to_level_set(input.mesh, {});
    input.directions = compute_directions(input.mesh, *level_set, {});
    input.lengths = line_step(input.mesh, *level_set, input.directions, {});
    apply_limits(input.lengths, vertex_limits(input.mesh, input.directions, LimitOptions{}.limit));
    return input;
}

void grow(const Input& input, const char* name, double factor, const GrowthSchedule& schedule)
{
    GrowOptions options;
    options.schedule = schedule;
    const std::vector<double> no_cap(input.mesh.points.size(),
                                     std::numeric_limits<double>::infinity());
    const std::clock_t before = std::clock();
    const PrismShell shell =
        grow_shell(input.mesh, input.directions, input.lengths, no_cap, options, {}).shell;
    const double seconds = double(std::clock() - before) / CLOCKS_PER_SEC;
    const double fill = 1 - signed_volume(shell.inner, shell.triangles) /
                                signed_volume(shell.outer, shell.triangles);
    std::cout << input.name << '\t' << input.mesh.triangles.size() << '\t' << name << '\t' << factor
              << '\t' << fill << '\t' << seconds << std::endl;
}

void probe(const Input& input, const std::string& only, std::size_t largest)
{
    grow(input, "default", 1, {});
    if (input.mesh.triangles.size() > largest)
        return;
    for (const Number& number : kNumbers) {
        if (!only.empty() &&
            ("," + only + ",").find("," + std::string(number.name) + ",") == std::string::npos)
            continue;
        for (const double factor : {0.5, 2.0}) {
            GrowthSchedule schedule;
            number.multiply(schedule, factor);
            grow(input, number.name, factor, schedule);
        }
    }
}

} // namespace

int main(int argc, char** argv)
try {
    std::string only;
    std::size_t largest = 15000;
    int first = 1;
    for (; first + 1 < argc && std::string(argv[first]).rfind("--", 0) == 0; first += 2) {
        if (std::string(argv[first]) == "--only")
            only = argv[first + 1];
        else
            largest = std::strtoul(argv[first + 1], nullptr, 10);
    }
    if (first >= argc) {
        std::cerr << "usage: schedule_probe [--only NAME,...] [--largest TRIANGLES] MESH...\n";
        return 2;
    }
    for (int i = first; i < argc; ++i)
        probe(input_of(argv[i]), only, largest);
    return 0;
} catch (const std::exception& error) {
    std::cerr << "schedule_probe: " << error.what() << '\n';
    return 1;
}
