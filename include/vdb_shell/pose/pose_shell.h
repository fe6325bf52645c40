// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/shell/core_tets.h"
#include "vdb_shell/shell/shell_stack.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace vdb_shell
{

struct PoseOptions {
    /// Distortion of a tet against its shape at rest up to which nothing is done about it: a third
    /// of the sum of the squared singular values of its map, over its determinant to 2/3. 1:
    /// similar to rest. Less keeps shapes better, and moves more points off where the skin carries
    /// them.
    double most_distortion = 4;
    /// Upper bound on the rounds in which points around distorted tets move, where the shell is
    /// valid already. 0: it is made valid, and no more.
    int rounds = 4;
};
OptionList describe(PoseOptions& options);

/// What posing found and did. Counts of tets are of shell and core together.
struct PoseReport {
    std::size_t tets = 0;
    std::size_t free_points = 0;      ///< those that are not on the skin
    std::size_t inverted_carried = 0; ///< tets that were not positive where the skin carried them
    std::size_t moved_points = 0;     ///< that left where the skin carried them
    std::size_t rounds = 0;           ///< of moves
    std::size_t inverted = 0;         ///< tets that are not positive in the end, exactly
    /// Of them, tets whose corners all lie on the skin: no inner point can mend them.
    std::size_t inverted_by_skin = 0;
    /// For which the exact tests left no length; kept as carried. In a tapered or filled shell:
    /// free points of inverted tets.
    std::size_t lost_pillars = 0;
    /// Of them, those to which the skin leaves no place: of vertices whose triangles no direction
    /// sees (theory, "Pins that geometry demands"); in a tapered or filled shell points that can be
    /// nowhere without inverting one of their tets on the skin.
    std::size_t lost_demanded = 0;
    /// Of a tapered shell: pairs of triangles that bound its tets and touch, or overlap.
    std::size_t faces_not_apart = 0;
    std::size_t skin_crossings = 0;    ///< pairs of triangles of the skin that cross or touch
    std::size_t excused_triangles = 0; ///< of whose prisms contacts were not tested because of that
    std::size_t distorted = 0;         ///< positive tets beyond PoseOptions::most_distortion
    double mean_distortion = 1, most_distortion = 1; ///< of positive tets, as in PoseOptions
};

struct PoseResult {
    /// Rest shell with other points: triangles, diagonals, pins, sharing and so the tets are the
    /// same, and so are the stop reasons.
    ShellStack stack;
    CoreTets core;
    PoseReport report;
};

/// A shell at rest with all that posing needs of it, made once for all frames. It can be posed from
/// several threads at a time.
class RestShell
{
public:
    /// Precondition: what certify_stack asks of a stack; the core fits the shell.
    explicit RestShell(ShellStack stack, CoreTets core = {});
    ~RestShell();
    RestShell(RestShell&&) noexcept;
    RestShell& operator=(RestShell&&) noexcept;

    const ShellStack& stack() const;
    const CoreTets& core() const;
    /// Of the tets as make_tets gives them.
    const TetMesh& tets() const;
    struct Parts;
    const Parts& parts() const { return *parts_; }

private:
    std::unique_ptr<const Parts> parts_;
};

/// The shell on the same surface in another pose. `skin` has a point for each vertex of
/// ShellStack::skin's surface, and stays as it is, bit for bit; all other points are free. They are
/// carried by the rigid motions that fit the skin best around each of them (Schaefer, McPhail and
/// Warren 2006, "Image deformation using moving least squares", in space and with solid angles for
/// weights), which depends on the rest shape and this skin alone: no frame depends on another, and
/// points move as continuously as the skin. Where tets are inverted or distorted, the points nearby
/// move until they are not; where surfaces touch, pillars are shortened.
///
/// Nothing is guaranteed but what the report and a certificate tell: a skin that is folded too
/// sharply has no shell of these tets. Same bits for any number of threads.
/// Throws InvalidOption when `skin` has another number of points, a point is not finite, or an
/// option is out of range; Cancelled.
PoseResult pose_shell(const RestShell& rest, const std::vector<openvdb::Vec3s>& skin,
                      const PoseOptions& options = {}, Interrupter* interrupter = nullptr);

} // namespace vdb_shell
