// SPDX-License-Identifier: Apache-2.0
#pragma once

// What is wrong with a shell that is not valid yet.

#include "growth/grow_state.h"

#include <cstdint>
#include <vector>

namespace vdb_shell::growth
{

/// The faces, of those that `changed`, whose prism has a tet that is not positive or holds another
/// component, or whose inner triangle touches another triangle where it should not; and the faces
/// that these touch. `first`: the inner tree is built anew. Precondition otherwise: since it was
/// built or last refitted only these faces have changed.
std::vector<std::uint8_t> violating_faces(GrowState& s, const std::vector<std::uint8_t>& changed,
                                          bool first);

/// The same by their numbers, ascending, in time that does not depend on all other faces.
/// Preconditions: `changed` ascending, each once; of the inner tree BoxTree::index_parents; no
/// crowds (Connectivity::has_crowds).
std::vector<int> violating_among(GrowState& s, const std::vector<int>& changed);

/// Whether none of these would be a violation. Precondition: the inner tree's boxes hold the inner
/// triangles.
bool faces_valid(const GrowState& s, const std::vector<int>& faces);

/// The corners of such faces that are not pinned.
std::vector<std::uint8_t> free_corners_of(const GrowState& s, const std::vector<std::uint8_t>& bad);
/// The same by their numbers, those of the corners ascending.
std::vector<int> free_corners_of(const GrowState& s, const std::vector<int>& bad);

/// The faces to test again once these vertices have moved: those that hold one, and those in whose
/// prism a component may have come to lie.
std::vector<std::uint8_t> faces_around(const GrowState& s, const std::vector<std::uint8_t>& moved);
/// The same by their numbers, both ascending.
std::vector<int> faces_around(const GrowState& s, const std::vector<int>& moved);

} // namespace vdb_shell::growth
