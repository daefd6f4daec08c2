/// Extents of structured VTK XML data, "i0 i1 j0 j1 k0 k1" in points, and how far pieces fill the whole.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace palpate {

struct Extent {
  std::array<std::int64_t, 3> first{};  ///< points
  std::array<std::int64_t, 3> last{};   ///< one below the first along an axis without points

  /// Along an axis.
  [[nodiscard]] std::uint64_t points(std::size_t axis) const noexcept;
  /// Numbers of all; kHuge where they do not fit. An axis of one point has one cell.
  [[nodiscard]] std::uint64_t points() const noexcept;
  [[nodiscard]] std::uint64_t cells() const noexcept;
};

/// Nothing where the text is no extent.
[[nodiscard]] std::optional<Extent> extent_of(const std::string& text);

/// Cells of `whole` that lie in none of the pieces, which may overlap. Nothing where the pieces cross each other
/// so much that it would take too long to know.
[[nodiscard]] std::optional<std::uint64_t> cells_left_out(const Extent& whole,
                                                          const std::vector<Extent>& pieces);

}  // namespace palpate
