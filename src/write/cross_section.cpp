// SPDX-License-Identifier: Apache-2.0

// Takes a shell, its tets and a plane across an axis; leaves a PNG file of the section, whole or
// not at all. This file chooses the frame and encodes; what the plane cuts is found in
// plane_cut.cpp, and the pixels are filled in cut_picture.cpp. The picture is for people: it is
// drawn in double, and nothing that is certified depends on it. All of it is drawn and encoded in
// memory before the file is opened, so a failure leaves no temporary file.

#include "vdb_shell/write/cross_section.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"

#include "vdb_shell/core/atomic_file.h"
#include "write/cut_picture.h"
#include "write/plane_cut.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>

namespace vdb_shell
{
namespace
{

using openvdb::Vec2d;

/// Pixels along a side. The upper end bounds the memory of the picture: 16384 squared pixels of
/// three bytes are 805 MB. The lower end also holds for the shorter side, so that a flat section
/// stays visible.
constexpr int kSmallestWidth = 16, kLargestWidth = 16384;
constexpr double kMargin = 0.03; ///< of the longer side, on each side

/// The picture's frame: world units to pixels, y downwards.
struct Frame {
    Vec2d low{0.0, 0.0};
    double scale = 1.0, margin = 0.0;
    int width = 0, height = 0;

    // World y grows upwards, rows of a picture downwards, so y is turned round here. That mirrors
    // the outlines: whoever needs their orientation has to take it before this step.
    Vec2d place(const Vec2d& p) const
    {
        return {(p[0] - low[0]) * scale + margin, height - margin - (p[1] - low[1]) * scale};
    }
};

/// The longer side gets all pixels that were wanted, the shorter one as many as its share needs;
/// the scale is the same for both, so angles stay right. A box without extent (all points at one
/// place) keeps a scale of 1, because the division would give infinity.
Frame frame_of(const Bounds& bounds, const CutPlane& plane, int longer_pixels)
{
    Frame frame;
    frame.low = {bounds.low[plane.right], bounds.low[plane.up]};
    const double wide = bounds.high[plane.right] - frame.low[0];
    const double tall = bounds.high[plane.up] - frame.low[1];
    const double longer = std::max(wide, tall);
    frame.margin = kMargin * longer_pixels;
    const double room = longer_pixels - 2.0 * frame.margin;
    frame.scale = longer > 0.0 ? room / longer : 1.0;
    const auto pixels = [&](double side) {
        const double size = std::round(side * frame.scale + 2.0 * frame.margin);
        return std::clamp(int(size), kSmallestWidth, longer_pixels);
    };
    frame.width = pixels(wide);
    frame.height = pixels(tall);
    return frame;
}

void to_pixels(CutDrawing& drawing, const Frame& frame)
{
    for (CutPolygon& polygon : drawing.tets)
        for (Vec2d& corner : polygon.corner)
            corner = frame.place(corner);
    for (auto* outline : {&drawing.outer, &drawing.inner})
        for (CutSegment& segment : *outline)
            segment = {frame.place(segment.from), frame.place(segment.to)};
    drawing.width = frame.width;
    drawing.height = frame.height;
}

/// The picture as the bytes of a PNG file.
std::string encode_png(const std::vector<std::uint8_t>& rgb, int width, int height)
{
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = png_uint_32(width);
    image.height = png_uint_32(height);
    image.format = PNG_FORMAT_RGB;
    // This macro of libpng bounds the size of any PNG of that many pixels, so one call is enough
    // and its second pass, which would only ask for the size, is not needed.
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr)) {
        // The message lives inside of the image, which the next call releases.
        const std::string why = image.message;
        png_image_free(&image);
        throw WriteError("the picture cannot be encoded: " + why);
    }
    bytes.resize(size);
    return bytes;
}

} // namespace

const NameTable<Axis>& names(Axis)
{
    static const NameTable<Axis> table{{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}};
    return table;
}

OptionList describe(CrossSectionOptions& o)
{
    return in_group(
        "Output", {option("axis", o.axis, "--section-axis", "Normal of the picture's cutting plane")
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

void write_cross_section(const std::filesystem::path& path, const PrismShell& shell,
                         const TetMesh& tets, const CrossSectionOptions& options, OutputSet* with)
{
    // Cheap refusals come first: a wrong option or a folder that cannot be written is told before
    // the section is computed.
    require_in_range(options, "cross-section");
    if (shell.outer.empty())
        throw InvalidOption("cross-section: the shell has no vertices");
    require_writable(path);
    const Bounds surface = bounds_of(shell.outer), below = bounds_of(shell.inner);
    // The share that the user gives is of the outer surface's box, so the same share cuts the same
    // place of the object whatever the shell below looks like.
    const CutPlane plane = cut_plane(options, surface);
    // Inverted prisms may stick out of the surface and are to be seen.
    const Bounds all{openvdb::math::minComponent(surface.low, below.low),
                     openvdb::math::maxComponent(surface.high, below.high)};
    CutDrawing drawing;
    drawing.tets = cut_tets(tets, prism_tints(shell.triangles), plane);
    drawing.outer = cut_surface(shell.outer, shell.triangles, plane);
    drawing.inner = cut_surface(shell.inner, shell.triangles, plane);
    to_pixels(drawing, frame_of(all, plane, options.width_pixels));
    const std::string png = encode_png(draw_cut(drawing), drawing.width, drawing.height);
    write_stream_atomically(
        path, [&](std::ostream& out) { out.write(png.data(), std::streamsize(png.size())); }, with);
}

} // namespace vdb_shell
