#include "loaders/vtk/plot3d/plot3d_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/written_number.h"
#include "common/math/lattice.h"

namespace palpate {
namespace {

constexpr std::int64_t kMostValues = 4096;  ///< at a point
/// Conditions of a grid in OVERFLOW's files: REFMACH, ALPHA, REY, TIME, GAMINF, BETA, TINF, the integer IGAM, HTINF, HT1,
/// HT2, RGAS (NQC of them, two at least), and FSMACH, TVREF, DTVREF of later versions.
constexpr std::uint64_t kConditions = 10;

/// The whole numbers and sizes of a binary file or of one in text, one after the other.
class Head {
 public:
  Head(std::string_view file, const Plot3dValues& layout) : file_(file), layout_(layout) {}

  [[nodiscard]] std::int64_t next() {
    if (!layout_.text.empty()) {
      const double value = at_ < layout_.text.size() ? layout_.text[at_] : -1.0;
      ++at_;
      constexpr double kMost = 1e15;
      return value >= 0.0 && value <= kMost && value == static_cast<double>(static_cast<std::int64_t>(value))
                 ? static_cast<std::int64_t>(value)
                 : -1;
    }
    std::array<char, 4> raw{};
    if (file_.size() < raw.size() || at_ > file_.size() - raw.size()) return -1;
    std::memcpy(raw.data(), file_.data() + at_, raw.size());
    if (layout_.big_endian != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
    at_ += raw.size();
    return std::bit_cast<std::int32_t>(raw);
  }
  /// Whether the byte count that begins or ends a record is `bytes`.
  [[nodiscard]] bool mark(std::uint64_t bytes) {
    return !layout_.record_marks || as_size(next() & 0xffffffff) == (bytes & 0xffffffffU);
  }
  /// The byte count that begins a record. @pre the file has them.
  [[nodiscard]] std::uint64_t length() { return static_cast<std::uint64_t>(next() & 0xffffffff); }
  /// Passes over bytes, of a text over numbers; false where they are not there.
  [[nodiscard]] bool skip(std::uint64_t count) {
    if (count > end() || at_ > end() - count) return false;
    at_ += count;
    return true;
  }
  [[nodiscard]] std::uint64_t at() const { return at_; }
  [[nodiscard]] bool at_end() const { return at_ == end(); }

 private:
  [[nodiscard]] std::uint64_t end() const {
    return layout_.text.empty() ? file_.size() : layout_.text.size();
  }
  std::string_view file_;
  const Plot3dValues& layout_;
  std::uint64_t at_ = 0;
};

/// @param bare bytes of the conditions of OVERFLOW behind HT2 and RGAS, and of IGAM, of a file without record marks.
bool fits(std::string_view file, const Plot3dLayout& grid, bool multi, std::uint64_t bare,
          Plot3dValues& layout) {
  Head head(file, layout);
  const std::uint64_t axes = grid.two_dimensional ? 2 : 3;
  const std::uint64_t grids = grid.grids.size();
  const std::uint64_t number = !layout.text.empty() ? 1 : layout.double_precision ? 8 : 4;
  const std::uint64_t whole = layout.text.empty() ? 4 : 1;
  if (multi && (!head.mark(4) || head.next() != static_cast<std::int64_t>(grids) || !head.mark(4)))
    return false;
  const std::uint64_t dimensions =
      whole * (grids * (axes + (layout.overflow ? 0 : 1)) + (layout.overflow ? 2 : 0));
  if (!head.mark(dimensions)) return false;
  layout.parts.clear();
  for (const Index3& n : grid.grids) {
    for (std::uint64_t axis = 0; axis < axes; ++axis) {
      if (head.next() != n[static_cast<int>(axis)]) return false;
    }
    const std::int64_t count = layout.overflow ? 0 : head.next();
    if (count < (layout.overflow ? 0 : 1) || count > kMostValues) return false;
    layout.parts.push_back({0, count_of(n), static_cast<std::uint64_t>(count)});
  }
  std::uint64_t gases = 0;
  if (layout.overflow) {
    const std::int64_t values = head.next(), species = head.next();
    if (values < static_cast<std::int64_t>(axes) + 2 || values > kMostValues || species < 0 ||
        species > values)
      return false;
    for (auto& part : layout.parts) part.count = static_cast<std::uint64_t>(values);
    gases = static_cast<std::uint64_t>(std::max<std::int64_t>(2, species));
  }
  if (!head.mark(dimensions)) return false;
  for (auto& part : layout.parts) {
    if (layout.overflow) {
      const std::uint64_t conditions =
          layout.record_marks ? head.length() : (kConditions + gases) * number + bare;
      if (!head.skip(conditions) || !head.mark(conditions)) return false;
    }
    const std::uint64_t size = part.points * part.count * number;  // below 2^40 * 2^12 * 2^3
    if (!head.mark(size)) return false;
    part.first = head.at();
    if (!head.skip(size) || !head.mark(size)) return false;
  }
  return head.at_end();
}

/// All numbers of a text; none where a word is no number.
std::vector<double> numbers_of(std::string_view file) {
  constexpr std::size_t kLook = 4096;
  static constexpr std::string_view kOfText = "0123456789+-.eEdD, \t\r\nnNaAiIfF#QqxX*";
  if (file.substr(0, kLook).find_first_not_of(kOfText) != std::string_view::npos) return {};
  std::vector<double> out;
  while (!file.empty()) {
    const std::size_t first = file.find_first_not_of(", \t\r\n");
    if (first == std::string_view::npos) break;
    file.remove_prefix(first);
    const std::size_t end = std::min(file.find_first_of(", \t\r\n"), file.size());
    const auto value = written_number(file.substr(0, end));
    if (!value) return {};
    out.push_back(*value);
    file.remove_prefix(end);
  }
  return out;
}

}  // namespace

std::optional<Plot3dValues> find_plot3d_values(std::string_view file, const Plot3dLayout& grid) {
  const std::array<bool, 2> both{false, true};
  if (auto numbers = numbers_of(file); !numbers.empty()) {
    Plot3dValues layout;
    layout.double_precision = true;
    layout.text = std::move(numbers);
    for (const bool multi : both) {
      if (fits(file, grid, multi, 0, layout)) return layout;
    }
    return std::nullopt;
  }
  for (int bits = 0; bits < 32; ++bits) {
    Plot3dValues layout;
    layout.overflow = (bits & 16) != 0;
    layout.big_endian = (bits & 1) != 0;
    layout.record_marks = (bits & 2) != 0;
    layout.double_precision = (bits & 4) != 0;
    const std::uint64_t number = layout.double_precision ? 8 : 4;
    // IGAM is a whole number or one like the others; FSMACH and what follows came later.
    for (const std::uint64_t bare :
         {4 + 3 * number, 4 * number, 4 + number, 2 * number, std::uint64_t{4}, number}) {
      if (fits(file, grid, (bits & 8) != 0, bare, layout)) return layout;
      if (!layout.overflow || layout.record_marks) break;
    }
  }
  return std::nullopt;
}

std::string describe(const Plot3dValues& values) {
  std::string text = values.overflow ? "of OVERFLOW, " : "functions, ";
  if (!values.text.empty()) return text + "text";
  text += values.big_endian ? "big endian, " : "little endian, ";
  text += values.double_precision ? "double precision" : "single precision";
  return text + (values.record_marks ? ", record marks" : ", no record marks");
}

std::vector<Plot3dArray> arrays_of(const Plot3dValues& values, std::size_t grid, int axes,
                                   const std::vector<std::string>& names) {
  const std::uint64_t count = values.parts[grid].count;
  std::vector<Plot3dArray> out;
  if (values.overflow) {
    const auto energy = static_cast<std::uint64_t>(axes) + 1;
    out = {{"Density", 0, 1}, {"Momentum", 1, axes}, {"StagnationEnergy", energy, 1}};
    for (std::uint64_t i = energy + 1; i < count; ++i)
      out.push_back({i == energy + 1 ? "Gamma" : "value " + std::to_string(i + 1), i, 1});
    return out;
  }
  for (std::uint64_t i = 0; i < count; ++i)
    out.push_back({i < names.size() ? names[i] : "function " + std::to_string(i + 1), i, 1});
  for (std::uint64_t i = names.size(); i + 3 <= count; ++i)
    out.push_back({"functions " + std::to_string(i + 1) + " to " + std::to_string(i + 3), i, 3});
  return out;
}

DataArray read_values(std::string_view file, const Plot3dValues& values, std::size_t grid,
                      const Plot3dArray& array) {
  const Plot3dValues::Part& part = values.parts[grid];
  const bool swap = values.big_endian != (std::endian::native == std::endian::big);
  const auto at = [&](std::uint64_t i) -> double {
    if (!values.text.empty()) return values.text[part.first + i];
    if (values.double_precision) {
      std::array<char, 8> raw{};
      std::memcpy(raw.data(), file.data() + part.first + 8 * i, raw.size());
      if (swap) std::reverse(raw.begin(), raw.end());
      return std::bit_cast<double>(raw);
    }
    std::array<char, 4> raw{};
    std::memcpy(raw.data(), file.data() + part.first + 4 * i, raw.size());
    if (swap) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<float>(raw);
  };
  // Of two axes nothing moves along the third.
  const int components = array.components == 2 ? 3 : array.components;
  std::vector<double> numbers(part.points * as_size(components));
  for (std::uint64_t p = 0; p < part.points; ++p) {
    for (std::uint64_t c = 0; c < as_size(array.components); ++c)
      numbers[p * as_size(components) + c] = at((array.first + c) * part.points + p);
  }
  return make_array(array.name, Association::kPoint, components, numbers);
}

}  // namespace palpate
