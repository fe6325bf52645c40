// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/shell/tessellate.h"
#include "vdb_shell/write/cross_section.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// A plane across an axis, and the two axes that become right and up in the picture.
struct CutPlane {
    int normal = 2, right = 0, up = 1;
    double offset = 0; ///< coordinate along the normal
};
/// Precondition: the axis is x, y or z.
CutPlane cut_plane(const CrossSectionOptions& options, const Bounds& bounds);

/// A tet's convex section: three or four corners, in order around it.
struct CutPolygon {
    std::array<openvdb::Vec2d, 4> corner;
    int corners = 3;
    std::uint8_t tint = 0;
};

struct CutSegment {
    openvdb::Vec2d from,
        to; ///< the solid lies to the right (in pixels, rows from the top, to the left)
};

inline constexpr std::uint8_t kTintCount = 6;
inline constexpr std::uint8_t kCoreTint = kTintCount; ///< of tets that belong to no prism

/// A tint per prism, never that of a prism across an edge; greedy, in the order of the prisms.
std::vector<std::uint8_t> prism_tints(const std::vector<openvdb::Vec3I>& triangles);

/// The section of one tet, without a tint; no corners where it lies on one side. Corners on the
/// plane count as above it, so every section is a proper polygon; a tet edge meets the plane in the
/// very same point for all tets around it.
CutPolygon cut_tet(const TetMesh& tets, std::size_t t, const CutPlane& plane);
std::vector<CutPolygon> cut_tets(const TetMesh& tets, const std::vector<std::uint8_t>& tints,
                                 const CutPlane& plane);
std::vector<CutSegment> cut_surface(const std::vector<openvdb::Vec3s>& points,
                                    const std::vector<openvdb::Vec3I>& triangles,
                                    const CutPlane& plane);

/// Area of the part of the plane that lies in the solid below a closed surface.
double section_area(const std::vector<openvdb::Vec3s>& points,
                    const std::vector<openvdb::Vec3I>& triangles, const CutPlane& plane);
/// The same options with x, y or z instead of Axis::widest; of equal areas z, then y.
CrossSectionOptions with_axis(CrossSectionOptions options,
                              const std::vector<openvdb::Vec3s>& points,
                              const std::vector<openvdb::Vec3I>& triangles);

} // namespace vdb_shell
