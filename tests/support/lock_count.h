/// Counts mutexes and read-write locks that this thread takes: `@rt Safe` calls take none.
#pragma once

#include <cstddef>

namespace palpate::test {

/// Locks taken by this thread from its construction on. Always 0 under a sanitizer, whose own locks would
/// count, and where the C library offers no way between: counts_locks() says.
class LockCount {
 public:
  LockCount() noexcept;
  [[nodiscard]] std::size_t count() const noexcept;

 private:
  std::size_t before_;
};

[[nodiscard]] bool counts_locks() noexcept;

}  // namespace palpate::test
