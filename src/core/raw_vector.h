// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace vdb_shell
{

/// Makes elements that are given no value without one.
template <typename T> struct RawAllocator : std::allocator<T> {
    // The standard library asks for this name.
    // NOLINTNEXTLINE(readability-identifier-naming)
    template <typename U> struct rebind {
        using other = RawAllocator<U>;
    };
    template <typename U> void construct(U* at) noexcept { ::new (static_cast<void*>(at)) U; }
    template <typename U, typename First, typename... Rest>
    void construct(U* at, First&& first, Rest&&... rest)
    {
        ::new (static_cast<void*>(at)) U(std::forward<First>(first), std::forward<Rest>(rest)...);
    }
};

/// A vector whose resize() leaves new elements as the memory is, for those that are all written
/// next, by several threads. A vector of zeros would be written by one thread first, and of
/// hundreds of megabytes the first touch of each page takes longer than what is written then.
template <typename T> using RawVector = std::vector<T, RawAllocator<T>>;

} // namespace vdb_shell
