// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/counter_random.h"
#include "growth/grow_state.h"
#include "growth/grown.h"
#include "support/shapes.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell::test
{

/// A sphere of radius 1 whose inner points lie at 0.5, or are thrown off there by up to `noise`
/// along each axis.
struct HalfFullSphere {
    TriangleMesh mesh = icosphere(1.0, 3);
    growth::Connectivity connectivity = growth::connect(mesh.points.size(), mesh.triangles);
    growth::GrowState s;

    explicit HalfFullSphere(double noise = 0, std::uint64_t seed = 7, double cap = kInfinity)
        : s(growth::make_state(connectivity, mesh.points,
                               std::vector<double>(mesh.points.size(), cap)))
    {
        const CounterRandom random(seed);
        for (std::size_t v = 0; v < s.b.size(); ++v) {
            openvdb::Vec3d off;
            for (std::uint64_t k = 0; k < 3; ++k)
                off[static_cast<int>(k)] = noise * (2 * random.unit(3 * v + k) - 1);
            s.b[v] = growth::rounded(0.5 * s.a[v] + off);
        }
    }
    // The state points into the sphere.
    HalfFullSphere(const HalfFullSphere&) = delete;
    HalfFullSphere& operator=(const HalfFullSphere&) = delete;
};

} // namespace vdb_shell::test
