// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/write/verify_file.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vdb_shell::test
{

/// What check says about one thing. A thing that was not looked at fails the test, for neither
/// answer would be one about it.
inline Verification verification_of(const std::vector<Verification>& all, const std::string& what)
{
    for (const Verification& entry : all)
        if (entry.what == what)
            return entry;
    ADD_FAILURE() << "not looked at whether " << what;
    return {};
}

/// The same after verifying a shell.
inline Verification verification_of(const ShellFile& file,
                                    const std::string& what = "certificate is as stated")
{
    return verification_of(verify_shell(file), what);
}

} // namespace vdb_shell::test
