// SPDX-License-Identifier: Apache-2.0

// Based on: S. Porumbescu, B. Budge, L. Feng and K. Joy, "Shell Maps", 2005. There, tets of texture
// space and of the shell are joined corner by corner; here the map within a prism is that of
// ShellMap, so that no tets show. Takes a texture volume, the shell's map and texture coordinates;
// goes from each voxel of the shell to the texture. Lengths in the texture are voxels of it until
// its transform is asked.

#include "vdb_shell/volume/map_volume.h"

#include "core/fail.h"
#include "field/level_set_again.h"
#include "io/volume_types.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"
#include "volume/sample_volume.h"
#include "volume/tet_index_grid.h"
#include "volume/voxel_budget.h"
#include "volume/voxel_leaves.h"

#include <openvdb/math/Mat3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

namespace vdb_shell
{
namespace
{

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::GridBase;
using openvdb::Int32Grid;
using openvdb::Mat3d;
using openvdb::Vec2d;
using openvdb::Vec3d;
using openvdb::Vec3SGrid;

/// Means of a tiled grid over small parallelepipeds. One for each thread.
template <typename Grid> class TiledSampler
{
public:
    using Value = typename Grid::ValueType;

    TiledSampler(const Grid& grid, const openvdb::CoordBBox& tile, std::size_t most)
        : values_(grid.getConstAccessor()), low_(tile.min()), size_(tile.dim()), most_(int(most))
    {
    }

    /// `across` * x, for x in the cube of side 1 about 0, is what the voxel covers around `place`.
    /// False where nothing of it is active.
    bool mean(const Vec3d& place, const Mat3d& across, Value& value)
    {
        if constexpr (std::is_integral_v<Value>) {
            return values_.probeValue(in_tile(Coord::round(place)), value);
        } else {
            const Samples samples(across, most_);
            limited_ += samples.limited();
            SumOf<Value> total(0.0);
            bool any = false;
            samples.for_each(place, [&](const Vec3d& at) { any |= add(at, total); });
            value = Value(total * (1.0 / samples.count()));
            return any;
        }
    }
    std::size_t limited() const { return limited_; }

private:
    /// Of the tile of all, for the texture has no end.
    Coord in_tile(Coord at) const
    {
        for (int axis = 0; axis < 3; ++axis) {
            // The remainder of a negative number is negative; tiles go on below the first one.
            const int beyond = (at[axis] - low_[axis]) % size_[axis];
            at[axis] = low_[axis] + (beyond < 0 ? beyond + size_[axis] : beyond);
        }
        return at;
    }

    bool add(const Vec3d& place, SumOf<Value>& total)
    {
        const Coord base = Coord::floor(place);
        const Vec3d share = place - base.asVec3d();
        const std::array<Vec3d, 2> weights{Vec3d(1.0) - share, share};
        // Once for each axis and not for each of the eight: remainders take as long as all the
        // rest.
        const std::array<Coord, 2> at{in_tile(base), in_tile(base.offsetBy(1))};
        bool any = false;
        for (unsigned i = 0; i < 8; ++i) {
            const unsigned x = i >> 2, y = i >> 1 & 1, z = i & 1;
            const double weight = weights[x][0] * weights[y][1] * weights[z][2];
            // On a voxel's centre only one of the eight counts. Asking the others could make a
            // voxel active that takes nothing from them.
            if (weight == 0)
                continue;
            Value value;
            any |= values_.probeValue({at[x][0], at[y][1], at[z][2]}, value);
            total += weight * SumOf<Value>(value);
        }
        return any;
    }

    typename Grid::ConstAccessor values_;
    Coord low_, size_;
    int most_;
    std::size_t limited_ = 0;
};

/// Voxels on either side of a level set's surface, as OpenVDB has them (LEVEL_SET_HALF_WIDTH).
constexpr float kHalfWidth = 3;

/// Where a voxel is in the texture.
struct TexturePlace {
    Vec3d index{0.0};
    Mat3d by_world; ///< d index / d shell
};

/// From places in the shell to the texture's index space.
class ToTexture
{
public:
    ToTexture(const ShellMap& map, const std::vector<std::array<Vec2d, 3>>& corner,
              const openvdb::CoordBBox& tile, const MapOptions& options)
        // From half a voxel before the first centre, so that tiles meet without a gap.
        : map_(map), corner_(corner), low_(tile.min().asVec3d() - Vec3d(0.5)),
          tiles_(options.repeat_u, options.repeat_v, options.repeat_depth),
          size_(tile.dim().asVec3d()), from_(options.from_depth), to_(options.to_depth)
    {
    }

    /// False in a core, outside of the range of depths, and where the map has no inverse
    /// (`singular`).
    bool find(std::uint32_t tet, const Vec3d& point, TexturePlace& found, bool& singular) const
    {
        const ShellPlace place = map_.place_in(tet, point);
        const SurfacePlace on = map_.on_surface(place);
        if (on.triangle == ShellPlace::kNone)
            return false;
        const double depth = depth_of(on);
        if (depth < from_ || depth > to_)
            return false;
        found.index = index_of(on);
        const Mat3d by_place = map_.jacobian_of(place), texture = derivatives(place, on);
        // Texture coordinates without extent: no place of the texture belongs here alone.
        singular = by_place.det() == 0 || texture.det() == 0;
        if (singular)
            return false;
        // The chain rule: d index / d place, times d place / d world.
        found.by_world = texture * by_place.inverse(0.0);
        return true;
    }

    /// Of the axis that depths go along.
    double farthest_voxel() const { return std::abs(low_[2]) + tiles_[2] * size_[2]; }
    /// Of the two axes that texture coordinates go along.
    double farthest_voxel(const Vec2d& uv) const
    {
        const Vec3d at = low_ + Vec3d(uv[0], uv[1], 0) * tiles_ * size_;
        return std::max(std::abs(at[0]), std::abs(at[1]));
    }

private:
    double depth_of(const SurfacePlace& on) const
    {
        return (on.layer + on.share) / double(map_.layers());
    }
    Vec3d index_of(const SurfacePlace& on) const
    {
        Vec2d uv(0.0);
        for (int k = 0; k < 3; ++k)
            uv += on.weight[k] * corner_[on.triangle][std::size_t(k)];
        // The texture's z points outwards and depth inwards.
        const double up = (to_ - depth_of(on)) / (to_ - from_);
        return low_ + Vec3d(uv[0], uv[1], up) * tiles_ * size_;
    }
    /// By the coordinates that ShellMap::jacobian_of derives by.
    Mat3d derivatives(const ShellPlace& place, const SurfacePlace& on) const
    {
        Mat3d by;
        if (place.prism == ShellPlace::kNone) {
            // Affine in the tet, so the differences between its corners are the derivatives.
            std::array<Vec3d, 4> at;
            for (int k = 0; k < 4; ++k) {
                ShellPlace end = place;
                end.weight = openvdb::Vec4d(0.0);
                end.weight[k] = 1;
                at[std::size_t(k)] = index_of(map_.on_surface(end));
            }
            for (int k = 0; k < 3; ++k)
                by.setCol(k, at[std::size_t(k) + 1] - at[0]);
            return by;
        }
        const std::array<Vec2d, 3>& uv = corner_[on.triangle];
        for (int k = 0; k < 2; ++k) {
            const Vec2d along = uv[std::size_t(k) + 1] - uv[0];
            by.setCol(k, Vec3d(along[0], along[1], 0) * tiles_ * size_);
        }
        // The third is the share of a layer: u and v do not change down a pillar.
        by.setCol(2, Vec3d(0, 0, -tiles_[2] * size_[2] / (double(map_.layers()) * (to_ - from_))));
        return by;
    }

    const ShellMap& map_;
    const std::vector<std::array<Vec2d, 3>>& corner_;
    Vec3d low_, tiles_, size_;
    double from_, to_;
};

double squared_norm(const Mat3d& m)
{
    return m.col(0).lengthSqr() + m.col(1).lengthSqr() + m.col(2).lengthSqr();
}

/// Sums over a leaf; leaves are added up in their order.
struct Sums {
    double texture = 0, shell = 0, stretch = 0;
    std::size_t limited = 0, mirrored = 0, singular = 0;
};

/// What else happens to a value than to be moved.
template <typename Value>
Value carried(const Value& value, const Mat3d& to_shell, const GridBase& texture, bool keep_mass)
{
    if constexpr (std::is_same_v<Value, float>) {
        const double ratio = std::abs(to_shell.det());
        // A distance has no one scale where the map stretches by direction. The mean scale keeps
        // the sign and the place of the surface; the distances are made anew afterwards.
        if (texture.getGridClass() == openvdb::GRID_LEVEL_SET)
            return float(value * std::cbrt(ratio));
        return keep_mass ? float(value / ratio) : value;
    } else if constexpr (std::is_integral_v<Value>) {
        return value;
    } else {
        if (texture.getVectorType() == openvdb::VEC_INVARIANT)
            return value;
        return Value(to_shell * Vec3d(value));
    }
}

/// Axes of the texture's index space, in its world.
Mat3d axes_of(const openvdb::math::Transform& transform)
{
    Mat3d axes;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d unit(0.0);
        unit[axis] = 1;
        axes.setCol(axis, transform.indexToWorld(unit) - transform.indexToWorld(Vec3d(0.0)));
    }
    return axes;
}

/// What is the same for all voxels.
template <typename Grid> struct Mapping {
    const Grid& texture;
    openvdb::CoordBBox tile;
    ToTexture to_texture;
    Mat3d axes;
    const MapOptions& options;
    bool level_set;
};

template <typename Grid>
void map_leaf(const Mapping<Grid>& mapping, std::size_t i, const TetIndexLeaf& leaf,
              VoxelLeaves<Grid>& leaves, Sums& sums)
{
    const MapOptions& options = mapping.options;
    const double voxel = options.voxel_size;
    TiledSampler<Grid> sampler(mapping.texture, mapping.tile, options.most_samples);
    leaves.begin(i, leaf, false);
    for (auto at = leaf.cbeginValueOn(); at; ++at) {
        TexturePlace place;
        bool singular = false;
        if (!mapping.to_texture.find(std::uint32_t(*at), voxel * at.getCoord().asVec3d(), place,
                                     singular)) {
            sums.singular += singular;
            continue;
        }
        const Mat3d to_world = mapping.axes * place.by_world;
        const double share = std::abs(to_world.det());
        const Mat3d to_shell = to_world.inverse(0.0);
        // Volume in the texture for one unit of volume in the shell.
        sums.texture += share;
        sums.shell += 1;
        sums.stretch += share * squared_norm(to_shell) / 3;
        // A mirrored chart, as half of a symmetric character may have.
        sums.mirrored += to_world.det() < 0;
        typename Grid::ValueType value;
        if (sampler.mean(place.index, voxel * place.by_world, value) || mapping.level_set)
            leaves.set_on(i, at.pos(),
                          carried(value, to_shell, mapping.texture, options.keep_mass));
    }
    sums.limited = sampler.limited();
}

void add_up(const std::vector<Sums>& sums, MapFigures& figures)
{
    Sums all;
    for (const Sums& s : sums) {
        all.texture += s.texture, all.shell += s.shell, all.stretch += s.stretch;
        figures.limited_samples += s.limited;
        figures.mirrored += s.mirrored;
        figures.singular += s.singular;
    }
    if (all.texture > 0)
        // Without the mean scale: a texture that is only larger is not stretched.
        figures.stretch = std::sqrt(all.stretch / all.texture) / std::cbrt(all.shell / all.texture);
}

/// Beyond that voxels have no numbers that differences of them fit into.
void require_voxels(const ToTexture& to_texture, const std::string& grid,
                    const std::vector<std::array<Vec2d, 3>>& corner)
{
    constexpr double kMost = 1 << 30;
    if (const double voxel = to_texture.farthest_voxel(); !(voxel < kMost))
        fail<InvalidOption>("grid \"", grid, "\": the tiles of --repeat-depth end at voxel ", voxel,
                            ", over the limit of 2^30");
    for (std::size_t t = 0; t < corner.size(); ++t)
        for (const Vec2d& uv : corner[t])
            if (const double voxel = to_texture.farthest_voxel(uv); !(voxel < kMost))
                fail<InvalidOption>(
                    "grid \"", grid, "\": triangle ", t, " has the texture coordinates ", uv[0],
                    ", ", uv[1], ", which with the tiles of --repeat-u and --repeat-v are voxel ",
                    voxel, ", over the limit of 2^30");
}

template <typename Grid>
GridBasePtr map_grid(const Grid& texture, const ShellMap& map,
                     const std::vector<std::array<Vec2d, 3>>& corner, const MapOptions& options,
                     MapFigures& figures, const StageProgress& progress)
{
    const openvdb::CoordBBox tile = texture.evalActiveVoxelBoundingBox();
    if (tile.empty() || texture.activeVoxelCount() == 0)
        throw InvalidOption("grid \"" + texture.getName() + "\" has no active voxels");
    // Of a level set all voxels are kept, also those far from its surface, whose signs say where
    // the inside is. What is cut off by the end of the shell is closed there: beyond is outside.
    const bool level_set =
        std::is_same_v<Grid, FloatGrid> && texture.getGridClass() == openvdb::GRID_LEVEL_SET;
    const Mapping<Grid> mapping{
        texture, tile,     {map, corner, tile, options}, axes_of(texture.transform()),
        options, level_set};
    require_voxels(mapping.to_texture, texture.getName(), corner);
    // The texture's value, and the tet that a voxel is in.
    require_voxels_fit(map.tets(), options.voxel_size,
                       sizeof(typename Grid::ValueType) + sizeof(std::int32_t), "map");
    const Int32Grid::Ptr tets = tet_index_grid(map.tets(), options.voxel_size, "map", progress);
    require_voxels_inside(*tets, map.tets(), "map");
    const auto background = level_set
                                ? typename Grid::ValueType(kHalfWidth * float(options.voxel_size))
                                : texture.background();
    VoxelLeaves<Grid> leaves(texture.getName(), background, tets->tree().leafCount());
    std::vector<Sums> sums(tets->tree().leafCount());
    for_each_leaf(*tets, progress, [&](std::size_t i, const TetIndexLeaf& leaf) {
        map_leaf(mapping, i, leaf, leaves, sums[i]);
    });
    add_up(sums, figures);
    typename Grid::Ptr made = leaves.grid(tets->transform());
    if constexpr (std::is_same_v<Grid, FloatGrid>) {
        if (level_set && made->activeVoxelCount() > 0)
            make_distances_of_signed(*made, kHalfWidth);
    }
    made->insertMeta(texture);
    figures.active = made->activeVoxelCount();
    return made;
}

void require_sensible(const MapOptions& o)
{
    require_in_range(o, "map");
    if (!(o.from_depth < o.to_depth))
        throw InvalidOption("map: depths from " + text_of(o.from_depth) + " to " +
                            text_of(o.to_depth) + " are no range");
}

} // namespace

OptionList describe(MapOptions& o)
{
    return in_group(
        "Map",
        {option("repeat_u", o.repeat_u, "--repeat-u", "Tiles for one unit of u").within(above(0)),
         option("repeat_v", o.repeat_v, "--repeat-v", "Tiles for one unit of v").within(above(0)),
         option("repeat_depth", o.repeat_depth, "--repeat-depth", "Tiles over the range of depths")
             .within(above(0)),
         option("from_depth", o.from_depth, "--from-depth",
                "Depth of the texture's top: 0 is the outermost surface, 1 the innermost")
             .in(Unit::share)
             .within(at_least(0).at_most(1)),
         option("to_depth", o.to_depth, "--to-depth", "Depth of the texture's foot")
             .in(Unit::share)
             .within(at_least(0).at_most(1)),
         option("keep_mass", o.keep_mass, "--keep-mass",
                "Multiply floats by the ratio of volumes, so that their mass is kept"),
         option("most_samples", o.most_samples, "--most-samples",
                "Samples along each axis of a voxel, at most, where the map shrinks")
             .in(Unit::count)
             .within(at_least(1).at_most(kMostSamples)),
         option("voxel_size", o.voxel_size, "--voxel-size",
                "Edge length of a voxel; 0: that of the shell's level set")
             .in(Unit::world_length)
             .within(at_least(0))});
}

GridBasePtr map_volume(const GridBase& texture, const ShellMap& map,
                       const std::vector<std::array<Vec2d, 3>>& corner, const MapOptions& options,
                       MapFigures& figures, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "map volume");
    figures = {};
    figures.grid = texture.getName();
    require_sensible(options);
    if (corner.size() != map.triangles())
        throw InvalidOption("map: there are texture coordinates of " +
                            std::to_string(corner.size()) + " triangles for a shell of " +
                            std::to_string(map.triangles()));
    if (!texture.transform().isLinear())
        throw InvalidOption("grid \"" + texture.getName() + "\": its transform is a " +
                            texture.transform().mapType() + ", which has no tiles; resample it");
    GridBasePtr made;
    with_volume(texture, "mapped", [&](const auto& grid) {
        made = map_grid(grid, map, corner, options, figures, progress);
    });
    return made;
}

} // namespace vdb_shell
