// SPDX-License-Identifier: Apache-2.0

// Takes a shell, its tets and a plane across an axis; leaves a PNG file of the section, whole or
// not at all. What the plane cuts is found in plane_cut.cpp, and the pixels are filled in
// cut_picture.cpp. The picture is for people: it is
// drawn in double, and nothing that is certified depends on it. All of it is drawn and encoded in
// memory before the file is opened, so a failure leaves no temporary file.

#include "vdb_shell/write/cross_section.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"

#include "vdb_shell/core/atomic_file.h"
#include "write/cut_picture.h"
#include "write/image.h"
#include "write/picture_frame.h"
#include "write/plane_cut.h"
#include "write/section_image.h"

namespace vdb_shell
{
namespace
{

void to_pixels(CutDrawing& drawing, const PictureFrame& frame)
{
    // All shapes by the same arithmetic, so that corners which were equal before are equal
    // afterwards.
    for (CutPolygon& polygon : drawing.tets)
        for (openvdb::Vec2d& corner : polygon.corner)
            corner = frame.place(corner);
    for (auto* outline : {&drawing.outer, &drawing.inner})
        for (CutSegment& segment : *outline)
            segment = {frame.place(segment.from), frame.place(segment.to)};
    drawing.width = frame.width;
    drawing.height = frame.height;
}

} // namespace

const NameTable<Axis>& names(Axis)
{
    static const NameTable<Axis> table{{"x", Axis::x},
                                       {"y", Axis::y},
                                       {"z", Axis::z},
                                       {"widest", Axis::widest},
                                       {"view", Axis::view}};
    return table;
}

OptionList describe(CrossSectionOptions& o)
{
    return in_group(
        "Output",
        {option("axis", o.axis, "--section-axis",
                "Normal of the picture's cutting plane; widest: x, y or z, where most is cut")
             .needing("--output .png"),
         option("position", o.position, "--section-position",
                "Place of the cutting plane, as a share of the bounding box")
             .needing("--output .png")
             .in(Unit::share)
             .within(at_least(0).at_most(1)),
         option("width_pixels", o.width_pixels, "--picture-width",
                "Pixels along the picture's longer side")
             .needing("--output .png")
             .in(Unit::pixels)
             .within(at_least(kSmallestWidth).at_most(kLargestWidth))});
}

Image draw_cross_section(const PrismShell& shell, const TetMesh& tets,
                         const CrossSectionOptions& options, const SectionFrame& shown)
{
    // By the surface and not by all that is drawn, which differs from shell to shell of the same
    // surface.
    const CutPlane plane = cut_plane(options, shown.surface);
    CutDrawing drawing;
    drawing.tets = cut_tets(tets, prism_tints(shell.triangles), plane);
    drawing.outer = cut_surface(shell.outer, shell.triangles, plane);
    drawing.inner = cut_surface(shell.inner, shell.triangles, plane);
    const auto in_plane = [&](const openvdb::Vec3d& p) {
        return openvdb::Vec2d(p[plane.right], p[plane.up]);
    };
    to_pixels(drawing,
              frame_of(in_plane(shown.all.low), in_plane(shown.all.high), options.width_pixels));
    return {drawing.width, drawing.height, draw_cut(drawing)};
}

SectionFrame section_frame(const PrismShell& shell)
{
    if (shell.outer.empty())
        throw InvalidOption("cross-section: the shell has no vertices");
    const Bounds surface = bounds_of(shell.outer);
    return {surface, joined(surface, bounds_of(shell.inner))};
}

Bounds joined(const Bounds& a, const Bounds& b)
{
    return {openvdb::math::minComponent(a.low, b.low), openvdb::math::maxComponent(a.high, b.high)};
}

void write_cross_section(const std::filesystem::path& path, const PrismShell& shell,
                         const TetMesh& tets, const CrossSectionOptions& options, OutputSet* with)
{
    // Cheap refusals come first: a wrong option or a folder that cannot be written is told before
    // the section is computed.
    require_in_range(options, "cross-section");
    if (options.axis == Axis::view)
        throw InvalidOption("cross-section: a section is across x, y or z");
    const SectionFrame frame = section_frame(shell);
    require_writable(path);
    write_png(
        path,
        draw_cross_section(shell, tets, with_axis(options, shell.outer, shell.triangles), frame),
        with);
}

} // namespace vdb_shell
