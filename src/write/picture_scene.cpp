// SPDX-License-Identifier: Apache-2.0

// Takes a shell and a view, gives coloured triangles: the outermost surface, and for a shell that
// is cut open the sections of its tets in the plane and the innermost surface, which shows where
// the shell leaves a void. Surfaces are cut sample by sample when they are drawn, sections lie in
// the plane: so the tets look solid.

#include "write/picture_scene.h"

#include "vdb_shell/shell/core_tets.h"
#include "vdb_shell/shell/quality.h"

#include "core/parallel.h"
#include "write/cut_picture.h"
#include "write/plane_cut.h"

#include <algorithm>
#include <array>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3f;
using openvdb::Vec3I;
using openvdb::Vec3s;

const Vec3f skin_colour(0.55f, 0.70f, 0.85f), inside_colour(0.93f, 0.80f, 0.62f);

/// A colour scale, linear between its steps.
struct ColourStep {
    double value;
    Vec3f colour;
};
using Scale = std::array<ColourStep, 4>;
/// Of angles in radians: 0, 5, 15 and 30 degrees.
const Scale quality_scale{{{0.0, Vec3f(0.70f, 0.09f, 0.13f)},
                           {0.0873, Vec3f(0.93f, 0.45f, 0.32f)},
                           {0.2618, Vec3f(0.97f, 0.86f, 0.70f)},
                           {0.5236, Vec3f(0.22f, 0.45f, 0.70f)}}};
/// Of shares.
const Scale share_scale{{{0.0, Vec3f(0.97f, 0.95f, 0.83f)},
                         {0.33, Vec3f(0.62f, 0.82f, 0.75f)},
                         {0.67, Vec3f(0.25f, 0.55f, 0.70f)},
                         {1.0, Vec3f(0.24f, 0.38f, 0.62f)}}};

/// Beyond the ends of the scale the colours of its ends.
Vec3f at(const Scale& scale, double value)
{
    if (value <= scale.front().value)
        return scale.front().colour;
    for (std::size_t i = 1; i < scale.size(); ++i)
        if (value <= scale[i].value) {
            const ColourStep &low = scale[i - 1], &high = scale[i];
            const double share = (value - low.value) / (high.value - low.value);
            return low.colour + float(share) * (high.colour - low.colour);
        }
    return scale.back().colour;
}

struct Colours {
    std::vector<Vec3f> tet, triangle;
};

void colour_by_quality(const PictureSubject& subject, Colours& colours)
{
    const TetMesh& tets = subject.tets;
    std::vector<double> angle(tets.tets.size());
    for_each_index(angle.size(),
                   [&](std::size_t t) { angle[t] = shape_of(tets, t).min_dihedral_radians; });
    std::vector<double> worst(colours.triangle.size(), std::numeric_limits<double>::infinity());
    for (std::size_t t = 0; t < angle.size(); ++t) {
        colours.tet[t] = at(quality_scale, angle[t]);
        if (tets.prism[t] != kCorePrism)
            // Seen from outside only the triangle shows, so it tells the worst of what is below.
            worst[tets.prism[t]] = std::min(worst[tets.prism[t]], angle[t]);
    }
    for (std::size_t p = 0; p < worst.size(); ++p)
        colours.triangle[p] = at(quality_scale, worst[p]);
}

void colour_by_thickness(const PictureSubject& subject, Colours& colours)
{
    const std::vector<Vec3I>& triangles = subject.stack.triangles();
    std::vector<double> length(subject.stack.surface(0).size());
    for (std::size_t v = 0; v < length.size(); ++v)
        length[v] = thickness_of(subject.stack, v);
    // Of this shell, so colours of two shells tell shares and not lengths.
    const double longest = *std::max_element(length.begin(), length.end());
    for (std::size_t p = 0; p < triangles.size(); ++p) {
        const Vec3I& t = triangles[p];
        const double mean = (length[t[0]] + length[t[1]] + length[t[2]]) / 3;
        colours.triangle[p] = at(share_scale, longest > 0 ? mean / longest : 0.0);
    }
    for (std::size_t t = 0; t < colours.tet.size(); ++t)
        if (subject.tets.prism[t] != kCorePrism)
            colours.tet[t] = colours.triangle[subject.tets.prism[t]];
}

Colours colours_of(const PictureSubject& subject, PictureColours by)
{
    const TetMesh& tets = subject.tets;
    Colours colours{std::vector<Vec3f>(tets.tets.size(), tint_colour(kCoreTint)),
                    std::vector<Vec3f>(subject.stack.triangles().size(), skin_colour)};
    // One layer alone has the first colour of the scale, and no division by 0.
    const double deepest = std::max<double>(1, double(subject.stack.layers.size()) - 1);
    const std::vector<std::uint8_t> tints = prism_tints(subject.stack.triangles());
    switch (by) {
    case PictureColours::quality:
        colour_by_quality(subject, colours);
        break;
    case PictureColours::thickness:
        colour_by_thickness(subject, colours);
        break;
    case PictureColours::layer:
        for (std::size_t t = 0; t < tets.tets.size(); ++t)
            if (tets.prism[t] != kCorePrism)
                colours.tet[t] = at(share_scale, tets.prism_layer[t] / deepest);
        break;
    case PictureColours::prism:
        for (std::size_t t = 0; t < tets.tets.size(); ++t)
            if (tets.prism[t] != kCorePrism)
                colours.tet[t] = tint_colour(tints[tets.prism[t]]);
        break;
    }
    return colours;
}

/// The plane of the cut, in the axes in which it is across one of them.
struct Cut {
    ViewAxes from_cut; ///< takes those axes into the view's
    CutPlane plane;
    double sign = 1; ///< of the normal, so that it points at the viewer

    double in_front(const Vec3d& p) const { return sign * (p[plane.normal] - plane.offset); }
    ShadedTriangle triangle(const std::array<Vec3d, 3>& corner) const
    {
        ShadedTriangle made;
        for (std::size_t k = 0; k < 3; ++k) {
            made.corner[k] = from_cut.in_view(corner[k]);
            made.in_front[k] = in_front(corner[k]);
        }
        return made;
    }
};

void add_surface(const std::vector<Vec3s>& points, const std::vector<Vec3I>& triangles,
                 const std::vector<Vec3f>& colour, const Cut& cut,
                 std::vector<ShadedTriangle>& scene)
{
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        std::array<Vec3d, 3> corner;
        for (std::size_t k = 0; k < 3; ++k)
            corner[k] = Vec3d(points[triangles[t][int(k)]]);
        ShadedTriangle made = cut.triangle(corner);
        made.colour = colour[t];
        scene.push_back(made);
    }
}

/// As triangles in the plane, drawn in their colours: a cut has no light of its own.
void add_section(const CutPolygon& polygon, const Vec3f& colour, const Cut& cut,
                 std::vector<ShadedTriangle>& scene)
{
    const auto corner = [&](int i) {
        Vec3d p(0.0);
        p[cut.plane.normal] = cut.plane.offset;
        p[cut.plane.right] = polygon.corner[std::size_t(i)][0];
        p[cut.plane.up] = polygon.corner[std::size_t(i)][1];
        return p;
    };
    // A fan from the first corner, as sections of tets are convex.
    for (int i = 1; i + 1 < polygon.corners; ++i) {
        ShadedTriangle made = cut.triangle({corner(0), corner(i), corner(i + 1)});
        // Exactly on the plane, whatever rounding would make of it: what is in front is left out.
        made.in_front = {0.0, 0.0, 0.0};
        made.colour = colour;
        made.lit = false;
        // Sides within the polygon are no edges.
        made.edges = std::uint8_t(2 | (i == 1 ? 1 : 0) | (i + 2 == polygon.corners ? 4 : 0));
        scene.push_back(made);
    }
}

/// The points in the view's axes, where the plane that faces the viewer is across z.
std::vector<Vec3s> turned(const std::vector<Vec3s>& points, const ViewAxes& axes)
{
    std::vector<Vec3s> made(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        made[i] = Vec3s(axes.in_view(Vec3d(points[i])));
    return made;
}

} // namespace

std::vector<ShadedTriangle> picture_scene(const PictureSubject& subject,
                                          const PictureOptions& options, const Bounds& surface)
{
    const std::vector<Vec3I>& triangles = subject.stack.triangles();
    std::vector<Vec3s> outer = subject.stack.surface(0);
    std::vector<Vec3s> inner = subject.stack.surface(subject.stack.surfaces() - 1);
    Cut cut{view_axes(options.view), {}, 1};
    TetMesh tets = subject.tets;
    CrossSectionOptions section = options.section;
    if (section.axis == Axis::view) {
        for (std::vector<Vec3s>* points : {&outer, &inner, &tets.points})
            *points = turned(*points, cut.from_cut);
        // All is in the view's axes already, so nothing is left to turn.
        cut.from_cut = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        section.axis = Axis::z;
        cut.plane = cut_plane(section, bounds_of(outer));
    } else {
        cut.plane = cut_plane(section, surface);
        cut.sign = cut.from_cut.towards[cut.plane.normal] < 0 ? -1 : 1;
    }
    const bool open = options.kind == PictureKind::cut_away;
    const Colours colours = colours_of(subject, options.colours);
    std::vector<ShadedTriangle> scene;
    add_surface(outer, triangles, colours.triangle, cut, scene);
    if (open) {
        add_surface(inner, triangles, std::vector<Vec3f>(triangles.size(), inside_colour), cut,
                    scene);
        for (std::uint32_t t = 0; t < tets.tets.size(); ++t) {
            const CutPolygon polygon = cut_tet(tets, t, cut.plane);
            add_section(polygon, colours.tet[t], cut, scene);
        }
    } else {
        for (ShadedTriangle& triangle : scene)
            // Behind the plane everywhere: nothing is cut away from a surface that is shown whole.
            triangle.in_front = {-1.0, -1.0, -1.0};
    }
    return scene;
}

} // namespace vdb_shell
