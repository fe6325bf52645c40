// SPDX-License-Identifier: Apache-2.0

// Takes a volume, and the maps of a shell at rest and in a pose. Gives the volume in the pose. The
// voxels of the posed shell are found by its tets; the place of each in the shell says where it was
// at rest, and the derivatives of the two maps how much of the source it covers.

#include "vdb_shell/volume/deform_volume.h"

#include "field/level_set_again.h"
#include "io/volume_types.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"
#include "volume/extend_volume.h"
#include "volume/plain_lattice.h"
#include "volume/pull_back.h"
#include "volume/sample_volume.h"
#include "volume/tet_index_grid.h"
#include "volume/volume_content.h"
#include "volume/voxel_leaves.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <type_traits>

namespace vdb_shell
{
namespace
{

using openvdb::FloatGrid;
using openvdb::GridBase;
using openvdb::Int32Grid;
using openvdb::Vec3d;
using openvdb::Vec3SGrid;

/// What else happens to a value than to be moved; nothing to whole numbers.
class ValueMap
{
public:
    ValueMap(const GridBase& grid, const DeformOptions& options) : options_(options)
    {
        if (grid.isType<Vec3SGrid>())
            vectors_ = vector_map(grid, options.vectors);
        keeps_mass_ = keeps_mass(grid, options.mass);
    }

    float operator()(float value, const Pullback& back, std::size_t& limited) const
    {
        if (!keeps_mass_)
            return value;
        const double most = options_.most_density;
        const double factor = std::clamp(back.volume_ratio, 1.0 / most, most);
        // Counted, because each of these voxels has a mass that is no longer that of the source.
        limited += factor != back.volume_ratio;
        return float(value * factor);
    }
    std::int32_t operator()(std::int32_t value, const Pullback&, std::size_t&) const
    {
        return value;
    }
    openvdb::Vec3s operator()(const openvdb::Vec3s& value, const Pullback& back, std::size_t&) const
    {
        return openvdb::Vec3s(carried_vector(Vec3d(value), vectors_, back.by_pose));
    }

private:
    static bool keeps_mass(const GridBase& grid, MassRule rule)
    {
        if (!grid.isType<FloatGrid>() || grid.getGridClass() == openvdb::GRID_LEVEL_SET)
            return false;
        const bool fog =
            grid.getGridClass() == openvdb::GRID_FOG_VOLUME || grid.getName() == "density";
        // A temperature or a mask means the same however small its voxel has become; a density is
        // an amount for a volume. The grid says which it is by its class, or by the one name that
        // programs agree on.
        return rule == MassRule::all || (rule == MassRule::fog && fog);
    }

    const DeformOptions& options_;
    VectorMap vectors_ = VectorMap::keep;
    bool keeps_mass_ = false;
};

/// The tets of the posed shell below which there may be something.
template <typename Grid>
std::vector<std::uint8_t> tets_with_content(const Grid& source, const ShellMap& rest,
                                            const VoxelLattice& lattice)
{
    return rest.tets_that([&](const openvdb::BBoxd& box) {
        // A voxel more, as trilinear samples and the prism's slight excess at curved sides ask.
        const Vec3d low = (box.min() - lattice.origin) / lattice.voxel_size - Vec3d(1.0);
        const Vec3d high = (box.max() - lattice.origin) / lattice.voxel_size + Vec3d(1.0);
        return any_active(source, {openvdb::Coord::floor(low), openvdb::Coord::ceil(high)});
    });
}

template <typename Grid>
typename Grid::Ptr deform(const Grid& source, const ShellMap& rest, const ShellMap& posed,
                          const VoxelLattice& lattice, const DeformOptions& options,
                          DeformFigures& figures, const StageProgress& progress)
{
    const ValueMap map(source, options);
    // Voxels of the pose are gone through, not those of the source: each asks where it comes from,
    // so none is left without a value where the map stretches.
    const Int32Grid::Ptr tets = tet_index_grid(posed.tets(), lattice, "deform", progress,
                                               tets_with_content(source, rest, lattice));
    VoxelLeaves<Grid> leaves(source.getName(), source.background(), tets->tree().leafCount());
    std::atomic<std::size_t> limited_density{0}, limited_samples{0};
    for_each_leaf(*tets, progress, [&](std::size_t i, const TetIndexLeaf& leaf) {
        VolumeSampler<Grid> sampler(source, options.most_samples);
        std::size_t limited = 0;
        leaves.begin(i, leaf, false);
        for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
            const Vec3d point = lattice.origin + lattice.voxel_size * voxel.getCoord().asVec3d();
            const Pullback back =
                pull_back(rest, posed, posed.place_in(std::uint32_t(*voxel), point));
            const Vec3d at = (back.rest - lattice.origin) / lattice.voxel_size;
            typename Grid::ValueType value;
            if (sampler.mean(at, back.by_pose, value))
                leaves.set_on(i, voxel.pos(), map(value, back, limited));
        }
        limited_density += limited;
        limited_samples += sampler.limited();
    });
    figures.limited_density = limited_density;
    figures.limited_samples = limited_samples;
    return leaves.grid(source.transform());
}

template <typename Grid>
GridBasePtr deform_grid(const Grid& source, const ShellMap& rest, const ShellMap& posed,
                        const Vec3d& shift, const DeformOptions& options, DeformFigures& figures,
                        const StageProgress& progress)
{
    const VoxelLattice lattice = plain_lattice(source, shift);
    figures.active_before = source.activeVoxelCount();
    if (figures.active_before == 0)
        throw InvalidOption("grid \"" + source.getName() + "\" has no active voxels");
    // Of the shell at rest: what lies outside there has no place to be carried with, and a volume
    // that is cut off without a word would be taken for whole.
    const Int32Grid::Ptr at_rest = tet_index_grid(rest.tets(), lattice, "deform", progress);
    const Content before = content_of(source, *at_rest);
    figures.outside = before.outside_share();
    require_inside(source.getName(), figures.outside, options.most_outside);
    const bool level_set = source.getGridClass() == openvdb::GRID_LEVEL_SET;
    typename Grid::Ptr made;
    // Whole numbers name things, so there is no mean of them to extend by. Level sets have values
    // on both sides of their surface already.
    if constexpr (std::is_integral_v<typename Grid::ValueType>) {
        made = deform(source, rest, posed, lattice, options, figures, progress);
    } else {
        const typename Grid::ConstPtr extended =
            level_set ? nullptr : extended_beyond(source, *at_rest);
        made =
            deform(extended ? *extended : source, rest, posed, lattice, options, figures, progress);
    }
    if constexpr (std::is_same_v<Grid, FloatGrid>) {
        if (level_set)
            make_distances_again(
                *made, std::max(2.0f, source.background() / float(source.voxelSize()[0])));
        else {
            const double voxel = std::pow(lattice.voxel_size, 3);
            figures.mass_before = before.sum * voxel;
            figures.mass_after = sum_of_values(*made) * voxel;
        }
    }
    made->insertMeta(source);
    figures.active_after = made->activeVoxelCount();
    return made;
}

} // namespace

const NameTable<MassRule>& names(MassRule)
{
    static const NameTable<MassRule> table{
        {"fog", MassRule::fog}, {"all", MassRule::all}, {"none", MassRule::none}};
    return table;
}

const NameTable<VectorRule>& names(VectorRule)
{
    static const NameTable<VectorRule> table{{"by-type", VectorRule::by_type},
                                             {"transform", VectorRule::transform},
                                             {"rotate", VectorRule::rotate},
                                             {"keep", VectorRule::keep}};
    return table;
}

OptionList describe(DeformOptions& o)
{
    return in_group(
        "Deform",
        {option("mass", o.mass, "--mass",
                "Grids whose sum of values times volume is kept: fog volumes and \"density\", all "
                "of floats, or none"),
         option("most_density", o.most_density, "--most-density",
                "Bound of the factor by which a density grows, and of its inverse")
             .within(at_least(1)),
         option("vectors", o.vectors, "--vectors",
                "What becomes of vectors: by the grid's vector type, turned and stretched, turned, "
                "or as they are"),
         option("most_samples", o.most_samples, "--most-samples",
                "Samples along each axis of a voxel, at most, where the map shrinks")
             .in(Unit::count)
             .within(at_least(1).at_most(kMostSamples)),
         option("most_outside", o.most_outside, "--most-outside",
                "Share of a volume that may lie outside the shell, and is left out")
             .in(Unit::share)
             .within(at_least(0).at_most(1))});
}

GridBasePtr deform_volume(const GridBase& source, const ShellMap& rest, const ShellMap& posed,
                          const Vec3d& shift, const DeformOptions& options, DeformFigures& figures,
                          Interrupter* interrupter)
{
    require_in_range(options, "deform");
    const StageProgress progress(interrupter, "deform volume");
    figures = {};
    figures.grid = source.getName();
    GridBasePtr made;
    with_volume(source, "deformed", [&](const auto& grid) {
        made = deform_grid(grid, rest, posed, shift, options, figures, progress);
    });
    return made;
}

} // namespace vdb_shell
