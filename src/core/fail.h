// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/text_stream.h"

namespace vdb_shell
{

/// Throws an Error whose message is the parts, one behind the other as streams print them.
template <typename Error, typename... Parts> [[noreturn]] void fail(const Parts&... parts)
{
    OutText message;
    (message << ... << parts);
    throw Error(message.str());
}

} // namespace vdb_shell
