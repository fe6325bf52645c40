// SPDX-License-Identifier: Apache-2.0

// Takes: a certified shell inside its surface, and tets that are said to fill what it leaves empty.
// Gives: everything that stands against the two being one complex that covers the solid. Since the
// shell has been certified before, it is enough that the core's tets are positive and that their
// faces match, with each other and with the free faces of the shell (docs/theory.md, "A filled
// core"). Corners are compared by index and never by place. The volumes, which the proof does not
// need, are a second opinion that looks at no face.

#include "vdb_shell/certify/core_certificate.h"

#include "certify/certificate_findings.h"
#include "certify/free_faces.h"
#include "core/bucket_sort.h"
#include "core/exact.h"
#include "core/parallel.h"
#include "mesh/exact_volume.h"
#include "shell/tet_faces.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <functional>
#include <tuple>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;
using openvdb::Vec4I;

/// A face of a tet of the core, or a triangle of the void's surface.
struct Face {
    std::array<std::uint32_t, 3> corners; ///< ascending
    bool wall;                            ///< of the void's surface
    std::uint32_t owner;                  ///< tet or triangle
    bool even; ///< the ascending order is an even permutation of the face as seen from outside
};

bool operator<(const Face& x, const Face& y)
{
    return std::tie(x.corners, x.wall, x.owner, x.even) <
           std::tie(y.corners, y.wall, y.owner, y.even);
}

Face face_of(const Vec3I& corners, bool wall, std::uint32_t owner)
{
    std::array<std::uint32_t, 3> sorted{corners[0], corners[1], corners[2]};
    bool even = true;
    // Three exchanges sort three numbers; each turns the permutation.
    for (const auto& [i, k] : {std::pair{0U, 1U}, std::pair{1U, 2U}, std::pair{0U, 1U}})
        if (sorted[i] > sorted[k]) {
            std::swap(sorted[i], sorted[k]);
            even = !even;
        }
    return {sorted, wall, owner, even};
}

std::vector<Face> sorted_faces(const std::vector<Vec4I>& tets, const VoidSurface& surface,
                               std::size_t points)
{
    std::vector<Face> faces;
    for (std::uint32_t t = 0; t < tets.size(); ++t)
        for (std::size_t corner = 0; corner < 4; ++corner)
            faces.push_back(face_of(tet_face(tets[t], corner), false, t));
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
        faces.push_back(face_of(surface.triangles[t], true, t));
    const auto smallest = [](const Face& face) { return face.corners[0]; };
    return bucket_sort<Face>(std::array{std::move(faces)}, points, smallest, std::less<>());
}

/// The faces from `first` on have the same corners, those of tets first.
void check_face(const Face* first, std::size_t tets, std::size_t walls,
                CoreCertificate& certificate)
{
    if (tets == 0) {
        for (std::size_t i = 0; i < walls; ++i)
            add_to(certificate.missing_triangles, first[i].owner);
    } else if (tets + walls > 2) {
        add_to(certificate.crowded_faces, first->owner);
    } else if (tets + walls == 1) {
        add_to(certificate.stray_faces, first->owner);
    } else {
        // Two tets see their face from opposite sides; the void's surface is seen as its tet does.
        const bool alike = first[0].even == first[1].even;
        if (alike != (walls == 1))
            add_to(certificate.misoriented_faces, first->owner);
    }
}

void check_faces(const std::vector<Vec4I>& tets, const VoidSurface& surface, std::size_t points,
                 CoreCertificate& certificate)
{
    const std::vector<Face> faces = sorted_faces(tets, surface, points);
    for (std::size_t first = 0, last = 0; first < faces.size(); first = last) {
        std::size_t walls = 0;
        while (last < faces.size() && faces[last].corners == faces[first].corners)
            walls += faces[last++].wall ? 1 : 0;
        check_face(&faces[first], last - first - walls, walls, certificate);
    }
}

void check_signs(const TetMesh& all, std::size_t first, CoreCertificate& certificate)
{
    std::vector<char> bad(all.tets.size() - first);
    for_each_index(bad.size(), [&](std::size_t i) {
        const Vec4I& t = all.tets[first + i];
        bad[i] = exact::orient3d(all.points[t[0]], all.points[t[1]], all.points[t[2]],
                                 all.points[t[3]]) <= 0;
    });
    certificate.bad_tets = raised(bad);
}

/// Zeros of either sign differ, as they do in files.
std::array<std::uint32_t, 3> bits_of(const Vec3s& point)
{
    std::array<std::uint32_t, 3> bits{};
    std::memcpy(bits.data(), point.asPointer(), sizeof bits);
    return bits;
}

/// Own points are the lone vertices and those of holes, each with its very bits, and then points of
/// the inside.
void check_points(const VoidSurface& surface, std::size_t shell_points, const CoreTets& core,
                  CoreCertificate& certificate)
{
    const std::size_t lone = surface.lone_vertices.size(), given = lone + surface.hole_points;
    for (std::uint32_t i = 0; i < std::max(given, core.points.size()); ++i) {
        const bool own = i < core.points.size();
        const std::uint32_t vertex = i < lone ? surface.lone_vertices[i] : CoreTets::kNoVertex;
        if (!own || core.source_vertex[i] != vertex ||
            (i < given && bits_of(core.points[i]) != bits_of(surface.points[shell_points + i])))
            add_to(certificate.foreign_points, i);
    }
    std::vector<char> unused(core.points.size(), 1);
    for (const Vec4I& tet : core.tets)
        for (int corner = 0; corner < 4; ++corner)
            if (tet[corner] >= shell_points)
                unused[tet[corner] - shell_points] = 0;
    certificate.unused_points = raised(unused);
}

/// The boundary of the solid without its holes. As join_cores() of the room obstacles, which this
/// room does without: a certificate shares no code with what it judges.
TriangleMesh less_holes(TriangleMesh solid, const TriangleMesh& holes)
{
    const auto first = std::uint32_t(solid.points.size());
    solid.points.insert(solid.points.end(), holes.points.begin(), holes.points.end());
    for (const Vec3I& t : holes.triangles)
        solid.triangles.emplace_back(first + t[0], first + t[2], first + t[1]);
    return solid;
}

template <typename Visit> void for_each_kind(const CoreCertificate& c, const Visit& visit)
{
    visit("foreign_points", c.foreign_points);
    visit("corners_out_of_range", c.corners_out_of_range);
    visit("bad_tets", c.bad_tets);
    visit("crowded_faces", c.crowded_faces);
    visit("misoriented_faces", c.misoriented_faces);
    visit("stray_faces", c.stray_faces);
    visit("missing_triangles", c.missing_triangles);
    visit("unused_points", c.unused_points);
}

} // namespace

VoidSurface void_surface(const ShellStack& stack, const TetMesh& tets, const TriangleMesh& holes)
{
    assert(stack.skin == 0);
    const FreeFaces free = find_free_faces(stack, tets);
    VoidSurface surface;
    surface.points = free.points;
    surface.lone_vertices.resize(free.points.size() - tets.points.size());
    for (std::size_t f = 0; f < free.faces.size(); ++f) {
        const Vec3I& face = free.faces[f];
        // Outer triangles without a tet have the void right behind them.
        if (!free.inner(f) && free.tet[f] == FreeFaces::kNoTet)
            surface.triangles.push_back(face);
        else if (free.inner(f))
            surface.triangles.emplace_back(face[0], face[2], face[1]);
        for (int k = 0; k < 3; ++k)
            if (face[k] >= tets.points.size())
                surface.lone_vertices[face[k] - tets.points.size()] = stack.triangles()[f][k];
    }
    const auto first = std::uint32_t(surface.points.size());
    surface.hole_points = holes.points.size();
    surface.points.insert(surface.points.end(), holes.points.begin(), holes.points.end());
    // Turned, for the void lies outside of them.
    for (const Vec3I& t : holes.triangles)
        surface.triangles.emplace_back(first + t[0], first + t[2], first + t[1]);
    return surface;
}

bool CoreCertificate::certified() const
{
    return volume_agrees && failures().empty();
}

std::vector<std::string> CoreCertificate::failures() const
{
    std::vector<std::string> lines;
    for_each_kind(*this, [&](const char* name, const auto& defect) {
        if (defect.count > 0)
            lines.push_back(failure_line(name, defect));
    });
    if (lines.empty() && !volume_agrees)
        lines.emplace_back("volume_agrees is false");
    return lines;
}

CoreCertificate certify_core(const ShellStack& stack, const TetMesh& tets, const CoreTets& core,
                             const TriangleMesh& holes)
{
    assert(core.source_vertex.size() == core.points.size());
    CoreCertificate certificate;
    const std::size_t points = tets.points.size() + core.points.size();
    for (std::uint32_t t = 0; t < core.tets.size(); ++t) {
        const Vec4I& c = core.tets[t];
        if (std::max({c[0], c[1], c[2], c[3]}) >= points)
            add_to(certificate.corners_out_of_range, t);
    }
    if (certificate.corners_out_of_range.count > 0)
        return certificate;
    const VoidSurface surface = void_surface(stack, tets, holes);
    check_points(surface, tets.points.size(), core, certificate);
    const TetMesh all = joined_tets(tets, core);
    check_signs(all, tets.tets.size(), certificate);
    // Lone vertices that the core leaves out have numbers all the same.
    check_faces(core.tets, surface, std::max(points, surface.points.size()), certificate);
    const TriangleMesh solid = less_holes({stack.surface(0), stack.triangles()}, holes);
    certificate.volume_agrees =
        exact::same_volume(all.points, all.tets, solid.points, solid.triangles);
    return certificate;
}

TriangleMesh holes_of_core(const ShellStack& stack, const TetMesh& tets, const CoreTets& core)
{
    const VoidSurface surface = void_surface(stack, tets);
    const std::size_t first = tets.points.size() + surface.lone_vertices.size();
    const std::size_t points = tets.points.size() + core.points.size();
    const std::vector<Face> faces =
        sorted_faces(core.tets, surface, std::max(points, surface.points.size()));
    TriangleMesh holes;
    std::size_t end = first;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const auto alike = [&](std::size_t k) {
            return k < faces.size() && faces[k].corners == faces[i].corners;
        };
        if (faces[i].wall || alike(i + 1) || (i > 0 && alike(i - 1)))
            continue;
        const auto& c = faces[i].corners;
        if (c[0] < first)
            return {};
        end = std::max(end, std::size_t(c[2]) + 1);
        // The tet sees its face from inside, and the hole is on the other side.
        const auto a = std::uint32_t(c[0] - first), b = std::uint32_t(c[1] - first),
                   d = std::uint32_t(c[2] - first);
        holes.triangles.push_back(faces[i].even ? Vec3I(a, d, b) : Vec3I(a, b, d));
    }
    const auto own = core.points.begin() + std::ptrdiff_t(surface.lone_vertices.size());
    holes.points.assign(own, own + std::ptrdiff_t(end - first));
    return holes;
}

} // namespace vdb_shell
