// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/obstacles/cores.h"
#include "vdb_shell/shell/shell_stack.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

/// Where a pillar that ended at a core would stand on it: the point of the cores nearest to the
/// pillar's innermost point.
struct CoreFoot {
    std::int32_t core = -1;     ///< index of the core; -1: the pillar did not end at one
    std::int32_t triangle = -1; ///< of the core's mesh, -1 as above
    openvdb::Vec3s uvw{0.0f};   ///< barycentric: weights of the triangle's corners; 0 as above
    float distance = 0;         ///< to the nearest core, whether or not the pillar ended there
};

/// One core in the report.
struct CoreFigures {
    std::string name;
    std::size_t triangles = 0, parts = 0;
    double volume = 0;     ///< that it encloses
    std::size_t ended = 0; ///< pillars that ended at it
};

struct CoreReport {
    double distance = 0;                ///< that was asked for
    double least_distance = 0;          ///< between shell and cores, measured between triangles
    double volume = 0;                  ///< of all cores
    std::size_t ended = 0;              ///< pillars that ended at a core
    std::size_t kept_out_triangles = 0; ///< of what the shell was held against
    std::vector<CoreFigures> cores;
};

/// By vertex of the surface. A pillar has ended at a core if what is left of its way, the distance
/// of its innermost point to Cores::kept_out, is at most CoreOptions::reach times its length, and
/// if the segment from there to the nearest point of the cores meets no innermost triangle that
/// does not have that point as a corner: nothing else of the shell is in between. Same result for
/// any number of threads. Precondition: the stack lies inward.
std::vector<CoreFoot> find_core_feet(const ShellStack& stack, const Cores& cores,
                                     const CoreOptions& options);

/// Sets StopReason::core for pillars that ended at a core, whatever held them: the core is what
/// ended them for whoever attaches them there. In all layers, as a pillar has one reason.
void mark_core_stops(ShellStack& stack, const std::vector<CoreFoot>& feet);

CoreReport report_cores(const ShellStack& stack, const Cores& cores, const CoreOptions& options,
                        const std::vector<CoreFoot>& feet);

/// Of the points of the tets, which may be joined_tets: those of innermost points have their feet,
/// all others none.
std::vector<CoreFoot> feet_of_tet_points(const ShellStack& stack, const TetMesh& tets,
                                         const std::vector<CoreFoot>& feet);

} // namespace vdb_shell
