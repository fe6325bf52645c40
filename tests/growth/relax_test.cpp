// SPDX-License-Identifier: Apache-2.0
#include "growth/relax.h"

#include "growth/half_full_sphere.h"
#include "growth/move_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace
{

using namespace vdb_shell;
using namespace vdb_shell::growth;

struct HalfFull : test::HalfFullSphere {
    explicit HalfFull(double cap = test::kInfinity) : HalfFullSphere(0, 7, cap) {}

    /// How many rounds there were.
    int relax_with(const RelaxOptions& relax_options)
    {
        GrowReport report;
        relax(s, std::vector<double>(s.b.size(), 1.0), GrowOptions{}, relax_options,
              StageProgress(nullptr, "test"), report);
        return int(report.rounds);
    }
};

/// One or more rounds with a light barrier, in which only vertices that win something are active.
RelaxOptions by_gain(int rounds, std::vector<double> predicted_gain)
{
    RelaxOptions relax;
    relax.most_rounds = rounds;
    relax.first_weight = 0.01;
    relax.weight_decrease = 0.5;
    relax.active_gain = 1e-3;
    relax.predicted_gain = std::move(predicted_gain);
    return relax;
}

TEST(Relax, MovesOnlyVerticesThatAreToWinAndThoseBeside)
{
    HalfFull sphere;
    const std::vector<Vec3d> before = sphere.s.b;
    const int winner = 100;
    std::vector<double> gain(before.size(), 0.0);
    gain[winner] = 1.0;
    sphere.relax_with(by_gain(1, gain));
    int moved = 0;
    for (int v = 0; v < sphere.s.mesh->vertices; ++v) {
        if (sphere.s.b[v] == before[v])
            continue;
        ++moved;
        const Slice<int> around = neighbours(*sphere.s.mesh, v);
        EXPECT_TRUE(v == winner || std::find(around.begin(), around.end(), winner) != around.end())
            << v;
    }
    EXPECT_GT(moved, 3);
}

TEST(Relax, WithoutPredictedGainsAllVerticesAreActive)
{
    HalfFull sphere;
    const std::vector<Vec3d> before = sphere.s.b;
    sphere.relax_with(by_gain(1, {}));
    for (std::size_t v = 0; v < before.size(); ++v)
        EXPECT_NE(sphere.s.b[v], before[v]) << v;
}

TEST(Relax, EndsWhenNoVertexIsToWin)
{
    HalfFull sphere;
    const std::vector<Vec3d> before = sphere.s.b;
    RelaxOptions relax = by_gain(40, std::vector<double>(before.size(), 0.0));
    relax.least_gain_per_vertex = 1e-6;
    sphere.relax_with(relax);
    EXPECT_EQ(sphere.s.b, before);
}

/// Three rounds of all vertices, which win much.
RelaxOptions winning(double weight_decrease, bool keep_weight)
{
    RelaxOptions relax;
    relax.most_rounds = 3;
    relax.first_weight = 0.1;
    relax.weight_decrease = weight_decrease;
    relax.keep_weight = keep_weight;
    return relax;
}

TEST(Relax, KeepsTheWeightWhileRoundsLikeTheLastWouldFillAll)
{
    HalfFull kept, fixed, falling;
    kept.relax_with(winning(0.5, true));
    fixed.relax_with(winning(1.0, false));
    falling.relax_with(winning(0.5, false));
    constexpr double kVoid = 0.125;
    ASSERT_GT(fill_of(fixed.s), 1 - kVoid + 3 * kVoid / 40) << "rounds win a fortieth and more";
    EXPECT_EQ(kept.s.b, fixed.s.b);
    EXPECT_NE(kept.s.b, falling.s.b);
}

TEST(Relax, LowersTheWeightOnceRoundsWinTooLittleForThat)
{
    HalfFull kept, falling;
    for (HalfFull* sphere : {&kept, &falling})
        sphere->s.schedule.barrier.most_rounds = 1;
    kept.relax_with(winning(0.5, true));
    falling.relax_with(winning(0.5, false));
    EXPECT_EQ(kept.s.b, falling.s.b);
}

/// Rounds that come to rest on a bound of the thickness.
struct Bounded : HalfFull {
    Bounded() : HalfFull(0.6) {}
};

RelaxOptions to_beat(double fill)
{
    RelaxOptions relax;
    relax.most_rounds = 40;
    relax.first_weight = 1e-3;
    relax.weight_decrease = 1;
    relax.least_gain = -1; // all the rounds, whatever they win
    relax.fill_to_beat = fill;
    return relax;
}

TEST(Relax, EndsWhereTheRoundsThatAreLeftCannotBeatAnotherShell)
{
    Bounded alone, beside_a_fuller;
    const int rounds = alone.relax_with(to_beat(0));
    const double fuller = 0.5 * (1 + fill_of(alone.s));
    EXPECT_LT(beside_a_fuller.relax_with(to_beat(fuller)), rounds);
    constexpr double kAtBound = 1 - 0.4 * 0.4 * 0.4;
    EXPECT_GT(fill_of(beside_a_fuller.s), kAtBound - 0.01) << "while it could, it went on";
    EXPECT_LT(fill_of(beside_a_fuller.s), fuller);
}

TEST(Relax, IsTheSameBesideAShellThatItBeats)
{
    Bounded alone, beside_a_thinner;
    alone.relax_with(to_beat(0));
    beside_a_thinner.relax_with(to_beat(fill_of(alone.s) - 0.01));
    EXPECT_EQ(beside_a_thinner.s.b, alone.s.b);
}

RelaxOptions wanting(double fill, std::vector<double> predicted_gain)
{
    RelaxOptions relax = by_gain(1, std::move(predicted_gain));
    relax.wanted_fill = fill;
    relax.wanted_gain_of_void = 0.02;
    relax.wanted_active_gain_of_void = 0.25;
    return relax;
}

TEST(Relax, RoundsGoOnUntilTheShellIsAsFullAsWantedAndNoLonger)
{
    HalfFull once, some, more;
    EXPECT_EQ(once.relax_with(wanting(0.0, {})), 1);
    const double wanted = 0.99, wanted_more = 0.997;
    ASSERT_LT(fill_of(once.s), wanted);
    const int rounds = some.relax_with(wanting(wanted, {}));
    EXPECT_GE(fill_of(some.s), wanted);
    EXPECT_GT(more.relax_with(wanting(wanted_more, {})), rounds);
    EXPECT_GE(fill_of(more.s), wanted_more);
    HalfFull before_the_last;
    RelaxOptions fewer = wanting(0.0, {});
    fewer.most_rounds = rounds - 1;
    fewer.active_gain = 0;
    before_the_last.relax_with(fewer);
    EXPECT_LT(fill_of(before_the_last.s), wanted) << "the last round was needed";
}

TEST(Relax, WhereTheActiveOnesWinLittleAllAreActiveOnceMore)
{
    HalfFull sphere;
    const double before = fill_of(sphere.s);
    const std::vector<double> none(sphere.s.b.size(), 0.0);
    EXPECT_GT(sphere.relax_with(wanting(0.95, none)), 1) << "in the first none was active";
    EXPECT_GT(fill_of(sphere.s), before);
}

} // namespace
