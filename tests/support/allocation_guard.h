/// Counts allocations of this thread: `@rt Safe` calls make none.
#pragma once

#include <cstddef>

namespace palpate::test {

/// Counts calls of operator new on this thread from its construction on.
class AllocationGuard {
 public:
  AllocationGuard() noexcept;
  [[nodiscard]] std::size_t count() const noexcept;

 private:
  std::size_t before_;
};

}  // namespace palpate::test
