// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/pipeline.h"

#include <vector>

namespace vdb_shell
{

/// Tapers r.stack towards what is wanted: as the options say first, then with other costs where
/// that falls short, kMostTaperRuns times in all. Leaves the stack that has most of it and its
/// TaperReport. `cap` as in taper_shell.
constexpr int kMostTaperRuns = 6;
void taper_to_bounds(ShellResult& r, const ShellOptions& options, const std::vector<double>& cap,
                     Interrupter* interrupter);

/// Fills in r.report.wanted from the finished shell; nothing where nothing is wanted.
void judge_result(ShellResult& r, const ShellOptions& options, const std::vector<double>& cap);

/// Throws InvalidOption for a number of tets that no shell of this surface has: fewer than
/// triangles.
void require_enough_tets(const TriangleMesh& surface, const WantedBounds& wanted);

} // namespace vdb_shell
