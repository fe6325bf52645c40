// SPDX-License-Identifier: Apache-2.0

// From a call's inputs and options to seconds, memory and bytes of files: sums of the number of
// triangles and voxels, each times a measured number (cost_numbers.h). The work of a shell depends
// on its shape too, which nobody knows before it is done, so this is good for a job's limits and
// not for a promise.

#include "command/cost_model.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"
#include "vdb_shell/io/volume_file.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include "command/call.h"
#include "command/cost_numbers.h"
#include "command/deform_command.h"
#include "command/file_commands.h"
#include "command/pose_command.h"
#include "command/posed_surface.h"
#include "mesh/triangle_area.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

namespace vdb_shell::command
{
namespace
{

/// What costs are proportional to. Voxels of the surface are its area over the square of a voxel's
/// edge, those of the solid its volume over the cube; `more_layers` counts those after the first.
struct Size {
    double triangles = 0, surface_voxels = 0, solid_voxels = 0, more_layers = 0;
};

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
        // As many equilateral triangles of that edge as the surface has room for.
        count = area / (std::sqrt(3.0) / 4 * edge * edge);
    }
    // Every level cuts a triangle in four.
    return count * std::pow(4.0, shell.subdivide.levels);
}

/// In the order in which CostNumbers is documented.
double sum_of(const CostNumbers& numbers, const Size& size)
{
    // Two slopes for triangles: from kCoarseFrom on growth begins on a coarser surface
    // (GrowOptions::coarse_from), so those beyond cost less.
    return numbers[0] + numbers[1] * std::min(size.triangles, kCoarseFrom) +
           numbers[2] * std::max(size.triangles - kCoarseFrom, 0.0) +
           numbers[3] * size.surface_voxels + numbers[4] * size.solid_voxels +
           numbers[5] * size.triangles * size.more_layers;
}

/// Bytes for each tet, or for each triangle of the surface where they have no tets: measured on
/// shells of 1,500, 20,000 and 40,000 triangles, which agree within a fifth.
double other_file(const std::string& extension, double triangles, double tets)
{
    static const std::map<std::string, double> by_tet{{".vtu", 78},  {".ele", 74}, {".node", 74},
                                                      {".mesh", 56}, {".msh", 87}, {".geo", 203},
                                                      {".bgeo", 94}, {".sc", 30},  {".usda", 85}};
    static const std::map<std::string, double> by_triangle{
        {".obj", 36}, {".ply", 22}, {".off", 35}, {".stl", 50}};
    if (const auto found = by_tet.find(extension); found != by_tet.end())
        return found->second * tets;
    const auto found = by_triangle.find(extension);
    return found == by_triangle.end() ? 0 : found->second * triangles;
}

/// Of all outputs. A format that the model does not know, as those of pictures and pages, counts as
/// nothing.
double disk_of(const Outputs& outputs, const Size& size, const CostNumbers& vdb)
{
    // Three tets a prism, as it has without pins and tapering: the most that there can be.
    const double tets = 3 * size.triangles * (1 + size.more_layers);
    double bytes = 0;
    for (const std::filesystem::path& path : outputs.paths)
        bytes += lower_case_extension(path) == ".vdb"
                     ? sum_of(vdb, size)
                     : other_file(lower_case_extension(path), size.triangles, tets);
    return bytes;
}

/// Triangles whose longest side is over a hundred times the height on it.
std::ptrdiff_t count_needles(const TriangleMesh& mesh)
{
    constexpr double kNeedle = 100;
    const auto corner = [&](const openvdb::Vec3I& t, int k) {
        return openvdb::Vec3d(mesh.points[t[k % 3]]);
    };
    return std::count_if(
        mesh.triangles.begin(), mesh.triangles.end(), [&](const openvdb::Vec3I& t) {
            double longest2 = 0;
            for (int k = 0; k < 3; ++k)
                longest2 = std::max(longest2, (corner(t, k + 1) - corner(t, k)).lengthSqr());
            // The height is twice the area over the longest side.
            return kNeedle * 2 * triangle_area(mesh.points, t) < longest2;
        });
}

/// Options that none of the measured builds had, and needles. What they cost is not known, so it is
/// said and not guessed.
std::vector<std::string> not_counted(const BuildArguments& a, const TriangleMesh& mesh)
{
    const ShellOptions& s = a.shell;
    std::vector<std::string> names;
    const auto add = [&](bool given, const char* name) {
        if (given)
            names.emplace_back(name);
    };
    add(s.side != Side::inward, "--side");
    add(s.grow.method == Method::raw, "--method raw");
    add(s.mend, "--mend");
    add(s.repair.has_value(), "--repair");
    add(s.wrap.wanted, "--wrap");
    add(s.remesh.wanted(), "--remesh");
    add(s.refine.rounds > 0, "--refine-rounds");
    add(s.layers.layers == 0, "--layers auto");
    add(s.taper.wanted, "--taper");
    add(s.field == FieldRoute::dense, "--field dense");
    add(s.core_fill.wanted(), "--core-fill");
    add(!a.cores.empty(), "--core");
    // Of more growth takes 7 to 91 times as long, of fewer about as long as others do
    // (docs/farm.md).
    constexpr double kMostNeedles = 0.01; // share of the triangles
    const std::ptrdiff_t needles = count_needles(mesh);
    if (s.grow.method != Method::raw && !s.remesh.wanted() &&
        double(needles) > kMostNeedles * double(mesh.triangles.size()))
        names.push_back(
            "growth beside " + std::to_string(needles) +
            " needles, 100 times as long as they are high (--retriangulate turns their edges "
            "where the surface is flat, --remesh-to N cuts them up)");
    return names;
}

/// Seconds and memory of a build by what it asks of growth. `--for speed` is what was measured of
/// the three-tet test; with more fill than that it takes up to as long as the default.
struct BuildNumbers {
    const CostNumbers &seconds, &memory;
};
BuildNumbers numbers_for(const GrowOptions& grow)
{
    // That of samples/presets/speed.json.
    constexpr double kSpeedFill = 0.975;
    if (grow.method == Method::thickest)
        return {kThickestSecondsNumbers, kThickestMemoryNumbers};
    if (grow.method == Method::certified && grow.prism_test == PrismTest::chosen_tets &&
        grow.enough_fill && *grow.enough_fill <= kSpeedFill)
        return {kSpeedSecondsNumbers, kSpeedMemoryNumbers};
    return {kSecondsNumbers, kMemoryNumbers};
}

/// A shell of a surface in these voxels; 0: without volumes.
Size size_of(const TriangleMesh& surface, double voxel, std::size_t layers)
{
    Size size;
    size.triangles = double(surface.triangles.size());
    size.more_layers = double(layers) - 1;
    if (voxel > 0) {
        const double volume = std::abs(signed_volume(surface.points, surface.triangles));
        size.surface_voxels = surface_area(surface.points, surface.triangles) / (voxel * voxel);
        size.solid_voxels = volume / (voxel * voxel * voxel);
    }
    return size;
}

double voxel_size_of(const ShellFile& shell)
{
    return shell.surface ? shell.surface->voxelSize()[0] : 0;
}

std::string name_of(const openvdb::GridBase& grid)
{
    return "grid " + grid.getName() + " (" + grid.valueType() + ")";
}

} // namespace

double CallCost::seconds(int threads) const
{
    // A second thread makes builds 1.81 times as fast (docs/measurements/benchmarks.md); by
    // Amdahl's law a tenth of the work is serial. More threads were not measured.
    constexpr double kSerial = 0.105;
    return cpu_seconds * (kSerial + (1 - kSerial) / std::max(threads, 1));
}

CallCost estimate_build(const BuildArguments& arguments)
{
    const std::filesystem::path file = split_grid_name(arguments.mesh.string()).file;
    if (lower_case_extension(file) == ".vdb")
        throw InvalidOption(arguments.mesh.string() +
                            ": is a level set; the model knows builds of triangles only");
    const ReadResult read = read_surface(arguments.mesh, arguments.read, arguments.format);
    const double unit = read.report.placement.unit;
    const ShellOptions shell = in_unit(arguments.shell, unit);
    const double voxel = resolve_voxel_size(read.mesh, shell.level_set);
    Size size = size_of(read.mesh, voxel, std::size_t(std::max(shell.layers.layers, 1)));
    // The voxels are those of the surface as it is read: resampling changes the number of its
    // triangles, and hardly its area and volume.
    size.triangles =
        triangles_of(shell, read.mesh, surface_area(read.mesh.points, read.mesh.triangles));
    CallCost cost;
    cost.file = arguments.mesh.string();
    cost.triangles = size.triangles;
    cost.voxel_size = voxel * unit;
    const BuildNumbers numbers = numbers_for(shell.grow);
    cost.cpu_seconds = sum_of(numbers.seconds, size);
    cost.memory = sum_of(numbers.memory, size);
    cost.disk = disk_of(arguments.outputs, size, kVdbNumbers);
    cost.not_counted = not_counted(arguments, read.mesh);
    return cost;
}

CallCost estimate_pose(const PoseArguments& arguments)
{
    const ShellFile shell = read_shell(arguments.shell);
    const ShellStack rest = rest_stack(shell);
    // Read as `pose` reads it: what it would refuse is refused here, and the area is that of the
    // pose.
    const TriangleMesh skin{read_posed_skin({arguments.mesh, arguments.format, arguments.rest_mesh},
                                            rest, shell.placement, arguments.shell),
                            rest.triangles()};
    // Volumes are made for a .vdb only.
    const double voxel = wants_vdb(arguments.outputs) ? voxel_size_of(shell) : 0;
    const Size size = size_of(skin, voxel, rest.layers.size());
    CallCost cost;
    cost.file = arguments.mesh.string();
    cost.triangles = size.triangles;
    cost.voxel_size = voxel * shell.placement.unit;
    cost.cpu_seconds = sum_of(kPoseSecondsNumbers, size);
    cost.memory = sum_of(kPoseMemoryNumbers, size);
    cost.disk = disk_of(arguments.outputs, size, kPoseVdbNumbers);
    if (!arguments.before.empty() || !arguments.after.empty())
        cost.not_counted.emplace_back("--mesh-before and --mesh-after");
    if (rest.tapered)
        cost.not_counted.emplace_back("a tapered shell");
    if (!shell.core.empty())
        cost.not_counted.emplace_back("a filled core");
    return cost;
}

CallCost estimate_deform(const DeformArguments& arguments)
{
    const ShellFile shell = read_shell(arguments.posed);
    Size size;
    size.triangles = double(shell.stack.triangles().size());
    size.more_layers = double(shell.stack.layers.size()) - 1;
    CallCost cost;
    cost.file = arguments.call.volume.string();
    for (const GridBasePtr& grid :
         read_volumes(arguments.call.volume, arguments.call.grids, GridKinds::volumes_and_points)) {
        // Of deformations the numbers for voxels of the surface mean those of the volume
        // (cost_numbers.h).
        size.surface_voxels += double(grid->activeVoxelCount());
        cost.voxel_size = grid->voxelSize()[0];
        if (!grid->isType<openvdb::FloatGrid>())
            cost.not_counted.push_back(name_of(*grid));
    }
    cost.triangles = size.triangles;
    cost.cpu_seconds = sum_of(kDeformSecondsNumbers, size);
    cost.memory = sum_of(kDeformMemoryNumbers, size);
    cost.disk = sum_of(kDeformVdbNumbers, size);
    if (arguments.velocity)
        cost.not_counted.emplace_back("--velocity");
    return cost;
}

bool is_modelled(const std::string& command)
{
    return std::find(kModelled.begin(), kModelled.end(), command) != kModelled.end();
}

CallCost estimate_call(const Call& call)
{
    if (call.name() == "pose")
        return estimate_pose(call.pose_arguments());
    if (call.name() == "deform")
        return estimate_deform(call.deform_arguments());
    return estimate_build(call.build_arguments());
}

} // namespace vdb_shell::command
