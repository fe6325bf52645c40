// SPDX-License-Identifier: Apache-2.0

// Takes a shell and what is wanted of its picture; leaves a PNG file, whole or not at all. The
// frame is chosen here; the picture is drawn by section_image.h or shaded_picture.h. Pictures are
// for people: they are drawn in double, and nothing that is certified depends on them.

#include "vdb_shell/write/picture.h"

#include "vdb_shell/core/atomic_file.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"

#include "write/image.h"
#include "write/picture_scene.h"
#include "write/plane_cut.h"
#include "write/section_image.h"
#include "write/shaded_picture.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;
using openvdb::Vec2d;
using openvdb::Vec3d;
using openvdb::Vec3s;

/// A sphere about the middle of the points' box.
struct Ball {
    Vec3d centre{0.0};
    double radius = 0;
};
Ball ball_of(const std::vector<Vec3s>& points)
{
    const Bounds box = bounds_of(points);
    Ball ball{0.5 * (box.low + box.high), 0};
    for (const Vec3s& p : points)
        ball.radius = std::max(ball.radius, (Vec3d(p) - ball.centre).length());
    return ball;
}

struct Window {
    Vec2d low{std::numeric_limits<double>::infinity()};
    Vec2d high{-std::numeric_limits<double>::infinity()};

    void add(const Vec2d& p)
    {
        low = openvdb::math::minComponent(low, p);
        high = openvdb::math::maxComponent(high, p);
    }
};

/// The outer surface, of a posed shell that at rest: what is chosen by it is the same in every
/// frame of a sequence.
const std::vector<Vec3s>& lasting_surface(const ShellFile& file)
{
    return file.rest.posed() ? file.rest.surface[0] : file.stack.surface(0);
}

/// A window that stays in place from frame to frame where there may be others, else a tight one.
Window window_of(const ShellFile& file, const ViewOptions& view)
{
    const ViewAxes axes = view_axes(view);
    const bool posed = file.rest.posed();
    const std::vector<Vec3s>& outer = lasting_surface(file);
    Window window;
    if (posed || view.turntable > 0) {
        const Ball ball = ball_of(outer);
        const Vec3d centre = axes.in_view(ball.centre);
        // A ball looks the same from all sides, so the object does not grow and shrink as the view
        // turns.
        const double reach = ball.radius * (posed ? kPosedRoom : 1.0);
        window.add({centre.x() - reach, centre.y() - reach});
        window.add({centre.x() + reach, centre.y() + reach});
        return window;
    }
    for (const Vec3s& p : outer) {
        const Vec3d seen = axes.in_view(Vec3d(p));
        window.add({seen.x(), seen.y()});
    }
    return window;
}

PictureOptions with_axis_for(PictureOptions options, const ShellFile& file)
{
    options.section = with_axis(options.section, lasting_surface(file), file.stack.triangles());
    return options;
}

Image draw(const ShellFile& file, const PictureOptions& options, const SectionFrame& section,
           const Window& window)
{
    const TetMesh tets = joined_tets(file.tets, file.core);
    if (options.kind == PictureKind::section)
        return draw_cross_section(hull_of(file.stack), tets, options.section, section);
    return draw_shaded(picture_scene({file.stack, tets}, options, section.surface),
                       {window.low, window.high, options.section.width_pixels});
}

} // namespace

const NameTable<PictureKind>& names(PictureKind)
{
    static const NameTable<PictureKind> table{{"section", PictureKind::section},
                                              {"surface", PictureKind::surface},
                                              {"cut-away", PictureKind::cut_away}};
    return table;
}

const NameTable<PictureColours>& names(PictureColours)
{
    static const NameTable<PictureColours> table{{"prism", PictureColours::prism},
                                                 {"layer", PictureColours::layer},
                                                 {"quality", PictureColours::quality},
                                                 {"thickness", PictureColours::thickness}};
    return table;
}

OptionList describe(PictureOptions& o)
{
    OptionList list =
        in_group("Output",
                 {option("kind", o.kind, "--picture", "What a .png shows").needing("--output .png"),
                  option("colours", o.colours, "--colour-by", "What its colours tell")
                      .with_names({"--color-by"})
                      .needing("--picture surface cut-away")});
    for (OptionList more : {describe(o.section), describe(o.view)})
        list.insert(list.end(), more.begin(), more.end());
    return list;
}

void require_sensible(const PictureOptions& options)
{
    require_in_range(options, "picture");
    if (options.section.axis == Axis::view && options.kind != PictureKind::cut_away)
        throw InvalidOption("--section-axis view needs --picture cut-away: a section is across x, "
                            "y or z");
}

void write_picture(const fs::path& path, const ShellFile& file, const PictureOptions& options,
                   OutputSet* with)
{
    require_sensible(options);
    const SectionFrame section = section_frame(hull_of(file.stack));
    require_writable(path);
    write_png(path,
              draw(file, with_axis_for(options, file), section, window_of(file, options.view)),
              with);
}

void write_picture_pair(const fs::path& path, const ShellFile& left, const ShellFile& right,
                        const PictureOptions& wanted, OutputSet* with)
{
    require_sensible(wanted);
    const PictureOptions options = with_axis_for(wanted, left);
    SectionFrame section = section_frame(hull_of(left.stack));
    section.all = joined(section.all, section_frame(hull_of(right.stack)).all);
    Window window = window_of(left, options.view);
    const Window other = window_of(right, options.view);
    // Both at one scale and in one place, or differences could not be seen.
    window.add(other.low);
    window.add(other.high);
    require_writable(path);
    write_png(path,
              beside(draw(left, options, section, window), draw(right, options, section, window)),
              with);
}

} // namespace vdb_shell
