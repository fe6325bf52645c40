// SPDX-License-Identifier: Apache-2.0

// What signed distances inside a surface cost and how wrong they are: by scan conversion of the
// tets of its shell, by OpenVDB's meshToVolume, and by the deep field of line stepping.
//
//   distance_probe MESH [RESOLUTION [REPEATS]]
//
// One JSON object. Each way is timed REPEATS times, the ways in turn; seconds are the medians of
// CPU time and of wall time, memory is the greatest that a way took beyond what there was before
// it. Errors are in voxels against the exact distances, which are themselves compared with all
// triangles in doubles at five hundred voxels. The two poses that lie a frame apart are those of a
// twist by half a turn in twenty frames. docs/scripts/distance_fields.py makes the tables of it.

#include "core/parallel.h"
#include "field/deep_field.h"
#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_corners.h"
#include "shapes/motions.h"

#include <vdb_shell/io/read_mesh.h>
#include <vdb_shell/pipeline.h>
#include <vdb_shell/volume/tet_distance.h>

#include <openvdb/openvdb.h>

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <exception>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

using namespace vdb_shell;
using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Vec3d;

namespace
{

constexpr std::size_t kSamples = 500;

/// Of /proc/self/status, in MiB.
double memory(const std::string& key)
{
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind(key + ":", 0) == 0)
            return std::stod(line.substr(key.size() + 1)) / 1024;
    return 0;
}

struct Way {
    std::string name;
    std::function<FloatGrid::Ptr()> make;
    std::vector<double> cpu, wall, peak;
    FloatGrid::Ptr grid;
};

void time(Way& way)
{
    way.grid.reset();
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << 5; // the peak begins anew
    const double before = memory("VmRSS");
    const std::clock_t cpu = std::clock();
    const auto wall = std::chrono::steady_clock::now();
    way.grid = way.make();
    way.wall.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count());
    way.cpu.push_back(double(std::clock() - cpu) / CLOCKS_PER_SEC);
    way.peak.push_back(memory("VmHWM") - before);
}

double median(std::vector<double> values)
{
    std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

/// Over the voxels of `exact`.
void print_errors(const FloatGrid& exact, const FloatGrid& other)
{
    const double voxel = exact.voxelSize()[0];
    const auto at = other.getConstAccessor();
    double sum = 0, most = 0, deepest_wrong = 0;
    std::size_t count = 0, beyond_half = 0, wrong_signs = 0;
    for (auto value = exact.cbeginValueOn(); value; ++value) {
        const float d = at.getValue(value.getCoord());
        const double error = std::abs(double(d) - *value) / voxel;
        sum += error, most = std::max(most, error);
        ++count;
        beyond_half += error > 0.5;
        if (*value < 0 && d > 0) {
            ++wrong_signs;
            deepest_wrong = std::max(deepest_wrong, -*value / voxel);
        }
    }
    std::cout << ", \"mean_error\": " << sum / double(std::max<std::size_t>(count, 1))
              << ", \"most_error\": " << most << ", \"beyond_half\": " << beyond_half
              << ", \"wrong_signs\": " << wrong_signs
              << ", \"deepest_wrong_sign\": " << deepest_wrong;
}

/// The largest difference to the least of the distances to all triangles.
double sampled_error(const FloatGrid& exact, const TriangleMesh& mesh)
{
    const double voxel = exact.voxelSize()[0];
    const std::size_t count = exact.activeVoxelCount(), step = count / kSamples + 1;
    std::vector<std::pair<Coord, float>> sample;
    std::size_t n = 0;
    for (auto value = exact.cbeginValueOn(); value; ++value)
        if (n++ % step == 0)
            sample.emplace_back(value.getCoord(), *value);
    std::vector<double> error(sample.size());
    for_each_index(
        sample.size(),
        [&](std::size_t i) {
            const Vec3d place = voxel * sample[i].first.asVec3d();
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
                least = std::min(
                    least,
                    (nearest_on_triangle(triangle_corners(mesh, t), place).point - place).length());
            error[i] = std::abs(least + sample[i].second) / voxel;
        },
        1);
    return error.empty() ? 0 : *std::max_element(error.begin(), error.end());
}

/// The voxels that lie in tets, from a narrow band and the tree of the deep field, as line stepping
/// reads them: by cells of two voxels a side.
FloatGrid::Ptr deep_voxels(const TriangleMesh& mesh, const LevelSetOptions& options,
                           const FloatGrid& voxels)
{
    const FloatGrid::Ptr band = mesh_to_narrow_band(mesh, options);
    const DeepField field(mesh, *band);
    const FloatGrid::Ptr grid = voxels.deepCopy();
    std::vector<openvdb::FloatTree::LeafNodeType*> leaves;
    grid->tree().getNodes(leaves);
    for_each_range(leaves.size(), [&](std::size_t begin, std::size_t end) {
        const auto in_band = band->getConstAccessor();
        TriangleTree::Nearby nearby;
        for (std::size_t n = begin; n < end; ++n)
            for (int cell = 0; cell < 64; ++cell) {
                const Coord base =
                    leaves[n]->origin().offsetBy(cell / 16 * 2, cell / 4 % 4 * 2, cell % 4 * 2);
                for (int i = 0; i < 8; ++i) {
                    const Coord at = base.offsetBy(i >> 2, i >> 1 & 1, i & 1);
                    const openvdb::Index place = leaves[n]->coordToOffset(at);
                    if (!leaves[n]->isValueOn(place))
                        continue;
                    float value = 0;
                    if (!in_band.probeValue(at, value) && value < 0)
                        value = field.value(at, base, nearby);
                    leaves[n]->setValueOnly(place, value);
                }
            }
    });
    return grid;
}

void print_ways(std::vector<Way>& ways, const FloatGrid& exact)
{
    std::cout << "{";
    for (std::size_t i = 0; i < ways.size(); ++i) {
        std::cout << (i ? ", " : "") << '"' << ways[i].name
                  << "\": {\"cpu_seconds\": " << median(ways[i].cpu)
                  << ", \"wall_seconds\": " << median(ways[i].wall)
                  << ", \"peak_mib\": " << median(ways[i].peak);
        print_errors(exact, *ways[i].grid);
        std::cout << "}";
    }
    std::cout << "}";
}

Way tet_way(const std::string& name, const ShellStack& stack, const TetMesh& tets, double voxel,
            TetDistanceMethod method)
{
    return {name,
            [&stack, &tets, voxel, method] {
                return tet_distances(stack, tets, {voxel, method}).distance;
            },
            {},
            {},
            {},
            {}};
}

struct Pose {
    ShellStack stack;
    TetMesh tets;
};

Pose pose_at(const RestShell& rest, double phase)
{
    Pose pose{pose_shell(rest, samples::twist(rest.stack().surface(0), 180, phase)).stack, {}};
    pose.tets = make_tets(pose.stack);
    return pose;
}

void probe_poses(const ShellStack& stack, double voxel, int repeats)
{
    const RestShell rest(stack);
    const Pose before = pose_at(rest, 0.5), now = pose_at(rest, 0.55);
    const TetDistances known = tet_distances(before.stack, before.tets, {voxel});
    std::vector<Way> ways;
    for (const TetDistanceMethod method :
         {TetDistanceMethod::own_prism, TetDistanceMethod::near_prisms, TetDistanceMethod::exact}) {
        const std::string name = method == TetDistanceMethod::own_prism     ? "own_prism"
                                 : method == TetDistanceMethod::near_prisms ? "near_prisms"
                                                                            : "exact";
        ways.push_back(tet_way(name, now.stack, now.tets, voxel, method));
        ways.push_back({name + "_next",
                        [&, method] {
                            return next_tet_distances(now.stack, now.tets, before.tets,
                                                      *known.nearest, {voxel, method})
                                .distance;
                        },
                        {},
                        {},
                        {},
                        {}});
    }
    for (int i = 0; i < repeats; ++i)
        for (Way& way : ways)
            time(way);
    std::cout << ", \"next_frame\": ";
    print_ways(ways, *ways.back().grid);
}

void probe(const std::string& path, int resolution, int repeats)
{
    const TriangleMesh mesh = read_mesh(path).mesh;
    ShellOptions options;
    options.coverage.samples = 0;
    const ShellResult result = build_shell(mesh, options);
    LevelSetOptions level_set;
    level_set.resolution = resolution;
    const double voxel = resolve_voxel_size(mesh, level_set);
    const TetDistances exact = tet_distances(result.stack, result.tets, {voxel});
    std::vector<Way> ways;
    ways.push_back(
        tet_way("own_prism", result.stack, result.tets, voxel, TetDistanceMethod::own_prism));
    ways.push_back(
        tet_way("near_prisms", result.stack, result.tets, voxel, TetDistanceMethod::near_prisms));
    ways.push_back(tet_way("exact", result.stack, result.tets, voxel, TetDistanceMethod::exact));
    ways.push_back(
        {"mesh_to_volume", [&] { return mesh_to_level_set(mesh, level_set); }, {}, {}, {}, {}});
    ways.push_back({"deep_field",
                    [&] { return deep_voxels(mesh, level_set, *exact.distance); },
                    {},
                    {},
                    {},
                    {}});
    for (int i = 0; i < repeats; ++i)
        for (Way& way : ways)
            time(way);
    std::cout << "{\"triangles\": " << mesh.triangles.size()
              << ", \"certified\": " << (result.report.certificate->certified() ? "true" : "false")
              << ", \"fill\": " << result.report.fill
              << ", \"voxels\": " << exact.distance->activeVoxelCount()
              << ", \"sampled_error\": " << sampled_error(*exact.distance, mesh) << ", \"ways\": ";
    print_ways(ways, *exact.distance);
    probe_poses(result.stack, voxel, repeats);
    std::cout << "}" << std::endl;
}

} // namespace

int main(int argc, char** argv)
try {
    if (argc < 2 || argc > 4) {
        std::cerr << "usage: distance_probe MESH [RESOLUTION [REPEATS]]\n";
        return 2;
    }
    openvdb::initialize();
    probe(argv[1], argc > 2 ? std::stoi(argv[2]) : 256, argc > 3 ? std::stoi(argv[3]) : 3);
    return 0;
} catch (const std::exception& error) {
    std::cerr << "distance_probe: " << error.what() << '\n';
    return 1;
}
