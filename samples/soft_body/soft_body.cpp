// SPDX-License-Identifier: Apache-2.0
// How a solid of tets deflects and moves: soft_body SHELL.vdb --reference SOLID.node --motion
// FRAMES

#include "motion.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <iostream>

using namespace soft_body;

namespace
{

struct Options {
    std::string tets, reference, motion_folder;
    int up = 1, refinements = 2;
    bool hold_inner = false, hold_foot = true, hold_skin = false;
    double height = .2;
    Material material{2e4, .4, 1000};
    MotionOptions motion;
};

void declare(CLI::App& app, Options& o)
{
    app.add_option("tets", o.tets, ".vdb of a shell; .node and .ele; .vtk")->required();
    app.add_option("--up", o.up, "axis that is up")
        ->transform(
            CLI::CheckedTransformer(std::map<std::string, int>{{"x", 0}, {"y", 1}, {"z", 2}}))
        ->default_str("y");
    const std::vector<std::string> holds{"foot", "skin", "inner", "both"};
    app.add_option_function<std::string>(
           "--hold",
           [&o](const std::string& what) {
               o.hold_foot = what != "inner";
               o.hold_skin = what == "skin";
               o.hold_inner = what == "inner" || what == "both";
           },
           "what is held: the lowest tenth of the height, its points on the surface alone, the "
           "inner "
           "surface, or the first and the last")
        ->check(CLI::IsMember(holds))
        ->default_str("foot");
    app.add_option("--height", o.height, "the body is taken to be so high, m")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--young", o.material.young, "Young's modulus, Pa")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--poisson", o.material.poisson, "Poisson's ratio")
        ->check(CLI::Range(0., .49))
        ->capture_default_str();
    app.add_option("--density", o.material.density, "kg/m^3")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--reference", o.reference,
                   "solid that is refined for the converged compliance, foot held");
    app.add_option("--refinements", o.refinements,
                   "of the reference, each with eight times the tets")
        ->check(CLI::Range(0, 4))
        ->capture_default_str();
    app.add_option("--motion", o.motion_folder, "folder for the frames of a motion, .obj");
    app.add_option("--seconds", o.motion.seconds, "of motion")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--fps", o.motion.frames_per_second, "frames a second")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--shake", o.motion.shake, "how far held points are shaken, share of the height")
        ->capture_default_str();
}

/// A solid in metres, and how many of them one unit of its file is.
struct Scaled {
    Solid solid;
    double unit;
};

Scaled read_scaled(const std::string& path, const Options& options)
{
    Solid solid = read_solid(path);
    const auto along = solid.points.row(options.up);
    const double unit = options.height / (along.maxCoeff() - along.minCoeff());
    solid.points *= unit;
    return {std::move(solid), unit};
}

Held held_points(const Solid& solid, const Options& options)
{
    Held held =
        options.hold_skin ? hold_skin(solid, options.up) : hold_foot(solid.points, options.up);
    if (!options.hold_foot)
        std::fill(held.begin(), held.end(), char(0));
    if (options.hold_inner) {
        const Held inner = hold_inner(solid);
        std::transform(held.begin(), held.end(), inner.begin(), held.begin(),
                       [](char a, char b) { return char(a || b); });
    }
    return held;
}

void report_statics(nlohmann::ordered_json& out, const Solid& solid, const Elasticity& elasticity,
                    const Held& held, int up)
{
    const Deflection found = deflect(solid, elasticity, held, up);
    out["tets"] = solid.tets.size();
    out["points"] = solid.points.cols();
    out["held_points"] = std::count(held.begin(), held.end(), char(1));
    out["steps"] = found.steps;
    out["converged"] = found.converged;
    out["compliance_joule"] = found.compliance;
    out["largest_displacement_m"] = found.displacement.colwise().norm().maxCoeff();
    const double eigenvalue = largest_eigenvalue(elasticity.stiffness(), elasticity.mass(), held);
    out["explicit_step_s"] = 2 / std::sqrt(eigenvalue);
}

/// Frames in the unit of the file that was read.
void write_motion(nlohmann::ordered_json& out, const Scaled& body, const Elasticity& elasticity,
                  const Held& held, const Options& options)
{
    std::filesystem::create_directories(options.motion_folder);
    const std::vector<Triangle> triangles = skin(body.solid);
    int steps = 0, frames = 0;
    move(body.solid, elasticity, held, options.up, options.motion, [&](const Frame& frame) {
        char name[32];
        std::snprintf(name, sizeof name, "frame_%04d.obj", frame.number);
        write_obj(std::filesystem::path(options.motion_folder) / name, frame.places / body.unit,
                  triangles);
        steps += frame.steps;
        ++frames;
    });
    out["frames"] = frames;
    out["motion_steps"] = steps;
}

int run(const Options& options)
{
    const Scaled body = read_scaled(options.tets, options);
    const Solid& solid = body.solid;
    const Elasticity elasticity(solid, options.material);
    const Held held = held_points(solid, options);
    nlohmann::ordered_json out;
    report_statics(out, solid, elasticity, held, options.up);
    if (!options.reference.empty()) {
        const Convergence found =
            converge(read_scaled(options.reference, options).solid, options.material, options.up,
                     options.refinements, options.hold_skin);
        out["refined_compliances_joule"] = found.compliances;
        out["limit_joule"] = found.limit;
        out["compliance_over_limit"] = out["compliance_joule"].get<double>() / found.limit;
    }
    if (!options.motion_folder.empty())
        write_motion(out, body, elasticity, held, options);
    std::cout << out.dump(2) << '\n';
    return 0;
}

} // namespace

int main(int argc, char** argv)
try {
    Options options;
    CLI::App app{"Deflection and motion of a soft body of linear tets under its weight"};
    declare(app, options);
    CLI11_PARSE(app, argc, argv);
    return run(options);
} catch (const std::exception& error) {
    std::cerr << "soft_body: " << error.what() << '\n';
    return 1;
}
