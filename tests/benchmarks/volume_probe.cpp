// SPDX-License-Identifier: Apache-2.0

// Measures the map of a shell and volumes that go through it: volume_probe POSED.vdb, a shell that
// `pose` wrote. Prints one JSON object; docs/scripts/volume_figures.py makes a page of several.

#include "benchmarks/resampling.h"
#include "vdb_shell/volume/coordinate_grids.h"
#include "vdb_shell/volume/deform_volume.h"
#include "vdb_shell/volume/shell_sampler.h"
#include "vdb_shell/write/vdb_file.h"

#include "core/parallel.h"
#include "volume/tet_index_grid.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>

namespace
{

using namespace vdb_shell;
using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Mat3d;
using openvdb::Vec3d;

void print(const char* key, double value)
{
    std::printf("\"%s\": %.6g,\n", key, value);
}

struct Voxel {
    std::uint32_t tet;
    Vec3d centre;
};

std::vector<Voxel> voxels_of(const openvdb::Int32Grid& tets)
{
    std::vector<Voxel> voxels;
    for (auto voxel = tets.cbeginValueOn(); voxel; ++voxel)
        voxels.push_back({std::uint32_t(*voxel), tets.transform().indexToWorld(voxel.getCoord())});
    return voxels;
}

void round_trip(const ShellMap& rest, const ShellMap& posed, const std::vector<Voxel>& voxels,
                double voxel_size)
{
    const ShellSampler at_rest(rest);
    std::vector<double> error(voxels.size());
    std::vector<std::uint8_t> lost(voxels.size());
    for_each_index(voxels.size(), [&](std::size_t i) {
        const Vec3d there = rest.point_of(posed.place_in(voxels[i].tet, voxels[i].centre));
        const ShellPlace back = at_rest.find(there);
        lost[i] = !back.found();
        error[i] = lost[i] ? 0 : (posed.point_of(back) - voxels[i].centre).length() / voxel_size;
    });
    double sum = 0;
    for (const double e : error)
        sum += e;
    std::sort(error.begin(), error.end());
    print("round_trip_mean_voxels", sum / double(error.size()));
    print("round_trip_99.9_voxels", error[error.size() * 999 / 1000]);
    print("round_trip_most_voxels", error.back());
    print("round_trip_lost", double(std::count(lost.begin(), lost.end(), 1)) / double(lost.size()));

    std::vector<Vec3d> points;
    for (const Voxel& voxel : voxels)
        points.push_back(voxel.centre);
    // Neighbours after each other, as in a volume, and in an order that has nothing to do with it.
    const ShellSampler sampler(posed);
    std::vector<ShellPlace> places(points.size());
    const auto rate = [&](std::size_t step) {
        const double time = seconds([&] {
            for_each_index(
                points.size(),
                [&](std::size_t i) { places[i] = sampler.find(points[i * step % points.size()]); },
                1024);
        });
        return double(points.size()) / time / 1e6;
    };
    print("queries_in_order_million_per_second", rate(1));
    print("queries_in_disorder_million_per_second", rate(7919));
}

/// The derivative of the way from pose to rest, linear in the tet.
Mat3d linear_gradient(const ShellMap& rest, const ShellMap& posed, std::uint32_t tet)
{
    const auto edges = [&](const ShellMap& map) {
        const openvdb::Vec4I& corner = map.tets().tets[tet];
        const Vec3d a(map.tets().points[corner[0]]);
        return Mat3d(Vec3d(map.tets().points[corner[1]]) - a,
                     Vec3d(map.tets().points[corner[2]]) - a,
                     Vec3d(map.tets().points[corner[3]]) - a, false);
    };
    const Mat3d pose = edges(posed);
    return pose.det() == 0 ? Mat3d::identity() : edges(rest) * pose.inverse(0.0);
}

Mat3d gradient(const ShellMap& rest, const ShellMap& posed, std::uint32_t tet, const Vec3d& point)
{
    const ShellPlace place = posed.place_in(tet, point);
    const Mat3d pose = posed.jacobian_of(place);
    return pose.det() == 0 ? Mat3d::identity() : rest.jacobian_of(place) * pose.inverse(0.0);
}

double size_of(const Mat3d& m)
{
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        sum += m.row(i).lengthSqr();
    return std::sqrt(sum);
}

/// Jumps across the middles of faces of two tets: within prisms, and between them.
void gradient_jumps(const ShellMap& rest, const ShellMap& posed)
{
    const TetMesh& tets = posed.tets();
    std::map<std::array<std::uint32_t, 3>, std::vector<std::uint32_t>> faces;
    for (std::uint32_t t = 0; t < tets.tets.size(); ++t)
        for (int k = 0; k < 4; ++k) {
            std::array<std::uint32_t, 3> face;
            for (int i = 0, n = 0; i < 4; ++i)
                if (i != k)
                    face[std::size_t(n++)] = tets.tets[t][i];
            std::sort(face.begin(), face.end());
            faces[face].push_back(t);
        }
    double linear[2] = {0, 0}, curved[2] = {0, 0};
    std::size_t count[2] = {0, 0};
    for (const auto& [face, both] : faces) {
        if (both.size() != 2)
            continue;
        Vec3d middle(0.0);
        for (const std::uint32_t corner : face)
            middle += Vec3d(tets.points[corner]) / 3.0;
        const bool between = tets.prism[both[0]] != tets.prism[both[1]];
        linear[between] +=
            size_of(linear_gradient(rest, posed, both[0]) - linear_gradient(rest, posed, both[1]));
        curved[between] += size_of(gradient(rest, posed, both[0], middle) -
                                   gradient(rest, posed, both[1], middle));
        ++count[between];
    }
    print("jump_linear_within_prisms", linear[0] / double(std::max<std::size_t>(count[0], 1)));
    print("jump_within_prisms", curved[0] / double(std::max<std::size_t>(count[0], 1)));
    print("jump_linear_between_prisms", linear[1] / double(std::max<std::size_t>(count[1], 1)));
    print("jump_between_prisms", curved[1] / double(std::max<std::size_t>(count[1], 1)));
}

/// A volume over the shell at rest.
FloatGrid::Ptr volume_at_rest(const ShellMap& rest, double voxel_size,
                              const std::function<float(const Vec3d&)>& value)
{
    const auto tets = tet_index_grid(rest.tets(), voxel_size, "probe", StageProgress(nullptr, ""));
    auto grid = FloatGrid::create();
    grid->setTransform(tets->transform().copy());
    auto write = grid->getAccessor();
    for (auto voxel = tets->cbeginValueOn(); voxel; ++voxel)
        write.setValueOn(voxel.getCoord(), value(voxel_size * voxel.getCoord().asVec3d()));
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return grid;
}

void deformation(const ShellMap& rest, const ShellMap& posed, double voxel_size)
{
    const auto wave = [&](const Vec3d& p) {
        return float(1 +
                     0.5 * std::sin(p[0] / (5 * voxel_size)) * std::cos(p[1] / (7 * voxel_size)));
    };
    const FloatGrid::Ptr source = volume_at_rest(rest, voxel_size, wave);
    DeformFigures figures;
    GridBasePtr made;
    // The best of three, for both: the machine does other things as well.
    double deform = 1e30;
    Resampling resampling;
    for (int i = 0; i < 3; ++i) {
        deform = std::min(deform, seconds([&] {
                              made = deform_volume(*source, rest, posed, Vec3d(0.0), {}, figures);
                          }));
        resampling.measure(*source);
    }
    print("mass_change", figures.mass_after / figures.mass_before - 1);
    print("deform_seconds", deform);
    print("deform_voxels", double(figures.active_after));
    print("resample_seconds", resampling.seconds);
    print("resample_voxels", double(resampling.voxels));
    print("time_ratio_per_voxel", deform / double(figures.active_after) / resampling.per_voxel());

    // There and back, against what was there; the two resamplings alone blur as much as they do.
    DeformOptions plain;
    plain.mass = MassRule::none;
    const GridBasePtr there = deform_volume(*source, rest, posed, Vec3d(0.0), plain, figures);
    const auto back = openvdb::gridPtrCast<FloatGrid>(
        deform_volume(*there, posed, rest, Vec3d(0.0), plain, figures));
    double sum = 0, most = 0;
    std::size_t count = 0;
    auto value = back->getConstAccessor();
    for (auto voxel = source->cbeginValueOn(); voxel; ++voxel)
        if (value.isValueOn(voxel.getCoord())) {
            const double error =
                std::abs(double(value.getValue(voxel.getCoord())) - double(*voxel));
            sum += error, most = std::max(most, error), ++count;
        }
    print("volume_there_and_back_mean", sum / double(count));
    print("volume_there_and_back_most", most);

    const auto same = openvdb::gridPtrCast<FloatGrid>(
        deform_volume(*source, rest, rest, Vec3d(0.0), {}, figures));
    std::size_t differing = same->activeVoxelCount() != source->activeVoxelCount();
    auto kept = same->getConstAccessor();
    for (auto voxel = source->cbeginValueOn(); voxel; ++voxel)
        differing += kept.getValue(voxel.getCoord()) != *voxel;
    print("identity_differing_voxels", double(differing));
}

/// A checkerboard of single voxels in the shell made ten times smaller: how far from grey.
void aliasing(const ShellStack& stack, const TetMesh& at_rest, const ShellMap& rest,
              double voxel_size)
{
    ShellStack small = stack;
    TetMesh tets = at_rest;
    const auto shrink = [](std::vector<openvdb::Vec3s>& points) {
        for (openvdb::Vec3s& p : points)
            p *= 0.1f;
    };
    for (PrismShell& layer : small.layers)
        shrink(layer.outer), shrink(layer.inner);
    shrink(tets.points);
    const ShellMap posed(small, tets);
    const FloatGrid::Ptr board = volume_at_rest(rest, voxel_size, [&](const Vec3d& p) {
        const Coord at = Coord::round(p / voxel_size);
        return float((at[0] + at[1] + at[2]) & 1);
    });
    for (const std::size_t samples : {std::size_t(1), std::size_t(16)}) {
        DeformOptions options;
        options.mass = MassRule::none;
        options.most_samples = samples;
        DeformFigures figures;
        const auto made = openvdb::gridPtrCast<FloatGrid>(
            deform_volume(*board, rest, posed, Vec3d(0.0), options, figures));
        double sum = 0;
        for (auto voxel = made->cbeginValueOn(); voxel; ++voxel)
            sum += std::pow(double(*voxel) - 0.5, 2);
        print(samples == 1 ? "aliasing_unfiltered" : "aliasing",
              std::sqrt(sum / double(made->activeVoxelCount())));
    }
}

} // namespace

int main(int count, char** words)
{
    if (count != 2) {
        std::fprintf(stderr, "usage: volume_probe POSED.vdb\n");
        return 2;
    }
    openvdb::initialize();
    const ShellFile file = read_shell_vdb(words[1]);
    TetMesh tets = joined_tets(file.tets, file.core), at_rest = tets;
    at_rest.points = vectors_of_tet_points(tets, rest_points(file));
    const double voxel_size = file.surface->voxelSize()[0];
    const ShellStack rest_shell = rest_stack(file);
    ShellMap posed(file.stack, tets), rest(rest_shell, at_rest);
    std::printf("{\n");
    print("triangles", double(posed.triangles()));
    print("prisms", double(posed.prisms()));
    print("linear_prisms", double(posed.linear_prisms()));
    print("linear_prisms_at_rest", double(rest.linear_prisms()));
    make_linear_alike(rest, posed);
    const auto grid = tet_index_grid(posed.tets(), voxel_size, "probe", StageProgress(nullptr, ""));
    const std::vector<Voxel> voxels = voxels_of(*grid);
    round_trip(rest, posed, voxels, voxel_size);
    gradient_jumps(rest, posed);
    deformation(rest, posed, voxel_size);
    aliasing(rest_shell, at_rest, rest, voxel_size);
    std::printf("\"voxels\": %zu\n}\n", voxels.size());
    return 0;
}
