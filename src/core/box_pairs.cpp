// SPDX-License-Identifier: Apache-2.0
#include "core/box_pairs.h"

#include "core/deal_out.h"
#include "core/parallel.h"

#include <embree3/rtcore.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <stdexcept>

namespace vdb_shell
{
namespace
{

using Pair = std::array<std::uint32_t, 2>;

struct Collector {
    const KeepPair& keep;
    tbb::enumerable_thread_specific<std::vector<Pair>> by_thread;
};

void store_bounds(const RTCBoundsFunctionArguments* arguments)
{
    const auto& boxes = *static_cast<const std::vector<Box>*>(arguments->geometryUserPtr);
    const Box& box = boxes[arguments->primID];
    RTCBounds& bounds = *arguments->bounds_o;
    bounds.lower_x = box.low[0], bounds.lower_y = box.low[1], bounds.lower_z = box.low[2];
    bounds.upper_x = box.high[0], bounds.upper_y = box.high[1], bounds.upper_z = box.high[2];
}

void store_pairs(void* user, RTCCollision* collisions, unsigned int count)
{
    Collector& collector = *static_cast<Collector*>(user);
    std::vector<Pair>& pairs = collector.by_thread.local();
    for (unsigned int i = 0; i < count; ++i) {
        const auto [low, high] = std::minmax(collisions[i].primID0, collisions[i].primID1);
        if (low < high && collector.keep(low, high))
            pairs.push_back({low, high});
    }
}

} // namespace

std::vector<Box> triangle_boxes(const std::vector<openvdb::Vec3s>& points,
                                const std::vector<openvdb::Vec3I>& triangles)
{
    std::vector<Box> boxes(triangles.size());
    for_each_index(triangles.size(), [&](std::size_t t) {
        Box box{points[triangles[t][0]], points[triangles[t][0]]};
        for (int corner = 1; corner < 3; ++corner) {
            const openvdb::Vec3s& p = points[triangles[t][corner]];
            box.low = openvdb::math::minComponent(box.low, p);
            box.high = openvdb::math::maxComponent(box.high, p);
        }
        boxes[t] = box;
    });
    return boxes;
}

std::vector<Pair> overlapping_pairs(const std::vector<Box>& boxes)
{
    return overlapping_pairs(boxes, [](std::uint32_t, std::uint32_t) { return true; });
}

std::vector<Pair> overlapping_pairs(const std::vector<Box>& boxes, const KeepPair& keep)
{
    if (boxes.empty())
        return {};
    RTCDevice device = rtcNewDevice(nullptr);
    if (!device)
        throw std::runtime_error("Embree could not be started");
    RTCScene scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned int>(boxes.size()));
    rtcSetGeometryUserData(geometry, const_cast<std::vector<Box>*>(&boxes));
    rtcSetGeometryBoundsFunction(geometry, store_bounds, nullptr);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcCommitScene(scene);

    Collector collector{keep, {}};
    rtcCollide(scene, scene, store_pairs, &collector);
    rtcReleaseGeometry(geometry);
    rtcReleaseScene(scene);
    const bool ok = rtcGetDeviceError(device) == RTC_ERROR_NONE;
    rtcReleaseDevice(device);
    if (!ok)
        throw std::runtime_error("Embree could not collide the bounding boxes");

    auto pairs = deal_out<Pair>(
        collector.by_thread, boxes.size(), [](const Pair& pair) { return pair[0]; },
        [](const Pair& x, const Pair& y) { return x[1] < y[1]; });
    const auto same = [](const Pair& x, const Pair& y) { return x[0] == y[0] && x[1] == y[1]; };
    pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
    return pairs;
}

} // namespace vdb_shell
