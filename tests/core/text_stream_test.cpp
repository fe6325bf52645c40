// SPDX-License-Identifier: Apache-2.0
#include "core/text_stream.h"

#include <gtest/gtest.h>

#include <new>
#include <ostream>
#include <streambuf>
#include <string>

namespace vdb_shell
{
namespace
{

/// A buffer that has no room for anything.
struct FullBuffer : std::streambuf {
    int_type overflow(int_type) override { throw std::bad_alloc(); }
};

TEST(TextStream, ThrowsOnWhatItsBufferThrows)
{
    FullBuffer full;
    std::ostream silent(&full);
    silent << "text"; // the standard library's own: a mark, and no word
    EXPECT_TRUE(silent.bad());

    OutText out;
    out.std::ostream::rdbuf(&full);
    EXPECT_THROW(out << "text", std::bad_alloc);
}

TEST(TextStream, OfWordsEndsWithoutAComplaint)
{
    InText words("one 2");
    std::string word;
    int number = 0;
    EXPECT_TRUE(words >> word >> number);
    EXPECT_EQ(word, "one");
    EXPECT_EQ(number, 2);
    EXPECT_FALSE(words >> word); // the end is no error
    InText lines("a\n\nb");
    std::size_t count = 0;
    for (std::string line; std::getline(lines, line);)
        ++count;
    EXPECT_EQ(count, 3U);
}

} // namespace
} // namespace vdb_shell
