// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

/// Eight bits each of red, green and blue, rows from the top.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

/// The two side by side, the lower one centred, white beside it.
Image beside(const Image& left, const Image& right);

/// As the bytes of a PNG file. Throws WriteError.
std::string encode_png(const Image& image);

} // namespace vdb_shell
