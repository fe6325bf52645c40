// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/name_table.h"

namespace vdb_shell
{

/// Which tets of each prism have to be positive.
enum class PrismTest {
    twelve_tets, ///< those of all six splits: any diagonals and any thinner shell are valid too
    chosen_tets, ///< the three of the given split
};
const NameTable<PrismTest>& names(PrismTest);

} // namespace vdb_shell
