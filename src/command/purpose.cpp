// SPDX-License-Identifier: Apache-2.0

// Takes the name of a purpose; gives the options for it. They are files of options like any user's,
// kept in samples/presets and built into the command, so that nothing has to be found at run time.

#include "command/purpose.h"

#include "vdb_shell/core/error.h"

#include "preset_texts.h"

namespace vdb_shell::command
{

const NameTable<Purpose>& names(Purpose)
{
    static const NameTable<Purpose> table{{"any", Purpose::any},
                                          {"simulation", Purpose::simulation},
                                          {"fewest-tets", Purpose::fewest_tets},
                                          {"thickness", Purpose::thickness},
                                          {"speed", Purpose::speed}};
    return table;
}

std::string options_for(Purpose purpose)
{
    switch (purpose) {
    case Purpose::simulation:
        return kSimulationPreset;
    case Purpose::fewest_tets:
        return kFewestTetsPreset;
    case Purpose::thickness:
        return kThicknessPreset;
    case Purpose::speed:
        return kSpeedPreset;
    case Purpose::any:
        break;
    }
    return "{}";
}

void require_fit(Purpose purpose, const ShellOptions& options)
{
    const char* hindrance = nullptr;
    // What is refused is only what leaves nothing of the purpose; all else a user may overrule.
    const bool tapers = purpose == Purpose::simulation || purpose == Purpose::fewest_tets;
    if (tapers && !options.taper.wanted)
        hindrance = "without tapering (--no-taper)";
    else if (purpose == Purpose::fewest_tets && options.layers.layers != 1)
        hindrance = "of several layers (--layers), each of which has tets of its own";
    else if (purpose == Purpose::fewest_tets && options.subdivide.levels > 0)
        hindrance = "of a surface cut into more triangles (--subdivide)";
    else if (purpose == Purpose::thickness && options.grow.method != Method::thickest)
        hindrance = "of another method than thickest (--method)";
    else if (purpose == Purpose::thickness && options.scale.factor < 1)
        hindrance = "of pillars scaled down (--thickness-scale)";
    else if (purpose == Purpose::speed && options.grow.coarse_from == 0)
        hindrance = "that is grown from lines alone (--coarse-from)";
    else if (purpose == Purpose::speed && options.side == Side::outward)
        hindrance = "outside, which has no solid to fill (--side)";
    if (hindrance)
        throw InvalidOption(std::string("--for ") + name_in_table(purpose) +
                            " is not for a shell " + hindrance);
}

} // namespace vdb_shell::command
