// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace vdb_shell::test
{

/// Eight bits a channel, rows from the top.
struct Picture {
    using Colour = std::array<int, 3>;
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
    /// At shares of width and height.
    Colour at(double right, double down) const
    {
        const auto x = std::size_t(right * width), y = std::size_t(down * height);
        const std::uint8_t* p = &rgb[3 * (y * std::size_t(width) + x)];
        return {p[0], p[1], p[2]};
    }
    std::size_t pixels_of(const Colour& colour) const
    {
        std::size_t count = 0;
        for (std::size_t i = 0; i < rgb.size(); i += 3)
            count += Colour{rgb[i], rgb[i + 1], rgb[i + 2]} == colour;
        return count;
    }
    std::size_t red_pixels() const
    {
        std::size_t count = 0;
        for (std::size_t i = 0; i < rgb.size(); i += 3)
            count += rgb[i] > 150 && rgb[i] > rgb[i + 1] + 90 && rgb[i] > rgb[i + 2] + 90;
        return count;
    }
};

inline Picture read_png(const std::filesystem::path& path)
{
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_file(&image, path.c_str())) << image.message;
    image.format = PNG_FORMAT_RGB;
    Picture picture{int(image.width), int(image.height), {}};
    picture.rgb.resize(PNG_IMAGE_SIZE(image));
    EXPECT_TRUE(png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr));
    return picture;
}

} // namespace vdb_shell::test
