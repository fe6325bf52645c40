// SPDX-License-Identifier: Apache-2.0

// Takes: the ways to a shell (attempts.h), and a function that grows in one of them. Gives: the
// fullest shell, as good in all else that counts more. Sources of what is tried in which order:
// docs/measurements/tried.md, "Restarts".

#include "growth/fullest.h"

#include "core/marked.h"
#include "growth/grow_state.h"
#include "mesh/exact_volume.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace vdb_shell::growth
{
namespace
{

double fill_of(const PrismShell& shell)
{
    return 1 - signed_volume(shell.inner, shell.triangles) /
                   signed_volume(shell.outer, shell.triangles);
}

std::ptrdiff_t pins_of(const PrismShell& shell)
{
    return std::count(shell.stop.begin(), shell.stop.end(), StopReason::pinned);
}

struct Fullest {
    GrowResult result;
    double fill;
    int restarts = 0;
    double last_share = 1; ///< of what was empty, that the last of them has won
};

/// A pin costs more than the volume around it: prisms, and all that needs their pillars. So does
/// the shape that the user asks for.
void take_if_better(const Connectivity& connectivity, GrowResult other, Fullest& fullest)
{
    const double fill = fill_of(other.shell);
    if (fill > fullest.fill && pins_of(other.shell) <= pins_of(fullest.result.shell) &&
        other.report.tets_below_quality <= fullest.result.report.tets_below_quality &&
        marked(turned_components(connectivity, other.shell)).empty()) {
        fullest.result = std::move(other);
        fullest.fill = fill;
    }
}

/// Of a shell that was grown on from another: what led to that one counts too.
GrowReport reports_of_both(const GrowReport& before, GrowReport report)
{
    report.rounds += before.rounds;
    report.flips += before.flips;
    report.released += before.released;
    report.fill_after_lines = before.fill_after_lines;
    report.quality_rounds += before.quality_rounds;
    return report;
}

/// The way from the attempts to one shell.
class Growth
{
public:
    Growth(const GrowStart& start, const Connectivity& connectivity, const std::vector<double>& cap,
           const GrowOptions& options, const GrowOneWay& grow)
        : connectivity_(connectivity), cap_(cap), schedule_(options.schedule.restarts), grow_(grow),
          attempts_(attempts_of(start, connectivity.faces.size(), options)),
          restarts_(restarts_of(attempts_.front(), connectivity.faces.size()))
    {
    }

    GrowResult fullest() const
    {
        Fullest fullest{grow_(attempts_.front(), nullptr), 0};
        // Such a bound leaves a void by itself.
        if (bounds_thickness(cap_))
            return std::move(fullest.result);
        fullest.fill = fill_of(fullest.result.shell);
        const double enough = enough_for(attempts_.front());
        if (attempts_.size() > 1 && fullest.fill < enough)
            try_others(fullest, enough);
        else
            restart(fullest, kAnyNumber);
        return std::move(fullest.result);
    }

private:
    static constexpr double kAnyNumber = std::numeric_limits<double>::infinity();

    /// After restarts of the first shell, where few may be enough; and restarts of the fullest.
    void try_others(Fullest& fullest, double enough) const
    {
        // By what each has come to itself: they have had no restarts.
        Fullest other = fullest;
        if (fullest.fill >= schedule_.before_others_from)
            restart(fullest, schedule_.most_before_others);
        if (fullest.fill >= enough)
            return;
        const double first = other.fill;
        for (std::size_t i = 1; i < attempts_.size() && other.fill < enough; ++i) {
            Attempt attempt = attempts_[i];
            attempt.rounds.fill_to_beat = other.fill;
            take_if_better(connectivity_, grow_(attempt, nullptr), other);
        }
        if (other.fill > first) {
            restart(other, kAnyNumber);
            take_if_better(connectivity_, std::move(other.result), fullest);
        } else {
            restart(fullest, kAnyNumber);
        }
    }

    /// Grows on from the shell, again and again, while that wins something and so many more that
    /// win as much would be enough.
    void restart(Fullest& fullest, double more) const
    {
        const auto goes_on = [&] {
            const double left = (1 - fullest.fill) * std::pow(1 - fullest.last_share, more);
            return fullest.fill < restarts_.enough && fullest.restarts < restarts_.most &&
                   fullest.last_share >= schedule_.least_gain_of_void &&
                   left <= 1 - restarts_.enough;
        };
        for (; goes_on(); ++fullest.restarts) {
            GrowResult next = grow_(restarts_.attempt, &fullest.result);
            next.report = reports_of_both(fullest.result.report, next.report);
            const double empty = 1 - fullest.fill;
            take_if_better(connectivity_, std::move(next), fullest);
            fullest.last_share = 1 - (1 - fullest.fill) / empty;
        }
    }

    const Connectivity& connectivity_;
    const std::vector<double>& cap_;
    const RestartSchedule& schedule_;
    const GrowOneWay& grow_;
    std::vector<Attempt> attempts_;
    Restarts restarts_;
};

} // namespace

GrowResult grow_fullest(const GrowStart& start, const Connectivity& connectivity,
                        const std::vector<double>& cap, const GrowOptions& options,
                        const GrowOneWay& grow)
{
    return Growth(start, connectivity, cap, options, grow).fullest();
}

std::vector<std::uint8_t> turned_components(const Connectivity& connectivity,
                                            const PrismShell& shell)
{
    const auto signs = [&](const std::vector<openvdb::Vec3s>& points) {
        return exact::volume_signs(points, connectivity.faces, connectivity.component,
                                   connectivity.components);
    };
    const std::vector<int> outer = signs(shell.outer), inner = signs(shell.inner);
    std::vector<std::uint8_t> turned(outer.size());
    for (std::size_t c = 0; c < turned.size(); ++c)
        turned[c] = outer[c] * inner[c] < 0;
    return turned;
}

} // namespace vdb_shell::growth
