// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vdb_shell
{

inline constexpr double kBytesPerGib = 1024.0 * 1024 * 1024;

/// Memory in bytes that the system could give without taking it from others, as Linux reports it;
/// infinite where it does not.
double available_memory();

} // namespace vdb_shell
