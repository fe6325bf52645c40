// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/certify/certificate.h"

#include "certify/certificate_findings.h"

#include <set>
#include <string>

namespace vdb_shell::test
{

inline std::set<std::string> kinds(const Certificate& certificate)
{
    std::set<std::string> names;
    for_each_kind(certificate, [&](const char* name, const auto& defect) {
        if (defect.count > 0)
            names.insert(name);
    });
    return names;
}

} // namespace vdb_shell::test
