/// Lines on their way from rank to rank, and the parts that stay where they were traced.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/line.h"

namespace palpate::mpi {

/// A line that has not ended.
struct HeldLine {
  std::uint64_t line = 0;  ///< seed times lines of a seed, plus which of them
  std::uint32_t part = 0;  ///< the next
  std::int32_t block = 0;  ///< where it goes on
  std::vector<std::byte> state;
};

void pack(const HeldLine& held, std::vector<std::byte>& bytes);
/// @throws Error (work failed) where the bytes are cut short.
[[nodiscard]] std::vector<HeldLine> unpack_held(std::span<const std::byte> bytes);

/// Points of a line from where it came to a rank to where it left.
struct LinePart {
  std::uint64_t line = 0;
  std::uint32_t part = 0;
  bool last = false;
  bool outside = false;  ///< the seed lies in no cell: there is no line
  End end = End::kLeftDomain;
  std::vector<LinePoint> points;
};

void pack(const LinePart& part, std::vector<std::byte>& bytes);
/// @throws Error as unpack_held().
[[nodiscard]] std::vector<LinePart> unpack_parts(std::span<const std::byte> bytes);

}  // namespace palpate::mpi
