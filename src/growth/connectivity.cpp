// SPDX-License-Identifier: Apache-2.0

// Takes: the triangles. Gives: who is beside whom, the edge-connected components, and a colouring
// by which vertices can be moved at the same time with the same result as one after the other
// (docs/theory.md, "Same result for any number of threads"). Built once, for growth never changes
// the triangles. Lists of all vertices lie one after another in one array, with the place where
// each begins.

#include "growth/connectivity.h"

#include "core/parallel.h"
#include "core/sort_unique.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace vdb_shell::growth
{
namespace
{

void build_incidence(Connectivity& c)
{
    c.rims = rims_around_vertices(static_cast<std::size_t>(c.vertices), c.faces);
    const VertexTriangles& around = c.rims.around;
    c.first.assign(around.offset.begin(), around.offset.end());
    c.incident.resize(around.triangle.size());
    for_each_index(static_cast<std::size_t>(c.vertices), [&](std::size_t i) {
        const int v = static_cast<int>(i);
        FaceCorner* at = c.incident.data() + c.first[v];
        for (const std::uint32_t t : around.around(i)) {
            const int f = static_cast<int>(t);
            *at++ = {f, c.corner(f, 0) == v ? 0 : c.corner(f, 1) == v ? 1 : 2};
        }
    });
}

void build_neighbours(Connectivity& c)
{
    // Each triangle gives a vertex at most two neighbours, so all vertices can list theirs at the
    // same time, each with room for that; the lists are then moved together.
    const auto vertices = static_cast<std::size_t>(c.vertices);
    std::vector<int> wide(2 * c.incident.size()), count(vertices);
    for_each_index(vertices, [&](std::size_t i) {
        const int v = static_cast<int>(i);
        int* const begin = wide.data() + 2 * static_cast<std::size_t>(c.first[v]);
        int* end = begin;
        for (const FaceCorner& at : star(c, v))
            for (int k = 1; k < 3; ++k)
                *end++ = c.corner(at.face, (at.local + k) % 3);
        // Ascending, so that sums over the neighbours of a vertex have an order that depends on
        // nothing but the indices.
        std::sort(begin, end);
        count[i] = static_cast<int>(std::unique(begin, end) - begin);
    });
    c.neighbour_first.assign(vertices + 1, 0);
    std::partial_sum(count.begin(), count.end(), c.neighbour_first.begin() + 1);
    c.neighbour.resize(static_cast<std::size_t>(c.neighbour_first.back()));
    for_each_index(vertices, [&](std::size_t i) {
        const int v = static_cast<int>(i);
        std::copy_n(wide.data() + 2 * static_cast<std::size_t>(c.first[v]), count[i],
                    c.neighbour.data() + c.neighbour_first[v]);
    });
}

void label_components(Connectivity& c)
{
    c.component.assign(static_cast<std::size_t>(c.vertices), -1);
    std::vector<int> stack;
    for (int seed = 0; seed < c.vertices; ++seed) {
        if (c.component[seed] >= 0)
            continue;
        // A stack of its own instead of recursion, which would go as deep as the component has
        // vertices. Numbers follow the smallest vertex of each component.
        stack.assign(1, seed);
        c.component[seed] = c.components;
        // By edges only: two fans that touch in a vertex have been split into copies before.
        while (!stack.empty()) {
            const int v = stack.back();
            stack.pop_back();
            for (const int u : neighbours(c, v)) {
                if (c.component[u] >= 0)
                    continue;
                c.component[u] = c.components;
                stack.push_back(u);
            }
        }
        ++c.components;
    }
}

/// Greedy in index order: vertices of one class are three edges apart or more, so that the tests of
/// one read nothing that another moves. Serial, because the colour of a vertex depends on all that
/// came before it; linear in the number of pairs of vertices within two edges, but for pairs around
/// a vertex of thousands. Those around such a one have a colour each, in ascending order.
void colour_vertices(Connectivity& c)
{
    std::vector<int> first_free(static_cast<std::size_t>(c.vertices)); // around a vertex
    std::vector<int> colour(static_cast<std::size_t>(c.vertices), -1);
    // Stamped with the vertex instead of cleared for each: a colour is free unless its stamp is
    // that of the vertex in question.
    std::vector<int> taken_for; // by colour: the last vertex that cannot have it
    const auto take = [&](int u, int v) {
        if (colour[u] >= 0)
            taken_for[colour[u]] = v;
    };
    for (int v = 0; v < c.vertices; ++v) {
        // All vertices within two edges: what they take, v cannot have.
        int first = 0;
        for (const int u : neighbours(c, v)) {
            take(u, v);
            if (std::size_t(neighbours(c, u).size()) > FanWork::kCrowd) {
                first = std::max(first, first_free[u]);
                continue;
            }
            for (const int w : neighbours(c, u))
                take(w, v);
        }
        const auto free =
            std::find_if(taken_for.begin() + first, taken_for.end(), [&](int u) { return u != v; });
        colour[v] = static_cast<int>(free - taken_for.begin());
        for (const int u : neighbours(c, v))
            first_free[u] = std::max(first_free[u], colour[v] + 1);
        if (free == taken_for.end()) {
            taken_for.push_back(-1);
            c.colour.emplace_back();
        }
        c.colour[colour[v]].push_back(v);
    }
}

} // namespace

std::vector<int> faces_at(const Connectivity& c, int v)
{
    std::vector<int> faces;
    for (const FaceCorner& at : star(c, v))
        faces.push_back(at.face);
    return faces;
}

std::vector<int> faces_at(const Connectivity& c, const std::vector<int>& vertices)
{
    std::vector<int> faces;
    for (const int v : vertices)
        for (const FaceCorner& at : star(c, v))
            faces.push_back(at.face);
    sort_unique(faces);
    return faces;
}

Connectivity connect(std::size_t vertices, const std::vector<Vec3I>& faces)
{
    Connectivity c;
    c.vertices = static_cast<int>(vertices);
    c.faces = faces;
    build_incidence(c);
    build_neighbours(c);
    FanWork work;
    for (int v = 0; v < c.vertices; ++v)
        work.add(std::size_t(star(c, v).size()));
    c.has_crowds = work.too_much();
    // Both only read the neighbours, and each writes members that the other does not touch.
    run_together([&] { label_components(c); }, [&] { colour_vertices(c); });
    return c;
}

} // namespace vdb_shell::growth
