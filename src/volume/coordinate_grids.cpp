// SPDX-License-Identifier: Apache-2.0

// Takes the map of a shell, gives for each voxel in it what it is asked for. The tet that holds a
// voxel's centre comes from the grid of tets; from there the map finds the place in the prism.

#include "vdb_shell/volume/coordinate_grids.h"

#include "core/parallel.h"
#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_corners.h"
#include "obstacles/nearest_core.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"
#include "volume/ramp.h"
#include "volume/tet_index_grid.h"
#include "volume/voxel_budget.h"
#include "volume/voxel_leaves.h"

#include <algorithm>
#include <cassert>
#include <memory>
#include <optional>

namespace vdb_shell
{
namespace
{

using openvdb::FloatGrid;
using openvdb::Int32Grid;
using openvdb::Vec3d;
using openvdb::Vec3s;
using openvdb::Vec3SGrid;

/// The grids under construction; those that nobody wants have no leaves.
struct Grids {
    VoxelLeaves<Vec3SGrid> rest, uvw, prism_weights, nearest_weights;
    VoxelLeaves<FloatGrid> depth, thickness, density;
    VoxelLeaves<Int32Grid> prism, nearest, layer;
    std::vector<VoxelLeaves<FloatGrid>> masks;

    template <typename Visit> void for_each(const Visit& visit)
    {
        // In the order of the enumerators, which is that of the grids that are returned. The masks
        // are not among them: their active voxels are those of one layer only.
        visit(rest), visit(depth), visit(thickness), visit(uvw), visit(prism), visit(prism_weights);
        visit(nearest), visit(nearest_weights), visit(layer), visit(density);
    }
};

Grids wanted_grids(const std::vector<Coordinate>& wanted, std::size_t leaves, std::size_t layers)
{
    Grids grids;
    for (const Coordinate coordinate : wanted)
        switch (coordinate) {
        case Coordinate::rest:
            grids.rest = {"rest", Vec3s(0), leaves};
            break;
        case Coordinate::depth:
            grids.depth = {"depth", 0.0f, leaves};
            break;
        case Coordinate::thickness:
            grids.thickness = {"thickness", 0.0f, leaves};
            break;
        case Coordinate::uvw:
            grids.uvw = {"uvw", Vec3s(0), leaves};
            break;
        case Coordinate::prism:
            grids.prism = {"prism", -1, leaves};
            grids.prism_weights = {"prism_weights", Vec3s(0), leaves};
            break;
        case Coordinate::nearest:
            grids.nearest = {"nearest", -1, leaves};
            grids.nearest_weights = {"nearest_weights", Vec3s(0), leaves};
            break;
        case Coordinate::layer:
            grids.layer = {"layer", -1, leaves};
            for (std::size_t k = 0; k < layers; ++k)
                grids.masks.emplace_back("layer_" + std::to_string(k), 0.0f, leaves);
            break;
        case Coordinate::density:
            grids.density = {"density", 0.0f, leaves};
            break;
        }
    return grids;
}

/// Of all grids, with that of the tets.
double voxel_bytes(const std::vector<Coordinate>& wanted, std::size_t layers)
{
    constexpr double kNumber = 4, kVector = 12;
    double bytes = kNumber;
    for (const Coordinate coordinate : wanted)
        switch (coordinate) {
        case Coordinate::rest:
        case Coordinate::uvw:
            bytes += kVector;
            break;
        case Coordinate::prism:
        case Coordinate::nearest:
            bytes += kNumber + kVector;
            break;
        case Coordinate::layer:
            // The masks of all layers have the leaves of the whole shell while they are made.
            bytes += kNumber * double(1 + layers);
            break;
        case Coordinate::depth:
        case Coordinate::thickness:
        case Coordinate::density:
            bytes += kNumber;
            break;
        }
    return bytes;
}

/// What is the same for all voxels.
class Coordinates
{
public:
    Coordinates(const CoordinateInputs& inputs, Ramp ramp, bool nearest)
        : in_(inputs), skin_(skin_surface(*inputs.stack)), ramp_(std::move(ramp))
    {
        // A tree over the whole skin takes memory and time, and only one of the coordinates needs
        // it.
        if (nearest)
            nearest_.emplace(skin_);
        for (std::size_t v = 0; v < skin_.points.size(); ++v)
            thickness_.push_back(pillar_length(*in_.stack, v));
    }

    void fill(std::size_t i, const TetIndexLeaf& leaf, const openvdb::math::Transform& transform,
              Grids& grids) const
    {
        grids.for_each([&](auto& grid) { grid.begin(i, leaf); });
        // No voxel is active yet, for whoever looks at the active voxels of a mask wants those of
        // the layer.
        for (auto& mask : grids.masks)
            mask.begin(i, leaf, false);
        for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel)
            fill_voxel(i, voxel.pos(), std::uint32_t(*voxel),
                       transform.indexToWorld(voxel.getCoord()), grids);
    }

private:
    void fill_voxel(std::size_t i, openvdb::Index voxel, std::uint32_t tet, const Vec3d& point,
                    Grids& grids) const
    {
        const ShellPlace place = in_.map->place_in(tet, point);
        const SurfacePlace on = in_.map->on_surface(place);
        // Tets of a core belong to no prism. Depth stays 1 there, so that a ramp over it does not
        // begin anew in the middle of the solid; numbers of triangles and layers keep their -1.
        const bool in_core = on.triangle == ShellPlace::kNone;
        const double depth = in_core ? 1.0 : (on.layer + on.share) / double(in_.map->layers());
        // A shell at rest is its own rest: the voxel's centre is taken as it is, without the detour
        // through the map, which rounds.
        grids.rest.set(i, voxel, Vec3s(in_.rest ? in_.rest->point_of(place) : point));
        grids.depth.set(i, voxel, float(depth));
        grids.density.set(i, voxel, float(ramp_.at(depth)));
        if (grids.nearest.wanted())
            set_nearest(i, voxel, point, grids);
        if (in_core)
            return;
        const openvdb::Vec3I& corner = in_.stack->triangles()[on.triangle];
        double thickness = 0;
        for (int k = 0; k < 3; ++k)
            thickness += on.weight[k] * thickness_[corner[k]];
        grids.thickness.set(i, voxel, float(thickness));
        grids.prism.set(i, voxel, std::int32_t(on.triangle));
        grids.prism_weights.set(i, voxel, Vec3s(on.weight));
        grids.layer.set(i, voxel, std::int32_t(on.layer));
        if (!grids.masks.empty())
            grids.masks[on.layer].set_on(i, voxel, 1.0f);
        if (grids.uvw.wanted()) {
            openvdb::Vec2d uv(0.0);
            for (int k = 0; k < 3; ++k)
                // The coordinates are those of this triangle's corners and not of vertices, which
                // on a seam have several; so nothing is averaged over one.
                uv += on.weight[k] * (*in_.texture)[on.triangle][std::size_t(k)];
            grids.uvw.set(i, voxel, Vec3s(float(uv[0]), float(uv[1]), float(depth)));
        }
    }

    void set_nearest(std::size_t i, openvdb::Index voxel, const Vec3d& point, Grids& grids) const
    {
        const std::uint32_t triangle = nearest_->nearest(point).triangle;
        const std::array<double, 3> weight =
            nearest_weights(triangle_corners(skin_, triangle), point);
        grids.nearest.set(i, voxel, std::int32_t(triangle));
        grids.nearest_weights.set(i, voxel,
                                  Vec3s(float(weight[0]), float(weight[1]), float(weight[2])));
    }

    CoordinateInputs in_;
    TriangleMesh skin_;
    Ramp ramp_;
    std::vector<double> thickness_; ///< by vertex
    std::optional<NearestOnMesh> nearest_;
};

/// For the message about a name that is none of them.
std::string list_of(const NameTable<Coordinate>& table)
{
    std::string list;
    for (const auto& entry : table)
        list += (list.empty() ? "" : ", ") + entry.first;
    return list;
}

bool has(const std::vector<Coordinate>& list, Coordinate one)
{
    return std::find(list.begin(), list.end(), one) != list.end();
}

} // namespace

const NameTable<Coordinate>& names(Coordinate)
{
    static const NameTable<Coordinate> table{
        {"rest", Coordinate::rest},           {"depth", Coordinate::depth},
        {"thickness", Coordinate::thickness}, {"uvw", Coordinate::uvw},
        {"prism", Coordinate::prism},         {"nearest", Coordinate::nearest},
        {"layer", Coordinate::layer},         {"density", Coordinate::density}};
    return table;
}

OptionList describe(CoordinateOptions& o)
{
    return in_group(
        "Volumes",
        {option("volumes", o.volumes, "--volumes",
                "What voxels are told, with commas: rest (where they are in the shell at rest), "
                "depth, thickness, uvw (texture coordinates and depth), prism (triangle and "
                "weights), nearest (the same of the nearest triangle), layer, density "
                "[rest,depth,thickness,prism,layer]"),
         option("voxel_size", o.voxel_size, "--voxel-size", "0: as in the shell's level set")
             .in(Unit::world_length)
             .within(at_least(0)),
         option("density_ramp", o.density_ramp, "--density-ramp",
                "density by depth, as depth:density with commas; linear between [0:1,1:0]")});
}

std::vector<Coordinate> coordinates_of(const CoordinateOptions& options)
{
    std::vector<Coordinate> list;
    for (const std::string& word : split_at(',', options.volumes)) {
        const auto& table = names(Coordinate{});
        const auto found = std::find_if(table.begin(), table.end(),
                                        [&](const auto& entry) { return entry.first == word; });
        if (found == table.end())
            throw InvalidOption("--volumes: \"" + word + "\" is none of " + list_of(table));
        if (has(list, found->second))
            // A mistake in any case, for there can be one grid of a name only.
            throw InvalidOption("--volumes: \"" + word + "\" comes twice");
        list.push_back(found->second);
    }
    return list;
}

std::vector<GridBasePtr> coordinate_grids(const CoordinateInputs& inputs,
                                          const CoordinateOptions& options,
                                          Interrupter* interrupter)
{
    assert(inputs.map && inputs.stack);
    require_in_range(options, "volumes");
    const std::vector<Coordinate> wanted = coordinates_of(options);
    if (has(wanted, Coordinate::uvw) && !inputs.texture)
        throw InvalidOption("--volumes uvw: there are no texture coordinates");
    if (inputs.texture && inputs.texture->size() != inputs.stack->triangles().size())
        throw InvalidOption("--volumes uvw: there are texture coordinates of " +
                            std::to_string(inputs.texture->size()) + " triangles for a shell of " +
                            std::to_string(inputs.stack->triangles().size()));
    require_voxels_fit(inputs.map->tets(), options.voxel_size,
                       voxel_bytes(wanted, inputs.map->layers()), "volumes");
    const StageProgress progress(interrupter, "shell coordinates");
    const Int32Grid::Ptr tets =
        tet_index_grid(inputs.map->tets(), options.voxel_size, "volumes", progress);
    require_voxels_inside(*tets, inputs.map->tets(), "volumes");
    Grids grids = wanted_grids(wanted, tets->tree().leafCount(), inputs.map->layers());
    const Coordinates coordinates(inputs, ramp_of(options.density_ramp, "--density-ramp"),
                                  has(wanted, Coordinate::nearest));
    for_each_leaf(*tets, progress, [&](std::size_t i, const TetIndexLeaf& leaf) {
        coordinates.fill(i, leaf, tets->transform(), grids);
    });
    std::vector<GridBasePtr> made;
    const auto add = [&](auto& grid) {
        if (grid.wanted())
            made.push_back(grid.grid(tets->transform()));
    };
    grids.for_each(add);
    for (auto& mask : grids.masks)
        add(mask);
    for (const GridBasePtr& grid : made)
        // So that programs show them as fog: they are numbers without a unit, 0 outside. A
        // thickness is a length.
        if (grid->isType<FloatGrid>() && grid->getName() != "thickness")
            grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return made;
}

} // namespace vdb_shell
