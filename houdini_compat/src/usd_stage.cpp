// SPDX-License-Identifier: Apache-2.0

// Takes the values of an attribute at all times, and writes one value where they are the same, else
// a sample for each time. Knows the text format of USD and nothing of shells.

#include "usd_stage.h"

#include "usd_text.h"

#include <algorithm>

namespace vdb_shell
{

void UsdStage::attribute(const std::string& declaration, const Text& value,
                         const std::string& metadata)
{
    std::vector<std::string> values;
    for (const UsdSample& sample : samples_)
        values.push_back(value(sample));
    const std::string behind = metadata.empty() ? metadata : " (" + metadata + ")";
    if (std::all_of(values.begin(), values.end(),
                    [&](const std::string& one) { return one == values.front(); })) {
        line(declaration + " = " + values.front() + behind);
        return;
    }
    // With time samples, metadata need a declaration without a value to stand behind.
    if (!metadata.empty())
        line(declaration + behind);
    line(declaration + ".timeSamples = {");
    ++depth_;
    for (std::size_t i = 0; i < values.size(); ++i)
        line(usd_value(samples_[i].time) + ": " + values[i] + ",");
    --depth_;
    line("}");
}

} // namespace vdb_shell
