// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <algorithm>
#include <array>
#include <vector>

namespace vdb_shell::growth
{

using openvdb::Vec3d;

struct Box {
    Vec3d lo{1e300}, hi{-1e300};
    void add(const Vec3d& p)
    {
        for (int k = 0; k < 3; ++k)
            lo[k] = std::min(lo[k], p[k]), hi[k] = std::max(hi[k], p[k]);
    }
    void add(const Box& o) { add(o.lo), add(o.hi); }
    void inflate(double r) { lo -= Vec3d(r), hi += Vec3d(r); }
    bool meets_ray(const Vec3d& p, const Vec3d& d, double limit) const
    {
        double t0 = 0, t1 = limit;
        for (int k = 0; k < 3; ++k) {
            if (d[k] == 0) {
                if (p[k] < lo[k] || p[k] > hi[k])
                    return false;
                continue;
            }
            const double a = (lo[k] - p[k]) / d[k], b = (hi[k] - p[k]) / d[k];
            t0 = std::max(t0, std::min(a, b)), t1 = std::min(t1, std::max(a, b));
        }
        return t0 <= t1 * (1 + 1e-9) + 1e-300;
    }
    bool contains(const Vec3d& p) const
    {
        return lo[0] <= p[0] && p[0] <= hi[0] && lo[1] <= p[1] && p[1] <= hi[1] && lo[2] <= p[2] &&
               p[2] <= hi[2];
    }
    bool overlaps(const Box& o) const
    {
        return lo[0] <= o.hi[0] && o.lo[0] <= hi[0] && lo[1] <= o.hi[1] && o.lo[1] <= hi[1] &&
               lo[2] <= o.hi[2] && o.lo[2] <= hi[2];
    }
};

/// A tree over boxes that is rebuilt every round and queried in parallel; core/box_pairs.h finds
/// all pairs of a fixed list, this one answers a box or a ray at a time.
class BoxTree
{
public:
    void build(std::vector<Box> boxes);
    /// Same boxes, moved: the tree keeps its shape. Precondition: as many boxes as in build().
    void refit(std::vector<Box> boxes);

    /// Calls visit(i) for every box i that overlaps `query`.
    template <class Visit> void for_each_overlap(const Box& query, Visit&& visit) const
    {
        descend([&](const Box& box) { return box.overlaps(query); }, visit);
    }

    /// Calls visit(i) for the boxes the ray p + t d, 0 <= t <= limit, may meet; visit may lower
    /// limit.
    template <class Visit>
    void for_each_on_ray(const Vec3d& p, const Vec3d& d, const double& limit, Visit&& visit) const
    {
        descend([&](const Box& box) { return box.meets_ray(p, d, limit); }, visit);
    }

private:
    struct Node {
        Box box;
        int begin, end;
        int right; ///< negative: a leaf; the left child follows its parent
    };
    // The tree is split at medians, so its depth stays below 32.
    static constexpr int kStack = 64;

    void split(int id, int begin, int end);

    /// Calls visit(i) for every box i that is met, leaving out what lies under boxes that are not.
    template <class Meets, class Visit> void descend(const Meets& meets, Visit&& visit) const
    {
        if (nodes_.empty())
            return;
        std::array<int, kStack> stack;
        int top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Node& n = nodes_[stack[--top]];
            if (!meets(n.box))
                continue;
            if (n.right < 0) {
                for (int i = n.begin; i < n.end; ++i)
                    if (meets(boxes_[item_[i]]))
                        visit(item_[i]);
            } else {
                stack[top++] = n.right;
                stack[top++] = static_cast<int>(&n - nodes_.data()) + 1;
            }
        }
    }

    // Owned: the tree is read long after its caller's boxes have moved on.
    std::vector<Box> boxes_;
    std::vector<int> item_;
    std::vector<Node> nodes_;
};

} // namespace vdb_shell::growth
