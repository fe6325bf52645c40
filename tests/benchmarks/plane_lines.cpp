// SPDX-License-Identifier: Apache-2.0

// Lines from any points of a surface, not from its vertices alone: the stages of level set,
// smoothing, directions and line stepping, called one by one. docs/scripts/paper.py draws the
// paper's figure 1 with it, from random points of an extruded plane shape.
//
//   plane_lines JOB.json > LINES.json
//
// JOB has `solid` (a mesh file), `points` ([x, y, z] each), `normals` (outward, one each) and
// `fields`: each has `resolution` or `voxel_size`, `smooth` (steps of mean-curvature flow),
// `reinitialise` (whether it is made a distance field again), `sparse` (whether deep voxels are
// made when a line reads them; without smoothing only) and `lines`: each has `directions` ("given"
// normals or the field's "gradient") and options of line stepping by their keys. The answer has the
// same order: `voxel`, `seconds` and `lines`, with `seconds`, `inward`, `length`, `steps` and
// `reason`. Seconds are of one thread.

#include <vdb_shell/field/level_set.h>
#include <vdb_shell/field/narrow_band.h>
#include <vdb_shell/field/smooth.h>
#include <vdb_shell/io/read_mesh.h>
#include <vdb_shell/options/option.h>
#include <vdb_shell/step/line_step.h>

#include <nlohmann/json.hpp>
#include <openvdb/tools/LevelSetFilter.h>
#include <tbb/global_control.h>

#include <cstdint>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

using namespace vdb_shell;
using Json = nlohmann::json;

namespace
{

double seconds_since(std::clock_t before)
{
    return double(std::clock() - before) / CLOCKS_PER_SEC;
}

openvdb::Vec3d vec3d_of(const Json& numbers)
{
    return {numbers.at(0).get<double>(), numbers.at(1).get<double>(), numbers.at(2).get<double>()};
}

/// Mean-curvature flow of all level sets at once, as the paper has it: the values are left as they
/// come out, so that they are no distances any more.
void flow_only(openvdb::FloatGrid& level_set, int steps)
{
    openvdb::tools::LevelSetFilter<openvdb::FloatGrid> filter(level_set);
    filter.setNormCount(0);
    filter.setTrimming(openvdb::tools::lstrack::TrimMode::kNone);
    for (int i = 0; i < steps; ++i)
        filter.meanCurvature();
}

FloatGridPtr field_of(const TriangleMesh& solid, const Json& wanted)
{
    LevelSetOptions options;
    options.resolution = wanted.at("resolution");
    if (wanted.contains("voxel_size"))
        options.voxel_size = wanted["voxel_size"].get<double>();
    if (wanted.at("sparse").get<bool>())
        return mesh_to_narrow_band(solid, options);
    options.exterior_voxels = 6; // what the flow without reinitialisation may eat of it
    auto level_set = mesh_to_level_set(solid, options);
    if (wanted.at("reinitialise").get<bool>())
        smooth_level_set(*level_set, solid, {wanted.at("smooth").get<int>()});
    else
        flow_only(*level_set, wanted.at("smooth"));
    return level_set;
}

LineStepOptions line_options(const Json& wanted)
{
    LineStepOptions options;
    auto described = describe(options);
    for (Option& option : described)
        if (wanted.contains(option.key)) {
            const Json& value = wanted[option.key];
            assign_text(option, value.is_string() ? value.get<std::string>() : value.dump(),
                        option.key);
        }
    return options;
}

/// The points are added to the solid's, no triangle has them: so they are starts like its vertices.
struct Starts {
    TriangleMesh solid;
    std::vector<openvdb::Vec3d> normals; ///< of all its points; those of the solid's own stay zero
    std::vector<std::uint32_t> added;
};

Starts starts_of(const Json& job)
{
    Starts starts;
    starts.solid = read_mesh(job.at("solid").get<std::string>()).mesh;
    starts.normals.resize(starts.solid.points.size(), openvdb::Vec3d(0.0));
    for (const Json& normal : job.at("normals"))
        starts.normals.push_back(vec3d_of(normal));
    for (const Json& point : job.at("points")) {
        starts.added.push_back(static_cast<std::uint32_t>(starts.solid.points.size()));
        starts.solid.points.emplace_back(vec3d_of(point));
    }
    return starts;
}

Json lines_of(const Starts& starts, const openvdb::FloatGrid& level_set, bool sparse,
              const Json& wanted)
{
    DirectionOptions source;
    source.source = DirectionSource::gradient;
    const Directions directions = wanted.at("directions") == "gradient"
                                      ? compute_directions(starts.solid, level_set, source)
                                      : directions_along(starts.solid, starts.normals);
    const std::clock_t before = std::clock();
    const LineStepOptions options = line_options(wanted);
    const LineLengths lines = sparse ? line_step_sparse(starts.solid, level_set, directions,
                                                        options, nullptr, nullptr, &starts.added)
                                     : line_step(starts.solid, level_set, directions, options,
                                                 nullptr, nullptr, &starts.added);
    Json answer;
    answer["seconds"] = seconds_since(before);
    for (const std::uint32_t v : starts.added) {
        const openvdb::Vec3d& inward = directions.inward[v];
        answer["inward"].push_back({inward.x(), inward.y(), inward.z()});
        answer["length"].push_back(lines.length[v]);
        answer["steps"].push_back(lines.steps[v]);
        answer["reason"].push_back(name_of(lines.reason[v]));
    }
    return answer;
}

Json answer_of(const Json& job)
{
    const Starts starts = starts_of(job);
    Json answer = Json::array();
    for (const Json& field : job.at("fields")) {
        const std::clock_t before = std::clock();
        const auto level_set = field_of(starts.solid, field);
        Json made;
        made["voxel"] = level_set->voxelSize()[0];
        made["seconds"] = seconds_since(before);
        for (const Json& wanted : field.at("lines"))
            made["lines"].push_back(lines_of(starts, *level_set, field.at("sparse"), wanted));
        answer.push_back(std::move(made));
    }
    return answer;
}

} // namespace

int main(int argc, char** argv)
try {
    if (argc != 2) {
        std::cerr << "usage: plane_lines JOB.json\n";
        return 2;
    }
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    std::ifstream file(argv[1]);
    std::cout << answer_of(Json::parse(file)) << '\n';
    return 0;
} catch (const std::exception& error) {
    std::cerr << "plane_lines: " << error.what() << '\n';
    return 1;
}
