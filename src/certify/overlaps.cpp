// SPDX-License-Identifier: Apache-2.0

// Takes: any tets. Gives: all pairs whose interiors have a common point, and which tets and prisms
// are positive and in no pair. It is for shells that the certificate refuses as a whole, those of
// surfaces that cross themselves and of the raw method among them: what is certified here is
// certified tet by tet (docs/theory.md, "A surface that crosses itself"). Pairs are looked for by
// bounding boxes in a tree, and each is decided by exact signs of corners, without any constructed
// point. Pairs come sorted, so no finding depends on the number of threads.

#include "vdb_shell/certify/overlaps.h"

#include "vdb_shell/shell/tessellate.h"

#include "certify/certificate_findings.h"
#include "core/box_pairs.h"
#include "core/exact.h"
#include "core/parallel.h"
#include "core/stage_progress.h"
#include "shell/tet_faces.h"

#include <algorithm>
#include <cassert>

namespace vdb_shell
{
namespace
{

std::vector<int> signs_of(const TetMesh& mesh)
{
    std::vector<int> sign(mesh.tets.size());
    for_each_index(sign.size(), [&](std::size_t t) {
        const exact::Tet c = corners_of(mesh, t);
        sign[t] = exact::orient3d(c[0], c[1], c[2], c[3]);
    });
    return sign;
}

std::vector<FloatBox> boxes_of(const TetMesh& mesh)
{
    std::vector<FloatBox> boxes(mesh.tets.size());
    for_each_index(boxes.size(), [&](std::size_t t) {
        const exact::Tet c = corners_of(mesh, t);
        FloatBox box = FloatBox::around(c[0]);
        for (const openvdb::Vec3s& p : c)
            box.add(p);
        boxes[t] = box;
    });
    return boxes;
}

/// Boxes that only touch belong to tets that do no more than touch. The comparison is exact on
/// float32 and far cheaper than the signs.
bool interiors_overlap(const FloatBox& a, const FloatBox& b)
{
    for (int k = 0; k < 3; ++k)
        if (!(a.lo[k] < b.hi[k] && b.lo[k] < a.hi[k]))
            return false;
    return true;
}

/// Flat tets have no interior, and the exact test has no answer for them. They are excluded by
/// their exact sign, before it.
std::vector<TetPair> overlapping_tets(const TetMesh& mesh, const std::vector<int>& sign)
{
    const std::vector<FloatBox> boxes = boxes_of(mesh);
    return overlapping_pairs(boxes, [&](std::uint32_t i, std::uint32_t j) {
        return sign[i] != 0 && sign[j] != 0 && interiors_overlap(boxes[i], boxes[j]) &&
               exact::tets_overlap(corners_of(mesh, i), corners_of(mesh, j));
    });
}

PrismIndex prism_of(const TetMesh& mesh, std::size_t tet)
{
    return {mesh.prism[tet], mesh.prism_layer.empty() ? 0U : mesh.prism_layer[tet]};
}

/// Counts by layer, then by triangle, whatever the order of the tets, so that each prism is named
/// once.
void count_prisms(const TetMesh& mesh, Overlaps& found)
{
    std::vector<std::array<std::uint32_t, 3>> uses; // layer, triangle, certified
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        const PrismIndex prism = prism_of(mesh, t);
        uses.push_back({prism[1], prism[0], found.certified[t]});
    }
    std::sort(uses.begin(), uses.end()); // in each prism the uncertified tets first
    for (std::size_t i = 0; i < uses.size(); ++i) {
        if (i > 0 && uses[i][0] == uses[i - 1][0] && uses[i][1] == uses[i - 1][1])
            continue;
        ++found.prisms;
        if (!uses[i][2])
            add_to(found.uncertified_prisms, PrismIndex{uses[i][1], uses[i][0]});
    }
}

template <typename Element> std::string first_of(const Defect<Element>& defect)
{
    std::string text = " (first";
    for (const Element& element : defect.first)
        text += " " + index_text(element);
    return text + ")";
}

/// Where all listed prisms are of layer 0, as in every shell of a single layer, their triangles
/// alone are named.
std::string first_prisms(const Defect<PrismIndex>& defect)
{
    Defect<std::uint32_t> triangles;
    for (const PrismIndex& prism : defect.first) {
        if (prism[1] > 0)
            return first_of(defect);
        triangles.first.push_back(prism[0]);
    }
    return first_of(triangles);
}

/// Certified tets have no interior point in common, so the sum of their volumes is the volume of
/// the space that they cover.
double certified_volume(const TetMesh& mesh, const std::vector<std::uint8_t>& certified)
{
    TetMesh part;
    part.points = mesh.points;
    for (std::size_t t = 0; t < certified.size(); ++t)
        if (certified[t])
            part.tets.push_back(mesh.tets[t]);
    return tet_volume(part);
}

} // namespace

std::string Overlaps::summary() const
{
    std::string text = std::to_string(pairs.count) +
                       (pairs.count == 1 ? " pair of tets overlaps" : " pairs of tets overlap");
    if (pairs.count > 0)
        text += first_of(pairs);
    text += "; certified by themselves: " + std::to_string(certified_prisms()) + " of " +
            std::to_string(prisms) + " prisms, " + std::to_string(certified_tets()) + " of " +
            std::to_string(tets) + " tets";
    if (uncertified_prisms.count > 0)
        text += "; prisms that are not" + first_prisms(uncertified_prisms);
    return text;
}

Overlaps find_overlaps(const TetMesh& mesh, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "overlaps");
    assert(mesh.prism.size() == mesh.tets.size());
    Overlaps found;
    found.tets = mesh.tets.size();
    const std::vector<int> sign = signs_of(mesh);
    for (const int s : sign)
        // An inverted tet is not certified but remains in the search: as a set of points it may lie
        // in others, and then those are not certified either.
        found.certified.push_back(s > 0);
    for (const TetPair& pair : overlapping_tets(mesh, sign)) {
        add_to(found.pairs, pair);
        found.certified[pair[0]] = found.certified[pair[1]] = 0;
    }
    progress.stop_if_interrupted(90);
    for (std::uint32_t t = 0; t < found.tets; ++t)
        if (!found.certified[t])
            add_to(found.uncertified, t);
    count_prisms(mesh, found);
    found.certified_volume = certified_volume(mesh, found.certified);
    return found;
}

} // namespace vdb_shell
