/// A thing that is made of an immutable object at its first use and lives as long as the object.
#pragma once

#include <memory>
#include <mutex>

namespace palpate {

class OnceMade {
 public:
  /// What `make` (returns std::shared_ptr<const T>) made at the first call; others wait until it is there.
  /// @pre every call is for the same T. An exception of `make` passes; the next call tries again.
  template <class T, class Make>
  [[nodiscard]] const T& get(const Make& make) const {
    std::call_once(once_, [&] { made_ = make(); });
    return *static_cast<const T*>(made_.get());
  }

 private:
  mutable std::once_flag once_;
  mutable std::shared_ptr<const void> made_;
};

}  // namespace palpate
