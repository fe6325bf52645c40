// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"

#include <openvdb/math/Mat3.h>
#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace vdb_shell
{

/// A place in index space, moved onto a voxel's centre where it is as near as rounding: what is
/// there already then stays bit for bit.
inline openvdb::Vec3d on_lattice(openvdb::Vec3d place)
{
    constexpr double kNear = 1e-6; // voxels
    for (int axis = 0; axis < 3; ++axis) {
        const double whole = std::round(place[axis]);
        if (std::abs(place[axis] - whole) < kNear)
            place[axis] = whole;
    }
    return place;
}

/// Along each axis: that many along all three are counted in an int.
constexpr double kMostSamples = 1024;

/// Samples of what a voxel covers: of `place` + `across` * x, x in the cube of side 1 about 0, so
/// many along each column of `across` that they are no farther apart than 1, or `most`, which is no
/// more than kMostSamples.
class Samples
{
public:
    Samples(const openvdb::Mat3d& across, int most) : across_(across)
    {
        for (int axis = 0; axis < 3; ++axis) {
            // A millionth more than a voxel is a voxel.
            constexpr double kRounding = 1e-6;
            const double wanted = std::ceil(across.col(axis).length() - kRounding);
            limited_ = limited_ || wanted > most;
            count_[std::size_t(axis)] = int(std::clamp(wanted, 1.0, double(most)));
        }
    }

    int count() const { return count_[0] * count_[1] * count_[2]; }
    /// Whether more were wanted.
    bool limited() const { return limited_; }

    template <typename Visit> void for_each(const openvdb::Vec3d& place, const Visit& visit) const
    {
        const auto offset = [&](int i, std::size_t axis) { return (i + 0.5) / count_[axis] - 0.5; };
        for (int x = 0; x < count_[0]; ++x)
            for (int y = 0; y < count_[1]; ++y)
                for (int z = 0; z < count_[2]; ++z)
                    visit(place +
                          across_ * openvdb::Vec3d(offset(x, 0), offset(y, 1), offset(z, 2)));
    }

private:
    const openvdb::Mat3d& across_;
    std::array<int, 3> count_;
    bool limited_ = false;
};

/// What values of a grid are added up in.
template <typename Value>
using SumOf = std::conditional_t<std::is_same_v<Value, float>, double, openvdb::Vec3d>;

/// Means of a grid over small parallelepipeds. One for each thread.
template <typename Grid> class VolumeSampler
{
public:
    using Value = typename Grid::ValueType;

    VolumeSampler(const Grid& grid, std::size_t most_samples)
        : values_(grid.getConstAccessor()), background_(grid.background()),
          level_set_(grid.getGridClass() == openvdb::GRID_LEVEL_SET), most_(int(most_samples))
    {
    }

    /// Of the samples at `place` + `across` * x, all in index space, x in the cube of side 1 about
    /// 0, no farther apart than 1 along any column of `across`. False where there is nothing:
    /// the background everywhere, and no active voxel is nearest to a sample.
    bool mean(const openvdb::Vec3d& place, const openvdb::Mat3d& across, Value& value)
    {
        const Samples samples(across, most_);
        limited_ += samples.limited();
        if constexpr (std::is_integral_v<Value>)
            return sample(on_lattice(place), value);
        else
            return samples.count() == 1 ? sample(on_lattice(place), value)
                                        : sum(place, samples, value);
    }

    /// How often there were fewer samples than wanted.
    std::size_t limited() const { return limited_; }

private:
    bool sample(const openvdb::Vec3d& at, Value& value)
    {
        if constexpr (std::is_integral_v<Value>)
            return openvdb::tools::PointSampler::sample(values_, at, value);
        else
            openvdb::tools::BoxSampler::sample(values_, at, value);
        // A level set's inside is no background, and not active either.
        return (!level_set_ && value != background_) ||
               values_.isValueOn(openvdb::Coord::round(at));
    }

    bool sum(const openvdb::Vec3d& place, const Samples& samples, Value& value)
    {
        SumOf<Value> total(0.0);
        bool any = false;
        samples.for_each(place, [&](const openvdb::Vec3d& at) {
            Value one;
            any |= sample(at, one);
            total += SumOf<Value>(one);
        });
        value = Value(total * (1.0 / samples.count()));
        return any;
    }

    typename Grid::ConstAccessor values_;
    Value background_;
    bool level_set_;
    int most_;
    std::size_t limited_ = 0;
};

} // namespace vdb_shell
