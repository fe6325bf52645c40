// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry.h"

#include "document_writer.h"

namespace vdb_shell::houdini
{

/// The key "attributes" and the attributes of all four classes.
void write_attributes(DocumentWriter& out, const HoudiniGeometry& geometry);

} // namespace vdb_shell::houdini
