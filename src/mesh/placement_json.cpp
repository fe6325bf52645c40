// SPDX-License-Identifier: Apache-2.0

// A placement for files and for people. Readers put an object back where it was by these two
// numbers, so JSON and text give all digits of the doubles: 17 always suffice. The classic locale
// keeps the decimal point, whatever the program around this library has set.

#include "mesh/placement_json.h"

#include "core/text_stream.h"

#include <locale>

namespace vdb_shell
{

nlohmann::ordered_json placement_json(const Placement& placement)
{
    const openvdb::Vec3d& o = placement.origin;
    return {{"origin", {o[0], o[1], o[2]}}, {"unit", placement.unit}};
}

std::string placement_text(const Placement& placement)
{
    OutText out;
    out.imbue(std::locale::classic());
    constexpr int kAllDigits = 17;
    out.precision(kAllDigits);
    const openvdb::Vec3d& o = placement.origin;
    out << "read about the point (" << o[0] << ", " << o[1] << ", " << o[2] << ")";
    if (placement.unit != 1.0)
        out << ", in units of " << placement.unit;
    return out.str();
}

} // namespace vdb_shell
