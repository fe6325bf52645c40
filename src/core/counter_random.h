// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vdb_shell
{

/// One step of splitmix64: a counter in, 64 well-mixed bits out, the same on every machine (Steele,
/// Lea, Flood, "Fast splittable pseudorandom number generators", 2014).
inline std::uint64_t splitmix64(std::uint64_t counter)
{
    std::uint64_t z = counter + 0x9e3779b97f4a7c15; // odd; 2^64 / golden ratio
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
}

/// Random numbers by counter: number k depends on the seed and on k only, so threads may draw in
/// any order. The standard library's distributions differ between implementations; these do not.
class CounterRandom
{
public:
    explicit CounterRandom(std::uint64_t seed) : key_(splitmix64(seed)) {}

    std::uint64_t bits(std::uint64_t counter) const
    {
        return splitmix64(key_ + (counter - 1) * kStep);
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    double unit(std::uint64_t counter) const
    {
        return static_cast<double>(bits(counter) >> 11) * 0x1p-53;
    }

    /// Uniform in [0, count). Precondition: 0 < count < 2^32, for which the bias is below 2^-21.
    std::uint64_t below(std::uint64_t counter, std::uint64_t count) const
    {
        return static_cast<std::uint64_t>(unit(counter) * static_cast<double>(count));
    }

private:
    static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15; ///< that of splitmix64

    std::uint64_t key_;
};

} // namespace vdb_shell
