// SPDX-License-Identifier: Apache-2.0

// A shell put onto its surface in one pose after another, set up once:
//
//   pose_frames SHELL.vdb FRAME.obj ...
//
// Prints a line of JSON for each frame: processor seconds, what is proven, and the farthest that
// points of the surface have gone since the frame before, and points inside over that.

#include <vdb_shell/io/read_mesh.h>
#include <vdb_shell/pipeline.h>

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <exception>
#include <iostream>

namespace
{

using Points = std::vector<openvdb::Vec3s>;

double farthest(const Points& from, const Points& to)
{
    double most = 0;
    for (std::size_t i = 0; i < from.size(); ++i)
        most = std::max(most, double((to[i] - from[i]).length()));
    return most;
}

/// How far inner points have gone, ascending, over the farthest that the skin has.
std::vector<double> inner_jumps(const vdb_shell::TetMesh& before, const vdb_shell::TetMesh& now,
                                double skin_jump)
{
    std::vector<double> jumps;
    for (std::size_t i = 0; i < before.points.size() && skin_jump > 0; ++i)
        if (now.layer[i] > 0)
            jumps.push_back((now.points[i] - before.points[i]).length() / skin_jump);
    std::sort(jumps.begin(), jumps.end());
    if (jumps.empty())
        jumps.push_back(0);
    return jumps;
}

} // namespace

int main(int argc, char** argv)
try {
    if (argc < 3) {
        std::cerr << "usage: pose_frames SHELL.vdb FRAME.obj ...\n";
        return 2;
    }
    const vdb_shell::ShellFile file = vdb_shell::read_shell_vdb(argv[1]);
    const vdb_shell::RestShell rest(file.stack, file.core);
    vdb_shell::TetMesh before;
    Points skin_before;
    for (int i = 2; i < argc; ++i) {
        const Points skin = vdb_shell::read_mesh(argv[i]).mesh.points;
        const std::clock_t start = std::clock();
        const vdb_shell::PoseResult only = vdb_shell::pose_shell(rest, skin);
        const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
        const vdb_shell::PosedShell posed = vdb_shell::build_posed(rest, skin, {}, argv[i]);
        const vdb_shell::PoseReport& pose = only.report;
        const double skin_jump = before.points.empty() ? 0 : farthest(skin_before, skin);
        const std::vector<double> jumps = inner_jumps(before, posed.tets, skin_jump);
        std::cout << "{\"frame\": " << i - 1 << ", \"seconds\": " << seconds
                  << ", \"certified\": " << posed.report.certificate->certified()
                  << ", \"tets\": " << posed.tets.tets.size() << ", \"certified_tets\": "
                  << (posed.report.overlaps ? posed.report.overlaps->certified_tets()
                                            : posed.tets.tets.size())
                  << ", \"crossings\": " << pose.skin_crossings
                  << ", \"inverted_carried\": " << pose.inverted_carried
                  << ", \"inverted\": " << pose.inverted << ", \"lost\": " << pose.lost_pillars
                  << ", \"lost_demanded\": " << pose.lost_demanded
                  << ", \"moved\": " << pose.moved_points << ", \"distorted\": " << pose.distorted
                  << ", \"skin_jump\": " << skin_jump
                  << ", \"jump_99\": " << jumps[jumps.size() * 99 / 100]
                  << ", \"jump_ratio\": " << jumps.back() << "}" << std::endl;
        before = posed.tets;
        skin_before = skin;
    }
    return 0;
} catch (const std::exception& error) {
    std::cerr << "pose_frames: " << error.what() << '\n';
    return 1;
}
