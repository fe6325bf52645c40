// SPDX-License-Identifier: Apache-2.0

// How long a stage works without asking its interrupter, which is how long a user waits who wants
// to stop it: builds the shell of a mesh and notes the longest time between two questions, by
// stage.
//
//   interrupt_gaps MESH [--thickest] [--layers] [--taper]
//
// One line a stage: name, how often it asked, the longest gap in seconds of the clock, of its own
// thread's processor time, and the greatest step of the percent that it told, separated by tabs.
// Time outside any stage counts as a stage "before" the next.
// docs/scripts/interrupt_gaps.py makes the table of docs/reliability.md from it.

#include <vdb_shell/io/read_mesh.h>
#include <vdb_shell/pipeline.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <exception>
#include <iostream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

using namespace vdb_shell;

namespace
{

double processor_seconds()
{
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

struct Gaps {
    std::string stage;
    long asked = 0;
    double longest = 0, longest_of_thread = 0; ///< seconds
    int percent = 0, longest_step = 0;
};

class GapInterrupter final : public Interrupter
{
public:
    void start(const char* name) override
    {
        const std::string stage = name ? name : "unnamed";
        if (open_.empty())
            note(0, place("before " + stage));
        else
            note(0, open_.back());
        open_.push_back(place(stage));
        all_[open_.back()].percent = 0;
    }
    void end() override
    {
        if (open_.empty())
            return;
        note(0, open_.back());
        open_.pop_back();
    }
    bool wasInterrupted(int percent) override
    {
        if (std::this_thread::get_id() == owner_)
            note(percent, open_.empty() ? place("outside any stage") : open_.back());
        return false;
    }
    void finish() { note(0, place("after the last")); }
    const std::vector<Gaps>& all() const { return all_; }

private:
    std::size_t place(const std::string& name)
    {
        const auto at =
            std::find_if(all_.begin(), all_.end(), [&](const Gaps& g) { return g.stage == name; });
        if (at != all_.end())
            return static_cast<std::size_t>(at - all_.begin());
        all_.push_back({name});
        return all_.size() - 1;
    }
    void note(int percent, std::size_t stage)
    {
        const Clock::time_point now = Clock::now();
        const double of_thread = processor_seconds();
        Gaps& gaps = all_[stage];
        ++gaps.asked;
        gaps.longest = std::max(gaps.longest, std::chrono::duration<double>(now - before_).count());
        gaps.longest_of_thread = std::max(gaps.longest_of_thread, of_thread - before_of_thread_);
        if (percent > 0) {
            gaps.longest_step = std::max(gaps.longest_step, percent - gaps.percent);
            gaps.percent = percent;
        }
        before_ = now;
        before_of_thread_ = of_thread;
    }

    using Clock = std::chrono::steady_clock;
    std::thread::id owner_ = std::this_thread::get_id();
    std::vector<Gaps> all_;
    std::vector<std::size_t> open_;
    Clock::time_point before_ = Clock::now();
    double before_of_thread_ = processor_seconds();
};

int run(const std::string& mesh_file, const std::vector<std::string_view>& wishes)
{
    const auto wished = [&](std::string_view wish) {
        return std::find(wishes.begin(), wishes.end(), wish) != wishes.end();
    };
    ShellOptions options;
    if (wished("--thickest"))
        options.grow.method = Method::thickest;
    options.taper.wanted = wished("--taper");
    if (wished("--layers"))
        options.layers.layers = 3;
    const TriangleMesh mesh = read_mesh(mesh_file).mesh;
    GapInterrupter interrupter;
    build_shell(mesh, options, mesh_file, nullptr, &interrupter);
    interrupter.finish();
    for (const Gaps& gaps : interrupter.all())
        std::cout << gaps.stage << '\t' << gaps.asked << '\t' << gaps.longest << '\t'
                  << gaps.longest_of_thread << '\t' << gaps.longest_step << '\n';
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    try {
        if (argc < 2) {
            std::cerr << "usage: interrupt_gaps MESH [--thickest] [--layers] [--taper]\n";
            return 2;
        }
        return run(argv[1], {argv + 2, argv + argc});
    } catch (const std::exception& error) {
        std::cerr << "interrupt_gaps: " << error.what() << '\n';
        return 1;
    }
}
