// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace vdb_shell
{
class OutputSet;

/// Eight bits each of red, green and blue, rows from the top.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

/// The two side by side, the lower one centred, white beside it.
Image beside(const Image& left, const Image& right);

/// A PNG file, whole or not at all: encoded before the file is opened. Throws WriteError.
void write_png(const std::filesystem::path& path, const Image& image, OutputSet* with = nullptr);

} // namespace vdb_shell
