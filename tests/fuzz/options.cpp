// SPDX-License-Identifier: Apache-2.0
#include "fuzz/targets.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/pipeline.h"

namespace vdb_shell::fuzz
{

void options(std::string_view bytes)
{
    ShellOptions read;
    try {
        read = options_from_json(std::string(bytes), {}, "fuzz");
    } catch (const ReadError&) {
        return;
    } catch (const InvalidOption&) {
        return;
    }
    const std::string stored = options_json(read);
    require(options_json(options_from_json(stored)) == stored, "stored options come back changed");
    try {
        require_sensible(read);
    } catch (const InvalidOption&) {
    }
}

} // namespace vdb_shell::fuzz
