// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/pipeline.h"

namespace vdb_shell
{

/// Fills in the report's figures of field, lines, prisms and tets (not coverage) from the rest of
/// the result. Throws Cancelled.
void measure_result(ShellResult& result, Interrupter* interrupter);

} // namespace vdb_shell
