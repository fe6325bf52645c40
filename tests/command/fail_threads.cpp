// SPDX-License-Identifier: Apache-2.0

// Loaded in front of the C library (LD_PRELOAD): the standard library gets no more threads than
// FAULT_THREADS, as where a limit of the system is met. FAULT_LOG gets a line for each that was
// refused. TBB makes its threads itself, and has all that it asks for.

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace
{

std::atomic<long> threads{0};

bool is_standard_library(const void* caller)
{
    Dl_info info{};
    return ::dladdr(caller, &info) != 0 && std::strstr(info.dli_fname, "libstdc++") != nullptr;
}

} // namespace

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*run)(void*), void* argument)
{
    const char* most = std::getenv("FAULT_THREADS");
    if (most && is_standard_library(__builtin_return_address(0)) && ++threads > std::atol(most)) {
        const char* log = std::getenv("FAULT_LOG");
        if (std::FILE* file = log ? std::fopen(log, "a") : nullptr) {
            std::fputs("refused\n", file);
            std::fclose(file);
        }
        return EAGAIN;
    }
    using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    return reinterpret_cast<Create>(::dlsym(RTLD_NEXT, "pthread_create"))(thread, attributes, run,
                                                                          argument);
}
