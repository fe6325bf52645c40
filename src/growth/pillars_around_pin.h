// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "growth/grow_state.h"

#include <array>
#include <optional>
#include <vector>

namespace vdb_shell::growth
{

/// A plane through a_v with the ends of two pillars beside v, which bounds v's own pillar.
struct Bound {
    Vec3d normal;
    std::array<int, 2> inner; ///< the vertices whose inner ends it goes through, or -1
};

/// With these bounds, the direction that keeps farthest from the worst of them.
struct View {
    std::vector<Bound> bounds;
    Vec3d direction;
    double least; ///< cosine to the worst bound's normal
};

/// The direction that serves the tets on v's pillar best, with the neighbours where they are: each
/// of these tets is positive on one side of a plane through a_v, whatever the pillar's length.
View best_view(const GrowState& s, int v);

/// That view, with bounds by the triangles beyond those of v whose other corners are both pinned,
/// where v lies inside their planes by less than `length`: a pillar so long that leans out of one
/// of them meets its triangle. None where there are no such triangles.
std::optional<View> view_beside_pins(const GrowState& s, int v, double length, View view);

/// The same with no pillar beside v: of the surface's own triangles.
View view_of_surface(const GrowState& s, int v);

/// The cosine that a view has to reach for nothing around the vertex to be shortened.
inline double clear_view(const GrowState& s, double visibility)
{
    return s.schedule.pins.share_of_visibility * visibility;
}

/// Where a pillar ends.
struct PillarEnd {
    int vertex;
    Vec3d end;
};

/// How pillars are shortened: to which share at a time, and whether only those that bind the view
/// or all that are near to it.
struct Shortening {
    double share;
    bool all;
};
/// The pillars around a pinned vertex, changed where they leave it no pillar of its own. All that
/// it does leaves the prisms' tets positive, with the vertex pinned; contacts are for valid() to
/// find. Source: docs/theory.md, "Pins that geometry demands".
class PillarsAround
{
public:
    /// Precondition: v is pinned, and the inner tree's boxes hold what may be changed.
    PillarsAround(GrowState& s, int v, const std::vector<double>& visibility,
                  Shortening shortening);

    /// Shortens those whose ends have a bound of the view that its direction is nearer to than
    /// `least`. False: there are none, or they are as short as they may become.
    bool shorten(const View& view, double least);

    /// Where no pillar in that direction, however short, leaves the tets of the pillars beside it
    /// positive, one of these hardly sees its own triangles. Turns it halfway to where it sees them
    /// best, half as long; or shortens those around it that leave it no better view. False: as
    /// before.
    bool turn(const Vec3d& direction);

    /// Puts all back as it was, the pin too; gives back what was there.
    std::vector<PillarEnd> restore();

    /// Six times the volume between the outer point and the inner triangles that were changed.
    double void6() const;

    bool none_changed() const { return pillars_.empty(); }

    /// Whether all prisms of the vertex, and of what was changed, pass the tests.
    bool valid() const;

private:
    struct Pillar {
        int vertex;
        bool done; ///< cannot be changed any more
        Vec3d before;
    };

    std::vector<int> corners_of_failing(const Vec3d& direction);
    Pillar& pillar(int u);
    bool change(int u, const Vec3d& arm);

    GrowState& s_;
    int pin_;
    const std::vector<double>& visibility_;
    Shortening shortening_;
    std::vector<int> faces_;
    std::vector<Pillar> pillars_;
};

} // namespace vdb_shell::growth
