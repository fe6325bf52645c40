// SPDX-License-Identifier: Apache-2.0
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
