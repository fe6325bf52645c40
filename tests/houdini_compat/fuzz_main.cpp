// SPDX-License-Identifier: Apache-2.0
#include "houdini_compat/fuzz.h"

#include <cstdlib>
#include <iostream>

// houdini_fuzz INPUTS [SEED [FORM]]: as many damaged files of each form, or of one (0 text, 1
// binary, 2 compressed), for longer runs than the tests.
int main(int argc, char** argv)
{
    const std::size_t inputs = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1000000;
    const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 2;
    const int only = argc > 3 ? std::atoi(argv[3]) : -1;
    bool well = true;
    for (const auto format : {vdb_shell::houdini::Format::text, vdb_shell::houdini::Format::binary,
                              vdb_shell::houdini::Format::compressed}) {
        if (only >= 0 && only != static_cast<int>(format))
            continue;
        const vdb_shell::test::FuzzResult r = vdb_shell::test::fuzz(format, inputs, seed);
        std::cout << name_of(format) << ": " << r.inputs << " inputs, " << r.read << " read, "
                  << r.refused << " refused, " << r.surfaces << " surfaces, " << r.shells
                  << " shells; slowest " << r.slowest_seconds << " s; at most "
                  << r.most_beyond_document << " bytes beyond 64 a byte"
                  << (r.wrong.empty() ? "" : "; WRONG: " + r.wrong) << std::endl;
        well = well && r.wrong.empty();
    }
    return well ? 0 : 1;
}
