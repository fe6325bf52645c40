// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/check_mesh.h"

#include <vector>

namespace vdb_shell
{

template <typename Element> void add_to(Defect<Element>& defect, const Element& element)
{
    if (defect.count++ < Defect<Element>::kFirstShown)
        defect.first.push_back(element);
}

/// How many, and the first of them.
template <typename Element> Defect<Element> summary_of(const std::vector<Element>& elements)
{
    Defect<Element> defect;
    for (const Element& element : elements)
        add_to(defect, element);
    return defect;
}

} // namespace vdb_shell
