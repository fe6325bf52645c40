// SPDX-License-Identifier: Apache-2.0

// Takes: the maps between a surface and what remeshing made of it. Leaves: a file of text, from
// which a program moves the original's vertices with those of the new surface: each is the sum of
// three corners times their weights. Weights have as many digits as their doubles need.

#include "vdb_shell/write/remesh_map.h"

#include "vdb_shell/core/atomic_file.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"
#include "vdb_shell/write/text_out.h"

#include <string>
#include <utility>
#include <vector>

namespace vdb_shell
{
namespace
{

using Ways = std::vector<std::pair<const char*, const std::vector<SurfacePoint>*>>;

void write_csv(TextOut& out, const Ways& ways)
{
    out << "map,vertex,triangle,corner0,corner1,corner2,weight0,weight1,weight2\n";
    for (const auto& [name, places] : ways)
        for (std::size_t v = 0; v < places->size(); ++v) {
            const SurfacePoint& p = (*places)[v];
            out << name << ',' << v << ',' << p.triangle;
            for (int k = 0; k < 3; ++k)
                out << ',' << p.corners[k];
            for (const double weight : p.weights)
                out << ',' << weight;
            out << '\n';
        }
}

/// "name": [value, value, ...], a line each.
template <typename Write>
void write_column(TextOut& out, const char* name, const std::vector<SurfacePoint>& places,
                  const Write& write)
{
    out << "    \"" << name << "\": [";
    for (std::size_t v = 0; v < places.size(); ++v) {
        out << (v > 0 ? ",\n      " : "\n      ");
        write(places[v]);
    }
    out << "\n    ]";
}

void write_json(TextOut& out, const Ways& ways)
{
    const char* between = "{\n";
    for (const auto& [name, places] : ways) {
        out << between << "  \"" << name << "\": {\n";
        write_column(out, "triangle", *places, [&](const SurfacePoint& p) { out << p.triangle; });
        out << ",\n";
        write_column(out, "corners", *places, [&](const SurfacePoint& p) {
            out << '[' << p.corners[0] << ", " << p.corners[1] << ", " << p.corners[2] << ']';
        });
        out << ",\n";
        write_column(out, "weights", *places, [&](const SurfacePoint& p) {
            out << '[' << p.weights[0] << ", " << p.weights[1] << ", " << p.weights[2] << ']';
        });
        out << "\n  }";
        between = ",\n";
    }
    out << "\n}\n";
}

} // namespace

void require_map_extension(const std::filesystem::path& path)
{
    const std::string extension = lower_case_extension(path);
    if (extension != ".json" && extension != ".csv")
        throw InvalidOption(path.string() + ": unknown extension \"" + extension +
                            "\" for a remesh map; known are .json .csv");
}

void write_remesh_map(const std::filesystem::path& path, const RemeshMap& map, OutputSet* with)
{
    require_map_extension(path);
    const Ways ways{{"input_on_result", &map.input_on_result},
                    {"result_on_input", &map.result_on_input}};
    write_stream_atomically(
        path,
        [&](std::ostream& stream) {
            TextOut out(stream);
            if (lower_case_extension(path) == ".csv")
                write_csv(out, ways);
            else
                write_json(out, ways);
        },
        with);
}

} // namespace vdb_shell
