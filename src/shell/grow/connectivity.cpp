// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/connectivity.h"

#include "mesh/topology.h"
#include "shell/grow/plane_sides.h"

#include <algorithm>

namespace vdb_shell::growth
{
namespace
{

void build_incidence(Connectivity& c)
{
    const VertexTriangles around =
        triangles_around_vertices(static_cast<std::size_t>(c.vertices), c.faces);
    c.first.assign(around.offset.begin(), around.offset.end());
    c.incident.reserve(around.triangle.size());
    for (int v = 0; v < c.vertices; ++v)
        for (const std::uint32_t t : around.around(static_cast<std::size_t>(v))) {
            const int f = static_cast<int>(t);
            c.incident.push_back({f, c.corner(f, 0) == v ? 0 : c.corner(f, 1) == v ? 1 : 2});
        }
}

void sort_unique(std::vector<int>& list)
{
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

void build_neighbours(Connectivity& c)
{
    c.neighbour_first.assign(1, 0);
    std::vector<int> ring;
    for (int v = 0; v < c.vertices; ++v) {
        ring.clear();
        for (const FaceCorner& at : star(c, v))
            for (int k = 1; k < 3; ++k)
                ring.push_back(c.corner(at.face, (at.local + k) % 3));
        sort_unique(ring);
        c.neighbour.insert(c.neighbour.end(), ring.begin(), ring.end());
        c.neighbour_first.push_back(static_cast<int>(c.neighbour.size()));
    }
}

void label_components(Connectivity& c)
{
    c.component.assign(static_cast<std::size_t>(c.vertices), -1);
    std::vector<int> stack;
    for (int seed = 0; seed < c.vertices; ++seed) {
        if (c.component[seed] >= 0)
            continue;
        stack.assign(1, seed);
        c.component[seed] = c.components;
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
/// one read nothing that another moves.
void colour_vertices(Connectivity& c)
{
    std::vector<int> colour(static_cast<std::size_t>(c.vertices), -1), used;
    for (int v = 0; v < c.vertices; ++v) {
        used.clear();
        for (const int u : neighbours(c, v)) {
            if (colour[u] >= 0)
                used.push_back(colour[u]);
            for (const int w : neighbours(c, u))
                if (colour[w] >= 0)
                    used.push_back(colour[w]);
        }
        sort_unique(used);
        int smallest_free = 0;
        for (const int u : used)
            smallest_free += u == smallest_free;
        colour[v] = smallest_free;
        if (smallest_free >= static_cast<int>(c.colour.size()))
            c.colour.resize(static_cast<std::size_t>(smallest_free) + 1);
        c.colour[smallest_free].push_back(v);
    }
}

int place_of(const std::vector<int>& list, int entry)
{
    return static_cast<int>(std::find(list.begin(), list.end(), entry) - list.begin());
}

/// The pairs of one vertex, with `ring` and `face` filled in; false where they are too many.
bool list_kin(const Connectivity& c, int v, std::vector<int>& ring, std::vector<int>& face,
              std::vector<KinPair>& pairs)
{
    for (const FaceCorner& at : star(c, v))
        face.push_back(at.face);
    const std::size_t moved = face.size();
    for (const int u : neighbours(c, v))
        for (const FaceCorner& at : star(c, u)) {
            if (!c.incident_to(at.face, v) &&
                std::find(face.begin() + std::ptrdiff_t(moved), face.end(), at.face) == face.end())
                face.push_back(at.face);
            for (int k = 0; k < 3; ++k)
                if (c.corner(at.face, k) != v)
                    ring.push_back(c.corner(at.face, k));
        }
    sort_unique(ring);
    if (ring.size() > PlaneSides::kMostPoints || moved > PlaneSides::kMostPlanes ||
        face.size() > 255)
        return false;
    for (std::size_t m = 0; m < moved; ++m)
        for (std::size_t o = m + 1; o < face.size(); ++o) {
            if (!c.share_a_corner(face[m], face[o]))
                continue;
            std::vector<std::uint8_t> own;
            for (int k = 0; k < 3; ++k)
                if (!c.incident_to(face[m], c.corner(face[o], k)))
                    own.push_back(static_cast<std::uint8_t>(place_of(ring, c.corner(face[o], k))));
            if (!own.empty())
                pairs.push_back({static_cast<std::uint8_t>(m), static_cast<std::uint8_t>(o),
                                 own.front(), own.back()});
        }
    return true;
}

void build_kin(Connectivity& c)
{
    Kin& kin = c.kin;
    kin.first_ring.assign(1, 0);
    kin.first_face.assign(1, 0);
    kin.first_pair.assign(1, 0);
    std::vector<int> ring, face;
    std::vector<KinPair> pairs;
    for (int v = 0; v < c.vertices; ++v) {
        ring.clear(), face.clear(), pairs.clear();
        if (list_kin(c, v, ring, face, pairs)) {
            kin.ring.insert(kin.ring.end(), ring.begin(), ring.end());
            kin.face.insert(kin.face.end(), face.begin(), face.end());
            kin.pair.insert(kin.pair.end(), pairs.begin(), pairs.end());
        }
        kin.first_ring.push_back(static_cast<int>(kin.ring.size()));
        kin.first_face.push_back(static_cast<int>(kin.face.size()));
        kin.first_pair.push_back(kin.pair.size());
    }
}

} // namespace

Connectivity connect(std::size_t vertices, const std::vector<Vec3I>& faces)
{
    Connectivity c;
    c.vertices = static_cast<int>(vertices);
    c.faces = faces;
    build_incidence(c);
    build_neighbours(c);
    label_components(c);
    colour_vertices(c);
    build_kin(c);
    return c;
}

} // namespace vdb_shell::growth
