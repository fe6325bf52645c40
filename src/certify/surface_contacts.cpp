// SPDX-License-Identifier: Apache-2.0

// Takes: a shell. Gives: all pairs of triangles of its two surfaces that meet in more than what
// they share, sorted by kind: condition 3 of docs/theory.md, "The whole shell", and condition 5, as
// pairs of different components are among them. Both surfaces are put into one list, so that one
// search finds the contacts of each with itself and with the other. Corners are shared by index and
// never by coordinate: two vertices in the same place are a contact, while a pinned inner corner is
// its outer one. The search is a tree of boxes, the decision exact; pairs come sorted, for any
// number of threads.

#include "certify/surface_contacts.h"

#include "certify/certificate_findings.h"
#include "core/triangle_pairs.h"
#include "mesh/surface_defects.h"
#include "mesh/triangle_contacts.h"

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;

/// Both surfaces over one set of points: the outer ones, then the inner ones. The inner corner of a
/// pinned vertex *is* its outer point, so triangles of different surfaces share it by index.
struct TwoSurfaces {
    std::vector<Vec3s> points;
    std::vector<Vec3I> faces;          ///< the outer triangles, then the inner ones
    std::vector<std::uint32_t> source; ///< per face: the triangle of the shell
    std::size_t outer_count = 0;

    bool inner(std::size_t face) const { return face >= outer_count; }
};

TwoSurfaces lay_together(const PrismShell& shell, const std::vector<char>& pinned)
{
    TwoSurfaces both;
    both.points.reserve(2 * shell.outer.size());
    both.points = shell.outer;
    both.points.insert(both.points.end(), shell.inner.begin(), shell.inner.end());
    both.faces.reserve(2 * shell.triangles.size());
    both.source.reserve(2 * shell.triangles.size());
    both.faces = shell.triangles;
    both.outer_count = shell.triangles.size();
    const auto shift = static_cast<std::uint32_t>(shell.outer.size());
    for (std::uint32_t t = 0; t < shell.triangles.size(); ++t)
        both.source.push_back(t);
    for (std::uint32_t t = 0; t < shell.triangles.size(); ++t) {
        const Vec3I& v = shell.triangles[t];
        // With three pinned corners the inner triangle is the outer one, and there already.
        if (pinned[v[0]] && pinned[v[1]] && pinned[v[2]])
            continue;
        Vec3I face = v;
        for (int k = 0; k < 3; ++k)
            if (!pinned[v[k]])
                face[k] += shift;
        both.faces.push_back(face);
        both.source.push_back(t);
    }
    return both;
}

/// Two inner triangles with a common corner that touch elsewhere are listed as a fold, those
/// without one as a contact.
int shared_corners(const Vec3I& first, const Vec3I& second)
{
    int shared = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            shared += first[i] == second[j];
    return shared;
}

void list_contact(const TwoSurfaces& both, std::uint32_t first, std::uint32_t second,
                  Certificate& certificate)
{
    const std::uint32_t s = both.source[first], t = both.source[second];
    if (!both.inner(first) && !both.inner(second))
        add_to(certificate.outer_contacts, {s, t});
    // Pairs come with the smaller face first, and outer faces stand before inner ones, so of a
    // mixed pair the first is the outer one. The finding names the inner triangle first.
    else if (!both.inner(first))
        add_to(certificate.inner_through_outer, {t, s});
    else if (shared_corners(both.faces[first], both.faces[second]) > 0)
        add_to(certificate.inner_folds, {s, t});
    else
        add_to(certificate.inner_contacts, {s, t});
}

} // namespace

std::vector<std::array<std::uint32_t, 2>>
check_surfaces(const PrismShell& shell, const std::vector<char>& pinned, Certificate& certificate)
{
    const TwoSurfaces both = lay_together(shell, pinned);
    const std::vector<char> degenerate = find_degenerate(both.points, both.faces);
    for (std::uint32_t f = 0; f < degenerate.size(); ++f)
        if (degenerate[f])
            add_to(both.inner(f) ? certificate.inner_folds : certificate.outer_contacts,
                   {both.source[f], both.source[f]});

    const TriangleContacts triangles(both.points, both.faces);
    const auto touch = [&](std::uint32_t f, std::uint32_t g) {
        // A triangle of no area has no plane; the shell has failed by it already.
        return !degenerate[f] && !degenerate[g] && triangles.touch(f, g);
    };
    std::vector<std::array<std::uint32_t, 2>> contacts;
    for (const auto& [f, g] : overlapping_triangles(both.points, both.faces, touch)) {
        list_contact(both, f, g, certificate);
        contacts.push_back({both.source[f], both.source[g]});
    }
    return contacts;
}

} // namespace vdb_shell
