// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/resample/surface_distance.h"

#include "core/parallel.h"
#include "core/stage_progress.h"
#include "mesh/triangle_area.h"
#include "resample/triangle_pieces.h"
#include "vdb_shell/core/error.h"

#include <embree3/rtcore.h>
#include <openvdb/math/Proximity.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

// Past this many points the answer would not change and memory would.
constexpr double kMostSamples = 134217728.0;

/// Embree's tree over the triangles of a mesh; nearest points in doubles.
class NearestPoint
{
public:
    explicit NearestPoint(const TriangleMesh& mesh) : mesh_(mesh), centre_(mesh.points.front())
    {
        device_ = rtcNewDevice(nullptr);
        if (!device_)
            throw std::runtime_error("Embree could not be started");
        scene_ = rtcNewScene(device_);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry,
                                         static_cast<unsigned int>(mesh.triangles.size()));
        rtcSetGeometryUserData(geometry, this);
        rtcSetGeometryBoundsFunction(geometry, store_bounds, nullptr);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~NearestPoint()
    {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    NearestPoint(const NearestPoint&) = delete;
    NearestPoint& operator=(const NearestPoint&) = delete;

    double distance(const Vec3d& point) const
    {
        const Vec3d relative = point - centre_;
        RTCPointQuery query;
        query.x = static_cast<float>(relative[0]);
        query.y = static_cast<float>(relative[1]);
        query.z = static_cast<float>(relative[2]);
        query.radius = std::numeric_limits<float>::infinity();
        query.time = 0.0F;
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        Search search{*this, point, std::numeric_limits<double>::infinity()};
        rtcPointQuery(scene_, &query, &context, visit, &search);
        return std::sqrt(search.squared);
    }

private:
    struct Search {
        const NearestPoint& tree;
        Vec3d point;
        double squared;
    };

    Vec3d corner(unsigned int triangle, int k) const
    {
        return Vec3d(mesh_.points[mesh_.triangles[triangle][k]]);
    }

    static void store_bounds(const RTCBoundsFunctionArguments* arguments)
    {
        const auto& self = *static_cast<const NearestPoint*>(arguments->geometryUserPtr);
        Vec3d low(std::numeric_limits<double>::infinity()), high = -low;
        for (int k = 0; k < 3; ++k) {
            const Vec3d p = self.corner(arguments->primID, k) - self.centre_;
            low = openvdb::math::minComponent(low, p);
            high = openvdb::math::maxComponent(high, p);
        }
        RTCBounds& bounds = *arguments->bounds_o;
        bounds.lower_x = down(low[0]), bounds.lower_y = down(low[1]), bounds.lower_z = down(low[2]);
        bounds.upper_x = up(high[0]), bounds.upper_y = up(high[1]), bounds.upper_z = up(high[2]);
    }
    static float down(double x)
    {
        return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
    }
    static float up(double x)
    {
        return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
    }

    static bool visit(RTCPointQueryFunctionArguments* arguments)
    {
        auto& search = *static_cast<Search*>(arguments->userPtr);
        const NearestPoint& self = search.tree;
        const unsigned int t = arguments->primID;
        Vec3d uvw;
        const Vec3d nearest = openvdb::math::closestPointOnTriangleToPoint(
            self.corner(t, 0), self.corner(t, 1), self.corner(t, 2), search.point, uvw);
        const double squared = (nearest - search.point).lengthSqr();
        if (!(squared < search.squared))
            return false;
        search.squared = squared;
        // The query's own point is rounded: look a little further than the distance found.
        arguments->query->radius = up(std::sqrt(squared) * (1 + 1e-6));
        return true;
    }

    const TriangleMesh& mesh_;
    Vec3d centre_;
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
};

struct Samples {
    std::vector<Vec3d> points;
    std::vector<double> areas;
};

Samples sample(const TriangleMesh& mesh, double spacing)
{
    const double area = surface_area(mesh.points, mesh.triangles);
    // Halving leaves pieces of a quarter of the square at worst on average.
    if (!(std::isfinite(spacing) && spacing > 0 && area / (spacing * spacing) * 8 < kMostSamples))
        throw InvalidOption("surface distance: spacing is " + std::to_string(spacing) +
                            " for an area of " + std::to_string(area) +
                            ", must be positive and give less than 2^27 points");
    Samples samples;
    for (const openvdb::Vec3I& t : mesh.triangles)
        for_each_piece(Vec3d(mesh.points[t[0]]), Vec3d(mesh.points[t[1]]), Vec3d(mesh.points[t[2]]),
                       spacing, [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
                           samples.points.push_back((a + b + c) / 3.0);
                           samples.areas.push_back(0.5 * (b - a).cross(c - a).length());
                       });
    for (const openvdb::Vec3s& p : mesh.points)
        samples.points.emplace_back(p);
    samples.areas.resize(samples.points.size(), 0.0);
    return samples;
}

} // namespace

DistanceFigures surface_distance(const TriangleMesh& from, const TriangleMesh& to, double spacing,
                                 Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "surface distance");
    if (from.triangles.empty() || to.triangles.empty())
        throw GeometryError("surface distance: the surfaces have " +
                            std::to_string(from.triangles.size()) + " and " +
                            std::to_string(to.triangles.size()) + " triangles");
    const Samples samples = sample(from, spacing);
    const NearestPoint nearest(to);
    std::vector<double> distances(samples.points.size());
    for_each_index(distances.size(),
                   [&](std::size_t i) { distances[i] = nearest.distance(samples.points[i]); });
    progress.stop_if_interrupted(100);
    DistanceFigures figures;
    figures.samples = distances.size();
    double area = 0;
    for (std::size_t i = 0; i < distances.size(); ++i) {
        figures.mean += samples.areas[i] * distances[i];
        area += samples.areas[i];
        figures.max = std::max(figures.max, distances[i]);
    }
    figures.mean = area > 0 ? figures.mean / area : 0.0;
    return figures;
}

} // namespace vdb_shell
