// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace vdb_shell
{

/// 128 bits that tell damaged data from sound (XXH3, as its authors have fixed it from version 0.8
/// on). Two inputs have the same with probability 2^-128, unless somebody made them so: this finds
/// damage, and proves nothing against forgery. Numbers are taken in the byte order of the machine.
class Digest
{
public:
    Digest();
    ~Digest();
    Digest(const Digest&) = delete;
    Digest& operator=(const Digest&) = delete;

    void add(const void* data, std::size_t size);
    template <typename T> void add_number(T value)
    {
        static_assert(std::is_arithmetic_v<T>);
        add(&value, sizeof value);
    }
    /// With its length, so that what follows cannot be taken for a part of it.
    void add_text(std::string_view text);
    /// With their number. Numbers, or structs of numbers without padding.
    template <typename T> void add_values(const std::vector<T>& values)
    {
        add_number(std::uint64_t(values.size()));
        add(values.data(), values.size() * sizeof(T));
    }

    std::array<std::uint64_t, 2> words() const;
    /// 32 hexadecimal digits, lower case.
    std::string hex() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The same of bytes that are all there.
std::array<std::uint64_t, 2> digest_of(const void* data, std::size_t size);

/// 32 hexadecimal digits, lower case.
std::string hex_of(const std::array<std::uint64_t, 2>& words);

} // namespace vdb_shell
