// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/growth/refine.h"
#include "vdb_shell/resample/decimate.h"
#include "vdb_shell/resample/remesh.h"
#include "vdb_shell/resample/retriangulate.h"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>

namespace vdb_shell
{

nlohmann::ordered_json distance_json(const DistanceFigures& distance);
nlohmann::ordered_json retriangulate_json(const RetriangulateReport& retriangulate);
nlohmann::ordered_json decimate_json(const DecimateReport& decimate);
nlohmann::ordered_json remesh_json(const RemeshReport& remesh);

void retriangulate_lines(std::ostringstream& out, const RetriangulateReport& retriangulate);
void decimate_line(std::ostringstream& out, const DecimateReport& decimate);
void remesh_lines(std::ostringstream& out, const RemeshReport& remesh);
void refine_lines(std::ostringstream& out, const RefineReport& refine);

} // namespace vdb_shell
