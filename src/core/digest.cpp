// SPDX-License-Identifier: Apache-2.0

// Digests by xxHash, of which the header alone is used: its functions are compiled into this source
// and nothing is linked.

#include "vdb_shell/core/digest.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace vdb_shell
{

struct Digest::State {
    XXH3_state_t xxh;
};

Digest::Digest() : state_(std::make_unique<State>())
{
    XXH3_128bits_reset(&state_->xxh);
}

Digest::~Digest() = default;

void Digest::add(const void* data, std::size_t size)
{
    // An empty vector has no address, which xxHash would refuse.
    if (size > 0)
        XXH3_128bits_update(&state_->xxh, data, size);
}

void Digest::add_text(std::string_view text)
{
    add_number(std::uint64_t(text.size()));
    add(text.data(), text.size());
}

std::array<std::uint64_t, 2> Digest::words() const
{
    const XXH128_hash_t hash = XXH3_128bits_digest(&state_->xxh);
    return {hash.high64, hash.low64};
}

std::string Digest::hex() const
{
    return hex_of(words());
}

std::array<std::uint64_t, 2> digest_of(const void* data, std::size_t size)
{
    const XXH128_hash_t hash = XXH3_128bits(data, size);
    return {hash.high64, hash.low64};
}

std::string hex_of(const std::array<std::uint64_t, 2>& words)
{
    static constexpr char kDigits[] = "0123456789abcdef";
    std::string text;
    for (const std::uint64_t word : words)
        for (int shift = 60; shift >= 0; shift -= 4)
            text += kDigits[(word >> shift) & 15u];
    return text;
}

} // namespace vdb_shell
