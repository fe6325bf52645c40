// SPDX-License-Identifier: Apache-2.0

#include "core/available_memory.h"

#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>

namespace vdb_shell
{

double available_memory()
{
    std::ifstream info("/proc/meminfo");
    for (std::string key, rest; info >> key && std::getline(info, rest);)
        if (key == "MemAvailable:")
            return std::strtod(rest.c_str(), nullptr) * 1024.0;
    return std::numeric_limits<double>::infinity();
}

} // namespace vdb_shell
