// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/vdb_conventions.h"

#include <CLI/CLI.hpp>

#include <iostream>

namespace
{

using namespace vdb_shell;

/// Exit statuses; those of the command vdb_shell, so that a script need not tell the two apart.
enum ExitCode {
    success = 0,
    internal_error = 1,
    usage_error = 2,
    read_error = 3,
    check_failed = 7,
};

/// Prints the file's violations and returns whether there are none.
bool keeps_conventions(const std::filesystem::path& file)
{
    const std::vector<VdbViolation> violations = check_vdb_conventions(file);
    for (const VdbViolation& violation : violations)
        std::cout << file.string() << ": " << to_text(violation) << '\n';
    std::cout << file.string()
              << (violations.empty() ? ": keeps Houdini's conventions\n"
                                     : ": " + std::to_string(violations.size()) + " violations\n");
    return violations.empty();
}

int run(int argc, char** argv)
{
    CLI::App app{"Holds .vdb files against Houdini's conventions for names, classes, metadata and "
                 "point attributes.",
                 "check_vdb"};
    std::vector<std::filesystem::path> files;
    app.add_option("files", files, "Any .vdb")->required();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? success : usage_error;
    }
    bool all_keep = true;
    for (const std::filesystem::path& file : files)
        all_keep = keeps_conventions(file) && all_keep;
    return all_keep ? success : check_failed;
}

} // namespace

int main(int argc, char** argv)
{
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "check_vdb: " << error.what() << '\n';
        return dynamic_cast<const ReadError*>(&error) ? read_error : internal_error;
    }
}
