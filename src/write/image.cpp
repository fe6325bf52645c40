// SPDX-License-Identifier: Apache-2.0

// Takes pixels, gives pixels or a PNG file: it is encoded in memory before a file is opened, so a
// failure leaves none.

#include "write/image.h"

#include "vdb_shell/core/atomic_file.h"
#include "vdb_shell/core/error.h"

#include <png.h>

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <string>

namespace vdb_shell
{
namespace
{

std::string encode_png(const Image& picture, const std::filesystem::path& path)
{
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = png_uint_32(picture.width);
    image.height = png_uint_32(picture.height);
    image.format = PNG_FORMAT_RGB;
    // This macro of libpng bounds the size of any PNG of that many pixels, so one call is enough
    // and its second pass, which would only ask for the size, is not needed.
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.rgb.data(), 0,
                                   nullptr)) {
        // The message lives inside of the image, which the next call releases.
        const std::string why = image.message;
        png_image_free(&image);
        throw WriteError(path.string() + ": the picture cannot be encoded: " + why);
    }
    bytes.resize(size);
    return bytes;
}

} // namespace

Image beside(const Image& left, const Image& right)
{
    Image both{left.width + right.width, std::max(left.height, right.height), {}};
    const auto row_bytes = 3 * static_cast<std::size_t>(both.width);
    both.rgb.assign(row_bytes * static_cast<std::size_t>(both.height), 255);
    std::size_t column = 0;
    for (const Image* image : {&left, &right}) {
        const auto bytes = 3 * static_cast<std::size_t>(image->width);
        const auto top = static_cast<std::size_t>((both.height - image->height) / 2);
        for (std::size_t y = 0; y < static_cast<std::size_t>(image->height); ++y)
            std::copy_n(image->rgb.begin() + static_cast<std::ptrdiff_t>(y * bytes), bytes,
                        both.rgb.begin() +
                            static_cast<std::ptrdiff_t>((top + y) * row_bytes + column));
        column += bytes;
    }
    return both;
}

void write_png(const std::filesystem::path& path, const Image& image, OutputSet* with)
{
    const std::string png = encode_png(image, path);
    write_stream_atomically(
        path, [&](std::ostream& out) { out.write(png.data(), std::streamsize(png.size())); }, with);
}

} // namespace vdb_shell
