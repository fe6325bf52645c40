// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/certify/core_certificate.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/options/name_table.h"
#include "vdb_shell/shell/core_tets.h"
#include "vdb_shell/shell/shell_stack.h"

#include <cstddef>
#include <optional>

namespace vdb_shell
{

/// An outside program that is missing, that failed, or whose result is refused.
struct ProgramError : Error {
    using Error::Error;
};

/// The outside program that fills what a shell leaves empty. It is run as a command and never
/// linked: TetGen is under the AGPL, Gmsh under the GPL.
enum class CoreFillProgram { none, gmsh, tetgen };
const NameTable<CoreFillProgram>& names(CoreFillProgram);

struct CoreFillOptions {
    CoreFillProgram program = CoreFillProgram::none;
    /// TetGen's bound on the radius of a tet's circumscribed sphere over its shortest edge, with
    /// 14 degrees for the smallest dihedral angle; 0: as few tets as the surface needs, in any
    /// shape.
    double radius_edge_ratio = 1.414;
    /// No tet is larger than the regular one of this edge length (TetGen), edges are about as long
    /// at most (Gmsh). Unset: as large as the surface of the void allows.
    std::optional<double> edge_length;
    double seconds = 600; ///< after which the program is ended

    bool wanted() const { return program != CoreFillProgram::none; }
};
OptionList describe(CoreFillOptions& options);

struct CoreFillReport {
    CoreFillProgram program = CoreFillProgram::none;
    std::size_t void_triangles = 0; ///< of the surface that was filled; 0: nothing was left to fill
    std::size_t points = 0;         ///< of the core's inside
    std::size_t moved_points = 0;   ///< of those: moved, as tets there were flat or turned over
    std::size_t tets = 0;
    double volume = 0;
    double min_dihedral_radians = 0; ///< of the core's tets
    CoreCertificate certificate;
};

struct CoreFill {
    CoreTets core;
    CoreFillReport report;
};

/// Hands the surface of the void to the program, and takes its tets if they are proven to fit: no
/// face of the shell split or lost, all tets positive, face to face with each other and with the
/// shell (certify_core). What `holes` enclose, closed surfaces inside the void, is left empty, and
/// their triangles are kept as well. Points are found again by index; new ones are rounded to
/// float32. The same tets for any number of threads. Precondition: the stack is certified and lies
/// inside its surface, `tets` are its tets; of holes, that of certify_core. Throws InvalidOption;
/// ProgramError where the program is missing or fails, and where its tets do not fit; WriteError
/// where there is no room for its files; Cancelled. Whatever happens, no temporary file and no
/// process is left.
CoreFill fill_core(const ShellStack& stack, const TetMesh& tets, const CoreFillOptions& options,
                   Interrupter* interrupter = nullptr, const TriangleMesh& holes = {});

/// Throws ProgramError unless the program is found on PATH: asked before the work begins.
void require_program(const CoreFillOptions& options);

} // namespace vdb_shell
