// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/report/report.h"

#include <sstream>

namespace vdb_shell
{

/// The lines on what was read and what became of it before there was a level set.
void surface_lines(std::ostringstream& out, const ShellReport& report);

} // namespace vdb_shell
