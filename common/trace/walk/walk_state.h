/// What a walk carries from one process to another, so that it goes on there with the same bits: numbers one after the
/// other, as they lie in memory. Between processes of one build, on processors of one byte order.
///
/// A class says once what its state is, in a function that both archives are given to:
///
///   template <class Self, class Archive>
///   static void each_member(Self& self, Archive& archive) { archive(self.x_, self.h_); }
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "common/base/error.h"

namespace palpate {

class StateWriter {
 public:
  template <class... Members>
  void operator()(const Members&... members) {
    (put(members), ...);
  }
  [[nodiscard]] const std::vector<std::byte>& bytes() const noexcept { return bytes_; }
  [[nodiscard]] std::vector<std::byte> take() noexcept { return std::move(bytes_); }

 private:
  template <class Member>
  void put(const Member& member) {
    static_assert(std::is_trivially_copyable_v<Member>);
    const auto* first = reinterpret_cast<const std::byte*>(&member);
    bytes_.insert(bytes_.end(), first, first + sizeof(Member));
  }

  std::vector<std::byte> bytes_;
};

class StateReader {
 public:
  /// @param bytes of a StateWriter, which outlive this.
  explicit StateReader(std::span<const std::byte> bytes) noexcept : left_(bytes) {}

  /// @throws Error (work failed) where there are not as many.
  template <class... Members>
  void operator()(Members&... members) {
    (get(members), ...);
  }
  [[nodiscard]] std::span<const std::byte> left() const noexcept { return left_; }

 private:
  template <class Member>
  void get(Member& member) {
    static_assert(std::is_trivially_copyable_v<Member>);
    if (left_.size() < sizeof(Member)) throw work_error("the state of a line is cut short");
    std::memcpy(static_cast<void*>(&member), left_.data(), sizeof(Member));
    left_ = left_.subspan(sizeof(Member));
  }

  std::span<const std::byte> left_;
};

}  // namespace palpate
