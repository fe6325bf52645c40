// SPDX-License-Identifier: Apache-2.0
// A mesh from arrays instead of a file, progress, and a cancelled run: custom_mesh

#include <vdb_shell/core/error.h>
#include <vdb_shell/pipeline.h>

#include <atomic>
#include <exception>
#include <iostream>

/// Says which stage runs; stops the work at the `patience`-th question. Stages may ask from their
/// own threads, hence the atomic.
class Watcher : public vdb_shell::Interrupter
{
public:
    explicit Watcher(int patience) : patience_(patience) {}
    void start(const char* name = nullptr) override
    {
        std::cout << "  " << (name ? name : "unnamed stage") << '\n';
    }
    bool wasInterrupted(int /*percent*/ = -1) override { return --patience_ < 0; }

private:
    std::atomic<int> patience_;
};

int main()
try {
    // An octahedron. Triangles run counter-clockwise seen from outside.
    vdb_shell::TriangleMesh mesh;
    mesh.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                      {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    vdb_shell::ShellOptions options;
    options.level_set.resolution = 64;
    // Every line 0.2 world units long: the inner surface is the octahedron shrunk to 0.8, and the
    // shell fills 1 - 0.8^3 = 0.488 of the solid.
    options.line_step.test = vdb_shell::StopTest::none;
    options.line_step.thickness = 0.2;

    std::cout << "to the end:\n";
    Watcher patient(1'000'000'000);
    const auto result = vdb_shell::build_shell(mesh, options, "octahedron", nullptr, &patient);
    std::cout << result.tets.tets.size() << " tets fill " << result.report.fill
              << " of the solid\ncancelled:\n";
    try {
        Watcher hasty(1);
        vdb_shell::build_shell(mesh, options, "octahedron", nullptr, &hasty);
    } catch (const vdb_shell::Cancelled& cancelled) {
        std::cout << cancelled.what() << '\n';
        return 0;
    }
    std::cerr << "custom_mesh: nobody asked whether to stop\n";
    return 1;
} catch (const std::exception& error) {
    std::cerr << "custom_mesh: " << error.what() << '\n';
    return 1;
}
