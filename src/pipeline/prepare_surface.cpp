// SPDX-License-Identifier: Apache-2.0

// Takes: the input. Leaves in the result: a surface that a shell can be made of, or throws. To mend
// means to change as little as makes it usable, so the attempts go from the least change to the
// most: a repair, which keeps all that is sound; one that drops loose pieces, and one that cuts
// through crossings, as long as nothing goes that is farther from the rest than a voxel of the
// wrap, and nothing is parted; and the wrap, of which something always comes, but which keeps no
// triangle.

#include "pipeline/prepare_surface.h"

#include "vdb_shell/repair/split_fans.h"
#include "vdb_shell/resample/surface_distance.h"

#include "report/text_lines.h"

#include <algorithm>
#include <utility>

namespace vdb_shell
{
namespace
{

/// Copies of vertices make sense only where nothing else stands in the way: at an edge of three or
/// more triangles the fans are no fans of one surface. They count as contacts of the surface with
/// itself, so self-intersections have to be allowed.
bool may_split_fans(const MeshCheck& check, const CheckOptions& options)
{
    return options.allow_self_intersections && check.non_manifold_vertices.count > 0 &&
           check.non_manifold_edges.count == 0;
}

/// Looks at r.surface and splits its fans where that is allowed. After a repair the check has been
/// made already, of the surface that the repair gives.
void look_at_surface(ShellResult& r, const CheckOptions& options, Interrupter* interrupter)
{
    // Those of an attempt to mend that came to nothing.
    r.report.split_vertices = {};
    r.report.vertex_copies = 0;
    r.report.mesh = r.report.repair ? r.report.repair->after : check_mesh(r.surface, interrupter);
    if (!may_split_fans(r.report.mesh, options))
        return;
    FanSplit split = split_fans(std::move(r.surface));
    r.surface = std::move(split.mesh);
    r.report.split_vertices = split.vertices;
    r.report.vertex_copies = split.copies;
    r.report.mesh = check_mesh(r.surface, interrupter);
}

void wrap(ShellResult& r, const TriangleMesh& mesh, const WrapOptions& options,
          Interrupter* interrupter)
{
    WrapResult wrapped = wrap_mesh(mesh, options, interrupter);
    r.surface = std::move(wrapped.mesh);
    r.report.wrap = wrapped.report;
    r.report.repair.reset();
}

void repair(ShellResult& r, const TriangleMesh& mesh, RepairOptions repair,
            const CheckOptions& check, Interrupter* interrupter)
{
    // Whoever allows the surface to cross itself is better served by a closed surface with a
    // crossing patch than by one that is refused for its hole.
    repair.keep_crossing_fills |= check.allow_self_intersections;
    RepairResult repaired = repair_mesh(mesh, repair, interrupter);
    r.surface = std::move(repaired.mesh);
    r.report.repair = std::move(repaired.report);
}

/// Loose pieces are in the way of fills, and are no cause of edges or points that are not manifold.
bool may_drop_loose(const RepairReport& repaired)
{
    return repaired.loose.count > 0 && repaired.after.manifold();
}

/// Cuts help against crossings alone. Where more are there than were counted, a wrap is sooner
/// done.
bool may_cut(const MeshCheck& check)
{
    CheckOptions crossings_allowed;
    crossings_allowed.allow_self_intersections = true;
    return !check.self_intersections.at_least && why_not_usable(check, crossings_allowed).empty();
}

/// What a voxel of the wrap can show is not to be lost: why the surface is not the input's any
/// more, beginning with `what`; empty if it is. Precondition: it is usable.
std::string what_is_lost(const ShellResult& r, const TriangleMesh& mesh, const WrapOptions& options,
                         const std::string& what, Interrupter* interrupter)
{
    const double voxel = wrap_voxel_size(mesh, options);
    const double spacing = std::max(voxel, finest_spacing(mesh));
    const double lost = surface_distance(mesh, r.surface, spacing, interrupter).max;
    if (lost <= voxel)
        return {};
    return what + " lies " + number(lost) + " from the rest, more than a voxel of a wrap, " +
           number(voxel);
}

/// The same of cuts. A body that is stuck into another one is cut in pieces, which have to be one
/// solid.
std::string what_cuts_have_spoiled(const ShellResult& r, const TriangleMesh& mesh,
                                   std::size_t components, const WrapOptions& options,
                                   Interrupter* interrupter)
{
    if (r.report.mesh.components.size() > components)
        return "the cuts part it into " + number(r.report.mesh.components.size(), 12) +
               " components instead of " + number(components, 12);
    return what_is_lost(r, mesh, options, "what the cuts take away", interrupter);
}

/// Precondition: r.surface has been looked at.
void mend(ShellResult& r, const TriangleMesh& mesh, const ShellOptions& options,
          Interrupter* interrupter)
{
    const auto refusal = [&] { return why_not_usable(r.report.mesh, options.check); };
    const auto take = [&](Mending tried, const std::string& refused) {
        r.report.mend.push_back({tried, refused});
        return refused.empty();
    };
    const auto try_repair = [&](const RepairOptions& how) {
        repair(r, mesh, how, options.check, interrupter);
        look_at_surface(r, options.check, interrupter);
    };
    if (take(options.repair ? Mending::repair : Mending::none, refusal()) || mesh.triangles.empty())
        return;
    RepairOptions how = options.repair.value_or(RepairOptions{});
    if (!options.repair) {
        try_repair(how);
        if (take(Mending::repair, refusal()))
            return;
    }
    // Repairs that take something away; `lost`: why that is too much.
    const auto try_more = [&](Mending tried, bool RepairOptions::*more, const auto& lost) {
        how.*more = true;
        try_repair(how);
        const std::string refused = refusal();
        return take(tried, refused.empty() ? lost() : refused);
    };
    if (!how.drop_loose && may_drop_loose(*r.report.repair) &&
        try_more(Mending::drop_loose, &RepairOptions::drop_loose,
                 [&] { return what_is_lost(r, mesh, options.wrap, "what is loose", interrupter); }))
        return;
    if (!how.cut_crossings && !refusal().empty() && may_cut(r.report.mesh)) {
        const std::size_t components = r.report.mesh.components.size();
        if (try_more(Mending::cut_crossings, &RepairOptions::cut_crossings, [&] {
                return what_cuts_have_spoiled(r, mesh, components, options.wrap, interrupter);
            }))
            return;
    }
    wrap(r, mesh, options.wrap, interrupter);
    look_at_surface(r, options.check, interrupter);
    take(Mending::wrap, refusal());
}

} // namespace

void prepare_surface(ShellResult& r, const TriangleMesh& mesh, const ShellOptions& options,
                     StageClock& clock, Interrupter* interrupter)
{
    const std::string& name = r.report.source;
    if (options.wrap.wanted)
        clock.run("wrap", [&] { wrap(r, mesh, options.wrap, interrupter); });
    else if (options.repair)
        clock.run("repair", [&] { repair(r, mesh, *options.repair, options.check, interrupter); });
    else
        r.surface = mesh;
    clock.run("check", [&] { look_at_surface(r, options.check, interrupter); });
    if (options.mend)
        clock.run("mend", [&] { mend(r, mesh, options, interrupter); });
    require_usable(r.report.mesh, options.check, r.report.repair ? name + " after --repair" : name);
    // After the check, whose findings say which components are inside out.
    r.surface = turn_outward(std::move(r.surface), r.report.mesh);
}

} // namespace vdb_shell
