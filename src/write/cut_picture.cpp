// SPDX-License-Identifier: Apache-2.0

// Takes polygons and outlines in pixels; gives 8-bit RGB. Nine samples per pixel are filled by scan
// lines with the usual half-open rule: a sample belongs to a polygon when its centre does, and a
// centre on a common side belongs to exactly one of the two neighbours. So two tets that only touch
// never count twice, and red in the picture means a real overlap of sections, up to the rounding of
// doubles. Bands of rows are drawn by different threads; no two write the same pixel and each goes
// through all shapes in the same order, so the bytes do not depend on the number of threads.

#include "write/cut_picture.h"

#include "core/parallel.h"
#include "write/picture_frame.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec2d;
using openvdb::Vec3f;

/// A band at the largest width of 16384 pixels is 24 rows of 49152 samples of 16 bytes, 19 MB for
/// each thread. Without bands the samples of the whole picture would take 39 GB.
constexpr int kBandPixels = 8; ///< rows drawn at once: bounds the memory of the samples
constexpr double kEdgeWidth = 0.9, kOuterWidth = 2.4, kInnerWidth = 1.6; ///< pixels
/// Tets smaller than this many pixels across fade out their edges, which would cover them.
constexpr double kEdgesFadeBelow = 14.0;
constexpr float kEdgeStrength = 0.55f;
/// A pixel with any overlap in it shows at least this much red. A single sample of nine would be a
/// faint pink that nobody sees, and an overlap is what the picture is looked at for.
constexpr float kLeastRed = 0.6f;

const Vec3f background_colour(1.0f, 1.0f, 1.0f), void_colour(0.90f, 0.90f, 0.90f),
    overlap_colour(0.88f, 0.07f, 0.07f);
const Vec3f outer_colour(0.07f, 0.09f, 0.13f), inner_colour(0.05f, 0.25f, 0.60f);
/// By prism, and the core's.
const std::array<Vec3f, kTintCount + 1> tint_colours{
    Vec3f(0.62f, 0.79f, 0.90f), Vec3f(0.98f, 0.87f, 0.62f), Vec3f(0.70f, 0.87f, 0.72f),
    Vec3f(0.86f, 0.80f, 0.92f), Vec3f(0.96f, 0.78f, 0.70f), Vec3f(0.78f, 0.88f, 0.88f),
    Vec3f(0.80f, 0.74f, 0.68f)};

/// The layers of lines are kept apart from the fill and from each other, because each line has to
/// lie over all fills whatever the order in which the shapes came.
struct Sample {
    std::uint16_t tets = 0;
    std::uint8_t tint = 0;
    bool inside = false;
    float edge = 0, outer = 0, inner = 0; ///< opacity
};

/// Some rows of samples. Coordinates are samples of the whole picture.
class Band
{
public:
    Band(int width, int first_row, int rows)
        : width_(width), first_(first_row), rows_(rows),
          samples_(std::size_t(width) * std::size_t(rows))
    {
    }
    Sample& at(int x, int row)
    {
        return samples_[std::size_t(row - first_) * std::size_t(width_) + std::size_t(x)];
    }
    int width() const { return width_; }
    /// Rows of this band whose centres lie in [low, high). The clamp comes before the conversion: a
    /// coordinate far outside of the picture does not fit an int, and such a conversion is
    /// undefined.
    int first_row(double low) const
    {
        return int(std::ceil(std::clamp(low - 0.5, double(first_), double(end_row()))));
    }
    int end_row(double high) const
    {
        return int(std::ceil(std::clamp(high - 0.5, double(first_), double(end_row()))));
    }
    int end_row() const { return first_ + rows_; }
    int begin_row() const { return first_; }
    /// Columns whose centres lie in [low, high).
    int column(double x) const { return int(std::ceil(std::clamp(x - 0.5, 0.0, double(width_)))); }

private:
    int width_, first_, rows_;
    std::vector<Sample> samples_;
};

/// Where a side crosses the row's line; the same for both polygons beside it. The ends are put into
/// the order of their heights, so the arithmetic is the same whichever polygon asks, and two
/// neighbours get bit for bit the same boundary: no gap and no double cover between them. The
/// division is safe, because this is called only where crosses() has found the heights to differ.
double crossing_at(const Vec2d& a, const Vec2d& b, double y)
{
    const bool ordered = a[1] < b[1];
    const Vec2d &low = ordered ? a : b, &high = ordered ? b : a;
    return low[0] + (y - low[1]) / (high[1] - low[1]) * (high[0] - low[0]);
}

/// Half-open: a side takes its lower end and leaves its upper one out. So a corner at the height of
/// a row is counted once for the two sides that meet there, and a level side is never counted.
bool crosses(const Vec2d& a, const Vec2d& b, double y)
{
    return (a[1] <= y) != (b[1] <= y);
}

void fill_polygon(Band& band, const CutPolygon& polygon)
{
    const auto* begin = polygon.corner.data();
    const auto* end = begin + polygon.corners;
    const auto lower = [](const Vec2d& a, const Vec2d& b) { return a[1] < b[1]; };
    const auto [low, high] = std::minmax_element(begin, end, lower);
    for (int row = band.first_row((*low)[1]); row < band.end_row((*high)[1]); ++row) {
        const double y = row + 0.5;
        // A convex polygon meets a row in one interval, so the least and the greatest crossing are
        // enough. The start values make the interval empty if nothing crosses.
        double left = band.width(), right = 0.0;
        for (int i = 0; i < polygon.corners; ++i) {
            const Vec2d &a = begin[i], &b = begin[(i + 1) % polygon.corners];
            if (!crosses(a, b, y))
                continue;
            const double x = crossing_at(a, b, y);
            left = std::min(left, x);
            right = std::max(right, x);
        }
        for (int x = band.column(left); x < band.column(right); ++x) {
            Sample& sample = band.at(x, row);
            // It saturates: more than 65535 tets over one sample would otherwise wrap to a count
            // that looks sound.
            sample.tets = std::uint16_t(std::min(sample.tets + 1, 65535));
            sample.tint = polygon.tint;
        }
    }
}

double distance_to(const Vec2d& p, const CutSegment& segment)
{
    const Vec2d along = segment.to - segment.from, from = p - segment.from;
    const double length2 = along.dot(along);
    const double share = length2 > 0.0 ? std::clamp(from.dot(along) / length2, 0.0, 1.0) : 0.0;
    return (from - share * along).length();
}

/// A straight stroke; `opacity` picks the layer that it is drawn in. Overlapping strokes take the
/// larger opacity instead of being blended twice. So an edge that two tets share is as dark as one
/// of a single tet, and the order of strokes does not matter.
void stroke(Band& band, const CutSegment& segment, double width_samples, float strength,
            float Sample::*opacity)
{
    const double half = 0.5 * width_samples;
    const double low = std::min(segment.from[1], segment.to[1]) - half;
    const double high = std::max(segment.from[1], segment.to[1]) + half;
    const Vec2d along = segment.to - segment.from;
    for (int row = band.first_row(low); row < band.end_row(high); ++row) {
        // Only the part of the line near this row is visited; without this bound a long slanted
        // line would visit all samples of its box. Nothing is left out: a sample within `half` of
        // the segment is within `half` of the line through it, and measured along the row that is
        // at most `reach`. Lines that are nearly level have no useful bound of this kind, and their
        // box is thin anyway.
        double left = std::min(segment.from[0], segment.to[0]);
        double right = std::max(segment.from[0], segment.to[0]);
        if (std::abs(along[1]) > 1e-9) {
            const double reach = half * along.length() / std::abs(along[1]);
            const double at = segment.from[0] + (row + 0.5 - segment.from[1]) / along[1] * along[0];
            left = std::max(left, at - reach);
            right = std::min(right, at + reach);
        }
        for (int x = band.column(left - half); x < band.column(right + half); ++x)
            if (distance_to({x + 0.5, row + 0.5}, segment) <= half) {
                float& value = band.at(x, row).*opacity;
                value = std::max(value, strength);
            }
    }
}

void draw_edges(Band& band, const CutPolygon& polygon)
{
    const auto& c = polygon.corner;
    // The root of the area stands for the size of the section. The longest side would not do:
    // slivers are long, and their edges would hide what lies below.
    double area = 0.0;
    for (int i = 0; i < polygon.corners; ++i) {
        const Vec2d a = c[std::size_t(i)], b = c[std::size_t((i + 1) % polygon.corners)];
        area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    const double across = std::sqrt(std::abs(area)) / kSamples;
    const float strength = kEdgeStrength * float(std::min(1.0, across / kEdgesFadeBelow));
    for (int i = 0; i < polygon.corners; ++i)
        stroke(band, {c[std::size_t(i)], c[std::size_t((i + 1) % polygon.corners)]},
               kEdgeWidth * kSamples, strength, &Sample::edge);
}

/// Marks what the outline winds round.
void fill_inside(Band& band, const std::vector<CutSegment>& outline)
{
    // A crossing of a row, and whether the outline goes up or down there.
    struct Crossing {
        double x;
        int turn;
    };
    std::vector<Crossing> line;
    for (int row = band.begin_row(); row < band.end_row(); ++row) {
        line.clear();
        const double y = row + 0.5;
        for (const CutSegment& s : outline)
            if (crosses(s.from, s.to, y))
                line.push_back({crossing_at(s.from, s.to, y), s.from[1] < s.to[1] ? 1 : -1});
        // Crossings at the same place may come in any order: the interval between them holds no
        // column.
        std::sort(line.begin(), line.end(),
                  [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
        int winding = 0;
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            winding += line[i].turn;
            // Because the picture has turned y round, the sign of the winding number tells nothing,
            // and any number but 0 counts as inside. The surface of a cavity has the opposite turn
            // and brings the number back to 0.
            if (winding != 0)
                for (int x = band.column(line[i].x); x < band.column(line[i + 1].x); ++x)
                    band.at(x, row).inside = true;
        }
    }
}

Vec3f blend(const Vec3f& under, const Vec3f& over, float opacity)
{
    return under * (1.0f - opacity) + over * opacity;
}

/// From below to above: background or void, the tets, their edges, the inner outline, the outer
/// outline.
Vec3f colour_of(const Sample& sample)
{
    Vec3f colour = sample.inside ? void_colour : background_colour;
    if (sample.tets == 1)
        colour = tint_colours[sample.tint];
    else if (sample.tets > 1)
        colour = overlap_colour;
    colour = blend(colour, edge_colour, sample.edge);
    colour = blend(colour, inner_colour, sample.inner);
    return blend(colour, outer_colour, sample.outer);
}

void write_pixel(Band& band, int x, int y, std::uint8_t* rgb)
{
    Vec3f sum(0.0f);
    int overlaps = 0;
    for (int row = 0; row < kSamples; ++row)
        for (int column = 0; column < kSamples; ++column) {
            const Sample& sample = band.at(x * kSamples + column, y * kSamples + row);
            sum += colour_of(sample);
            overlaps += sample.tets > 1 ? 1 : 0;
        }
    constexpr float kCount = kSamples * kSamples;
    Vec3f colour = sum / kCount;
    const float red = float(overlaps) / kCount;
    // The share of red that is added brings the total to kLeastRed: red + (1 - red) * share.
    if (overlaps > 0 && red < kLeastRed)
        colour = blend(colour, overlap_colour, (kLeastRed - red) / (1.0f - red));
    for (int channel = 0; channel < 3; ++channel)
        rgb[channel] = std::uint8_t(std::lround(255.0f * std::clamp(colour[channel], 0.0f, 1.0f)));
}

CutDrawing in_samples(CutDrawing drawing)
{
    constexpr double kScale = kSamples;
    for (CutPolygon& polygon : drawing.tets)
        for (Vec2d& corner : polygon.corner)
            corner *= kScale;
    for (auto* outline : {&drawing.outer, &drawing.inner})
        for (CutSegment& segment : *outline) {
            segment.from *= kScale;
            segment.to *= kScale;
        }
    return drawing;
}

} // namespace

Vec3f tint_colour(std::uint8_t tint)
{
    return tint_colours[tint];
}

std::vector<std::uint8_t> draw_cut(const CutDrawing& pixels)
{
    const CutDrawing drawing = in_samples(pixels);
    const auto row_bytes = 3 * std::size_t(drawing.width);
    std::vector<std::uint8_t> image(row_bytes * std::size_t(drawing.height));
    // Each band looks at all shapes; those of other rows cost it one empty loop.
    const int bands = (drawing.height + kBandPixels - 1) / kBandPixels;
    for_each_index(
        std::size_t(bands),
        [&](std::size_t index) {
            const int top = int(index) * kBandPixels;
            const int bottom = std::min(top + kBandPixels, drawing.height);
            Band band(drawing.width * kSamples, top * kSamples, (bottom - top) * kSamples);
            for (const CutPolygon& polygon : drawing.tets) {
                fill_polygon(band, polygon);
                draw_edges(band, polygon);
            }
            fill_inside(band, drawing.outer);
            for (const CutSegment& segment : drawing.inner)
                stroke(band, segment, kInnerWidth * kSamples, 1.0f, &Sample::inner);
            for (const CutSegment& segment : drawing.outer)
                stroke(band, segment, kOuterWidth * kSamples, 1.0f, &Sample::outer);
            for (int y = top; y < bottom; ++y)
                for (int x = 0; x < drawing.width; ++x)
                    write_pixel(band, x, y,
                                &image[std::size_t(y) * row_bytes + 3 * std::size_t(x)]);
        },
        1);
    return image;
}

} // namespace vdb_shell
