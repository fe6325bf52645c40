// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/connectivity.h"

#include "core/parallel.h"
#include "mesh/topology.h"
#include "shell/grow/plane_sides.h"

#include <algorithm>
#include <array>
#include <cstdint>

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
    std::vector<int> colour(static_cast<std::size_t>(c.vertices), -1);
    std::vector<int> taken_for; // by colour: the last vertex that cannot have it
    const auto take = [&](int u, int v) {
        if (colour[u] >= 0)
            taken_for[colour[u]] = v;
    };
    for (int v = 0; v < c.vertices; ++v) {
        for (const int u : neighbours(c, v)) {
            take(u, v);
            for (const int w : neighbours(c, u))
                take(w, v);
        }
        const auto free =
            std::find_if(taken_for.begin(), taken_for.end(), [&](int u) { return u != v; });
        colour[v] = static_cast<int>(free - taken_for.begin());
        if (free == taken_for.end()) {
            taken_for.push_back(-1);
            c.colour.emplace_back();
        }
        c.colour[colour[v]].push_back(v);
    }
}

/// The lists of some vertices, one after another, with what each adds.
struct KinLists {
    struct Count {
        int ring = 0, face = 0;
        std::size_t pair = 0;
    };
    std::vector<int> ring, face;
    std::vector<KinPair> pair;
    std::vector<Count> count;
};

/// Places of vertices and faces in the lists of the vertex at hand; -1 for those in none.
struct Places {
    std::vector<std::int8_t> vertex, face;
};

/// Appends the lists of one vertex, or nothing where they are too long. Leaves `places` at -1.
void list_kin_of(const Connectivity& c, int v, Places& places, KinLists& out)
{
    static_assert(PlaneSides::kMostPoints < 64);
    constexpr int kMostFaces = 127;
    const std::size_t first_ring = out.ring.size(), first_face = out.face.size(),
                      first_pair = out.pair.size();
    std::vector<int>&ring = out.ring, &face = out.face;
    std::array<std::uint64_t, kMostFaces> corners; // of each face, a bit for each place but v's
    bool short_enough = star(c, v).size() <= static_cast<int>(PlaneSides::kMostPlanes);
    const auto add_face = [&](int f) {
        const std::size_t place = face.size() - first_face;
        if (places.face[f] >= 0 || place == kMostFaces) {
            short_enough = short_enough && places.face[f] >= 0;
            return;
        }
        places.face[f] = static_cast<std::int8_t>(place);
        face.push_back(f);
        corners[place] = 0;
        for (int k = 0; k < 3; ++k) {
            const int u = c.corner(f, k);
            if (u == v)
                continue;
            std::int8_t& at = places.vertex[u];
            if (at < 0 && ring.size() - first_ring == PlaneSides::kMostPoints) {
                short_enough = false;
                continue;
            }
            if (at < 0) {
                at = static_cast<std::int8_t>(ring.size() - first_ring);
                ring.push_back(u);
            }
            corners[place] |= std::uint64_t(1) << at;
        }
    };
    for (const FaceCorner& at : star(c, v))
        add_face(at.face);
    const std::size_t moved = face.size() - first_face;
    for (const int u : neighbours(c, v))
        for (const FaceCorner& at : star(c, u))
            add_face(at.face);
    const std::size_t rings = ring.size() - first_ring, faces = face.size() - first_face;
    for (std::size_t i = first_ring; i < ring.size(); ++i)
        places.vertex[ring[i]] = -1;
    for (std::size_t i = first_face; i < face.size(); ++i)
        places.face[face[i]] = -1;
    if (!short_enough) {
        ring.resize(first_ring);
        face.resize(first_face);
        out.count.emplace_back();
        return;
    }
    for (std::size_t m = 0; m < moved; ++m)
        for (std::size_t o = m + 1; o < faces; ++o) {
            const std::uint64_t own = corners[o] & ~corners[m];
            // Beside the star a face has v's bit nowhere: one that shares nothing has three.
            const std::uint64_t but_lowest = own & (own - 1);
            if (own != 0 && (but_lowest & (but_lowest - 1)) == 0)
                out.pair.push_back({static_cast<std::uint8_t>(m), static_cast<std::uint8_t>(o),
                                    static_cast<std::uint8_t>(__builtin_ctzll(own)),
                                    static_cast<std::uint8_t>(63 - __builtin_clzll(own))});
        }
    out.count.push_back(
        {static_cast<int>(rings), static_cast<int>(faces), out.pair.size() - first_pair});
}

/// Puts the lists of the chunks one after another.
template <class Entry>
void join(const std::vector<KinLists>& chunks, std::vector<Entry> KinLists::*list,
          std::vector<Entry>& out)
{
    std::vector<std::size_t> begin(chunks.size() + 1, 0);
    for (std::size_t i = 0; i < chunks.size(); ++i)
        begin[i + 1] = begin[i] + (chunks[i].*list).size();
    out.resize(begin.back());
    for_each_index(
        chunks.size(),
        [&](std::size_t i) {
            std::copy((chunks[i].*list).begin(), (chunks[i].*list).end(),
                      out.begin() + std::ptrdiff_t(begin[i]));
        },
        1);
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
    const std::size_t none = vertices + 1;
    c.kin.first_ring.assign(none, 0);
    c.kin.first_face.assign(none, 0);
    c.kin.first_pair.assign(none, 0);
    return c;
}

void list_kin(Connectivity& c)
{
    constexpr std::size_t kChunk = 512;
    const auto vertices = static_cast<std::size_t>(c.vertices);
    std::vector<KinLists> chunks((vertices + kChunk - 1) / kChunk);
    for_each_range(
        chunks.size(),
        [&](std::size_t begin, std::size_t end) {
            Places places{std::vector<std::int8_t>(vertices, -1),
                          std::vector<std::int8_t>(c.faces.size(), -1)};
            for (std::size_t i = begin; i < end; ++i)
                for (std::size_t v = i * kChunk; v < std::min(vertices, (i + 1) * kChunk); ++v)
                    list_kin_of(c, static_cast<int>(v), places, chunks[i]);
        },
        1);
    Kin& kin = c.kin;
    join(chunks, &KinLists::ring, kin.ring);
    join(chunks, &KinLists::face, kin.face);
    join(chunks, &KinLists::pair, kin.pair);
    kin.first_ring.assign(1, 0);
    kin.first_face.assign(1, 0);
    kin.first_pair.assign(1, 0);
    for (const KinLists& chunk : chunks)
        for (const KinLists::Count& count : chunk.count) {
            kin.first_ring.push_back(kin.first_ring.back() + count.ring);
            kin.first_face.push_back(kin.first_face.back() + count.face);
            kin.first_pair.push_back(kin.first_pair.back() + count.pair);
        }
}

} // namespace vdb_shell::growth
