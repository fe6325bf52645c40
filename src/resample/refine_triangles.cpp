// SPDX-License-Identifier: Apache-2.0

// Takes an embedded surface and the triangles that are to be cut, most wanted first, and leaves a
// conforming, embedded surface. The rule is that of Rivara 1984, "Algorithms for refining
// triangular grids suitable for adaptive and mixed finite element techniques": no triangle is cut
// before its longest edge is, so angles stay bounded from below however many rounds there are. The
// middles are rounded to float32, by which triangles can become flat or touch; exact tests find
// these, and the edges in question are barred and all is chosen anew. Serial but for the exact
// tests, and by index, so the result is determined.

#include "vdb_shell/resample/refine_triangles.h"

#include "core/stage_progress.h"
#include "resample/edge_split.h"
#include "resample/spoiled_triangles.h"

#include <algorithm>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

/// What does not change while edges are chosen. Edges of equal length are ordered by their index,
/// so that each pair of neighbours agrees which edge is longer.
struct Plan {
    const TriangleMesh& mesh;
    EdgeList edges;
    std::vector<std::uint8_t> longest; ///< per triangle: its side; ties go to the smaller edge
    std::vector<std::array<std::uint32_t, 2>> around; ///< per edge: its triangles
};

Plan make_plan(const TriangleMesh& mesh)
{
    Plan plan{mesh, edges_of(mesh.triangles), {}, {}};
    std::vector<double> length(plan.edges.ends.size());
    for (std::size_t e = 0; e < length.size(); ++e) {
        const auto [a, b] = plan.edges.ends[e];
        length[e] = (Vec3d(mesh.points[b]) - Vec3d(mesh.points[a])).lengthSqr();
    }
    plan.around.resize(length.size());
    std::vector<char> seen(length.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::array<std::uint32_t, 3>& sides = plan.edges.triangles[t];
        std::uint8_t longest = 0;
        for (std::uint8_t k = 0; k < 3; ++k) {
            const std::uint32_t e = sides[k], best = sides[longest];
            if (length[e] > length[best] || (length[e] == length[best] && e < best))
                longest = k;
            plan.around[e][seen[e] ? 1 : 0] = t;
            seen[e] = 1;
        }
        plan.longest.push_back(longest);
    }
    return plan;
}

std::uint32_t longest_edge(const Plan& plan, std::uint32_t triangle)
{
    return plan.edges.triangles[triangle][plan.longest[triangle]];
}

/// The edges to halve.
struct Choice {
    std::vector<char> marked;
    std::size_t cut = 0; ///< wanted triangles that lose an edge
    bool out_of_room = false;
};

/// Marks an edge and, until the rule of the longest edge holds, those that have to go before it;
/// returns these with it. Nothing is marked when one of them is barred, since the edge could not be
/// halved then without breaking the rule. Each edge is marked once at most, so this ends.
std::vector<std::uint32_t> mark(const Plan& plan, const std::vector<char>& barred,
                                std::uint32_t edge, std::vector<char>& marked)
{
    std::vector<std::uint32_t> newly{edge};
    bool allowed = !barred[edge];
    marked[edge] = 1;
    for (std::size_t next = 0; allowed && next < newly.size(); ++next)
        for (const std::uint32_t t : plan.around[newly[next]]) {
            const std::uint32_t before = longest_edge(plan, t);
            if (marked[before])
                continue;
            allowed &= !barred[before];
            marked[before] = 1;
            newly.push_back(before);
        }
    if (!allowed) {
        for (const std::uint32_t e : newly)
            marked[e] = 0;
        newly.clear();
    }
    return newly;
}

/// Takes the wanted triangles one after another while there is room.
Choice choose(const Plan& plan, const std::vector<std::uint32_t>& wanted,
              std::size_t most_triangles, const std::vector<char>& barred)
{
    Choice choice{std::vector<char>(plan.edges.ends.size()), 0};
    std::size_t triangles = plan.mesh.triangles.size();
    for (const std::uint32_t t : wanted) {
        std::vector<std::uint32_t> newly;
        for (const std::uint32_t edge : plan.edges.triangles[t])
            if (!choice.marked[edge])
                for (const std::uint32_t e : mark(plan, barred, edge, choice.marked))
                    newly.push_back(e);
        // A halved edge of a closed surface cuts a piece on either side of it in two.
        triangles += 2 * newly.size();
        if (triangles > most_triangles) {
            for (const std::uint32_t e : newly)
                choice.marked[e] = 0;
            choice.out_of_room = true;
            break;
        }
        const auto& sides = plan.edges.triangles[t];
        choice.cut += choice.marked[sides[0]] || choice.marked[sides[1]] || choice.marked[sides[2]];
    }
    return choice;
}

/// Bars the edges whose halving spoiled pieces that were no part of a spoiled triangle before.
/// Which of the marked edges of a triangle did it is not known, so all of them are barred.
bool bar_spoiled(const Plan& plan, const EdgeSplit& split, const std::vector<char>& spoiled_before,
                 const std::vector<char>& marked, std::vector<char>& barred)
{
    const std::vector<char> spoiled = spoiled_triangles(split.mesh);
    bool any = false;
    for (std::size_t t = 0; t < spoiled.size(); ++t) {
        const std::uint32_t source = split.source[t];
        if (!spoiled[t] || (!spoiled_before.empty() && spoiled_before[source]))
            continue;
        for (const std::uint32_t edge : plan.edges.triangles[source])
            if (marked[edge] && !barred[edge])
                any = true, barred[edge] = 1;
    }
    return any;
}

} // namespace

RefinedMesh refine_triangles(const TriangleMesh& mesh, const std::vector<std::uint32_t>& wanted,
                             std::size_t most_triangles, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "refine triangles");
    const Plan plan = make_plan(mesh);
    const std::vector<char> spoiled_before = spoiled_triangles(mesh);
    std::vector<char> barred(plan.edges.ends.size());
    RefinedMesh out;
    EdgeSplit split;
    // Every turn but the last bars an edge at least, and edges are finitely many, so this ends.
    for (bool again = true; again;) {
        progress.stop_if_interrupted(50);
        const Choice choice = choose(plan, wanted, most_triangles, barred);
        out.cut = choice.cut;
        out.out_of_room = choice.out_of_room;
        split = split_edges(mesh, plan.edges, choice.marked, plan.longest);
        again = bar_spoiled(plan, split, spoiled_before, choice.marked, barred);
    }
    for (const std::uint32_t edge : split.edge)
        out.halved.push_back(plan.edges.ends[edge]);
    out.barred_edges = static_cast<std::size_t>(std::count(barred.begin(), barred.end(), 1));
    out.mesh = std::move(split.mesh);
    out.source = std::move(split.source);
    return out;
}

} // namespace vdb_shell
