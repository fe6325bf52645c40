// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/digest.h"

#include <gtest/gtest.h>

#include <string>

namespace vdb_shell
{
namespace
{

TEST(Digests, AreThoseOfTheSpecification)
{
    // XXH3 of 128 bits and no bytes, seed 0, from xxHash's own table of test vectors.
    EXPECT_EQ(Digest().hex(), "99aa06d3014798d86001c324468d497f");
    EXPECT_EQ(hex_of(digest_of(nullptr, 0)), "99aa06d3014798d86001c324468d497f");
}

TEST(Digests, OfPiecesAreThoseOfTheWhole)
{
    std::string bytes;
    for (int i = 0; i < 5000; ++i)
        bytes += char(i * i);
    Digest digest;
    for (std::size_t i = 0; i < bytes.size(); i += 100)
        digest.add(bytes.data() + i, 100);
    EXPECT_EQ(digest.words(), digest_of(bytes.data(), bytes.size()));
    EXPECT_EQ(digest.hex(), hex_of(digest_of(bytes.data(), bytes.size())));
}

TEST(Digests, ChangeWithEveryBit)
{
    std::string bytes(300, 'a');
    const auto sound = digest_of(bytes.data(), bytes.size());
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        bytes[bit / 8] = char(bytes[bit / 8] ^ (1 << bit % 8));
        EXPECT_NE(digest_of(bytes.data(), bytes.size()), sound) << bit;
        bytes[bit / 8] = char(bytes[bit / 8] ^ (1 << bit % 8));
    }
}

TEST(Digests, KnowWhereATextEnds)
{
    Digest one, other;
    one.add_text("ab");
    one.add_text("c");
    other.add_text("a");
    other.add_text("bc");
    EXPECT_NE(one.hex(), other.hex());
}

} // namespace
} // namespace vdb_shell
