// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/defect_list.h"
#include "vdb_shell/certify/certificate.h"
#include "vdb_shell/certify/complex_certificate.h"

#include <array>
#include <string>
#include <vector>

namespace vdb_shell
{

/// The indices of the flags that are raised.
inline Defect<std::uint32_t> raised(const std::vector<char>& flags)
{
    Defect<std::uint32_t> defect;
    for (std::uint32_t i = 0; i < flags.size(); ++i)
        if (flags[i])
            add_to(defect, i);
    return defect;
}

inline std::string index_text(std::uint32_t index)
{
    return std::to_string(index);
}
inline std::string index_text(const std::array<std::uint32_t, 2>& pair)
{
    return std::to_string(pair[0]) + "-" + std::to_string(pair[1]);
}

/// "name COUNT (first I J K)".
template <typename Element>
std::string failure_line(const char* name, const Defect<Element>& defect)
{
    std::string line = std::string(name) + " " + std::to_string(defect.count) + " (first";
    for (const Element& element : defect.first)
        line += " " + index_text(element);
    return line + ")";
}

/// visit(name, defect) for each kind of failure. The names are those of messages and of JSON.
template <typename Visit> void for_each_kind(const Certificate& c, const Visit& visit)
{
    visit("bad_prisms", c.bad_prisms);
    visit("non_conforming_edges", c.non_conforming_edges);
    visit("cyclic_prisms", c.cyclic_prisms);
    visit("outer_contacts", c.outer_contacts);
    visit("inner_folds", c.inner_folds);
    visit("inner_contacts", c.inner_contacts);
    visit("inner_through_outer", c.inner_through_outer);
    visit("inside_out_components", c.inside_out_components);
    visit("nested_wrongly", c.nested_wrongly);
    visit("open_edges", c.open_edges);
    visit("split_vertices", c.split_vertices);
}
template <typename Visit> void for_each_kind(const ComplexCertificate& c, const Visit& visit)
{
    visit("cyclic_prisms", c.cyclic_prisms);
    visit("bad_tets", c.bad_tets);
    visit("crowded_faces", c.conformity.crowded_faces);
    visit("misoriented_faces", c.conformity.misoriented_faces);
    visit("stray_faces", c.conformity.stray_faces);
    visit("missing_triangles", c.conformity.missing_triangles);
    visit("outer_contacts", c.outer_contacts);
    visit("inner_contacts", c.inner_contacts);
    visit("inner_through_outer", c.inner_through_outer);
    visit("tets_through_outer", c.tets_through_outer);
    visit("overlapping_tets", c.overlapping_tets);
    visit("detached_tets", c.detached_tets);
    visit("open_edges", c.open_edges);
    visit("split_vertices", c.split_vertices);
    visit("doubled_vertices", c.doubled_vertices);
}

} // namespace vdb_shell
