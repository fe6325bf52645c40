// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/usd_file.h"
#include "vdb_shell/write/text_out.h"

#include <cstddef>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace vdb_shell
{

/// The stage under construction: prims in braces, each attribute on a line of its own.
class UsdStage
{
public:
    /// The text of a value at one time.
    using Text = std::function<std::string(const UsdSample&)>;

    UsdStage(std::ostream& out, const std::vector<UsdSample>& samples)
        : text_(out), samples_(samples)
    {
    }

    void line(const std::string& text)
    {
        text_ << std::string(text.empty() ? 0 : 4 * depth_, ' ') << text << '\n';
    }

    void open(const std::string& prim)
    {
        line(prim);
        line("{");
        ++depth_;
    }
    void close()
    {
        --depth_;
        line("}");
    }

    /// `declaration` is type and name, `metadata` what stands behind the value. Whether a value
    /// changes with time is decided by its text: equal texts are equal values, and the text has to
    /// be made in any case. All samples of one attribute are in memory at once, those of different
    /// attributes are not.
    void attribute(const std::string& declaration, const Text& value,
                   const std::string& metadata = {});

    void primvar(const std::string& declaration, const Text& value)
    {
        attribute(declaration, value, "interpolation = \"vertex\"");
    }

private:
    TextOut text_;
    const std::vector<UsdSample>& samples_;
    std::size_t depth_ = 0;
};

} // namespace vdb_shell
