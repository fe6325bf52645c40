// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace vdb_shell
{

/// The bytes of a .vdb being walked. Every read is held against what is left of them, and whatever
/// does not fit throws ReadError with file, grid, element and place. Numbers are in the byte order
/// of the machine, as OpenVDB writes them.
class VdbCursor
{
public:
    VdbCursor(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

    template <typename T> T number(const char* what)
    {
        T value{};
        std::memcpy(&value, take(sizeof value, what).data(), sizeof value);
        return value;
    }

    std::string_view take(std::uint64_t count, const char* what)
    {
        need(count, what);
        const std::string_view taken = bytes_.substr(at_, count);
        at_ += count;
        return taken;
    }

    /// A length followed by that many bytes.
    std::string_view text(const char* what) { return take(number<std::uint32_t>(what), what); }

    /// Precondition: not beyond the end.
    void go_to(std::uint64_t place) { at_ = place; }
    std::uint64_t at() const { return at_; }
    std::uint64_t size() const { return bytes_.size(); }
    std::uint64_t left() const { return bytes_.size() - at_; }
    std::string_view bytes() const { return bytes_; }

    /// What messages name besides the file, "" for the file itself.
    void enter_grid(std::string grid) { grid_ = std::move(grid); }

    /// "FILE: what".
    [[noreturn]] void fail(const std::string& what) const;
    /// "FILE: the file is truncated or damaged: grid ...: what at byte ...".
    [[noreturn]] void damaged(const std::string& what) const;
    void require(bool condition, const char* what) const
    {
        if (!condition)
            damaged(what);
    }

private:
    void need(std::uint64_t count, const char* what) const;

    std::string_view bytes_;
    std::string name_, grid_;
    std::uint64_t at_ = 0; ///< never beyond the end
};

} // namespace vdb_shell
