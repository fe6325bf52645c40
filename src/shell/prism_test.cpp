// SPDX-License-Identifier: Apache-2.0

// The names by which options and files speak of the two tests of a prism. They are stored in files,
// so a name is never given to another test. What the tests promise: docs/theory.md, "One prism: the
// twelve tets".

#include "vdb_shell/shell/prism_test.h"

namespace vdb_shell
{

const NameTable<PrismTest>& names(PrismTest)
{
    static const NameTable<PrismTest> table{{"twelve-tets", PrismTest::twelve_tets},
                                            {"chosen-tets", PrismTest::chosen_tets}};
    return table;
}

} // namespace vdb_shell
