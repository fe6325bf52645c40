// SPDX-License-Identifier: Apache-2.0

// Takes a shell as a file gave it, and says of each claim of the file whether it holds. Nothing is
// taken over from the report but the claims themselves: surface, tets, signs, certificate,
// overlaps, volume and grids are computed afresh from the stored floats, by the exact tests that
// certified the shell when it was built. So the certificate of a file that passes is proven anew
// (docs/theory.md, "The whole shell"), whoever wrote the file. A figure that is missing compares as
// unequal to every number; a file without certificate or overlaps claims nothing of them, and
// cannot fail there.

#include "vdb_shell/write/verify_file.h"

#include "options/parse_json.h"
#include "vdb_shell/certify/conformity.h"
#include "vdb_shell/certify/core_certificate.h"
#include "vdb_shell/certify/overlaps.h"
#include "vdb_shell/certify/stack_certificate.h"
#include "vdb_shell/certify/tet_signs.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/shell/tessellate.h"

#include <nlohmann/json.hpp>
#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

namespace vdb_shell
{
namespace
{

using nlohmann::json;

/// Bytes and not values, so that zeros of either sign differ. The types have no padding.
template <typename T> bool same_bytes(const std::vector<T>& a, const std::vector<T>& b)
{
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// A figure of the report by its JSON pointer; NaN where it is missing, which equals nothing.
double stated(const json& report, const char* pointer)
{
    const json::json_pointer place(pointer);
    return report.contains(place) && report.at(place).is_number() ? report.at(place).get<double>()
                                                                  : std::nan("");
}

/// Shortest digits that give the same double again.
std::string digits(double value)
{
    if (std::isnan(value))
        return "nothing";
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    return {text.data(), end};
}

std::string compare(double found, double claimed)
{
    return "found " + digits(found) + ", the file says " + digits(claimed);
}

const std::vector<openvdb::Vec3s>& skin_of(const ShellFile& file)
{
    return file.stack.surface(file.stack.skin);
}

/// The surface need not be free of self-intersections: a shell may be built on one that crosses
/// itself (docs/theory.md, "A surface that crosses itself"). The number that the file states has to
/// be the right one.
Verification verify_surface(const ShellFile& file, const json& report)
{
    // The skin is the surface that the shell was built of; the others are for the certificate.
    const MeshCheck check = check_mesh({skin_of(file), file.stack.triangles()});
    const double crossings = stated(report, "/mesh/self_intersections");
    const bool sound = check.closed() && check.manifold() && check.inconsistent_edges.count == 0 &&
                       check.degenerate_triangles.count == 0;
    return {"surface is closed, manifold and as embedded as stated",
            sound && double(check.self_intersections.count) == crossings,
            std::to_string(check.boundary_edges.count) + " boundary edges, " +
                std::to_string(check.non_manifold_edges.count + check.non_manifold_vertices.count) +
                " non-manifold elements; self-intersections: " +
                compare(double(check.self_intersections.count), crossings)};
}

Verification verify_tets(const ShellFile& file)
{
    // The way from prisms to tets has no freedom left once the split orders are fixed, so the tets
    // of the file have to be the very same.
    const TetMesh expected = make_tets(file.stack);
    const bool same = same_bytes(expected.points, file.tets.points) &&
                      same_bytes(expected.tets, file.tets.tets) &&
                      same_bytes(expected.prism, file.tets.prism) &&
                      same_bytes(expected.prism_layer, file.tets.prism_layer);
    return {"tets are those of the prisms", same,
            std::to_string(file.tets.tets.size()) + " tets, " +
                std::to_string(expected.tets.size()) + " expected"};
}

Verification verify_conformity(const ShellFile& file)
{
    const Conformity found = check_conformity(file.stack, file.tets);
    return {"tets conform", found.conforming(),
            std::to_string(found.crowded_faces.count) + " crowded, " +
                std::to_string(found.misoriented_faces.count) + " misoriented, " +
                std::to_string(found.stray_faces.count) + " stray faces, " +
                std::to_string(found.missing_triangles.count) + " missing triangles"};
}

Verification verify_signs(const ShellFile& file, const json& report)
{
    const TetSigns found = count_tet_signs(file.tets);
    const double inverted = stated(report, "/tets/inverted"), flat = stated(report, "/tets/flat");
    return {"tet signs are as stated",
            double(found.inverted.count) == inverted && double(found.flat.count) == flat,
            "inverted: " + compare(double(found.inverted.count), inverted) +
                "; flat: " + compare(double(found.flat.count), flat)};
}

json certificate_claim(const json& report)
{
    return report.is_object() ? report.value("certificate", json::object()) : json::object();
}

/// The two tests differ in strength: a shell that was certified by the tets that were chosen may
/// fail the twelve of a prism. The one that the file names is the one that is run.
PrismTest claimed_test(const json& claim)
{
    const bool twelve = claim.is_object() && claim.contains("test") &&
                        claim.at("test") == name_in_table(PrismTest::twelve_tets);
    return twelve ? PrismTest::twelve_tets : PrismTest::chosen_tets;
}

/// What a file without a certificate is held to is nothing, but the findings are told all the same.
Verification verify_certificate(const StackCertificate& found, PrismTest test, const json& claim)
{
    auto agrees = [&](const char* what, bool value) {
        return !claim.is_object() || !claim.contains(what) || claim.at(what) == value;
    };
    const bool claims = claim.is_object() && claim.value("certified", json()) == true;
    std::string detail = std::string(found.certified() ? "certified" : "not certified") +
                         " by the test " + (found.complex ? "complex" : name_in_table(test)) +
                         ", the file says " + (claims ? "certified" : "not certified");
    for (const std::string& failure : found.failures())
        detail += "; " + failure;
    return {"certificate is as stated",
            agrees("certified", found.certified()) &&
                agrees("locally_valid", found.locally_valid()),
            detail};
}

/// A file that says nothing of overlaps claims nothing; the findings are told all the same.
Verification verify_overlaps(const ShellFile& file, const json& report, Interrupter* interrupter)
{
    const Overlaps found = find_overlaps(file.tets, interrupter);
    const json::json_pointer place("/overlaps");
    const bool told = report.contains(place) && report.at(place).is_object();
    const double pairs = stated(report, "/overlaps/pairs/count");
    const double prisms = stated(report, "/overlaps/certified_prisms");
    const double tets = stated(report, "/overlaps/certified_tets");
    std::string detail = found.summary() + "; the file says ";
    detail += told ? digits(pairs) + " pairs, " + digits(prisms) + " prisms and " + digits(tets) +
                         " tets certified"
                   : std::string("nothing");
    return {"overlaps are as stated",
            !told ||
                (double(found.pairs.count) == pairs && double(found.certified_prisms()) == prisms &&
                 double(found.certified_tets()) == tets),
            detail};
}

Verification verify_volume(const ShellFile& file, const json& report)
{
    const double found = tet_volume(file.tets), claimed = stated(report, "/volume/shell");
    // Both sums run over the same floats in the same order; JSON keeps doubles exactly.
    return {"volume is as stated", found == claimed, compare(found, claimed)};
}

/// Surfaces that a certificate can take for holes; their volume is a sum in another order than that
/// of the report, so it agrees to rounding only.
bool sound_holes(const TriangleMesh& holes, double stated_volume)
{
    const MeshCheck check = check_mesh(holes);
    const bool outward =
        std::all_of(check.components.begin(), check.components.end(),
                    [](const Component& c) { return !c.inside_out && c.nesting_depth == 0; });
    constexpr double kRounding = 1e-9;
    return check.closed() && check.manifold() && check.embedded() &&
           check.inconsistent_edges.count + check.degenerate_triangles.count == 0 && outward &&
           std::abs(check.volume - stated_volume) <= kRounding * stated_volume;
}

/// The core is proven anew, beside a shell that has just been. Where the file says that there were
/// surfaces inside, the core ends at them: they are what its own tets leave open.
Verification verify_core(const ShellFile& file, const StackCertificate& shell, const json& report)
{
    const double tets = stated(report, "/core_fill/tets");
    const double volume = stated(report, "/core_fill/volume");
    TetMesh alone = joined_tets(file.tets, file.core);
    // The figures that the file states are those of the core's own tets.
    alone.tets = file.core.tets;
    const double found = tet_volume(alone);
    bool fits = false;
    std::string detail = "shell not certified";
    if (shell.certified() && file.stack.skin == 0) {
        const double inside = stated(report, "/cores/volume");
        const TriangleMesh holes =
            inside > 0 ? holes_of_core(file.stack, file.tets, file.core) : TriangleMesh{};
        const CoreCertificate core = certify_core(file.stack, file.tets, file.core, holes);
        const bool sound = holes.triangles.empty() ? !(inside > 0) : sound_holes(holes, inside);
        fits = core.certified() && sound;
        detail = fits ? "one complex with the shell, and the volume of the surface, exactly" : "";
        if (!holes.triangles.empty() || !sound)
            detail += (detail.empty() ? "" : "; ") + std::to_string(holes.triangles.size()) +
                      " triangles of surfaces inside, " +
                      (sound ? "which enclose what the file says" : "which are not what it says");
        for (const std::string& failure : core.failures())
            detail += (detail.empty() ? "" : "; ") + failure;
    }
    return {"core fills the shell",
            fits && double(file.core.tets.size()) == tets && found == volume,
            detail + "; tets: " + compare(double(file.core.tets.size()), tets) +
                "; volume: " + compare(found, volume)};
}

Verification verify_level_set(const ShellFile& file, const json& report)
{
    const openvdb::FloatGrid& grid = *file.surface;
    const openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler> phi(grid);
    const bool level_set = grid.getGridClass() == openvdb::GRID_LEVEL_SET;
    // Where the surface crosses itself, parts of it lie inside of others, far from the zero
    // crossing.
    if (stated(report, "/mesh/self_intersections") > 0)
        return {"level set follows the surface", level_set,
                std::string("the surface crosses itself, so no distance is asked for") +
                    (level_set ? "" : "; its class is not level set")};
    double worst = 0.0;
    for (const openvdb::Vec3s& p : skin_of(file))
        worst = std::max(worst, std::abs(double(phi.wsSample(openvdb::Vec3d(p)))));
    // A vertex lies on the zero crossing to within the cell that holds it, plus what smoothing
    // moved.
    const double drift = stated(report, "/field/smooth/max_drift");
    const double bound =
        std::sqrt(3.0) * grid.voxelSize()[0] + (std::isfinite(drift) ? drift : 0.0);
    return {"level set follows the surface", level_set && worst <= bound,
            "largest |phi| at a vertex " + digits(worst) + ", allowed " + digits(bound) +
                (level_set ? "" : "; its class is not level set")};
}

Verification verify_depth(const ShellFile& file, Interrupter* interrupter)
{
    // Topology alone is compared: the values differ from fresh ones where the file was written with
    // half floats.
    const openvdb::FloatGrid::Ptr depth =
        shell_depth_grid(file.tets, file.surface->voxelSize()[0], interrupter);
    return {"depth grid is that of the tets",
            depth->tree().hasSameTopology(file.depth->tree()) &&
                depth->activeVoxelCount() == file.depth->activeVoxelCount(),
            std::to_string(file.depth->activeVoxelCount()) + " active voxels, " +
                std::to_string(depth->activeVoxelCount()) + " expected"};
}

/// Reading has held them against the file, and refuses it where one differs.
Verification tell_digests(const ShellFile& file)
{
    return {"parts are those that were written", true,
            file.digests > 0 ? std::to_string(file.digests) + " digests of grids, attributes and "
                                                              "metadata hold"
                             : "it has no digests; changed values may go unnoticed"};
}

} // namespace

std::vector<Verification> verify_shell(const ShellFile& file, Interrupter* interrupter)
{
    // A report that is no JSON makes a discarded value, which has no claims; the findings then say
    // so instead of an exception.
    const json report = parse_json_if_any(file.report_json);
    const json claim = certificate_claim(report);
    const PrismTest test = claimed_test(claim);
    const StackCertificate certificate = certify_stack(file.stack, test, interrupter);
    std::vector<Verification> found{verify_surface(file, report),
                                    verify_tets(file),
                                    verify_conformity(file),
                                    verify_signs(file, report),
                                    verify_certificate(certificate, test, claim),
                                    verify_volume(file, report)};
    if (!file.core.empty() || stated(report, "/core_fill/tets") > 0)
        found.push_back(verify_core(file, certificate, report));
    // A certified shell has no overlap (docs/theory.md, "The whole shell"), so they are looked for,
    // tet by tet, only where the certificate leaves some to find, or where the file states a
    // number.
    if (!certificate.certified() || report.contains(json::json_pointer("/overlaps/pairs")))
        found.push_back(verify_overlaps(file, report, interrupter));
    // Files of Houdini geometry hold no grids, so there is nothing to compare.
    if (file.surface && file.depth) {
        found.push_back(verify_level_set(file, report));
        found.push_back(verify_depth(file, interrupter));
    }
    found.push_back(tell_digests(file));
    return found;
}

std::vector<std::uint8_t> certified_tets(const ShellFile& file, Interrupter* interrupter)
{
    // The certificate proves that there are no overlaps in far less time than they are searched in
    // (convert of skull.obj's shell to .vtu, 100,002 triangles: 1 s and 42 s).
    const bool proven = file.core.empty() && verify_tets(file).holds &&
                        certify_stack(file.stack, PrismTest::chosen_tets, interrupter).certified();
    return proven ? std::vector<std::uint8_t>(file.tets.tets.size(), 1)
                  : find_overlaps(file.tets, interrupter).certified;
}

} // namespace vdb_shell
