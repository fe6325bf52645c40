// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/util/NullInterrupter.h>

namespace vdb_shell
{

/// Progress and cancellation: OpenVDB's own interface, which Houdini's interrupter derives from.
/// Every stage that can take long has it as its last parameter; null means "never asked".
/// `start(name)` and `end()` frame a stage, `wasInterrupted(percent)` is polled inside it; a stage
/// that is told to stop throws Cancelled.
using Interrupter = openvdb::util::NullInterrupter;

} // namespace vdb_shell
