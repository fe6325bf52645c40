// SPDX-License-Identifier: Apache-2.0
#include "fuzz/targets.h"

#include <tbb/global_control.h>

#include <cstddef>
#include <cstdint>

// libFuzzer's main() calls this with inputs that it makes of those that went new ways.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    // Two processes go through more inputs than one with two threads.
    static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    vdb_shell::fuzz::VDB_SHELL_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
    return 0;
}
