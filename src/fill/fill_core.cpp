// SPDX-License-Identifier: Apache-2.0

// Takes: a certified shell. Gives: tets that fill what it leaves empty, made by an outside program
// and proven here. The program gets the surface of the void with its points numbered from 0 and is
// told to keep it; points of what comes back are those of the surface by their number, never by
// their place. Nothing that the program says is believed: certify_core looks at its tets as it
// would at anybody's.

#include "vdb_shell/fill/fill_core.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"
#include "vdb_shell/shell/quality.h"

#include "core/exact.h"
#include "core/stage_progress.h"
#include "fill/mesher_files.h"
#include "fill/mesher_result.h"
#include "fill/outside_program.h"
#include "vdb_shell/shell/tessellate.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;
using fill::MesherTets;
using openvdb::Vec4I;

constexpr std::uint32_t kNone = ~std::uint32_t(0);

/// The points that the void's surface has, numbered as the program sees them.
struct Handed {
    TriangleMesh surface;
    std::vector<std::uint32_t> index; ///< by point handed over: the point of the void's surface
};

/// Without the shell's other points: a program might take lone ones for points of the void and mesh
/// around them.
Handed handed_over(const VoidSurface& surface)
{
    Handed handed;
    std::vector<std::uint32_t> number(surface.points.size(), kNone);
    for (const openvdb::Vec3I& triangle : surface.triangles)
        for (int corner = 0; corner < 3; ++corner)
            number[triangle[corner]] = 0;
    // In the order of the shell's points, so that the program gets the same file each time.
    for (std::uint32_t p = 0; p < number.size(); ++p)
        if (number[p] != kNone) {
            number[p] = std::uint32_t(handed.index.size());
            handed.index.push_back(p);
            handed.surface.points.push_back(surface.points[p]);
        }
    for (const openvdb::Vec3I& t : surface.triangles)
        handed.surface.triangles.emplace_back(number[t[0]], number[t[1]], number[t[2]]);
    return handed;
}

/// Digits without an exponent, of which not every version of TetGen knows.
std::string plain_digits(double value)
{
    std::array<char, 512> digits{};
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed)
            .ptr;
    return {digits.data(), end};
}

/// p: a surface; Y: its triangles are not cut; M: coplanar ones are not joined to larger facets,
/// which may then be cut anew; q, a: shape and size.
std::string tetgen_switches(const CoreFillOptions& options)
{
    std::string switches = "-pYM";
    // 14 degrees are what TetGen's manual couples with that ratio, and what the measurements of
    // other meshers in docs/measurements/shape.md were made with.
    if (options.radius_edge_ratio > 0)
        switches += "q" + plain_digits(options.radius_edge_ratio) + "/14";
    // The regular tet of edge length L has the volume L^3 / (6 sqrt(2)).
    if (options.edge_length)
        switches += "a" + plain_digits(std::pow(*options.edge_length, 3) / (6 * std::sqrt(2.0)));
    return switches;
}

MesherTets run_mesher(const TriangleMesh& surface, const CoreFillOptions& options,
                      Interrupter* interrupter)
{
    const fs::path program = fill::find_program(name_in_table(options.program));
    // Lives until the results have been read, and takes all files with it, also where something is
    // thrown.
    const fill::TemporaryFolder folder;
    const fs::path stem = folder.path() / "void";
    const auto run = [&](const std::vector<std::string>& words) {
        fill::run_program(program, words, folder.path(), options.seconds, interrupter);
    };
    if (options.program == CoreFillProgram::tetgen) {
        const fs::path poly = stem.string() + ".poly";
        fill::write_poly(poly, surface);
        run({tetgen_switches(options), poly.string()});
        return fill::read_tetgen(stem);
    }
    // Gmsh would write its result over the input of the same stem.
    const fs::path geo = stem.string() + ".geo", filled = folder.path() / "filled.msh";
    fill::write_gmsh_input(geo, stem.string() + ".msh", surface, options.edge_length,
                           options.radius_edge_ratio > 0);
    // One thread: the same tets on every machine.
    run({"-3", "-nt", "1", geo.string(), "-o", filled.string()});
    return fill::read_gmsh_output(filled);
}

/// Programs differ in the order of a tet's corners, but each has one for all of its tets. Where
/// most are negative, all are turned; single ones never are.
void turn_positive(MesherTets& made)
{
    std::ptrdiff_t sum = 0;
    for (const Vec4I& t : made.tets)
        sum +=
            exact::orient3d(openvdb::Vec3s(made.points[t[0]]), openvdb::Vec3s(made.points[t[1]]),
                            openvdb::Vec3s(made.points[t[2]]), openvdb::Vec3s(made.points[t[3]]));
    // Flat tets count as nothing. A tet that is turned over among others is a fault of the
    // program's, and the certificate is to find it.
    if (sum < 0)
        for (Vec4I& t : made.tets)
            std::swap(t[2], t[3]);
}

void require_same_points(const MesherTets& made, const TriangleMesh& surface,
                         const std::string& name)
{
    if (made.points.size() < surface.points.size())
        throw ProgramError(name + ": gave back " + std::to_string(made.points.size()) +
                           " points of the " + std::to_string(surface.points.size()) +
                           " that it was given");
    for (std::size_t p = 0; p < surface.points.size(); ++p)
        // The same float32: what is common to core and shell is common by index, and has one place
        // only.
        if (openvdb::Vec3s(made.points[p]) != surface.points[p])
            throw ProgramError(name + ": gave back another point " + std::to_string(p) +
                               " than it was given");
    for (std::size_t p = surface.points.size(); p < made.points.size(); ++p)
        if (!openvdb::Vec3s(made.points[p]).isFinite())
            throw ProgramError(name + ": point " + std::to_string(p) +
                               " of those that it made is not a finite float32");
}

/// The program's tets by the points of the joined mesh; points that none of them has are left out.
CoreTets core_of(const MesherTets& made, const std::vector<openvdb::Vec3s>& points,
                 const Handed& handed, const VoidSurface& surface)
{
    CoreTets core;
    const std::size_t given = surface.lone_vertices.size() + surface.hole_points;
    // The joined mesh has the points of the shell's tets first, then vertices and holes that no tet
    // of the shell has, then those that the program made.
    const std::size_t shell = surface.points.size() - given;
    core.points.assign(surface.points.begin() + std::ptrdiff_t(shell), surface.points.end());
    core.source_vertex = surface.lone_vertices;
    core.source_vertex.resize(given, CoreTets::kNoVertex);
    std::vector<std::uint32_t> number(points.size(), kNone);
    std::copy(handed.index.begin(), handed.index.end(), number.begin());
    for (const Vec4I& tet : made.tets)
        for (int corner = 0; corner < 4; ++corner)
            if (number[tet[corner]] == kNone)
                // Marks those that a tet has. Numbers are given afterwards, by ascending point, and
                // not in the order of tets.
                number[tet[corner]] = 0;
    for (std::size_t p = handed.index.size(); p < points.size(); ++p)
        if (number[p] != kNone) {
            number[p] = std::uint32_t(shell + core.points.size());
            core.points.push_back(points[p]);
            core.source_vertex.push_back(CoreTets::kNoVertex);
        }
    for (const Vec4I& t : made.tets)
        core.tets.emplace_back(number[t[0]], number[t[1]], number[t[2]], number[t[3]]);
    return core;
}

void measure(const TetMesh& tets, std::size_t given_points, CoreFill& made)
{
    TetMesh alone = joined_tets(tets, made.core);
    // Figures are those of the core's own tets, by the points of the whole.
    alone.tets = made.core.tets;
    CoreFillReport& report = made.report;
    report.points = made.core.empty() ? 0 : made.core.points.size() - given_points;
    report.tets = made.core.tets.size();
    report.volume = tet_volume(alone);
    report.min_dihedral_radians =
        made.core.empty() ? 0 : measure_quality(alone).min_dihedral_radians.min;
}

void require_fit(const CoreFillReport& report, const std::string& name)
{
    if (report.certificate.certified())
        return;
    std::string text = name + ": its tets do not fit the shell, and none is taken:";
    for (const std::string& failure : report.certificate.failures())
        text += " " + failure + ";";
    // The last failure ends the sentence.
    text.back() = '.';
    throw ProgramError(text + " The other program or other values of --core-fill-ratio may do");
}

} // namespace

const NameTable<CoreFillProgram>& names(CoreFillProgram)
{
    static const NameTable<CoreFillProgram> table{{"none", CoreFillProgram::none},
                                                  {"gmsh", CoreFillProgram::gmsh},
                                                  {"tetgen", CoreFillProgram::tetgen}};
    return table;
}

OptionList describe(CoreFillOptions& o)
{
    return in_group(
        "Core",
        {option("program", o.program, "--core-fill",
                "Fill what the shell leaves empty with tets of this program, found on PATH"),
         option("radius_edge_ratio", o.radius_edge_ratio, "--core-fill-ratio",
                "Bound on circumscribed radius over shortest edge of a tet of the core (tetgen); 0 "
                "for as few tets as possible")
             .needing("--core-fill tetgen")
             .within(at_least(0)),
         option("edge_length", o.edge_length, "--core-fill-edge-length",
                "Largest edge length in the core, world units; unset: what the surface allows")
             .needing("--core-fill")
             .in(Unit::world_length)
             .within(above(0)),
         option("seconds", o.seconds, "--core-fill-seconds", "Time limit of that program, seconds")
             .needing("--core-fill")
             .within(above(0))
             .not_stored()});
}

void require_program(const CoreFillOptions& options)
{
    if (!options.wanted())
        return;
    const std::string& name = name_in_table(options.program);
    if (fill::find_program(name).empty())
        throw ProgramError("--core-fill " + name + ": there is no program " + name +
                           " in the folders of PATH; install it, or leave the option out");
}

CoreFill fill_core(const ShellStack& stack, const TetMesh& tets, const CoreFillOptions& options,
                   Interrupter* interrupter, const TriangleMesh& holes)
{
    require_in_range(options, "core_fill");
    require_program(options);
    const StageProgress progress(interrupter, "core fill");
    // Of a shell that fills the solid it has no triangles. Then no program is started, and the
    // certificate says the same of an empty core.
    const VoidSurface surface = void_surface(stack, tets, holes);
    CoreFill made;
    made.report.program = options.program;
    made.report.void_triangles = surface.triangles.size();
    if (options.wanted() && !surface.triangles.empty()) {
        const std::string name = "--core-fill " + name_in_table(options.program);
        const Handed handed = handed_over(surface);
        MesherTets mesher = run_mesher(handed.surface, options, interrupter);
        // Before any tet is looked at: all that follows refers to points by their numbers.
        require_same_points(mesher, handed.surface, name);
        turn_positive(mesher);
        // First what lies outside the void goes, then triangles that were cut are closed: a
        // triangle can only be seen to be missing among the tets that stay.
        mesher.tets = fill::tets_inside(mesher, handed.surface);
        fill::close_cut_triangles(mesher, handed.surface);
        const std::vector<openvdb::Vec3s> points = fill::rounded_points(
            mesher.points, handed.index.size(), mesher.tets, made.report.moved_points);
        made.core = core_of(mesher, points, handed, surface);
        // A stop that was asked for while the program ended is answered here, before the proof,
        // which takes its time.
        progress.stop_if_interrupted(100);
    }
    made.report.certificate = certify_core(stack, tets, made.core, holes);
    if (options.wanted())
        require_fit(made.report, "--core-fill " + name_in_table(options.program));
    measure(tets, surface.lone_vertices.size() + surface.hole_points, made);
    return made;
}

} // namespace vdb_shell
