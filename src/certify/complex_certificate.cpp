// SPDX-License-Identifier: Apache-2.0

// Takes: a tapered stack. Gives: everything that stands against its tets being a geometric
// simplicial complex inside the outermost surface; an empty list is a proof, by docs/theory.md,
// "Tapered shells". Unlike the certificate of a layer it needs no inner surface: it looks at the
// tets and at the faces that only one of them has. Those may not touch, which makes the number of
// tets over a point the same all along one side of a connected piece of them; one tet of each piece
// then tells that number. Findings are listed in index order, whatever the number of threads.

#include "vdb_shell/certify/complex_certificate.h"

#include "core/sort_unique.h"
#include "mesh/surface_defects.h"
#include "vdb_shell/shell/shared_points.h"

#include "certify/certificate_findings.h"
#include "certify/free_faces.h"
#include "certify/prism_checks.h"
#include "core/exact.h"
#include "core/parallel.h"
#include "core/stage_progress.h"
#include "core/triangle_pairs.h"
#include "mesh/exact_winding.h"
#include "mesh/topology.h"
#include "mesh/triangle_contacts.h"
#include "shell/tet_faces.h"

#include <algorithm>
#include <cassert>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;
using Pair = std::array<std::uint32_t, 2>;

/// Closed, oriented, manifold, and no two vertices in one place.
void check_outer_surface(const ShellStack& stack, ComplexCertificate& certificate)
{
    const PrismShell& top = stack.layers.front();
    const EdgeUses uses = sorted_edge_uses(top.triangles);
    // Called for edges and fans. As if all were pinned, for diagonals are a matter of conformity.
    Certificate found;
    std::vector<char> open_triangle(top.triangles.size());
    check_edges(stack.splits.front(), std::vector<char>(top.outer.size(), 1), uses, found,
                open_triangle);
    check_vertices(top, uses, found);
    certificate.open_edges = found.open_edges;
    certificate.split_vertices = found.split_vertices;
    const std::vector<std::uint32_t> first = first_places(stack);
    for (std::uint32_t v = 0; v < top.outer.size(); ++v)
        if (first[v] != v)
            add_to(certificate.doubled_vertices, v);
}

void check_orders(const ShellStack& stack, ComplexCertificate& certificate)
{
    std::uint32_t prism = 0;
    for (const PrismSplit& split : stack.splits)
        for (const auto& order : split.order) {
            std::array<bool, 3> seen{};
            for (const std::uint8_t corner : order)
                if (corner < 3)
                    seen[corner] = true;
            if (!(seen[0] && seen[1] && seen[2]))
                add_to(certificate.cyclic_prisms, prism);
            ++prism;
        }
}

std::vector<int> check_signs(const TetMesh& mesh, ComplexCertificate& certificate)
{
    std::vector<int> sign(mesh.tets.size());
    for_each_index(sign.size(), [&](std::size_t t) {
        const exact::Tet c = corners_of(mesh, t);
        sign[t] = exact::orient3d(c[0], c[1], c[2], c[3]);
    });
    for (std::uint32_t t = 0; t < sign.size(); ++t)
        if (sign[t] <= 0)
            add_to(certificate.bad_tets, t);
    return sign;
}

void list_contact(const FreeFaces& free, std::uint32_t f, std::uint32_t g,
                  ComplexCertificate& certificate)
{
    // Pairs come with the smaller face first, and outer triangles are the first faces.
    if (free.inner(f))
        add_to(certificate.inner_contacts, {free.tet[f], free.tet[g]});
    else if (free.inner(g))
        add_to(certificate.inner_through_outer, {free.tet[g], f});
    else
        add_to(certificate.outer_contacts, {f, g});
}

void check_contacts(const FreeFaces& free, const std::vector<char>& degenerate,
                    ComplexCertificate& certificate)
{
    for (std::uint32_t f = 0; f < degenerate.size(); ++f)
        if (degenerate[f])
            list_contact(free, f, f, certificate);
    const TriangleContacts triangles(free.points, free.faces);
    const auto touch = [&](std::uint32_t f, std::uint32_t g) {
        // A triangle of no area has no plane; the stack has failed by it already.
        return !degenerate[f] && !degenerate[g] && triangles.touch(f, g);
    };
    for (const auto& [f, g] : overlapping_triangles(free.points, free.faces, touch))
        list_contact(free, f, g, certificate);
}

/// The tets by their boxes, without those that are not positive: a flat one has no interior.
class TetTree
{
public:
    TetTree(const TetMesh& mesh, const std::vector<int>& sign) : mesh_(mesh), sign_(sign)
    {
        std::vector<FloatBox> boxes(mesh.tets.size());
        for_each_index(boxes.size(),
                       [&](std::size_t t) { boxes[t] = box_of(corners_of(mesh, t)); });
        tree_.build(boxes);
    }

    template <typename Corners> static FloatBox box_of(const Corners& corners)
    {
        FloatBox box = FloatBox::around(corners[0]);
        for (const Vec3s& p : corners)
            box.add(p);
        return box;
    }

    /// The tets near the box for which holds(tet, corners), ascending.
    template <typename Holds>
    std::vector<std::uint32_t> find(const FloatBox& box, const Holds& holds) const
    {
        std::vector<std::uint32_t> found;
        tree_.for_each_overlap(box, [&](int item) {
            const auto t = static_cast<std::uint32_t>(item);
            if (sign_[t] > 0 && holds(t, corners_of(mesh_, t)))
                found.push_back(t);
        });
        std::sort(found.begin(), found.end());
        return found;
    }

    bool positive(std::uint32_t t) const { return sign_[t] > 0; }

private:
    const TetMesh& mesh_;
    const std::vector<int>& sign_;
    BoxTree tree_;
};

/// Of each piece of the free faces, whether the tet behind its first one is the only one there.
void check_pieces(const FreeFaces& free, const TetMesh& mesh, const TetTree& tree,
                  ComplexCertificate& certificate)
{
    std::vector<std::uint32_t> behind;
    for (const std::uint32_t f : first_faces_of_pieces(free))
        behind.push_back(free.tet[f]);
    sort_unique(behind);
    std::vector<std::vector<std::uint32_t>> others(behind.size());
    for_each_index(
        behind.size(),
        [&](std::size_t i) {
            if (!tree.positive(behind[i]))
                return;
            const exact::Tet own = corners_of(mesh, behind[i]);
            others[i] = tree.find(TetTree::box_of(own), [&](std::uint32_t t, const auto& tet) {
                return t != behind[i] && exact::tets_overlap(own, tet);
            });
        },
        1);
    for (std::size_t i = 0; i < behind.size(); ++i)
        for (const std::uint32_t other : others[i])
            add_to(certificate.overlapping_tets, Pair{behind[i], other});
}

/// Whether the point is inside a positive tet.
bool holds(const exact::Tet& t, const Vec3s& p)
{
    return exact::orient3d(p, t[1], t[2], t[3]) > 0 && exact::orient3d(t[0], p, t[2], t[3]) > 0 &&
           exact::orient3d(t[0], t[1], p, t[3]) > 0 && exact::orient3d(t[0], t[1], t[2], p) > 0;
}

/// Whether the triangle and the tet meet in more than common corners and edges. If they do, the
/// triangle has a corner inside the tet or meets a face of it (docs/theory.md, "Tapered shells").
bool meets(const FreeFaces& free, const Vec3I& triangle, const openvdb::Vec4I& tet,
           const exact::Tet& corners)
{
    for (int k = 0; k < 3; ++k)
        if (holds(corners, free.points[triangle[k]]))
            return true;
    for (std::size_t opposite = 0; opposite < 4; ++opposite)
        if (exact::triangles_touch(free.points, triangle, tet_face(tet, opposite)))
            return true;
    return false;
}

/// Outer triangles that no tet has may not lie in the tets either.
void check_bare_triangles(const FreeFaces& free, const std::vector<char>& degenerate,
                          const TetMesh& mesh, const TetTree& tree, ComplexCertificate& certificate)
{
    std::vector<std::vector<std::uint32_t>> found(free.outer_count);
    for_each_index(free.outer_count, [&](std::size_t f) {
        if (free.tet[f] != FreeFaces::kNoTet || degenerate[f])
            return;
        const Vec3I& face = free.faces[f];
        const exact::Triangle corners{free.points[face[0]], free.points[face[1]],
                                      free.points[face[2]]};
        found[f] = tree.find(TetTree::box_of(corners), [&](std::uint32_t t, const auto& tet) {
            return meets(free, face, mesh.tets[t], tet);
        });
    });
    for (std::uint32_t f = 0; f < found.size(); ++f)
        for (const std::uint32_t tet : found[f])
            add_to(certificate.tets_through_outer, Pair{tet, f});
}

/// Whether the point, which is not on the outer surface, is behind it.
bool behind_surface(const ShellStack& stack, const Vec3s& point)
{
    const ExactWinding winding = exact_winding(point, stack.surface(0), stack.triangles());
    return winding.number > 0 && !winding.on_surface;
}

/// A piece of tets without an outer triangle of its own hangs on others by edges or corners only.
/// Any of its corners that is no outer vertex tells where it is.
void check_attached(const ShellStack& stack, const FreeFaces& free, const TetMesh& mesh,
                    ComplexCertificate& certificate)
{
    constexpr std::uint32_t kNone = ~std::uint32_t(0);
    std::vector<char> attached(free.piece.size());
    for (std::size_t f = 0; f < free.outer_count; ++f)
        if (free.tet[f] != FreeFaces::kNoTet)
            attached[free.piece[free.tet[f]]] = 1;
    std::vector<std::uint32_t> corner(free.piece.size(), kNone);
    for (std::uint32_t t = 0; t < free.piece.size(); ++t)
        for (int k = 0; k < 4; ++k)
            if (mesh.layer[mesh.tets[t][k]] > 0)
                corner[free.piece[t]] = mesh.tets[t][k];
    for (std::uint32_t t = 0; t < free.piece.size(); ++t)
        if (free.piece[t] == t && !attached[t] &&
            (corner[t] == kNone || !behind_surface(stack, mesh.points[corner[t]])))
            add_to(certificate.detached_tets, t);
}

} // namespace

bool ComplexCertificate::certified() const
{
    std::size_t failures = 0;
    for_each_kind(*this, [&](const char*, const auto& defect) { failures += defect.count; });
    return failures == 0;
}

bool ComplexCertificate::locally_valid() const
{
    return cyclic_prisms.count + bad_tets.count + open_edges.count + split_vertices.count == 0 &&
           conformity.conforming();
}

std::vector<std::string> ComplexCertificate::failures() const
{
    std::vector<std::string> lines;
    for_each_kind(*this, [&](const char* name, const auto& defect) {
        if (defect.count > 0)
            lines.push_back(failure_line(name, defect));
    });
    return lines;
}

ComplexCertificate certify_complex(const ShellStack& stack, Interrupter* interrupter)
{
    assert(!stack.layers.empty() && stack.splits.size() == stack.layers.size());
    const StageProgress progress(interrupter, "certificate");
    ComplexCertificate certificate;
    check_outer_surface(stack, certificate);
    check_orders(stack, certificate);
    // Without an order it is not known which tets there are.
    if (certificate.cyclic_prisms.count > 0)
        return certificate;
    const TetMesh tets = make_tets(stack);
    const std::vector<int> sign = check_signs(tets, certificate);
    certificate.conformity = check_conformity(stack, tets);
    progress.stop_if_interrupted(30);
    const FreeFaces free = find_free_faces(stack, tets);
    const std::vector<char> degenerate = find_degenerate(free.points, free.faces);
    check_contacts(free, degenerate, certificate);
    progress.stop_if_interrupted(80);
    const TetTree tree(tets, sign);
    check_pieces(free, tets, tree, certificate);
    check_bare_triangles(free, degenerate, tets, tree, certificate);
    check_attached(stack, free, tets, certificate);
    return certificate;
}

} // namespace vdb_shell
