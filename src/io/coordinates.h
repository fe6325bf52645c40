// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/scan_text.h"
#include "vdb_shell/mesh/placement.h"

namespace vdb_shell
{

/// Turns the coordinates of a file into those of the mesh, one rounding each, and keeps what is to
/// be known of them all: where they lie and what the rounding cost.
class Coordinates
{
public:
    /// For a first look, with which to choose a placement: no limit on the size.
    static Coordinates first_look();
    explicit Coordinates(const Placement& placement = {});

    // Both throw ReadError for what is no number, not finite in float32 or, in the mesh, over the
    // limit.
    float from_text(const std::string& name, const Place& place, std::string_view word, int axis);
    float from_number(const std::string& name, const Place& place, double value, int axis);

    const Placement& placement() const { return placement_; }
    const Bounds& box() const { return box_; }                    ///< in the file's coordinates
    double largest_rounding() const { return largest_rounding_; } ///< in the mesh's units

private:
    void see(double exact, int axis);
    float placed(const std::string& name, const Place& place, double exact, int axis);
    void require_limit(const std::string& name, const Place& place, double exact,
                       double value) const;

    Placement placement_;
    bool limited_ = true;
    Bounds box_;
    double largest_rounding_ = 0;
};

} // namespace vdb_shell
