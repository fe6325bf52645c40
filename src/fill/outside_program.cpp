// SPDX-License-Identifier: Apache-2.0

// Runs a program of the machine's and waits for it. No shell stands between, so there is nothing to
// quote and nothing that a name could inject. The program is the leader of a process group of its
// own: a Ctrl-C at the terminal goes to this process alone, which then ends the whole group, and a
// time limit reaches what the program has started too. Its home is the temporary folder, for a
// user's own settings of the program would change what comes back.

#include "fill/outside_program.h"

#include "core/temporary_file.h"
#include "core/text_stream.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/fill/fill_core.h"
#include "vdb_shell/options/option_value.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>
#include <thread>

namespace vdb_shell::fill
{
namespace
{

namespace fs = std::filesystem;

/// Where the program's output goes: nothing in it and what is wrong where it cannot be started.
struct Spawn {
    Spawn(const fs::path& output)
    {
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(),
                                           O_WRONLY | O_CREAT | O_TRUNC, 0600);
        // Into one file in the order in which they came: which of the two streams a program
        // complains on differs.
        ::posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
        ::posix_spawnattr_init(&attributes);
        ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
        // 0 makes it the leader of a new group, whose number is its own.
        ::posix_spawnattr_setpgroup(&attributes, 0);
        sigset_t signals;
        ::sigemptyset(&signals);
        // A library's caller may ignore them, and what is ignored stays so in a new program.
        for (const int number : {SIGINT, SIGTERM, SIGPIPE})
            ::sigaddset(&signals, number);
        ::posix_spawnattr_setsigdefault(&attributes, &signals);
    }
    ~Spawn()
    {
        ::posix_spawn_file_actions_destroy(&actions);
        ::posix_spawnattr_destroy(&attributes);
    }
    Spawn(const Spawn&) = delete;
    Spawn& operator=(const Spawn&) = delete;

    posix_spawn_file_actions_t actions{};
    posix_spawnattr_t attributes{};
};

/// Words as posix_spawn takes them. `words` has to outlive them.
std::vector<char*> pointers_to(std::vector<std::string>& words)
{
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words)
        pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

std::vector<std::string> environment_with_home(const fs::path& home)
{
    std::vector<std::string> entries;
    for (char** entry = environ; entry && *entry; ++entry)
        // Of two entries of a name some programs take the first and some the last.
        if (std::strncmp(*entry, "HOME=", 5) != 0)
            entries.emplace_back(*entry);
    entries.push_back("HOME=" + home.string());
    return entries;
}

std::string text_of(const fs::path& path)
{
    std::ifstream in(path, std::ios::binary);
    OutText text;
    text << in.rdbuf();
    return text.str();
}

/// Ends the process and those that it started, and waits for it, unless it has been waited for.
class Child
{
public:
    explicit Child(pid_t id) : id_(id) {}
    ~Child()
    {
        if (ended_)
            return;
        // A negative number means the group. SIGKILL, since a program may catch anything else, and
        // its files are removed with the folder.
        ::kill(-id_, SIGKILL);
        int status = 0;
        while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
        }
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Whether it has ended; `status` is then as waitpid gives it, or 0 where nobody can tell.
    bool ended(int& status)
    {
        // Once it has been waited for, the number may belong to another process: it must not be
        // killed any more.
        const pid_t answer = ::waitpid(id_, &status, WNOHANG);
        // A host that ignores SIGCHLD has the system wait for its children. What the program has
        // left is looked at in any case.
        const bool waited_for = answer < 0 && errno == ECHILD;
        if (waited_for)
            status = 0;
        ended_ = answer == id_ || waited_for;
        return ended_;
    }

private:
    pid_t id_;
    bool ended_ = false;
};

[[noreturn]] void fail(const fs::path& program, const std::string& what, const std::string& output)
{
    const std::string line = last_line(output);
    throw ProgramError(program.string() + ": " + what +
                       (line.empty() ? "; it said nothing" : "; it said: " + line));
}

} // namespace

TemporaryFolder::TemporaryFolder()
{
    std::error_code none;
    const fs::path base = fs::temp_directory_path(none);
    if (none)
        throw WriteError("files for another program: " + no_temporary_folder(none));
    std::string name = (base / "vdb_shell.XXXXXX").string();
    // Makes the folder with rights for its owner alone, under a name that nobody could have taken
    // before.
    if (!::mkdtemp(name.data()))
        throw WriteError(name + ": no folder can be made there: " + std::strerror(errno));
    path_ = name;
}

TemporaryFolder::~TemporaryFolder()
{
    std::error_code ignored;
    // A destructor that is run by an exception cannot tell of another one.
    fs::remove_all(path_, ignored);
}

fs::path find_program(const std::string& name)
{
    const char* path = std::getenv("PATH");
    InText folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        // An empty entry means the present folder to a shell, a well known trap; here it is none.
        if (folder.empty())
            continue;
        fs::path candidate = fs::path(folder) / name;
        std::error_code ignored;
        if (fs::is_regular_file(candidate, ignored) && ::access(candidate.c_str(), X_OK) == 0)
            return candidate;
    }
    return {};
}

std::string last_line(const std::string& text)
{
    InText lines(text);
    std::string last;
    for (std::string line; std::getline(lines, line);)
        if (line.find_first_not_of(" \t\r") != std::string::npos)
            last = line;
    return last;
}

std::string run_program(const fs::path& program, const std::vector<std::string>& words,
                        const fs::path& folder, double seconds, Interrupter* interrupter)
{
    const fs::path output = folder / "output.txt";
    std::vector<std::string> all{program.string()};
    all.insert(all.end(), words.begin(), words.end());
    std::vector<std::string> environment = environment_with_home(folder);
    const Spawn spawn(output);
    pid_t id = 0;
    const int error = ::posix_spawn(&id, program.c_str(), &spawn.actions, &spawn.attributes,
                                    pointers_to(all).data(), pointers_to(environment).data());
    if (error != 0)
        fail(program, std::string("cannot be started: ") + std::strerror(error), "");
    // From here on every way out ends the program.
    Child child(id);
    const auto start = std::chrono::steady_clock::now();
    int status = 0;
    while (!child.ended(status)) {
        if (interrupter && interrupter->wasInterrupted())
            throw Cancelled();
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        if (taken.count() > seconds)
            fail(program, "was ended after " + vdb_shell::text_of(seconds) + " s, its time limit",
                 text_of(output));
        // Short beside any meshing, and long enough to cost nothing.
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    // Read once it has ended: before, a line could be cut in the middle.
    std::string said = text_of(output);
    if (WIFSIGNALED(status))
        fail(program, "was ended by signal " + std::to_string(WTERMSIG(status)), said);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        fail(program, "ended with status " + std::to_string(WEXITSTATUS(status)), said);
    return said;
}

} // namespace vdb_shell::fill
