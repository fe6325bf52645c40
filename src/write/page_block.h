// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

/// Arrays of whole numbers and what JSON can say of them, as the script of the page reads them:
/// the length of the JSON text in four bytes, the text, and the arrays. It stands in the page as
/// deflated base 64, so nothing in it can end a script or begin one.
class PageBlock
{
public:
    nlohmann::ordered_json about; ///< "arrays" is ours

    /// `stride` numbers belong together, as the corners of a triangle do: each is stored as the
    /// difference to the one `stride` before, the bytes of equal weight side by side, which
    /// deflates to a third of what the numbers themselves would.
    void add(const char* name, const std::vector<std::uint8_t>& values, std::size_t stride = 1);
    void add(const char* name, const std::vector<std::uint16_t>& values, std::size_t stride = 1);
    void add(const char* name, const std::vector<std::uint32_t>& values, std::size_t stride = 1);

    std::string base64() const;

private:
    template <typename T>
    void add_array(const char* name, const std::vector<T>& values, std::size_t stride);
    nlohmann::ordered_json arrays_ = nlohmann::ordered_json::array();
    std::string bytes_;
};

} // namespace vdb_shell
