// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_stop.h"

#include <tbb/parallel_sort.h>

namespace vdb_shell
{

/// Sorts on all threads. Precondition: `before` tells any two elements apart, or else the order of
/// those that it does not would depend on the threads.
template <class Iterator, class Before>
void parallel_sort(Iterator begin, Iterator end, const Before& before)
{
    stop_if_stage_wants();
    tbb::parallel_sort(begin, end, before);
}

} // namespace vdb_shell
