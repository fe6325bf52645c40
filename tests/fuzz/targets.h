// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

// What is run on inputs that a fuzzer makes up: each takes any bytes, lets the errors pass that the
// library promises for bad input, and throws Broken, or crashes, where a promise is broken. The
// first use is libFuzzer's (entry.cpp), the second a test over the inputs in this folder.

namespace vdb_shell::fuzz
{

struct Broken : std::logic_error {
    using std::logic_error::logic_error;
};

inline void require(bool holds, const std::string& what)
{
    if (!holds)
        throw Broken(what);
}

// One for each reader. What is read has to be sound, anything else to be refused with ReadError.
void obj(std::string_view bytes);
void ply(std::string_view bytes);
void off(std::string_view bytes);
void stl(std::string_view bytes);
/// Of both, with texture coordinates.
void obj_texture(std::string_view bytes);
void ply_texture(std::string_view bytes);
/// .geo, .bgeo and .bgeo.sc, which are told apart by content. What is read is written the same
/// twice.
void houdini(std::string_view bytes);
/// A shell's .vdb, and a level set.
void vdb(std::string_view bytes);
/// A file of options. What is read comes back from what it is stored as.
void options(std::string_view bytes);

/// A closed surface of a few triangles, and options, made of the bytes: the shell is certified, and
/// no two of its tets overlap, or the surface is refused by name.
void tiny_meshes(std::string_view bytes);

struct Target {
    const char* name; ///< also of the folder with its inputs
    void (*run)(std::string_view bytes);
};
inline const std::vector<Target>& targets()
{
    static const std::vector<Target> all{{"obj", obj},
                                         {"ply", ply},
                                         {"off", off},
                                         {"stl", stl},
                                         {"obj_texture", obj_texture},
                                         {"ply_texture", ply_texture},
                                         {"houdini", houdini},
                                         {"vdb", vdb},
                                         {"options", options},
                                         {"tiny_meshes", tiny_meshes}};
    return all;
}

} // namespace vdb_shell::fuzz
