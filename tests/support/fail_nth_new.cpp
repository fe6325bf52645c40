// SPDX-License-Identifier: Apache-2.0

// Loaded in front of the C++ library (LD_PRELOAD): the FAULT_NEW-th allocation of C++, counted from
// 1, fails. FAULT_LOG is made when it happens.

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <exception>
#include <new>

namespace
{

long number_of(const char* name)
{
    const char* text = std::getenv(name);
    return text ? std::atol(text) : 0;
}

// What runs before main() cannot be caught by anybody; the command sets its handler there first.
std::atomic<bool> counting{false};

bool fails()
{
    if (!counting)
        return false;
    static std::atomic<long> count{0};
    static const long at = number_of("FAULT_NEW");
    const long now = ++count;
    if (at <= 0 || now != at)
        return false;
    if (const char* log = std::getenv("FAULT_LOG"))
        ::close(::open(log, O_WRONLY | O_CREAT | O_APPEND, 0600));
    return true;
}

} // namespace

std::terminate_handler std::set_terminate(std::terminate_handler handler) noexcept
{
    using Set = std::terminate_handler (*)(std::terminate_handler);
    const auto set = reinterpret_cast<Set>(::dlsym(RTLD_NEXT, "_ZSt13set_terminatePFvvE"));
    counting = true;
    return set(handler);
}

void* operator new(std::size_t size)
{
    void* memory = fails() ? nullptr : std::malloc(size > 0 ? size : 1);
    if (!memory)
        throw std::bad_alloc();
    return memory;
}
void operator delete(void* memory) noexcept
{
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept
{
    std::free(memory);
}
