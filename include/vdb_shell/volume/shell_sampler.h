// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/volume/shell_map.h"

#include <memory>

namespace vdb_shell
{

/// Finds the places of points anywhere, for as many threads as ask. The way back is
/// ShellMap::point_of, of the same shell or of another pose of it.
///
///     const ShellSampler sampler(map);
///     const ShellPlace place = sampler.find(point);
///     if (place.found())
///         moved = posed.point_of(place);
class ShellSampler
{
public:
    /// Keeps a reference to the map. `voxel_size`: of a grid that says which tet is near; 0: a
    /// third of the cube root of a tet's mean volume, which takes 27 voxels a tet. Throws
    /// InvalidOption for voxels too small for the coordinates.
    explicit ShellSampler(const ShellMap& map, double voxel_size = 0);
    ~ShellSampler();
    ShellSampler(ShellSampler&&) noexcept;

    /// The place of a point; not found where no tet holds it, to a billionth of a tet. On
    /// faces between tets it is the same each time.
    ShellPlace find(const openvdb::Vec3d& point) const;

    const ShellMap& map() const { return map_; }

private:
    struct Parts;
    const ShellMap& map_;
    std::unique_ptr<const Parts> parts_;
};

} // namespace vdb_shell
