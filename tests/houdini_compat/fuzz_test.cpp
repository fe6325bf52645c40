// SPDX-License-Identifier: Apache-2.0
#include "houdini_compat/fuzz.h"

#include <gtest/gtest.h>

namespace vdb_shell::test
{
namespace
{

class HoudiniFuzz : public ::testing::TestWithParam<houdini::Format>
{
};

TEST_P(HoudiniFuzz, DamagedFilesAreReadOrRefused)
{
    const FuzzResult result = fuzz(GetParam(), 20000, 1);
    EXPECT_EQ(result.wrong, "");
    EXPECT_EQ(result.inputs, result.read + result.refused);
    // Both happen often, else the damage is not of the right kind.
    EXPECT_GT(result.read, 200u);
    EXPECT_GT(result.refused, 10000u);
    // The free part of the budget, and a chunk.
    EXPECT_LT(result.most_beyond_document, 4 << 20);
    EXPECT_LT(result.slowest_seconds, 10.0);
}

INSTANTIATE_TEST_SUITE_P(Formats, HoudiniFuzz,
                         ::testing::Values(houdini::Format::text, houdini::Format::binary,
                                           houdini::Format::compressed));

} // namespace
} // namespace vdb_shell::test
