// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace vdb_shell
{

/// Those of the names that somebody may have meant who wrote `name`: that are it but for a few
/// letters, or have a word that begins with it (without its leading minus signs). The nearest
/// first, four at most, equally near ones in the given order.
std::vector<std::string> near_names(const std::string& name, const std::vector<std::string>& names);

/// The same as the end of a message: "; near it: --layers, --layers-auto". Empty where none is
/// near.
std::string hint_of_near(const std::string& name, const std::vector<std::string>& names);

} // namespace vdb_shell
