// SPDX-License-Identifier: Apache-2.0
#pragma once

// What decimation and remeshing have in common: both measure how far the result is from the input,
// and try again with a smaller tolerance where that is too far.

namespace vdb_shell
{

constexpr double kFewestTriangles = 4; // a tetrahedron

/// By what the tolerance of the operations is multiplied where the measured distance is too large.
/// The last of decimation's twelve attempts then has a fiftieth of the tolerance that was wanted.
constexpr double kStricter = 0.7;

/// Bounds the work for small tolerances: the spacing of samples is never under the diagonal over
/// this.
constexpr double kSamplesAlongDiagonal = 256.0;

} // namespace vdb_shell
