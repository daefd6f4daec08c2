#include "common/load/plot3d_layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "common/base/text.h"
#include "common/load/written_number.h"
#include "common/math/lattice.h"

namespace palpate {
namespace {

/// Numbers that a text may have beside its own size, repeated ones: a few letters must not fill the memory.
constexpr std::uint64_t kMaxRepeated = std::uint64_t{1} << 24;
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

/// Points of a grid of these dimensions, or nothing for dimensions that cannot be.
std::optional<Index3> checked_grid(std::span<const std::optional<std::int32_t>> dimensions) {
  Index3 points{1};
  std::uint64_t product = 1;
  for (std::size_t axis = 0; axis < dimensions.size(); ++axis) {
    const auto& n = dimensions[axis];
    if (!n || *n < 2) return std::nullopt;
    points[static_cast<int>(axis)] = *n;
    product *= static_cast<std::uint64_t>(*n);
    if (product > kMaxPoints) return std::nullopt;
  }
  return points;
}

std::size_t axes_of(const Plot3dLayout& layout) { return layout.two_dimensional ? 2 : 3; }

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
  const std::size_t axes = axes_of(layout);
  if (!mark(4 * axes * std::uint64_t{grids})) return std::nullopt;
  for (std::uint32_t grid = 0; grid < grids; ++grid) {
    std::array<std::optional<std::int32_t>, 3> n;
    for (std::size_t axis = 0; axis < axes; ++axis, at += 4) n[axis] = reader.at<std::int32_t>(at);
    const auto points = checked_grid(std::span(n).first(axes));
    if (!points) return std::nullopt;
    layout.grids.push_back(*points);
  }
  if (!mark(4 * axes * std::uint64_t{grids})) return std::nullopt;
  layout.data_offset = at;
  return layout;
}

/// Values at a point of a solution: density, momentum, energy.
std::uint64_t solution_values(const Plot3dLayout& layout) { return axes_of(layout) + 2; }

/// The size of a file of this layout. At most 1e5 grids of 2^40 points of 44 bytes: no overflow.
std::uint64_t expected_size(const Plot3dLayout& layout, Plot3dFile kind) {
  const std::uint64_t number = layout.double_precision ? 8 : 4;
  const std::uint64_t marks = layout.record_marks ? 8 : 0;
  std::uint64_t size = layout.data_offset;
  for (const Index3& n : layout.grids) {
    if (kind == Plot3dFile::kGrid) {
      size += marks + count_of(n) * (axes_of(layout) * number + (layout.blanking ? 4 : 0));
    } else {
      size += marks + 4 * number + marks + count_of(n) * solution_values(layout) * number;
    }
  }
  return size;
}

// ---- text ----------------------------------------------------------------------------------------------

bool parts_numbers(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == ','; }

/// Nothing but what Fortran's numbers are written with, repeated ones ("75*0.3") included.
bool is_numeric_text(std::string_view text) {
  static constexpr std::string_view kNumber = "0123456789+-.eEdD*";
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return parts_numbers(c) || kNumber.find(c) != std::string_view::npos; });
}

/// Walks over words separated by blanks and commas.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  /// A word, and how often it stands there ("75*0.3"): 0 at the end of the text.
  struct Repeated {
    std::string_view text;
    std::uint64_t count = 0;
  };
  Repeated next_word() {
    while (at_ < text_.size() && parts_numbers(text_[at_])) ++at_;
    const std::size_t first = at_;
    while (at_ < text_.size() && !parts_numbers(text_[at_])) ++at_;
    const std::string_view word = text_.substr(first, at_ - first);
    const std::size_t star = word.find('*');
    if (star == std::string_view::npos) return {word, word.empty() ? std::uint64_t{0} : 1};
    const auto count = parsed<std::uint64_t>(word.substr(0, star));
    // What repeats itself no whole number of times is no number either.
    if (!count || *count < 1 || *count > kMaxPoints) return {word, 1};
    return {word.substr(star + 1), *count};
  }
  std::string_view next() {
    if (last_.count == 0) last_ = next_word();
    if (last_.count == 0) return {};
    --last_.count;
    return last_.text;
  }
  /// The next word as a whole number.
  std::optional<std::int32_t> next_integer() { return parsed<std::int32_t>(next()); }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  Repeated last_;
};

std::optional<Plot3dLayout> read_text_dimensions(std::string_view head, const Plot3dLayout& assumed) {
  Plot3dLayout layout = assumed;
  Words words(head);
  std::int32_t grids = 1;
  if (layout.multi_grid) {
    const auto count = words.next_integer();
    if (!count || *count < 1 || static_cast<std::uint32_t>(*count) > kMaxGrids) return std::nullopt;
    grids = *count;
  }
  const std::size_t axes = axes_of(layout);
  for (std::int32_t grid = 0; grid < grids; ++grid) {
    std::array<std::optional<std::int32_t>, 3> n;
    for (std::size_t axis = 0; axis < axes; ++axis) n[axis] = words.next_integer();
    const auto points = checked_grid(std::span(n).first(axes));
    if (!points) return std::nullopt;
    layout.grids.push_back(*points);
  }
  return layout;
}

/// How many numbers a text file of this layout has.
std::uint64_t expected_numbers(const Plot3dLayout& layout, Plot3dFile kind) {
  const std::uint64_t axes = axes_of(layout);
  std::uint64_t numbers = (layout.multi_grid ? 1 : 0) + axes * layout.grids.size();
  for (const Index3& n : layout.grids) {
    numbers += kind == Plot3dFile::kGrid ? count_of(n) * (axes + (layout.blanking ? 1 : 0))
                                         : 4 + count_of(n) * solution_values(layout);
  }
  return numbers;
}

/// Calls `fits` with every layout that the dimensions at the head allow, until it says yes.
template <typename Fits>
std::optional<Plot3dLayout> find_text_layout(std::string_view head, Plot3dFile kind, const Fits& fits) {
  for (int bits = 0; bits < 8; ++bits) {
    Plot3dLayout assumed;
    assumed.text = true;
    assumed.double_precision = true;
    assumed.multi_grid = (bits & 1) != 0;
    assumed.blanking = (bits & 2) != 0;
    assumed.two_dimensional = (bits & 4) != 0;
    if (assumed.blanking && kind == Plot3dFile::kSolution) continue;
    auto layout = read_text_dimensions(head, assumed);
    if (layout && fits(expected_numbers(*layout, kind))) return layout;
  }
  return std::nullopt;
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
  for (int bits = 0; bits < 64; ++bits) {
    Plot3dLayout assumed;
    assumed.big_endian = (bits & 1) != 0;
    assumed.multi_grid = (bits & 2) != 0;
    assumed.record_marks = (bits & 4) != 0;
    assumed.blanking = (bits & 8) != 0;
    assumed.double_precision = (bits & 16) != 0;
    assumed.two_dimensional = (bits & 32) != 0;
    if (assumed.blanking && kind == Plot3dFile::kSolution) continue;
    const Reader reader(bytes.head.first(std::min(bytes.head.size(), kPlot3dHeadBytes)), assumed.big_endian);
    const auto layout = read_dimensions(reader, assumed);
    if (!layout) continue;
    const std::uint64_t expected = expected_size(*layout, kind);
    // Two dimensions fit more by chance: no padding is forgiven.
    if (layout->two_dimensional && expected != bytes.file_size) continue;
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

bool may_be_plot3d_text(const Plot3dBytes& bytes, Plot3dFile kind) {
  const std::string_view head(reinterpret_cast<const char*>(bytes.head.data()),
                              std::min(bytes.head.size(), kPlot3dHeadBytes));
  if (!is_numeric_text(head)) return false;
  // A number and its blank take two characters at least, and no program writes more than some fifty.
  constexpr std::uint64_t kMostCharacters = 64;
  // Repeated ones take less.
  const bool repeats = head.find('*') != std::string_view::npos;
  const std::uint64_t most = repeats ? std::numeric_limits<std::uint64_t>::max() : bytes.file_size / 2 + 1;
  return find_text_layout(head, kind,
                          [&](std::uint64_t numbers) {
                            return numbers <= most && numbers >= bytes.file_size / kMostCharacters;
                          })
      .has_value();
}

std::optional<Plot3dLayout> find_plot3d_text_layout(std::string_view text, Plot3dFile kind) {
  std::uint64_t count = 0;
  Words words(text);
  for (auto word = words.next_word(); word.count > 0; word = words.next_word()) {
    count += word.count;
    if (count > kMaxRepeated + text.size() || !written_number(word.text)) return std::nullopt;
  }
  return find_text_layout(text, kind, [count](std::uint64_t numbers) { return numbers == count; });
}

std::string plot3d_bytes(std::string_view file, const Plot3dLayout& layout, Plot3dFile kind) {
  std::string bytes;
  const auto put = [&bytes](auto value) {
    std::array<char, sizeof(value)> raw{};
    std::memcpy(raw.data(), &value, sizeof(value));
    bytes.append(raw.data(), raw.size());
  };
  Words words(layout.text ? file : std::string_view());
  const Reader reader(std::as_bytes(std::span(file)), layout.big_endian);
  std::uint64_t at = layout.data_offset;
  const auto next = [&]() -> double {
    if (layout.text) return written_number(words.next()).value_or(0.0);
    const std::uint64_t here = at;
    at += layout.double_precision ? 8 : 4;
    return layout.double_precision ? reader.at<double>(here).value_or(0.0)
                                   : double{reader.at<float>(here).value_or(0.0F)};
  };
  const auto put_numbers = [&](std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) put(next());
  };
  const auto put_integers = [&](std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i, at += layout.text ? 0 : 4) {
      constexpr double kMost = std::numeric_limits<std::int32_t>::max();
      const double number = layout.text ? next() : double{1.0} * reader.at<std::int32_t>(at).value_or(0);
      put(std::abs(number) <= kMost ? static_cast<std::int32_t>(number) : std::int32_t{0});
    }
  };
  const auto skip_mark = [&] { at += layout.record_marks ? 4 : 0; };

  const std::uint64_t axes = axes_of(layout);
  put(static_cast<std::int32_t>(layout.grids.size()));
  for (const Index3& n : layout.grids) {
    for (std::size_t axis = 0; axis < axes; ++axis) put(static_cast<std::int32_t>(n[static_cast<int>(axis)]));
  }
  if (layout.text) {
    for (std::size_t i = 0; i < (layout.multi_grid ? 1 : 0) + axes * layout.grids.size(); ++i)
      (void)words.next();
  }
  for (const Index3& n : layout.grids) {
    skip_mark();
    if (kind == Plot3dFile::kGrid) {
      put_numbers(axes * count_of(n));
      if (layout.blanking) put_integers(count_of(n));
    } else {
      put_numbers(4);
      skip_mark();
      skip_mark();
      put_numbers(count_of(n) * solution_values(layout));
    }
    skip_mark();
  }
  return bytes;
}

std::string describe(const Plot3dLayout& layout, Plot3dFile kind) {
  std::string text = layout.text ? "text, " : (layout.big_endian ? "big endian, " : "little endian, ");
  if (layout.two_dimensional) text += "two-dimensional, ";
  text += std::to_string(layout.grids.size()) + (layout.grids.size() == 1 ? " grid, " : " grids, ");
  text += layout.double_precision ? "double precision" : "single precision";
  if (!layout.text) text += layout.record_marks ? ", record marks" : ", no record marks";
  if (kind == Plot3dFile::kGrid) text += layout.blanking ? ", blanking" : ", no blanking";
  return text;
}

}  // namespace palpate
