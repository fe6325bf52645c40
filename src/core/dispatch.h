// SPDX-License-Identifier: Apache-2.0
#pragma once

// For the end of a source of kernels (core/simd.h): VDB_SHELL_KERNEL(name) is the function of that
// name for the processor at hand, as HWY_DYNAMIC_DISPATCH is, but without that one's call into
// Highway's library. Growth calls kernels of some ten nanoseconds a million times (fandisk: that
// call alone was 0.4 % of the whole command).

#include <hwy/highway.h>

namespace vdb_shell::simd
{

/// Highway's own record: tests may change what it holds at any time.
inline const hwy::ChosenTarget& chosen_target()
{
    static const hwy::ChosenTarget& chosen = hwy::GetChosenTarget();
    return chosen;
}

} // namespace vdb_shell::simd

// Where only one target is compiled Highway calls it without a table.
#if HWY_IDE || ((HWY_TARGETS & (HWY_TARGETS - 1)) == 0)
#define VDB_SHELL_KERNEL(name) HWY_DYNAMIC_DISPATCH(name)
#else
#define VDB_SHELL_KERNEL(name)                                                                     \
    (*(HWY_DISPATCH_TABLE(name)[vdb_shell::simd::chosen_target().GetIndex()]))
#endif
