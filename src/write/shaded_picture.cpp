// SPDX-License-Identifier: Apache-2.0

// Takes triangles in the view's axes; gives pixels. The nearest triangle wins at each of nine
// samples per pixel, of equally near ones the first. No library in Debian draws triangles into
// memory without a window system or a ray tracer's size, and this is all that is needed of one.
// Bands of rows are drawn by different threads, each in the order of the triangles, so the bytes do
// not depend on the number of threads.

#include "write/shaded_picture.h"

#include "core/parallel.h"
#include "write/picture_frame.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec2d;
using openvdb::Vec3d;
using openvdb::Vec3f;

constexpr int kShadedBandPixels = 16; ///< rows drawn at once
constexpr double kEdgePixels = 0.45;  ///< of an edge's width, on each of its two sides
/// Triangles smaller than this many pixels across fade out their edges, which would cover them.
constexpr double kShadedEdgesFadeBelow = 12.0;
constexpr float kShadedEdgeStrength = 0.6f;
/// Light from the upper left, and from everywhere: nothing is black.
const Vec3d light = Vec3d(-0.4, 0.6, 0.7).unit();
constexpr float kAmbient = 0.45f;

struct DepthSample {
    double depth = -std::numeric_limits<double>::infinity();
    Vec3f colour{1.0f};
};

/// An affine function of the samples' places.
struct Plane {
    double value, right, down;
    double at(double x, double y) const { return value + right * x + down * y; }
};

/// A triangle in samples, y downwards.
struct Flat {
    std::array<Vec2d, 3> corner;
    std::array<Plane, 3> weight;        ///< barycentric coordinates
    std::array<double, 3> edge_samples; ///< distance from a side over the weight of its far corner
    Vec3f colour;
    float edge_strength = 0;
    bool empty = false;
};

float brightness(const ShadedTriangle& t)
{
    if (!t.lit)
        return 1.0f;
    Vec3d normal = (t.corner[1] - t.corner[0]).cross(t.corner[2] - t.corner[0]);
    // Seen from behind it is turned round: both sides are lit.
    if (normal.z() < 0)
        normal = -normal;
    const double length = normal.length();
    const double lit = length > 0 ? std::max(0.0, normal.dot(light) / length) : 0.0;
    return kAmbient + (1.0f - kAmbient) * float(lit);
}

Flat flat_of(const ShadedTriangle& t, const PictureFrame& frame)
{
    Flat flat;
    for (std::size_t k = 0; k < 3; ++k)
        flat.corner[k] = frame.place({t.corner[k].x(), t.corner[k].y()}) * double(kSamples);
    const auto& c = flat.corner;
    const Vec2d b = c[1] - c[0], d = c[2] - c[0];
    const double twice_area = b.x() * d.y() - b.y() * d.x();
    // Seen along its plane, or without any area: there is no sample inside.
    flat.empty = !(std::abs(twice_area) > 0) || !std::isfinite(1.0 / twice_area);
    if (flat.empty)
        return flat;
    for (std::size_t k = 0; k < 3; ++k) {
        // The weight of a corner is the share of the area beyond the side opposite to it, so it is
        // 0 along that side. The sign of the area cancels: triangles seen from behind have positive
        // weights inside too.
        const Vec2d &from = c[(k + 1) % 3], &to = c[(k + 2) % 3];
        const Vec2d along = to - from;
        flat.weight[k] = {(along.y() * from.x() - along.x() * from.y()) / twice_area,
                          -along.y() / twice_area, along.x() / twice_area};
        flat.edge_samples[k] = std::abs(twice_area) / std::max(along.length(), 1e-12);
    }
    flat.colour = t.colour * brightness(t);
    const double across = std::sqrt(0.5 * std::abs(twice_area)) / kSamples;
    flat.edge_strength = kShadedEdgeStrength * float(std::min(1.0, across / kShadedEdgesFadeBelow));
    return flat;
}

/// The rows, or columns, whose centres lie between. The clamp comes before the conversion: a
/// coordinate far outside of the picture does not fit an int.
int first_centre(double low, int least, int most)
{
    return int(std::ceil(std::clamp(low - 0.5, double(least), double(most))));
}

class DepthBand
{
public:
    DepthBand(int width, int first_row, int rows)
        : width_(width), first_(first_row), end_(first_row + rows),
          samples_(std::size_t(width) * std::size_t(rows))
    {
    }

    const DepthSample& at(int x, int row) const { return samples_[place(x, row)]; }

    void draw(const ShadedTriangle& t, const Flat& flat)
    {
        const auto& c = flat.corner;
        const auto [left, right] = std::minmax({c[0].x(), c[1].x(), c[2].x()});
        const auto [top, bottom] = std::minmax({c[0].y(), c[1].y(), c[2].y()});
        const int end_row = first_centre(bottom, first_, end_);
        const int end_column = first_centre(right, 0, width_);
        for (int row = first_centre(top, first_, end_); row < end_row; ++row)
            for (int x = first_centre(left, 0, width_); x < end_column; ++x)
                draw_sample(t, flat, x, row);
    }

private:
    std::size_t place(int x, int row) const
    {
        return std::size_t(row - first_) * std::size_t(width_) + std::size_t(x);
    }

    void draw_sample(const ShadedTriangle& t, const Flat& flat, int x, int row)
    {
        std::array<double, 3> weight{};
        double depth = 0, in_front = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            weight[k] = flat.weight[k].at(x + 0.5, row + 0.5);
            // A centre on a common side is inside of both neighbours, and the first one keeps it.
            if (weight[k] < 0)
                return;
            depth += weight[k] * t.corner[k].z();
            in_front += weight[k] * t.in_front[k];
        }
        DepthSample& sample = samples_[place(x, row)];
        // What is cut away leaves the sample to what lies behind.
        if (in_front > 0 || depth <= sample.depth)
            return;
        sample.depth = depth;
        sample.colour = flat.colour;
        for (std::size_t k = 0; k < 3; ++k) {
            // Weight k falls to 0 at the side from corner k + 1 to the next, which is the bit of
            // that corner.
            const bool drawn = (t.edges >> ((k + 1) % 3)) & 1;
            if (drawn && weight[k] * flat.edge_samples[k] < kEdgePixels * kSamples) {
                sample.colour += flat.edge_strength * (edge_colour - flat.colour);
                return;
            }
        }
    }

    int width_, first_, end_;
    std::vector<DepthSample> samples_;
};

void write_row(const DepthBand& band, int y, int width, std::uint8_t* rgb)
{
    for (int x = 0; x < width; ++x) {
        Vec3f sum(0.0f);
        for (int row = 0; row < kSamples; ++row)
            for (int column = 0; column < kSamples; ++column)
                sum += band.at(x * kSamples + column, y * kSamples + row).colour;
        for (int channel = 0; channel < 3; ++channel) {
            const float value = sum[channel] / float(kSamples * kSamples);
            *rgb++ = std::uint8_t(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
        }
    }
}

/// The triangles of each band, ascending.
std::vector<std::vector<std::uint32_t>> by_band(const std::vector<Flat>& flats, int height,
                                                int bands)
{
    std::vector<std::vector<std::uint32_t>> list(static_cast<std::size_t>(bands));
    constexpr int kBandSamples = kShadedBandPixels * kSamples;
    for (std::uint32_t i = 0; i < flats.size(); ++i) {
        if (flats[i].empty)
            continue;
        const auto& c = flats[i].corner;
        const auto [top, bottom] = std::minmax({c[0].y(), c[1].y(), c[2].y()});
        const int first = first_centre(top, 0, height), end = first_centre(bottom, 0, height);
        for (int band = first / kBandSamples; first < end && band <= (end - 1) / kBandSamples;
             ++band)
            list[std::size_t(band)].push_back(i);
    }
    return list;
}

} // namespace

Image draw_shaded(const std::vector<ShadedTriangle>& triangles, const ShadedFrame& shown)
{
    const PictureFrame frame = frame_of(shown.low, shown.high, shown.longer_pixels);
    std::vector<Flat> flats(triangles.size());
    for_each_index(triangles.size(),
                   [&](std::size_t i) { flats[i] = flat_of(triangles[i], frame); });
    const auto row_bytes = 3 * std::size_t(frame.width);
    Image image{frame.width, frame.height,
                std::vector<std::uint8_t>(row_bytes * std::size_t(frame.height))};
    const int bands = (frame.height + kShadedBandPixels - 1) / kShadedBandPixels;
    const auto lists = by_band(flats, frame.height * kSamples, bands);
    for_each_index(
        std::size_t(bands),
        [&](std::size_t index) {
            const int top = int(index) * kShadedBandPixels;
            const int rows = std::min(kShadedBandPixels, frame.height - top);
            DepthBand band(frame.width * kSamples, top * kSamples, rows * kSamples);
            for (const std::uint32_t i : lists[index])
                band.draw(triangles[i], flats[i]);
            for (int y = top; y < top + rows; ++y)
                write_row(band, y, frame.width, &image.rgb[std::size_t(y) * row_bytes]);
        },
        1);
    return image;
}

} // namespace vdb_shell
