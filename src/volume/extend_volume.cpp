// SPDX-License-Identifier: Apache-2.0

// A tree of whole numbers though a mask would do: its code is there already
// (core/grid_instances.h), where a mask's takes the compiler ten seconds.

#include "volume/extend_volume.h"

#include <openvdb/tools/Morphology.h>

namespace vdb_shell
{

std::vector<openvdb::Coord> rim_of(const openvdb::Int32Grid& inside)
{
    openvdb::Int32Tree rim(inside.tree());
    openvdb::tools::dilateActiveValues(rim, 1, openvdb::tools::NN_FACE_EDGE_VERTEX,
                                       openvdb::tools::IGNORE_TILES);
    rim.topologyDifference(inside.tree());
    std::vector<openvdb::Coord> places;
    for (auto voxel = rim.cbeginValueOn(); voxel; ++voxel)
        places.push_back(voxel.getCoord());
    return places;
}

} // namespace vdb_shell
