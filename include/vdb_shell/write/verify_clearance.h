// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/obstacles/cores.h"
#include "vdb_shell/write/verify_file.h"

#include <vector>

namespace vdb_shell
{

/// Holds a shell against the cores that its file says it was kept off, which the file does not
/// hold: no tet meets them, by the certificate of shell and cores together, none is nearer than the
/// distance that the file says was asked for, and the least distance is the one that it states.
/// Cores that cannot be inside this surface are a failure with its reason, no exception. The cores
/// stand in the frame of the stack. Throws Cancelled.
Verification verify_clearance(const ShellFile& file, std::vector<CoreMesh> cores,
                              Interrupter* interrupter = nullptr);

} // namespace vdb_shell
