// SPDX-License-Identifier: Apache-2.0
#pragma once

// Every number that steers growth, by the phase that reads it. None of them bears on validity: each
// accepted state passes the exact tests whatever stands here (docs/theory.md, "Growth"). They
// decide how thick the shell gets and how long that takes. docs/growth.md has what halving and
// doubling does, on two halves of the meshes: one to choose a value on, one to check it on.
//
// Units: "share of the solid" is a volume over that of the solid to fill; "share of the diagonal"
// a length over the diagonal of the surface's bounding box; "mean tets" a volume over the mean
// volume that a tet would have if the solid were full.

#include <cstddef>

namespace vdb_shell
{

/// Initialise: directions, first lengths, and a valid start.
struct InitialSchedule {
    /// Cosine. A direction whose visibility is not above this is replaced by the most visible one,
    /// for a pillar along it would be held at once.
    double poor_visibility = 0.02;
    /// Count. Passes of bilateral smoothing over the directions.
    int smoothing_passes = 8;
    /// Cosine. A neighbour whose direction is further off than this angle (60 degrees) has no part
    /// in the smoothing, so that the faces of a machined solid keep their own directions.
    double smoothing_cosine = 0.5;
    /// Cosine, and share of the visibility before smoothing: a smoothed direction is taken if its
    /// visibility is not below the smaller of the two.
    double kept_visibility = 0.3, kept_visibility_share = 0.5;
    /// Share of the first lengths to try: a little short of where two fronts would touch.
    double share_of_half_ray = 0.98;
    /// Share of the smallest altitude around a vertex: the length of a thin start.
    double thin_share = 0.02;
    /// Factor on the length of the pillars of a prism that fails a test, until it passes.
    double shrink_factor = 0.65;
};

/// Initialise: directions that make the quads of prisms planar, for a start from these. What they
/// are chosen by is squares of numbers without a unit: how bent each quad is, 1 where a tet of its
/// prism would be flat, and what follows.
struct PlanarSchedule {
    /// Weight of how far the inner triangle is from where it would be parallel, over its depth.
    double parallel_weight = 10;
    /// Weight of how far the pillar is from where it was, over its depth: little, so that one is
    /// the best where many are as good.
    double staying_weight = 1e-3;
    /// Count. Rounds of Newton's method with a linear problem each, and steps of conjugate
    /// gradients in one: on plates of needles three rounds are enough, on other parts up to ten.
    int most_rounds = 20, most_steps = 300;
    /// Share of the sum of squares that a round has to win for another to follow.
    double least_gain = 1e-3;
    /// Cosine, and share of the visibility before: directions below the smaller of the two are left
    /// as they were.
    double least_visibility = 0.05, kept_visibility_share = 0.5;
};

/// All phases again, from the fullest shell that they have come to.
struct RestartSchedule {
    /// Share of what is still empty that one has to win for another to follow.
    double least_gain_of_void = 0.05;
    /// Count. Restarts at most: machined parts have come to eight (docs/measurements/tried.md).
    int most = 12;
    /// Share of the solid, and count. A first shell as full as that has restarts before any other
    /// start is tried, while so many more of them, each as good as the last, would be enough: a
    /// restart takes half of a start's time (docs/measurements/tried.md).
    double before_others_from = 0.95;
    int most_before_others = 3;
    /// BarrierSchedule::weight_decrease and TrustRadiusSchedule::factor_on_move in a restart: both
    /// slower and farther than at first, for a third less void in as much time
    /// (docs/measurements/tried.md).
    double weight_decrease = 0.8, factor_on_move = 1.5;
    /// Share of the solid that is enough on a surface of more than most_coarsest_triangles, where
    /// one takes about as long as all before; from one_round_triangles on there is none
    /// (MultilevelSchedule). Scans are fuller than that (docs/measurements/scans.md).
    double large_enough = 0.97;
};

/// Initialise: pillars lengthened along their lines.
struct LineSchedule {
    /// Shares of the solid. Below the first the start is thin and lines go first, since free moves
    /// alone get stuck; above the second the inner surface has collapsed in one direction at least,
    /// and lines finish that sooner. In between lines are left out.
    double thin_start = 0.3, nearly_full = 0.9;
    /// Share of the solid that a round has to win for another to follow, where free moves come
    /// after the lines.
    double least_gain = 3e-3;
    /// Shares of the diagonal: a vertex's first step, its longest, and the one below which it is
    /// tried no more.
    double first_step = 1e-3, longest_step = 1e-2, shortest_step = 2e-4;
    /// Count. Rounds at most: a bound for termination that no mesh tried has reached.
    int most_rounds = 400;
    /// Count. Rounds before least_gain is asked for, while the steps find their length.
    int first_rounds = 3;
    /// Share of the way to the first separating plane that a step goes: some room is left for the
    /// vertices on its other side.
    double share_of_room = 0.9;
};

/// Initialise and relax: pinned vertices given a pillar.
struct PinSchedule {
    /// Count. Lengths tried for a pinned vertex, each half the one before.
    int lengths = 16;
    /// Share of the diagonal: the longest that is tried.
    double longest = 0.05;
    /// Share of a pillar near a pinned vertex that is left of it at least, where it is shortened
    /// because it leaves the vertex no direction.
    double shortest_share = 1e-3;
    /// Share. A direction that sees the worst tet at this share of the cosine to the worst of the
    /// surface's own triangles is as good as any: what fails then does not fail for the neighbours.
    double share_of_visibility = 0.5;
};

/// Prolongate: which coarser surfaces growth begins on, and the rounds on them.
struct MultilevelSchedule {
    /// Triangles of the coarsest surface, about.
    double coarsest_triangles = 1200;
    /// Triangles up to which a surface may be the coarsest where the next one would cross itself:
    /// growth from lines costs by the triangle, and more of them than a crossing does harm.
    double most_coarsest_triangles = 12000;
    /// Ratio of triangles between one surface and the next at most. Mending loses less on each the
    /// smaller the step is.
    double greatest_ratio = 4;
    /// Rounds on a coarse surface end once the barrier weight (mean tets) is below the first and a
    /// round has won no more than the second (share of what is still empty).
    double end_weight = 0.004, end_gain_of_void = 0.2;
    /// Factor on the barrier weight in each round: on the coarsest surface, and on those after it.
    double coarsest_weight_decrease = 0.5, weight_decrease = 0.35;
    /// The first barrier weight after a prolongation, in mean tets over the share of the solid that
    /// is still empty. Twice this where the user asked for more than the default.
    double first_weight_over_void = 0.5;
    /// A surface of so many triangles or more gets one round after a prolongation, one of n times
    /// fewer n^2.
    double one_round_triangles = 50000;
    /// Share of the solid, and of what is still empty: while a prolonged shell is less full than
    /// the first, rounds go on as long as one wins more than the second
    /// (docs/measurements/scans.md).
    double wanted_fill = 0.9855, wanted_gain_of_void = 0.02;
    /// Cost of all rounds on one coarse surface, where a round on the whole surface costs 1.
    double cost_share = 1.0 / 3;
    /// Share of the coarse surface's diagonal: the nearest point on it is found to within this.
    float nearest_tolerance = 1e-4F;
    /// Count. Passes that make prolonged inner points fair, over about half a coarse edge.
    int fair_passes = 3;
    /// Share of the void that is enough on the whole surface: what is enough on a coarser one.
    double level_void_share = 0.75;
    /// Cosine. A prolonged pillar whose visibility is not above this gives way to the line.
    double least_visibility = 0.05;
};

/// Prolongate: a prolonged shell made valid, first by moves, then by shortening.
struct MendSchedule {
    /// Shares of a failing pillar that shortening takes away: at first, and at most.
    double first_cut = 0.01, greatest_cut = 0.7;
    /// Factor on the share from one round to the next: while there are moves, and afterwards.
    double cut_growth = 2, last_cut_growth = 2;
    /// Count. Rounds that move inner points before they shorten; after these only shortening is
    /// left, which terminates.
    int moving_rounds = 8;
    /// Counts. Sweeps of moves in the first such round and in the others.
    int first_sweeps = 12, sweeps = 5;
    /// Shares of the shortest inner edge at a vertex: the distance that a move seeks to each plane
    /// of its tets, and the longest move of one sweep.
    double room = 0.1, longest_move = 1.0;
    /// The same two, in roundings of a coordinate: below that float32 cannot tell.
    double room_in_roundings = 4, longest_move_in_roundings = 20;
    /// Weight of staying in place, where each unmet plane has weight 1, in all directions and along
    /// the normal of the inner surface besides: a move along the surface loses no thickness.
    double weight_of_staying = 1.0, weight_of_staying_across = 10.0;
    /// Count. Gauss-Newton steps for one vertex.
    int newton_steps = 6;
    /// Share of what is empty, over the number of vertices: what a point has to have lost to be put
    /// back. Half of it: an eighth more time for mending, as much fill
    /// (docs/measurements/scans.md).
    double least_loss = 1;
    /// Count. Lengths tried on the way back, each half the one before.
    int tries_back = 4;
};

/// Prolongate: the inner points of many vertices moved at once, after mending.
struct GroupSchedule {
    /// Square roots of the area that a group moves: the longest step.
    double radius = 2.5;
    /// Mean tets. Weight of the barrier.
    double barrier_weight = 0.02;
    /// Shares of what is empty, over the number of groups: what has to lie before a group for it to
    /// be tried, and what a step of it has to win. A quarter of the first: the whole command takes
    /// up to an eighth longer for the same fill (docs/measurements/scans.md).
    double least_void = 8, least_gain = 0.05;
    /// Count. Sweeps over all groups; after the first only those beside a change.
    int sweeps = 2;
    /// Share of the solid that has to be empty for groups to be moved at all.
    double least_void_of_solid = 0.01;
    /// Counts. How often planes are put before what a step would meet, and lengths tried, each half
    /// the one before.
    int cuts = 6, halvings = 5;
};

/// Relax: the interior-point method of all inner vertices.
struct BarrierSchedule {
    /// Mean tets. First barrier weight from lines, where a large one spreads the inner vertices,
    /// and under the three-tet test after rounds under the twelve-tet test, where it would undo
    /// what is reached.
    double first_weight = 1.0, first_weight_three = 0.02;
    /// First barrier weight at most, over the share of the solid that is still empty: a barrier
    /// that weighs more than what there is to win undoes what is reached.
    double most_weight_over_void = 7;
    /// Mean tets. The smallest barrier weight.
    double least_weight = 1e-3;
    /// Factor on the barrier weight in each round, from lines and under Method::thickest; the
    /// slower, the thicker and the longer.
    double weight_decrease = 0.65, weight_decrease_thickest = 0.72;
    /// The same after a prolongation, where most is done already.
    double weight_decrease_prolonged = 0.4, weight_decrease_thickest_prolonged = 0.6;
    /// The same in a round that won less than stale_gain (share of the solid) with the weight below
    /// settled_weight.
    double weight_decrease_stale = 0.3, stale_gain = 5e-4;
    /// Mean tets. Above it a round may lose volume, because the barrier undoes jams of vertices.
    double settled_weight = 0.05;
    /// Share of the solid that a round has to win at the smallest barrier weight for another to
    /// follow, and under Method::thickest.
    double least_gain = 3e-4, least_gain_thickest = 1e-4;
    /// Share of the solid from which no round follows.
    double enough_fill = 0.998;
    /// Count. Rounds at most, and those under the twelve-tet test before the three-tet one, of
    /// which there are none after a prolongation.
    int most_rounds = 40, twelve_rounds_before_three = 25;
    /// Count. Sweeps in a round; before each but the first the separating planes are recentred.
    int sweeps = 2;
    /// Weight of all near separating planes of a vertex together, where one tet has weight 1.
    float planes_weight = 4;
    /// Share of the trust radius within which a separating plane is a barrier; farther ones only
    /// stop a move.
    double plane_range = 0.8;
    /// Factor on the thickness bound for the barrier's ball, so that a vertex on the bound has room
    /// on every side.
    double cap_factor = 1.02;
    /// Count. Lengths tried for a move, each half the one before.
    int halvings = 5;
    /// Share of the diagonal: a shorter move is not tried.
    double shortest_move = 1e-6;
};

/// Relax: how far a vertex may go in one round. A longer radius needs more separating planes, and
/// they are dearer than all else.
struct TrustRadiusSchedule {
    /// Share of the mean outer edge at a vertex: its first radius at most.
    double first_edge_share = 0.3;
    /// Share of the solid. From a start as full as that first radii are short; in a restart, after
    /// a prolongation and on a large surface (GrowOptions::coarse_from) they are wherever a void
    /// is to be filled: there most vertices move less, and long ones take up to ten times the
    /// planes (docs/measurements/tried.md, "Short first radii").
    double short_from_fill = 0.9;
    /// Share of that first radius, and shortest inner edges: the short ones.
    double short_first_share = 0.45, short_first_inner_edges = 3;
    /// Factor on the length of a vertex's move in one round: its radius for the next.
    double factor_on_move = 1.1;
    /// Share of its radius that a vertex keeps for the next round at least.
    double kept_share = 0.6;
    /// Shares of the diagonal: the shortest and the longest radius.
    double shortest = 1e-4, longest = 0.05;
};

/// Relax: which vertices take part in a round.
struct ActiveSetSchedule {
    /// A vertex rests in a round when it has moved less than this in more than `patience` rounds
    /// running: the larger of a share of the diagonal and a share of its pillar. It takes part
    /// again in one round out of `period`.
    double resting_move = 3e-5, resting_pillar_share = 3e-3;
    int patience = 1, period = 4;
    /// Share of the solid. After a prolongation a vertex is active when it, or a neighbour, has won
    /// more than this in the round before: what it costs to try, on a surface of full_size vertices
    /// or more; less in proportion on a smaller one.
    double gain_per_vertex = 1e-6, full_size = 6500;
    /// Share of what is still empty, over all vertices: the same while a shell is less full than
    /// MultilevelSchedule::wanted_fill.
    double gain_of_void = 0.25;
    /// Share of the solid over all vertices: the same from lines.
    double gain_of_all = 3e-4;
    /// The same for Method::thickest after a prolongation. A third of it: a tenth more time and
    /// .0004 more fill on the scan boot.
    double gain_of_all_thickest = 1e-3;
    /// Share of that gain that all active vertices have to win on average for another round.
    double gain_share_to_go_on = 0.46;
    /// Share of that gain that keeps a vertex active from one sweep to the next.
    double gain_share_in_round = 0.3;
};

/// Improve: inner vertices moved for better tets, when GrowOptions::min_quality asks for it.
struct QualitySchedule {
    /// Counts. Rounds at most, sweeps in each, and lengths tried for a move.
    int most_rounds = 60, sweeps = 3, halvings = 7;
    /// Share of a vertex's shortfall that a move has to take away.
    double least_gain = 1e-3;
    /// Share of the whole shortfall that a round has to take away for another to follow.
    double least_gain_of_round = 2e-3;
    /// Share of the mean outer edge at a vertex: its trust radius.
    double radius_edge_share = 0.3;
    /// Share of what is left of the trust radius that one move may use.
    double share_of_radius = 0.9;
    /// Count. Passes over all diagonals at most.
    int diagonal_passes = 20;
};

/// Improve: what holds each vertex at the end, for the report.
struct StopSchedule {
    /// Share of the diagonal: the step along its pillar that a vertex is asked to make.
    double step = 1e-3;
    /// Share of the thickness bound: a pillar this close to it is held by it, for rounding stops
    /// short of the bound.
    double at_cap = 1e-6;
};

struct GrowthSchedule {
    InitialSchedule initial;
    PlanarSchedule planar;
    RestartSchedule restarts;
    LineSchedule lines;
    PinSchedule pins;
    MultilevelSchedule multilevel;
    MendSchedule mend;
    GroupSchedule groups;
    BarrierSchedule barrier;
    TrustRadiusSchedule radius;
    ActiveSetSchedule active;
    QualitySchedule quality;
    StopSchedule stops;
};

} // namespace vdb_shell
