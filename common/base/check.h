/// Checks of promises between functions. A failed check is a bug of ours, never of the user's data.
#pragma once

namespace palpate::detail {
[[noreturn]] void check_failed(const char* condition, const char* file, int line) noexcept;
}  // namespace palpate::detail

/// Always checked; prints the condition and aborts.
#define PALPATE_CHECK(condition) \
  (static_cast<bool>(condition) ? void(0) : ::palpate::detail::check_failed(#condition, __FILE__, __LINE__))

/// Checked where PALPATE_ASSERTIONS is defined (presets dev, asan, tsan).
#ifdef PALPATE_ASSERTIONS
#define PALPATE_ASSERT(condition) PALPATE_CHECK(condition)
#else
#define PALPATE_ASSERT(condition) void(0)
#endif
