// SPDX-License-Identifier: Apache-2.0
#include "fuzz/targets.h"

#include <cstddef>
#include <cstdint>

// libFuzzer's main() calls this with inputs that it makes of those that went new ways.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    vdb_shell::fuzz::VDB_SHELL_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
    return 0;
}
