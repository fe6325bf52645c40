// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vdb_shell::command
{

/// Exit statuses, as docs/command_line.md lists them. Farms give 33, 137 and 126 and up meanings of
/// their own, so none of those is used.
enum ExitCode {
    success = 0,
    internal_error = 1,
    usage_error = 2,
    read_error = 3,
    geometry_error = 4,
    write_error = 5,
    bound_not_met = 6,
    check_failed = 7,
    program_failed = 8, ///< an outside program (--core-fill)
    out_of_memory = 9,
    signal_base = 128, ///< plus the signal's number
};

} // namespace vdb_shell::command
