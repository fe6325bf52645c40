// SPDX-License-Identifier: Apache-2.0

// Threads of a loop write to one place. The thread sanitizer has to say so: what is left out of its
// reports is left out by names on the way to an access, and the ways of our loops lead through TBB.

#include "core/parallel.h"

#include <chrono>
#include <iostream>
#include <thread>

int main()
{
    std::size_t sum = 0;
    vdb_shell::for_each_index(
        200,
        [&](std::size_t i) {
            sum += i;
            // Time for another thread to take its part.
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        },
        1);
    std::cout << sum << '\n';
}
