// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/sequence.h"

#include <vector>

namespace vdb_shell::command
{

/// Runs them, several at once where that is faster (--frames-at-once); what they print comes in
/// their order. The status is that of the first one that did not succeed; the ones after it are run
/// only if the call wants it (--keep-going).
int run_steps(const std::vector<Step>& steps, const GlobalArguments& global,
              const Context& context);

} // namespace vdb_shell::command
