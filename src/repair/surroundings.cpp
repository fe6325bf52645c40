// SPDX-License-Identifier: Apache-2.0

// Takes a surface that grows by fills. Keeps trees over it in which what is near a fill is found
// without building anew what has not changed.

#include "repair/surroundings.h"

#include "core/triangle_piece.h"

namespace vdb_shell::repair
{

Surroundings::Surroundings(const TriangleMesh& mesh, const std::vector<Hole>& holes)
    : mesh_(mesh), on_rim_(mesh.points.size()), around_(mesh.points.size())
{
    for (const Hole& hole : holes)
        for (const std::uint32_t point : hole.points)
            on_rim_[point] = 1;
    add_from(0);
}

void Surroundings::update()
{
    const std::size_t known = parts_.empty() ? 0 : parts_.back().end;
    if (known < mesh_.triangles.size())
        add_from(known);
}

void Surroundings::add_from(std::size_t begin)
{
    const std::size_t end = mesh_.triangles.size();
    for (std::size_t t = begin; t < end; ++t)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t point = mesh_.triangles[t][k];
            // Points of fills are on no rim.
            if (point < on_rim_.size() && on_rim_[point])
                around_[point].push_back(static_cast<std::uint32_t>(t));
        }
    while (!parts_.empty() && parts_.back().end - parts_.back().begin <= end - begin) {
        begin = parts_.back().begin;
        parts_.pop_back();
    }
    PartBoxes boxes = part_boxes(
        mesh_.points, {mesh_.triangles.begin() + std::ptrdiff_t(begin), mesh_.triangles.end()});
    parts_.push_back({begin, end, {}, std::move(boxes.triangle)});
    parts_.back().tree.build(boxes.boxes);
}

} // namespace vdb_shell::repair
