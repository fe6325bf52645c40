// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/resample/coarsen.h"

#include <vector>

namespace vdb_shell
{

/// On which side of each component of a closed surface its inside is. No test of single triangles
/// sees that a component of a few triangles has turned inside out: each of several collapses may
/// turn a triangle by less than a right angle.
class ComponentSides
{
public:
    explicit ComponentSides(const TriangleMesh& mesh);

    /// Marks all vertices of the components that enclose another sign of volume (exact) in what the
    /// collapses left of the surface. False where there are none. Precondition: collapses neither
    /// part nor join components, nor do away with one.
    bool hold_turned(const Coarsened& left, std::vector<char>& fixed) const;

private:
    std::vector<int> component_; ///< by vertex
    std::vector<int> sign_;      ///< by component
};

} // namespace vdb_shell
