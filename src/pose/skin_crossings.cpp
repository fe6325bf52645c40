// SPDX-License-Identifier: Apache-2.0

// Takes a posed skin and where the shell's points are carried. Gives the triangles whose prisms
// cannot be free of contacts because the skin crosses itself there, as it does in armpits. Behind
// them the solid is covered twice, which the winding number of the skin tells. It changes nowhere
// along a piece of skin that crosses nothing, so each piece is asked once; and what is covered
// twice is bounded by such pieces, so only pillars in their boxes are asked besides.

#include "pose/skin_crossings.h"

#include "core/box_pairs.h"
#include "core/box_tree.h"
#include "core/disjoint_sets.h"
#include "core/parallel.h"
#include "field/winding_number.h"
#include "mesh/surface_defects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

/// Winding numbers of points near the skin are off by up to 0.02, so half a turn tells for certain.
bool other_than_once(float turns)
{
    return std::abs(turns - 1.0f) > 0.5f;
}

class CoveredTwice
{
public:
    CoveredTwice(const RestShell::Parts& parts, const PoseState& state,
                 const std::vector<Vec3s>& skin, const std::vector<TrianglePair>& pairs)
        : parts_(parts), state_(state), skin_(skin), pairs_(pairs),
          winding_(corners_of(parts, skin))
    {
    }

    /// Vertices of triangles that cross others or have behind them what the skin does not enclose
    /// once, and vertices whose pillar leads there.
    std::vector<std::uint8_t> vertices() const
    {
        const std::vector<Vec3I>& triangles = parts_.stack.triangles();
        const std::vector<std::uint8_t> marked = marked_triangles();
        std::vector<std::uint8_t> vertex(skin_.size(), 0);
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (int k = 0; marked[t] && k < 3; ++k)
                vertex[triangles[t][k]] = 1;
        BoxTree boxes;
        boxes.build(boxes_of_classes(marked));
        for_each_index(
            skin_.size(), [&](std::size_t v) { vertex[v] = vertex[v] || leads_there(boxes, v); },
            16);
        return vertex;
    }

private:
    static std::vector<TriangleCorners> corners_of(const RestShell::Parts& parts,
                                                   const std::vector<Vec3s>& skin)
    {
        std::vector<TriangleCorners> corners;
        for (const Vec3I& t : parts.stack.triangles())
            corners.push_back({Vec3d(skin[t[0]]), Vec3d(skin[t[1]]), Vec3d(skin[t[2]])});
        return corners;
    }
    FloatBox box_of(std::size_t triangle) const
    {
        return triangle_box(skin_, parts_.stack.triangles()[triangle]);
    }

    std::vector<std::uint8_t> marked_triangles() const
    {
        const std::size_t count = parts_.stack.triangles().size();
        std::vector<std::uint8_t> crossing(count, 0);
        for (const TrianglePair& pair : pairs_)
            crossing[pair[0]] = crossing[pair[1]] = 1;
        DisjointSets pieces(count);
        for (const auto& [t, u] : parts_.neighbours)
            if (!crossing[t] && !crossing[u])
                pieces.join(t, u);
        // Each piece is asked behind its largest triangle, where the error is least.
        std::vector<std::uint32_t> piece(count), largest(count);
        std::vector<double> area(count, -1.0);
        for (std::uint32_t t = 0; t < count; ++t) {
            piece[t] = pieces.root_of(t);
            const double own = normal_of(t).lengthSqr();
            if (own > area[piece[t]])
                area[piece[t]] = own, largest[piece[t]] = t;
        }
        std::vector<std::uint8_t> marked(count, 0);
        for (std::uint32_t t = 0; t < count; ++t)
            if (piece[t] == t && !crossing[t])
                marked[t] = other_than_once(turns_behind(largest[t]));
        for (std::uint32_t t = 0; t < count; ++t)
            marked[t] = crossing[t] || marked[piece[t]];
        return marked;
    }
    Vec3d normal_of(std::uint32_t t) const
    {
        const Vec3I& c = parts_.stack.triangles()[t];
        const Vec3d a(skin_[c[0]]);
        return (Vec3d(skin_[c[1]]) - a).cross(Vec3d(skin_[c[2]]) - a);
    }
    float turns_behind(std::uint32_t t) const
    {
        // As near as the rounding lets be: nothing else of the skin shall be between.
        constexpr double kShareOfSide = 1e-3;
        const Vec3I& c = parts_.stack.triangles()[t];
        const Vec3d normal = normal_of(t);
        const Vec3d middle = (Vec3d(skin_[c[0]]) + Vec3d(skin_[c[1]]) + Vec3d(skin_[c[2]])) / 3.0;
        const Vec3d at = middle - normal * (kShareOfSide / std::sqrt(normal.length()));
        float turns = 0;
        winding_.around(&at, 1, &turns);
        return turns;
    }

    /// What is covered twice is bounded by marked triangles that hang together.
    std::vector<FloatBox> boxes_of_classes(const std::vector<std::uint8_t>& marked) const
    {
        DisjointSets classes(marked.size());
        for (const auto& [t, u] : parts_.neighbours)
            if (marked[t] && marked[u])
                classes.join(t, u);
        for (const TrianglePair& pair : pairs_)
            classes.join(pair[0], pair[1]);
        constexpr std::uint32_t kNone = ~std::uint32_t(0);
        std::vector<std::uint32_t> index(marked.size(), kNone);
        std::vector<FloatBox> boxes;
        for (std::uint32_t t = 0; t < marked.size(); ++t) {
            if (!marked[t])
                continue;
            std::uint32_t& at = index[classes.root_of(t)];
            if (at == kNone) {
                at = static_cast<std::uint32_t>(boxes.size());
                boxes.push_back(box_of(t));
            }
            boxes[at].add(box_of(t));
        }
        return boxes;
    }

    bool leads_there(const BoxTree& boxes, std::size_t v) const
    {
        const std::size_t place = (parts_.stack.surfaces() - 1) * skin_.size() + v;
        const std::uint32_t point = parts_.point_of_place[parts_.first_place[place]];
        if (point == RestShell::Parts::kFree)
            return false;
        FloatBox box = FloatBox::around(skin_[v]);
        box.add(Vec3s(state_.place[point]));
        bool near = false;
        boxes.for_each_overlap(box, [&](int) { near = true; });
        if (!near)
            return false;
        // Along the pillar; its ends can lie on the skin.
        std::array<Vec3d, 3> at;
        for (std::size_t i = 0; i < at.size(); ++i)
            at[i] =
                Vec3d(skin_[v]) + (double(i) + 0.5) / 3 * (state_.place[point] - Vec3d(skin_[v]));
        std::array<float, 3> turns{};
        winding_.around(at.data(), at.size(), turns.data());
        return std::any_of(turns.begin(), turns.end(), other_than_once);
    }

    const RestShell::Parts& parts_;
    const PoseState& state_;
    const std::vector<Vec3s>& skin_;
    const std::vector<TrianglePair>& pairs_;
    WindingNumber winding_;
};

} // namespace

SkinCrossings find_skin_crossings(const RestShell::Parts& parts, const PoseState& state,
                                  const std::vector<Vec3s>& skin, Interrupter* interrupter)
{
    const std::vector<Vec3I>& triangles = parts.stack.triangles();
    const TriangleMesh mesh{skin, triangles};
    const std::vector<TrianglePair> pairs =
        find_self_intersections(mesh, find_degenerate(mesh.points, mesh.triangles), interrupter);
    SkinCrossings found;
    found.pairs = pairs.size();
    if (pairs.empty())
        return found;
    const std::vector<std::uint8_t> vertex = CoveredTwice(parts, state, skin, pairs).vertices();
    found.region.resize(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        found.region[t] =
            vertex[triangles[t][0]] || vertex[triangles[t][1]] || vertex[triangles[t][2]];
    return found;
}

} // namespace vdb_shell
