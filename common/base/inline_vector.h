/// A short list with its storage inside: for paths that must not allocate.
#pragma once

#include <array>
#include <cstddef>

#include "common/base/check.h"

namespace palpate {

template <class T, std::size_t Capacity>
class InlineVector {
 public:
  /// @pre size() < Capacity.
  void push_back(const T& value) {
    PALPATE_CHECK(size_ < Capacity);
    items_[size_++] = value;
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return items_[i]; }
  [[nodiscard]] const T& front() const noexcept { return items_[0]; }
  [[nodiscard]] const T& back() const noexcept { return items_[size_ - 1]; }
  [[nodiscard]] T* begin() noexcept { return items_.data(); }
  [[nodiscard]] T* end() noexcept { return items_.data() + size_; }
  [[nodiscard]] const T* begin() const noexcept { return items_.data(); }
  [[nodiscard]] const T* end() const noexcept { return items_.data() + size_; }

 private:
  std::array<T, Capacity> items_{};
  std::size_t size_ = 0;
};

}  // namespace palpate
