// SPDX-License-Identifier: Apache-2.0

// Takes: a shell, its components and the triangles that touch. Gives: conditions 4 and 6 of
// docs/theory.md, "The whole shell": the two surfaces of a component enclose volumes of one sign,
// and no component has a surface in the region of another. Both are decided exactly, by the sign of
// the volume and by crossings of an upward ray. One point of each surface stands for all of it,
// which is true only where the surfaces do not touch: hence pairs in contact, which have failed
// already, are left out. A component with an open edge encloses nothing and has failed likewise.
// Each component and each pair writes its own flag, so threads do not change the result; pairs come
// from a tree of boxes.

#include "certify/regions.h"

#include "certify/certificate_findings.h"
#include "core/box_pairs.h"
#include "core/exact.h"
#include "core/parallel.h"
#include "core/sort_unique.h"
#include "mesh/exact_volume.h"
#include "mesh/exact_winding.h"

#include <algorithm>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;

/// One component with its two closed surfaces. Their region is where their winding numbers differ.
struct Piece {
    std::vector<std::uint32_t> triangles;
    bool closed = true;
    FloatBox box{}; ///< of both surfaces
};

std::vector<Piece> gather_pieces(const PrismShell& shell,
                                 const std::vector<std::uint32_t>& component_of,
                                 const std::vector<char>& open_triangle)
{
    std::vector<Piece> pieces;
    for (std::uint32_t t = 0; t < component_of.size(); ++t) {
        const std::uint32_t c = component_of[t];
        // Components are numbered by their first triangle, so a new number is always the next one.
        if (c == pieces.size()) {
            pieces.emplace_back();
            pieces[c].box = FloatBox::around(shell.outer[shell.triangles[t][0]]);
        }
        Piece& piece = pieces[c];
        piece.triangles.push_back(t);
        piece.closed = piece.closed && !open_triangle[t];
        for (int k = 0; k < 3; ++k)
            for (const auto* surface : {&shell.outer, &shell.inner})
                piece.box.add((*surface)[shell.triangles[t][k]]);
    }
    return pieces;
}

/// A point on the surface would be a contact, and pairs in contact do not come here.
int winding_number(const std::vector<Vec3s>& points, const PrismShell& shell, const Piece& piece,
                   const Vec3s& at)
{
    const auto corners_of = [&](std::size_t i) {
        const Vec3I& v = shell.triangles[piece.triangles[i]];
        return exact::Triangle{points[v[0]], points[v[1]], points[v[2]]};
    };
    return exact_winding(at, piece.triangles.size(), corners_of).number;
}

bool in_region(const PrismShell& shell, const Piece& piece, const Vec3s& at)
{
    // Outside the box of both surfaces both winding numbers are nought, and the region is where
    // they differ.
    return piece.box.contains(at) && winding_number(shell.outer, shell, piece, at) !=
                                         winding_number(shell.inner, shell, piece, at);
}

/// Surfaces that do not touch those of `piece` lie in its region as a whole or not at all: one
/// point of each decides.
bool reaches_into(const PrismShell& shell, const Piece& other, const Piece& piece)
{
    const std::uint32_t v = shell.triangles[other.triangles.front()][0];
    return in_region(shell, piece, shell.outer[v]) || in_region(shell, piece, shell.inner[v]);
}

using ComponentPair = std::array<std::uint32_t, 2>;

std::vector<ComponentPair>
touching_components(const std::vector<std::uint32_t>& component_of,
                    const std::vector<std::array<std::uint32_t, 2>>& contacts)
{
    std::vector<ComponentPair> touching;
    for (const auto& [s, t] : contacts) {
        const auto [low, high] = std::minmax(component_of[s], component_of[t]);
        if (low != high)
            touching.push_back({low, high});
    }
    sort_unique(touching);
    return touching;
}

void check_orientation(const PrismShell& shell, const std::vector<Piece>& pieces,
                       Certificate& certificate)
{
    std::vector<char> inside_out(pieces.size());
    for_each_index(
        pieces.size(),
        [&](std::size_t c) {
            const Piece& piece = pieces[c];
            if (!piece.closed)
                return;
            const int outer = exact::volume_sign(shell.outer, shell.triangles, piece.triangles);
            const int inner = exact::volume_sign(shell.inner, shell.triangles, piece.triangles);
            // Two volumes of nought have equal signs too, but a surface without volume has no
            // inside that prisms could fill.
            inside_out[c] = outer == 0 || inner != outer;
        },
        1);
    for (std::size_t c = 0; c < pieces.size(); ++c)
        if (inside_out[c])
            add_to(certificate.inside_out_components, pieces[c].triangles.front());
}

} // namespace

void check_regions(const PrismShell& shell, const std::vector<std::uint32_t>& component_of,
                   const std::vector<char>& open_triangle,
                   const std::vector<std::array<std::uint32_t, 2>>& contacts,
                   Certificate& certificate)
{
    const std::vector<Piece> pieces = gather_pieces(shell, component_of, open_triangle);
    check_orientation(shell, pieces, certificate);

    std::vector<FloatBox> boxes;
    boxes.reserve(pieces.size());
    for (const Piece& piece : pieces)
        boxes.push_back(piece.box);
    const std::vector<ComponentPair> touching = touching_components(component_of, contacts);
    const auto pairs = pieces.size() < 2 ? std::vector<ComponentPair>{} : overlapping_pairs(boxes);
    std::vector<char> nested(pairs.size());
    for_each_index(
        pairs.size(),
        [&](std::size_t i) {
            const Piece &first = pieces[pairs[i][0]], &second = pieces[pairs[i][1]];
            // A contact has failed the pair already, and of surfaces that touch no single point
            // tells on which side the rest lies.
            if (first.closed && second.closed &&
                !std::binary_search(touching.begin(), touching.end(), pairs[i]))
                nested[i] =
                    reaches_into(shell, first, second) || reaches_into(shell, second, first);
        },
        1);
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (nested[i])
            add_to(certificate.nested_wrongly,
                   {pieces[pairs[i][0]].triangles.front(), pieces[pairs[i][1]].triangles.front()});
}

} // namespace vdb_shell
