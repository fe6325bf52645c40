// SPDX-License-Identifier: Apache-2.0
#pragma once

// The names that option values have on the command line and in JSON: one table an enum.

#include "vdb_shell/certify/certificate.h"
#include "vdb_shell/field/contour.h"
#include "vdb_shell/field/narrow_band.h"
#include "vdb_shell/growth/grow.h"
#include "vdb_shell/growth/refine.h"
#include "vdb_shell/shell/sides.h"
#include "vdb_shell/shell/tessellate.h"
#include "vdb_shell/step/directions.h"
#include "vdb_shell/step/limits.h"
#include "vdb_shell/step/line_step.h"
#include "vdb_shell/write/cross_section.h"
#include "vdb_shell/write/vdb_file.h"

#include <cassert>
#include <string>
#include <utility>
#include <vector>

namespace vdb_shell
{

template <typename Enum> using NameTable = std::vector<std::pair<std::string, Enum>>;

inline const NameTable<ContourMethod>& names(ContourMethod)
{
    static const NameTable<ContourMethod> table{{"volume-to-mesh", ContourMethod::volume_to_mesh},
                                                {"marching-tets", ContourMethod::marching_tets}};
    return table;
}

inline const NameTable<DirectionSource>& names(DirectionSource)
{
    static const NameTable<DirectionSource> table{{"pseudo-normal", DirectionSource::pseudo_normal},
                                                  {"gradient", DirectionSource::gradient}};
    return table;
}

inline const NameTable<FieldRoute>& names(FieldRoute)
{
    static const NameTable<FieldRoute> table{{"auto", FieldRoute::automatic},
                                             {"sparse", FieldRoute::sparse},
                                             {"dense", FieldRoute::dense}};
    return table;
}

inline const NameTable<StopTest>& names(StopTest)
{
    static const NameTable<StopTest> table{{"none", StopTest::none},
                                           {"normal", StopTest::normal},
                                           {"start-gradient", StopTest::start_gradient},
                                           {"distance", StopTest::distance},
                                           {"bisection", StopTest::bisection},
                                           {"relative-normal", StopTest::relative_normal},
                                           {"own-sheet", StopTest::own_sheet}};
    return table;
}

inline const NameTable<Limit>& names(Limit)
{
    static const NameTable<Limit> table{
        {"none", Limit::none}, {"uniform", Limit::uniform}, {"adaptive", Limit::adaptive}};
    return table;
}

inline const NameTable<Side>& names(Side)
{
    static const NameTable<Side> table{
        {"inward", Side::inward}, {"outward", Side::outward}, {"both", Side::both}};
    return table;
}

inline const NameTable<Method>& names(Method)
{
    static const NameTable<Method> table{
        {"raw", Method::raw}, {"certified", Method::certified}, {"thickest", Method::thickest}};
    return table;
}

inline const NameTable<RefineBy>& names(RefineBy)
{
    static const NameTable<RefineBy> table{
        {"contacts", RefineBy::contacts}, {"voids", RefineBy::voids}, {"area", RefineBy::area}};
    return table;
}

inline const NameTable<SplitRule>& names(SplitRule)
{
    static const NameTable<SplitRule> table{{"index", SplitRule::vertex_index},
                                            {"length-descending", SplitRule::length_descending},
                                            {"length-ascending", SplitRule::length_ascending},
                                            {"ripple", SplitRule::ripple}};
    return table;
}

inline const NameTable<PrismTest>& names(PrismTest)
{
    static const NameTable<PrismTest> table{{"twelve-tets", PrismTest::twelve_tets},
                                            {"chosen-tets", PrismTest::chosen_tets}};
    return table;
}

inline const NameTable<PointPlacement>& names(PointPlacement)
{
    static const NameTable<PointPlacement> table{{"same-file", PointPlacement::same_file},
                                                 {"beside", PointPlacement::beside}};
    return table;
}

inline const NameTable<Axis>& names(Axis)
{
    static const NameTable<Axis> table{{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}};
    return table;
}

template <typename Enum> const std::string& name_in_table(Enum value)
{
    for (const auto& [name, entry] : names(value))
        if (entry == value)
            return name;
    assert(false && "every enumerator stands in its table");
    return names(value).front().first;
}

} // namespace vdb_shell
