// SPDX-License-Identifier: Apache-2.0
#pragma once

// What is near a fill of a hole.

#include "core/box_tree.h"
#include "repair/hole_walk.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace vdb_shell::repair
{

/// The surface with the fills made so far: trees over its triangles, and the triangles at each
/// point of a rim. A fill is a tree of its own until there are as many triangles in the trees
/// behind; they are made one then. So each triangle is put into a tree a logarithm of times, and
/// there are no more trees than that, however many holes there are.
class Surroundings
{
public:
    Surroundings(const TriangleMesh& mesh, const std::vector<Hole>& holes);

    /// Takes note of the triangles that were appended since.
    void update();

    const std::vector<std::uint32_t>& around(std::uint32_t point) const { return around_[point]; }

    /// Each triangle that has a part near one of these boxes, once, until visit(t) returns false.
    template <typename Visit>
    void for_each_near(const std::vector<FloatBox>& boxes, const Visit& visit)
    {
        ++search_;
        seen_.resize(mesh_.triangles.size(), 0);
        bool on = true;
        for (const FloatBox& box : boxes)
            for (auto part = parts_.begin(); on && part != parts_.end(); ++part)
                part->tree.for_each_overlap_while(box, [&](int i) {
                    const std::size_t t = part->begin + part->triangle[std::size_t(i)];
                    if (std::exchange(seen_[t], search_) != search_)
                        on = visit(t);
                    return on;
                });
    }

private:
    struct Part {
        std::size_t begin, end;
        BoxTree tree; ///< of parts of triangles: needles lie in each other's boxes
        std::vector<std::uint32_t> triangle; ///< of each, from begin
    };

    void add_from(std::size_t begin);

    const TriangleMesh& mesh_;
    std::vector<char> on_rim_;
    std::vector<std::vector<std::uint32_t>> around_; ///< by point, those of rims only
    std::vector<Part> parts_;
    std::vector<std::uint32_t> seen_; ///< by triangle: the last search that came to it
    std::uint32_t search_ = 0;
};

} // namespace vdb_shell::repair
