#pragma once

#include <new>

/// How often the program has called `operator new` so far. This header replaces the operator, so that one
/// source file of a program includes it.
static std::size_t allocations = 0;

void *operator new(std::size_t size) {
    ++allocations;
    if (void *memory = std::malloc(size))
        return memory;
    throw std::bad_alloc();
}
void operator delete(void *memory) noexcept {
    std::free(memory);
}
void operator delete(void *memory, std::size_t) noexcept {
    std::free(memory);
}

/// How many allocations the last of so many calls makes; buffers grow in the first ones.
template <typename Call>
std::size_t allocationsOnceGrown(int calls, const Call &call) {
    std::size_t before = 0;
    for (int i = 0; i < calls; ++i) {
        before = allocations;
        call();
    }
    return allocations - before;
}
