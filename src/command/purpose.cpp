// SPDX-License-Identifier: Apache-2.0

// Takes the name of a purpose; gives the options for it. They are files of options like any user's,
// kept in samples/presets and built into the command, so that nothing has to be found at run time.

#include "command/purpose.h"

#include "preset_texts.h"

namespace vdb_shell::command
{

const NameTable<Purpose>& names(Purpose)
{
    static const NameTable<Purpose> table{{"any", Purpose::any},
                                          {"simulation", Purpose::simulation},
                                          {"fewest-tets", Purpose::fewest_tets},
                                          {"thickness", Purpose::thickness}};
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
    case Purpose::any:
        break;
    }
    return "{}";
}

} // namespace vdb_shell::command
