// SPDX-License-Identifier: Apache-2.0

// From a surface and options to seconds, memory and bytes of files: sums of the number of triangles
// and voxels, each times a measured number (cost_numbers.h). The work of a shell depends on its
// shape too, which nobody knows before it is done, so this is good for a job's limits and not for a
// promise.

#include "command/cost_model.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include "command/cost_numbers.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace vdb_shell::command
{
namespace
{

using openvdb::Vec3d;

struct Size {
    double triangles = 0, surface_voxels = 0, solid_voxels = 0, more_layers = 0;
};

double area_of(const TriangleMesh& mesh)
{
    double sum = 0;
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const Vec3d a(mesh.points[t[0]]), b(mesh.points[t[1]]), c(mesh.points[t[2]]);
        sum += 0.5 * (b - a).cross(c - a).length();
    }
    return sum;
}

/// After resampling.
double triangles_of(const ShellOptions& shell, const TriangleMesh& mesh, double area)
{
    double count = double(mesh.triangles.size());
    if (shell.decimate.triangles)
        count = std::min(count, double(*shell.decimate.triangles));
    if (shell.remesh.triangles)
        count = double(*shell.remesh.triangles);
    if (shell.remesh.edge_length) {
        const double edge = *shell.remesh.edge_length;
        count = area / (std::sqrt(3.0) / 4 * edge * edge);
    }
    return count * std::pow(4.0, shell.subdivide.levels);
}

double sum_of(const CostNumbers& numbers, const Size& size)
{
    return numbers[0] + numbers[1] * std::min(size.triangles, kCoarseFrom) +
           numbers[2] * std::max(size.triangles - kCoarseFrom, 0.0) +
           numbers[3] * size.surface_voxels + numbers[4] * size.solid_voxels +
           numbers[5] * size.triangles * size.more_layers;
}

/// Bytes for each tet, or for each triangle of the surface where they have no tets: measured on
/// shells of 1,500, 20,000 and 40,000 triangles, which agree within a fifth.
double other_file(const std::string& extension, double triangles, double tets)
{
    static const std::map<std::string, double> by_tet{
        {".vtu", 69},  {".ele", 59},  {".node", 59},    {".mesh", 45}, {".msh", 68},
        {".geo", 203}, {".bgeo", 94}, {".bgeo.sc", 30}, {".sc", 30},   {".usda", 85}};
    static const std::map<std::string, double> by_triangle{
        {".obj", 36}, {".ply", 22}, {".off", 35}, {".stl", 50}};
    if (const auto found = by_tet.find(extension); found != by_tet.end())
        return found->second * tets;
    const auto found = by_triangle.find(extension);
    return found == by_triangle.end() ? 0 : found->second * triangles;
}

double disk_of(const Outputs& outputs, const Size& size)
{
    const double tets = 3 * size.triangles * (1 + size.more_layers);
    double bytes = 0;
    for (const std::filesystem::path& path : outputs.paths)
        bytes += path.extension() == ".vdb"
                     ? sum_of(kVdbNumbers, size)
                     : other_file(path.extension().string(), size.triangles, tets);
    return bytes;
}

std::vector<std::string> not_counted(const BuildArguments& a)
{
    const ShellOptions& s = a.shell;
    std::vector<std::string> names;
    const auto add = [&](bool given, const char* name) {
        if (given)
            names.emplace_back(name);
    };
    add(s.side != Side::inward, "--side");
    add(s.grow.method != Method::certified, "--method");
    add(s.repair.has_value(), "--repair");
    add(s.wrap.wanted, "--wrap");
    add(s.remesh.wanted(), "--remesh");
    add(s.refine.rounds > 0, "--refine-rounds");
    add(s.layers.layers == 0, "--layers auto");
    add(s.taper.wanted, "--taper");
    add(s.field == FieldRoute::dense, "--field dense");
    add(s.core_fill.wanted(), "--core-fill");
    add(!a.cores.empty(), "--core");
    return names;
}

} // namespace

double BuildCost::seconds(int threads) const
{
    // A second thread makes builds 1.81 times as fast (docs/measurements/benchmarks.md); by
    // Amdahl's law a tenth of the work is serial. More threads were not measured.
    constexpr double kSerial = 0.105;
    return cpu_seconds * (kSerial + (1 - kSerial) / std::max(threads, 1));
}

BuildCost estimate_build(const BuildArguments& arguments)
{
    const std::filesystem::path file = split_grid_name(arguments.mesh.string()).file;
    if (file.extension() == ".vdb")
        throw InvalidOption(arguments.mesh.string() +
                            ": is a level set; the model knows builds of triangles only");
    const ReadResult read = read_surface(arguments.mesh, arguments.read, arguments.format);
    const double unit = read.report.placement.unit;
    const ShellOptions shell = in_unit(arguments.shell, unit);
    const double voxel = resolve_voxel_size(read.mesh, shell.level_set);
    const double area = area_of(read.mesh);
    const double volume = std::abs(signed_volume(read.mesh.points, read.mesh.triangles));
    Size size;
    size.triangles = triangles_of(shell, read.mesh, area);
    size.surface_voxels = area / (voxel * voxel);
    size.solid_voxels = volume / (voxel * voxel * voxel);
    size.more_layers = std::max(shell.layers.layers - 1, 0);
    BuildCost cost;
    cost.triangles = size.triangles;
    cost.voxel_size = voxel * unit;
    cost.cpu_seconds = sum_of(kSecondsNumbers, size);
    cost.memory = sum_of(kMemoryNumbers, size);
    cost.disk = disk_of(arguments.outputs, size);
    cost.not_counted = not_counted(arguments);
    return cost;
}

} // namespace vdb_shell::command
