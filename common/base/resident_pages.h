/// Memory that is about to be filled: its pages are made by several threads, which the first write to each
/// would do one after another in one.
#pragma once

#include <cstddef>

namespace palpate {

/// Makes the pages of [memory, memory + bytes) resident, on up to `threads` threads (0: as many as there are
/// cores). Only a wish: where the system cannot, the first write makes them as ever. Contents stay.
void make_resident(void* memory, std::size_t bytes, int threads) noexcept;

}  // namespace palpate
