// SPDX-License-Identifier: Apache-2.0
#include "io/file_scan.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace vdb_shell
{

std::size_t first_unique_corner(const Corners& corners)
{
    Corners sorted = corners;
    std::sort(sorted.begin(), sorted.end());
    const auto once = [&](std::uint32_t corner) {
        const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), corner);
        return last - first == 1;
    };
    return static_cast<std::size_t>(std::find_if(corners.begin(), corners.end(), once) -
                                    corners.begin());
}

bool tidy_polygon(Corners& corners)
{
    if (corners.size() == 3 && corners[0] != corners[1] && corners[1] != corners[2] &&
        corners[2] != corners[0])
        return true;
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    while (corners.size() > 1 && corners.front() == corners.back())
        corners.pop_back();
    return corners.size() >= 3 && first_unique_corner(corners) < corners.size();
}

bool count_face(FileScan& scan, Corners& corners)
{
    const std::size_t face = scan.file_faces++;
    if (tidy_polygon(corners)) {
        scan.corners_passed_on += corners.size();
        return true;
    }
    scan.skipped_faces.push_back(face);
    return false;
}

void require_corner(const std::string& name, const Place& face, std::int64_t index,
                    std::size_t vertices, const std::string& shown)
{
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertices)
        refuse(name, face.text() + ": the vertex index " + shown +
                         " is out of range, the file has " + std::to_string(vertices) +
                         " vertices");
}

std::vector<std::uint32_t> first_equal_point(const std::vector<openvdb::Vec3s>& points)
{
    auto key = [&](std::uint32_t i) {
        const openvdb::Vec3s& p = points[i];
        return std::make_tuple(p[0], p[1], p[2], i);
    };
    std::vector<std::uint32_t> order(points.size()), first(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::size_t k = 0; k < order.size(); ++k) {
        const bool repeats = k > 0 && points[order[k]] == points[order[k - 1]];
        first[order[k]] = repeats ? first[order[k - 1]] : order[k];
    }
    return first;
}

std::string plain_ply_header(const char* encoding, const char* coordinate, std::size_t vertices,
                             std::size_t faces)
{
    const std::string type = coordinate;
    return "ply\nformat " + std::string(encoding) + " 1.0\nelement vertex " +
           std::to_string(vertices) + "\nproperty " + type + " x\nproperty " + type +
           " y\nproperty " + type + " z\nelement face " + std::to_string(faces) +
           "\nproperty list int int vertex_indices\nend_header\n";
}

} // namespace vdb_shell
