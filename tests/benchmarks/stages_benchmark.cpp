// SPDX-License-Identifier: Apache-2.0
// Seconds of each stage through the public headers, as STAGE/SURFACE/TRIANGLES.

#include "vdb_shell/certify/certificate.h"
#include "vdb_shell/certify/coverage.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/pipeline.h"
#include "vdb_shell/write/tet_file.h"
#include "vdb_shell/write/vdb_file.h"

#include "benchmarks/surfaces.h"
#include "support/files.h"

#include <benchmark/benchmark.h>

#include <limits>
#include <string>
#include <vector>

namespace vdb_shell::bench
{
namespace
{

void read_obj(benchmark::State& state, Surface surface, std::int64_t size)
{
    const test::TemporaryFolder folder;
    write_mesh(folder / "surface.obj", mesh_of(surface, size));
    for (auto _ : state)
        benchmark::DoNotOptimize(read_mesh(folder / "surface.obj").mesh.points.data());
}

void check(benchmark::State& state, Surface surface, std::int64_t size)
{
    const TriangleMesh& mesh = mesh_of(surface, size);
    for (auto _ : state)
        benchmark::DoNotOptimize(check_mesh(mesh).volume);
}

void level_set_narrow(benchmark::State& state, Surface surface, std::int64_t size)
{
    const TriangleMesh& mesh = mesh_of(surface, size);
    const LevelSetOptions options = narrow_options(mesh);
    for (auto _ : state)
        benchmark::DoNotOptimize(mesh_to_level_set(mesh, options).get());
}

void narrow_band(benchmark::State& state, Surface surface, std::int64_t size)
{
    const TriangleMesh& mesh = mesh_of(surface, size);
    for (auto _ : state)
        benchmark::DoNotOptimize(mesh_to_narrow_band(mesh, deep_options()).get());
}

void level_set_deep(benchmark::State& state, Surface surface, std::int64_t size)
{
    const TriangleMesh& mesh = mesh_of(surface, size);
    const LevelSetOptions options = deep_options();
    for (auto _ : state)
        benchmark::DoNotOptimize(mesh_to_level_set(mesh, options).get());
}

void stepping(benchmark::State& state, Surface surface, std::int64_t size)
{
    const TriangleMesh& mesh = mesh_of(surface, size);
    const openvdb::FloatGrid& field = deep_field_of(surface, size);
    const Directions& directions = directions_of(surface, size);
    for (auto _ : state)
        benchmark::DoNotOptimize(line_step(mesh, field, directions, {}).length.data());
}

void stepping_sparse(benchmark::State& state, Surface surface, std::int64_t size)
{
    const TriangleMesh& mesh = mesh_of(surface, size);
    const openvdb::FloatGrid& field = narrow_field_of(surface, size);
    const Directions& directions = directions_of(surface, size);
    for (auto _ : state)
        benchmark::DoNotOptimize(line_step_sparse(mesh, field, directions, {}).length.data());
}

void growth(benchmark::State& state, Surface surface, std::int64_t size)
{
    const TriangleMesh& mesh = mesh_of(surface, size);
    const Directions& directions = directions_of(surface, size);
    const LineLengths& lengths = lengths_of(surface, size);
    const std::vector<double> no_cap(mesh.points.size(), std::numeric_limits<double>::infinity());
    for (auto _ : state) {
        const GrowResult grown = grow_shell(mesh, directions, lengths, no_cap, {}, {});
        benchmark::DoNotOptimize(grown.shell.inner.data());
    }
}

void certificate(benchmark::State& state, Surface surface, std::int64_t size)
{
    const GrowResult& grown = shell_of(surface, size);
    for (auto _ : state) {
        if (!certify_shell(grown.shell, grown.split, PrismTest::twelve_tets).certified()) {
            state.SkipWithError("the shell is not certified");
            break;
        }
    }
}

void coverage(benchmark::State& state, Surface surface, std::int64_t size)
{
    const TriangleMesh& mesh = mesh_of(surface, size);
    const TetMesh& tets = tets_of(surface, size);
    for (auto _ : state)
        benchmark::DoNotOptimize(estimate_coverage(mesh, tets, {}).covered_share);
}

ShellFile shell_file(Surface surface, std::int64_t size)
{
    const GrowResult& grown = shell_of(surface, size);
    const openvdb::FloatGrid& field = narrow_field_of(surface, size);
    const TetMesh& tets = tets_of(surface, size);
    return {field.deepCopy(),
            shell_depth_grid(tets, field.voxelSize()[0]),
            one_layer(grown.shell, grown.split),
            tets,
            options_json({}),
            "{}"};
}

void write_vdb(benchmark::State& state, Surface surface, std::int64_t size)
{
    const test::TemporaryFolder folder;
    const ShellFile file = shell_file(surface, size);
    for (auto _ : state)
        write_shell_vdb(folder / "shell.vdb", file);
}

void depth_grid(benchmark::State& state, Surface surface, std::int64_t size)
{
    const TetMesh& tets = tets_of(surface, size);
    const double voxel = narrow_field_of(surface, size).voxelSize()[0];
    for (auto _ : state)
        benchmark::DoNotOptimize(shell_depth_grid(tets, voxel).get());
}

void write_vtu(benchmark::State& state, Surface surface, std::int64_t size)
{
    const test::TemporaryFolder folder;
    const TetMesh& tets = tets_of(surface, size);
    for (auto _ : state)
        write_tets(folder / "shell.vtu", tets);
}

using Stage = void (*)(benchmark::State&, Surface, std::int64_t);

void add(const std::string& name, Stage stage)
{
    const std::vector<std::pair<Surface, std::vector<std::int64_t>>> surfaces{
        {Surface::icosphere, {3, 4}}, {Surface::torus, {48, 96, 192}}};
    for (const auto& [surface, sizes] : surfaces)
        for (const std::int64_t size : sizes) {
            const std::size_t triangles = mesh_of(surface, size).triangles.size();
            const std::string title =
                name + "/" + name_of(surface) + "/" + std::to_string(triangles);
            const auto run = [stage, surface = surface, size](benchmark::State& state) {
                stage(state, surface, size);
                state.counters["triangles_per_second"] =
                    benchmark::Counter(static_cast<double>(mesh_of(surface, size).triangles.size()),
                                       benchmark::Counter::kIsIterationInvariantRate);
            };
            // Wall time: the stages run on threads of their own.
            benchmark::RegisterBenchmark(title.c_str(), run)
                ->UseRealTime()
                ->MeasureProcessCPUTime()
                ->Unit(benchmark::kMillisecond);
        }
}

void add_all()
{
    add("read_obj", read_obj);
    add("check", check);
    add("level_set_narrow", level_set_narrow);
    add("narrow_band", narrow_band);
    add("level_set_deep", level_set_deep);
    add("stepping", stepping);
    add("stepping_sparse", stepping_sparse);
    add("growth", growth);
    add("certificate", certificate);
    add("coverage", coverage);
    add("depth_grid", depth_grid);
    add("write_vdb", write_vdb);
    add("write_vtu", write_vtu);
}

} // namespace
} // namespace vdb_shell::bench

int main(int argc, char** argv)
{
    openvdb::initialize();
    vdb_shell::bench::add_all();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv))
        return 2;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
