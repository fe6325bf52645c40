// SPDX-License-Identifier: Apache-2.0

// Takes a shell as a file gave it, and cores that the user gives again. Says whether the shell
// keeps off them as the file claims. The proof is that of the build (docs/theory.md, "Cores"): what
// the shell was kept out of is made anew, and the shell is certified together with it, pinned
// throughout. The least distance is computed from the same floats in the same order, so it has to
// be the very number that the file states.

#include "vdb_shell/write/verify_clearance.h"

#include "core/text_stream.h"
#include "options/parse_json.h"
#include "vdb_shell/certify/stack_certificate.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/obstacles/core_feet.h"
#include "vdb_shell/obstacles/join_cores.h"

#include <nlohmann/json.hpp>

#include <locale>
#include <optional>
#include <utility>

namespace vdb_shell
{
namespace
{

using nlohmann::json;

constexpr const char* kWhat = "shell keeps off the cores as stated";

/// Nothing where the report does not say it.
std::optional<double> stated_of_cores(const json& report, const char* key)
{
    const json::json_pointer place(std::string("/cores/") + key);
    if (!report.contains(place) || !report.at(place).is_number())
        return std::nullopt;
    return report.at(place).get<double>();
}

/// The certificate of shell and cores as one surface. By the chosen tets: the twelve of a prism say
/// no more of what it keeps off.
bool certified_with(const ShellStack& stack, const TriangleMesh& kept_out, Interrupter* interrupter)
{
    const VertexRange range{std::uint32_t(stack.surface(0).size()),
                            std::uint32_t(kept_out.points.size())};
    const ShellStack both = join_cores(stack, kept_out);
    return certify_stack(both, PrismTest::chosen_tets, interrupter).certified() &&
           !(both.tapered && shares_core_point(both, range));
}

} // namespace

Verification verify_clearance(const ShellFile& file, std::vector<CoreMesh> cores,
                              Interrupter* interrupter)
{
    const json report = parse_json_if_any(file.report_json);
    CoreOptions options;
    // The claim is taken from the file, and the cores from the user.
    options.distance = stated_of_cores(report, "distance").value_or(0);
    const TriangleMesh surface{file.stack.surface(0), file.stack.triangles()};
    if (file.stack.skin != 0)
        return {kWhat, false, "a shell outside its surface has no cores"};
    try {
        const Cores prepared =
            prepare_cores(surface, "the surface", std::move(cores), options, interrupter);
        const bool clear = certified_with(file.stack, prepared.kept_out, interrupter);
        const double least = report_cores(file.stack, prepared, options, {}).least_distance;
        const std::optional<double> claimed = stated_of_cores(report, "least_distance");
        OutText detail;
        detail.imbue(std::locale::classic());
        detail.precision(17);
        detail << (clear ? "certified with them" : "not certified with them") << ", kept off at "
               << options.distance << "; least distance: found " << least << ", the file says ";
        if (claimed)
            detail << *claimed;
        else
            detail << "nothing";
        // Equal and not nearly so: both are computed from the same floats in the same order.
        const bool far_enough = least >= options.distance && (!claimed || *claimed == least);
        return {kWhat, clear && far_enough, detail.str()};
    } catch (const GeometryError& error) {
        return {kWhat, false, error.what()};
    } catch (const InvalidOption& error) {
        return {kWhat, false, error.what()};
    }
}

} // namespace vdb_shell
