// SPDX-License-Identifier: Apache-2.0
#pragma once

// The parts of the report about the shape of tets, as JSON and as text.

#include "vdb_shell/report/report.h"

#include <nlohmann/json.hpp>

#include <sstream>

namespace vdb_shell
{

/// The distribution of a figure over all tets or pillars, `convert` put to each of its values. That
/// keeps their order only if it rises, as a change of unit does.
nlohmann::ordered_json spread_json(const Spread& spread, double (*convert)(double) = nullptr);

nlohmann::ordered_json quality_json(const QualityReport& quality);
nlohmann::ordered_json bounds_json(const SurfaceBounds& bounds);
nlohmann::ordered_json wanted_json(const BoundsReport& report);

/// The shapes that solvers ask about, and below them how good the surface lets them be.
void shape_lines(std::ostringstream& out, const ShellReport& report);
/// A line for each bound that was wanted.
/// One wish and what became of it.
std::string wanted_text(const WantedBound& bound);

} // namespace vdb_shell
