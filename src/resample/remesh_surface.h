// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_tree.h"
#include "resample/feature_curves.h"
#include "resample/moving_boxes.h"
#include "resample/triangles_around.h"
#include "vdb_shell/resample/remesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace vdb_shell
{

/// Why an operation was not done. In the order of the tests, of which the first that fails counts.
enum class Refusal : std::uint8_t { none, topology, feature, length, shape, turned, contact, far };

/// What a vertex may do: move over the surface, slide along its curve, nothing.
enum class VertexKind : std::uint8_t { free, on_curve, corner };

/// Where a split puts the new vertex, unless the edge is on a curve of features.
enum class SplitTo : std::uint8_t { middle, input };

/// For the cosine of an operation: every angle has a smaller one.
constexpr double kLargerThanBefore = -1;

/// A triangle surface whose edges are split, collapsed and flipped and whose vertices are moved.
/// Each operation is done only if the surface stays a closed manifold of the same topology,
/// embedded (exact), near the input and turned as it is, and if feature edges stay; else nothing
/// changes. Precondition: the input is closed, manifold, consistently oriented, embedded.
class RemeshSurface
{
public:
    /// Keeps references. Lengths in world units: how far the surfaces may be apart, and how far
    /// points of the input may be from each other at which that is tested.
    RemeshSurface(const TriangleMesh& input, const FeatureCurves& features, double tolerance,
                  double spacing);

    // What there is. Triangles and vertices that have gone keep their numbers until new ones take
    // them.
    std::size_t triangle_slots() const { return triangles_.size(); }
    std::size_t live_triangles() const { return live_; }
    bool alive(std::uint32_t t) const { return triangles_[t][0] != triangles_[t][1]; }
    const openvdb::Vec3I& triangle(std::uint32_t t) const { return triangles_[t]; }
    std::size_t vertex_slots() const { return points_.size(); }
    openvdb::Vec3d point(std::uint32_t v) const { return openvdb::Vec3d(points_[v]); }
    const std::vector<std::uint32_t>& star(std::uint32_t v) const { return star_[v]; }
    VertexKind kind(std::uint32_t v) const { return kind_[v]; }
    bool on_input(std::uint32_t v) const { return on_input_[v] != 0; }
    /// Cosine of the smallest angle.
    double cosine(std::uint32_t t) const { return cosine_[t]; }
    bool has_edge(std::uint32_t a, std::uint32_t b) const;
    bool is_feature(std::uint32_t a, std::uint32_t b) const { return feature(a, b) != nullptr; }
    double length(std::uint32_t a, std::uint32_t b) const { return (point(a) - point(b)).length(); }
    /// Counts what has been done; and what it was at when this triangle became what it is, 0 for
    /// those of the input.
    std::uint64_t now() const { return now_; }
    std::uint64_t changed_at(std::uint32_t t) const { return changed_at_[t]; }
    /// The two triangles of an edge: the first runs from a to b. Precondition: it is one.
    std::array<std::uint32_t, 2> triangles_at(std::uint32_t a, std::uint32_t b) const;
    /// The wanted length of edges at a vertex, for callers to read and set.
    double& size(std::uint32_t v) { return size_[v]; }
    double size(std::uint32_t v) const { return size_[v]; }
    double size_of_edge(std::uint32_t a, std::uint32_t b) const
    {
        return 0.5 * (size_[a] + size_[b]);
    }

    // The operations. `cosine`: no triangle may get a smaller angle than that of this cosine, but
    // for one that is no smaller than the smallest before; kLargerThanBefore: the smallest has to
    // grow.
    Refusal split(std::uint32_t a, std::uint32_t b, SplitTo to, double cosine);
    /// `longest`: of the wanted lengths, which no new edge may be longer than.
    Refusal collapse(std::uint32_t a, std::uint32_t b, double longest, double cosine);
    Refusal flip(std::uint32_t a, std::uint32_t b, double cosine);
    /// A free vertex, to the point of the input nearest to p.
    Refusal move(std::uint32_t v, const openvdb::Vec3d& p, double cosine);
    /// A vertex on a curve: to where its curve is at this share of the way between its neighbours
    /// there.
    Refusal slide(std::uint32_t v, double share, double cosine);
    /// The neighbours of a vertex on a curve, along the curve.
    std::array<std::uint32_t, 2> along_curve(std::uint32_t v) const;
    /// The point of its curve at this share of the way between these neighbours.
    openvdb::Vec3d point_between(std::uint32_t v, double share) const;

    /// Looks at one more point of the input from now on, which is near that triangle.
    void look_at(const openvdb::Vec3d& p, std::uint32_t t);
    /// Finds the nearest triangle for each sample anew, from neighbour to neighbour, so that none
    /// of them jumps to another sheet.
    void settle_samples();

    /// The surface without gaps in its numbers, and both maps.
    RemeshResult result() const;

private:
    struct FeatureEdge {
        std::uint32_t curve, from;
        double s_from, s_to;
    };
    /// An edge that is to become a feature edge.
    struct NewFeature {
        std::uint32_t a, b;
        FeatureEdge edge;
    };
    /// Triangles that take the place of others. Every new edge has the hub for an end.
    struct Patch {
        std::vector<std::uint32_t> removed;
        std::vector<openvdb::Vec3I> added;
        std::vector<NewFeature> features;
        std::vector<std::uint64_t> forgotten; ///< keys of feature edges that go
        std::uint32_t hub = 0;
        /// What comes is where what goes was, but for rounding: nowhere nearer or farther than
        /// that.
        bool same_surface = false;
        void clear()
        {
            removed.clear(), added.clear(), features.clear(), forgotten.clear();
            same_surface = false;
        }
    };
    struct Foot {
        openvdb::Vec3d point{0.0};
        openvdb::Vec3d normal{0.0}; ///< of the input's triangle, unit length or zero
        double squared = 0;
    };
    struct Shape {
        double cosine, facing;
    };

    static std::uint64_t key(std::uint32_t a, std::uint32_t b)
    {
        return a < b ? std::uint64_t(a) << 32U | b : std::uint64_t(b) << 32U | a;
    }
    const FeatureEdge* feature(std::uint32_t a, std::uint32_t b) const;
    std::array<std::uint32_t, 2> opposite(std::uint32_t a, std::uint32_t b) const;
    std::vector<std::uint32_t> ring(std::uint32_t v) const;
    std::uint32_t new_vertex(const openvdb::Vec3d& p, double size);

    void place_samples(double spacing);
    Foot foot_of(const openvdb::Vec3d& p) const;
    openvdb::Vec3d cross_of(const openvdb::Vec3I& c) const;
    std::array<openvdb::Vec3d, 3> corners_of(const openvdb::Vec3I& c) const;

    /// Does what the patch says, with its hub at p, if that is allowed.
    Refusal replace(const Patch& patch, const openvdb::Vec3s& p, double cosine);
    Refusal refusal_of(const Patch& patch, double cosine);
    bool keeps_shape(const Patch& patch, double cosine);
    bool faces_as_before(const Patch& patch);
    bool stays_in_plane(const Patch& patch) const;
    bool touches(const Patch& patch) const;
    bool is_near(const Patch& patch, double squared);
    double farthest_before(const Patch& patch) const;
    bool keeps_near(const Patch& patch);
    bool features_near(const Patch& patch) const;
    bool samples_near(const Patch& patch);
    void commit(const Patch& patch);
    void find_homes(std::uint32_t from, const std::vector<std::uint32_t>& samples,
                    std::vector<std::uint32_t>& homes) const;
    std::uint32_t home_from(std::uint32_t t, const openvdb::Vec3d& p) const;
    void neighbours_of(std::uint32_t t, std::vector<std::uint32_t>& around) const;
    void unlink(std::uint32_t t);
    void link(std::uint32_t t, const openvdb::Vec3I& corners, const Shape& shape);
    void put(std::uint32_t t, const openvdb::Vec3I& corners, const Shape& shape);

    // Operations on feature edges, in remesh_operations.cpp.
    bool keeps_manifold(std::uint32_t a, std::uint32_t b) const;
    bool collapse_patch(std::uint32_t gone, std::uint32_t kept, double s, Patch& patch) const;
    void hand_on_features(std::uint32_t gone, std::uint32_t kept, double s, Patch& patch) const;
    Refusal collapse_to(std::uint32_t gone, std::uint32_t kept, const openvdb::Vec3d& p, double s,
                        double longest, double cosine);
    bool too_long(const openvdb::Vec3d& p, double longest) const;
    Refusal collapse_free(std::uint32_t a, std::uint32_t b, double longest, double cosine);
    Refusal collapse_on_curve(std::uint32_t a, std::uint32_t b, double longest, double cosine);

    const TriangleMesh& input_;
    const FeatureCurves& features_;
    double tolerance_;
    double scale_; ///< makes of lengths numbers near 1, for floats
    TriangleTree tree_;
    mutable TriangleTree::Seed seed_ = TriangleTree::kNoSeed;

    std::vector<openvdb::Vec3s> points_;
    std::vector<VertexKind> kind_;
    std::vector<std::uint8_t> on_input_;
    std::vector<double> size_;
    std::vector<std::vector<std::uint32_t>> star_;
    std::vector<std::uint32_t> free_vertices_;

    std::vector<openvdb::Vec3I> triangles_; ///< all corners equal: none there
    std::vector<double> cosine_;            ///< of the smallest angle
    std::vector<double> facing_;            ///< cosine to the input's normal next to the middle
    std::vector<std::uint64_t> changed_at_;
    std::uint64_t now_ = 1, settled_at_ = 1;
    std::vector<std::uint32_t> free_triangles_;
    std::size_t live_ = 0;
    MovingBoxes boxes_;

    /// Feature edges by their ends. Only looked up, never walked through: its order is not used.
    std::unordered_map<std::uint64_t, FeatureEdge> feature_edges_;

    // Points of the input, its vertices first, each with a triangle that it is near to.
    std::vector<openvdb::Vec3d> samples_;
    std::vector<std::vector<std::uint32_t>> samples_of_; ///< by triangle

    // Of the patch that is looked at: where its hub was; the largest squared distance of what goes,
    // less than 0 while it is not known.
    openvdb::Vec3s hub_before_{0.0F};
    double farthest_before_ = -1;

    // Kept between calls for their memory.
    Patch patch_;
    std::vector<Shape> shapes_; ///< of the triangles that the patch adds
    TrianglesAround around_;    ///< the same
    mutable std::vector<std::uint32_t> near_;
    /// The samples of the triangles that go, and of each the triangle to be that is nearest.
    std::vector<std::uint32_t> handed_over_, nearest_added_;
};

} // namespace vdb_shell
