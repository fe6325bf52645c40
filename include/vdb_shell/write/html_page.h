// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/write/vdb_file.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace vdb_shell
{

/// A page that shows a shell in a browser: one file that needs nothing else and no network. It can
/// hold frames of a sequence, which differ in where their points are and in nothing else.
/// docs/page.md says what can be done with it and what is rounded.
class HtmlPage
{
public:
    /// Prisms that are drawn; of more only a coarser shell is shown, and the page says so. A page
    /// of so many has 8 MB, and its cuts are made in 30 ms (docs/page.md).
    static constexpr std::size_t kMostShownPrisms = 200000;

    explicit HtmlPage(std::size_t most_shown_prisms = kMostShownPrisms);
    ~HtmlPage();
    HtmlPage(const HtmlPage&) = delete;
    HtmlPage& operator=(const HtmlPage&) = delete;

    /// The next frame, with what the page calls it; `file` is not needed afterwards. Throws
    /// InvalidOption where arrays do not fit together, GeometryError where triangles or tets are
    /// not those of the first frame, their messages opened by the label.
    void add(const std::string& label, const ShellFile& file);

    /// Same bytes for the same frames. The file appears whole or not at all. Throws WriteError,
    /// InvalidOption without a frame.
    void write(const std::filesystem::path& path, OutputSet* with = nullptr) const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace vdb_shell
