#include "common/load/plot3d_layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace palpate {
namespace {

/// No file holds more points than this; products of dimensions stay below 2^63.
constexpr std::uint64_t kMaxPoints = std::uint64_t{1} << 40;
constexpr std::uint32_t kMaxGrids = 100'000;

/// Reads numbers of either byte order from the head of a file.
class Reader {
 public:
  Reader(std::span<const std::byte> bytes, bool big_endian)
      : bytes_(bytes), swap_(big_endian != (std::endian::native == std::endian::big)) {}

  template <typename T>
  [[nodiscard]] std::optional<T> at(std::uint64_t offset) const {
    if (offset > bytes_.size() || bytes_.size() - offset < sizeof(T)) return std::nullopt;
    std::array<std::byte, sizeof(T)> raw{};
    std::memcpy(raw.data(), bytes_.data() + offset, sizeof(T));
    if (swap_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

 private:
  std::span<const std::byte> bytes_;
  bool swap_;
};

/// The dimensions at the head of the file under one assumption about its layout.
std::optional<Plot3dLayout> read_dimensions(const Reader& reader, const Plot3dLayout& assumed) {
  Plot3dLayout layout = assumed;
  std::uint64_t at = 0;
  const auto mark = [&](std::uint64_t bytes) {
    if (!layout.record_marks) return true;
    const bool right = reader.at<std::uint32_t>(at) == bytes;
    at += 4;
    return right;
  };

  std::uint32_t grids = 1;
  if (layout.multi_grid) {
    if (!mark(4)) return std::nullopt;
    const auto count = reader.at<std::uint32_t>(at);
    if (!count || *count < 1 || *count > kMaxGrids) return std::nullopt;
    grids = *count;
    at += 4;
    if (!mark(4)) return std::nullopt;
  }
  if (!mark(12 * std::uint64_t{grids})) return std::nullopt;
  for (std::uint32_t grid = 0; grid < grids; ++grid) {
    Index3 points{0};
    std::uint64_t product = 1;
    for (int axis = 0; axis < 3; ++axis, at += 4) {
      const auto n = reader.at<std::int32_t>(at);
      if (!n || *n < 2) return std::nullopt;
      points[axis] = *n;
      product *= static_cast<std::uint64_t>(*n);
      if (product > kMaxPoints) return std::nullopt;
    }
    layout.grids.push_back(points);
  }
  if (!mark(12 * std::uint64_t{grids})) return std::nullopt;
  layout.data_offset = at;
  return layout;
}

/// The size of a file of this layout. At most 1e5 grids of 2^40 points of 44 bytes: no overflow.
std::uint64_t expected_size(const Plot3dLayout& layout, Plot3dFile kind) {
  const std::uint64_t number = layout.double_precision ? 8 : 4;
  const std::uint64_t marks = layout.record_marks ? 8 : 0;
  std::uint64_t size = layout.data_offset;
  for (const Index3& n : layout.grids) {
    const std::uint64_t points =
        static_cast<std::uint64_t>(n.x) * static_cast<std::uint64_t>(n.y) * static_cast<std::uint64_t>(n.z);
    if (kind == Plot3dFile::kGrid) {
      size += marks + points * (3 * number + (layout.blanking ? 4 : 0));
    } else {
      size += marks + 4 * number + marks + points * 5 * number;
    }
  }
  return size;
}

/// Whether the last `padding` bytes of the file are known to be zeros.
bool zero_padding(std::span<const std::byte> tail, std::uint64_t padding) {
  if (padding > tail.size()) return false;
  const auto end = tail.last(padding);
  return std::all_of(end.begin(), end.end(), [](std::byte b) { return b == std::byte{0}; });
}

/// Whether the first numbers could be coordinates or flow values: a wrong byte order or precision shows as
/// NaN or as absurd magnitudes.
bool plausible_numbers(const Reader& reader, const Plot3dLayout& layout) {
  constexpr int kLook = 64;
  constexpr double kAbsurd = 1e30;
  const std::uint64_t start = layout.data_offset + (layout.record_marks ? 4 : 0);
  for (int i = 0; i < kLook; ++i) {
    const auto step = static_cast<std::uint64_t>(i);
    const std::optional<double> value = layout.double_precision
                                            ? reader.at<double>(start + 8 * step)
                                            : std::optional<double>(reader.at<float>(start + 4 * step));
    if (!value) break;
    if (!std::isfinite(*value) || std::abs(*value) > kAbsurd) return false;
    if (*value != 0.0 && std::abs(*value) < 1.0 / kAbsurd) return false;
  }
  return true;
}

}  // namespace

std::optional<Plot3dLayout> find_plot3d_layout(const Plot3dBytes& bytes, Plot3dFile kind) {
  std::optional<Plot3dLayout> best;
  int best_score = -1;
  // Every combination; the plain ones come first and win a tie.
  for (int bits = 0; bits < 32; ++bits) {
    Plot3dLayout assumed;
    assumed.big_endian = (bits & 1) != 0;
    assumed.multi_grid = (bits & 2) != 0;
    assumed.record_marks = (bits & 4) != 0;
    assumed.blanking = (bits & 8) != 0;
    assumed.double_precision = (bits & 16) != 0;
    if (assumed.blanking && kind == Plot3dFile::kSolution) continue;
    const Reader reader(bytes.head.first(std::min(bytes.head.size(), kPlot3dHeadBytes)), assumed.big_endian);
    const auto layout = read_dimensions(reader, assumed);
    if (!layout) continue;
    const std::uint64_t expected = expected_size(*layout, kind);
    if (expected > bytes.file_size || !zero_padding(bytes.tail, bytes.file_size - expected)) continue;
    // The right size to the byte counts more than numbers that look right; both beat the order above.
    const int score = (expected == bytes.file_size ? 2 : 0) + (plausible_numbers(reader, *layout) ? 1 : 0);
    if (score > best_score) {
      best = layout;
      best_score = score;
    }
  }
  return best;
}

std::string describe(const Plot3dLayout& layout, Plot3dFile kind) {
  std::string text = layout.big_endian ? "big endian, " : "little endian, ";
  text += std::to_string(layout.grids.size()) + (layout.grids.size() == 1 ? " grid, " : " grids, ");
  text += layout.double_precision ? "double precision, " : "single precision, ";
  text += layout.record_marks ? "record marks" : "no record marks";
  if (kind == Plot3dFile::kGrid) text += layout.blanking ? ", blanking" : ", no blanking";
  return text;
}

}  // namespace palpate
