#include "loaders/vtk/legacy_check.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "common/base/index.h"
#include "common/base/text.h"
#include "loaders/vtk/saturated.h"
#include "loaders/vtk/text_number.h"

namespace palpate {
namespace {

std::string upper(std::string_view word) {
  std::string text(word);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

/// Bits that one value of a type takes in a binary file; 0 for types of no fixed size (string, variant).
std::optional<std::uint64_t> bits_of(std::string_view type) {
  struct Size {
    std::string_view name;
    std::uint64_t bits;
  };
  static constexpr std::array<Size, 16> kSizes{{{"BIT", 1},
                                                {"CHAR", 8},
                                                {"SIGNED_CHAR", 8},
                                                {"UNSIGNED_CHAR", 8},
                                                {"SHORT", 16},
                                                {"UNSIGNED_SHORT", 16},
                                                {"INT", 32},
                                                {"UNSIGNED_INT", 32},
                                                {"LONG", 64},
                                                {"UNSIGNED_LONG", 64},
                                                {"VTKTYPEINT64", 64},
                                                {"VTKTYPEUINT64", 64},
                                                {"VTKIDTYPE", 32},
                                                {"FLOAT", 32},
                                                {"DOUBLE", 64},
                                                {"LONG_LONG", 64}}};
  const std::string name = upper(type);
  for (const Size& size : kSizes) {
    if (name == size.name) return size.bits;
  }
  return std::nullopt;
}

struct Impossible {
  std::string what;
};
/// The walk has come to something that it does not know.
struct Stop {};

class Walk {
 public:
  explicit Walk(std::string_view text) : text_(text) {}

  /// Where words stand that are not finite.
  [[nodiscard]] const std::vector<LegacyWord>& not_finite() const noexcept { return not_finite_; }

  [[nodiscard]] bool ambiguous() const noexcept { return ambiguous_; }

  /// What the field data states, as far as the walk came.
  [[nodiscard]] std::optional<double> time() const noexcept { return time_; }

  void run() {
    for (int i = 0; i < 2; ++i) (void)line();  // version and title
    const std::string encoding = upper(word());
    if (encoding != "ASCII" && encoding != "BINARY")
      throw Impossible{place() + "found '" + encoding.substr(0, 40) + "', expected ASCII or BINARY"};
    binary_ = encoding == "BINARY";
    while (true) {
      const std::string keyword = upper(word());
      if (keyword.empty() && !dataset_) throw Impossible{place() + "the file ends before DATASET"};
      if (keyword.empty()) return;
      section(keyword);
    }
  }

 private:
  void section(const std::string& keyword) {
    keyword_ = keyword;
    section_place_ = place();
    if (keyword == "DATASET") {
      const std::string kind = upper(word());
      static constexpr std::array<std::string_view, 5> kKinds{
          "STRUCTURED_POINTS", "STRUCTURED_GRID", "RECTILINEAR_GRID", "UNSTRUCTURED_GRID", "POLYDATA"};
      if (std::find(kKinds.begin(), kKinds.end(), kind) == kKinds.end()) {
        throw Impossible{
            place() + "found DATASET '" + printable(kind) +
            "', expected STRUCTURED_POINTS, STRUCTURED_GRID, RECTILINEAR_GRID or UNSTRUCTURED_GRID"};
      }
      dataset_ = true;
    } else if (!dataset_) {
      throw Impossible{place() + "found '" + printable(keyword) + "', expected DATASET"};
    } else if (keyword == "DIMENSIONS" || keyword == "EXTENT" || keyword == "SPACING" ||
               keyword == "ASPECT_RATIO" || keyword == "ORIGIN") {
      (void)line();
    } else if (keyword == "POINTS") {
      const std::uint64_t number = count();
      values(times(number, 3), word());
    } else if (keyword == "X_COORDINATES" || keyword == "Y_COORDINATES" || keyword == "Z_COORDINATES") {
      const std::uint64_t number = count();
      values(number, word());
    } else if (keyword == "CELLS" || keyword == "VERTICES" || keyword == "LINES" || keyword == "POLYGONS" ||
               keyword == "TRIANGLE_STRIPS") {
      const std::uint64_t cells = count();
      const std::uint64_t size = count();
      // Version 5.1 gives OFFSETS and CONNECTIVITY as sections of their own.
      if (upper(peek()) == "OFFSETS") {
        (void)word();
        values(cells, word());
        if (upper(word()) != "CONNECTIVITY") throw Stop{};
        values(size, word());
      } else {
        cell_list(cells, size);
      }
    } else if (keyword == "CELL_TYPES") {
      values(count(), "int");
    } else if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
      tuples_ = count();
      mesh_data_ = false;
    } else if (keyword == "SCALARS") {
      (void)word();
      const std::string type(word());
      std::uint64_t components = 1;
      if (const auto given = same_line_count()) components = *given;
      if (upper(peek()) == "LOOKUP_TABLE") {
        (void)word();
        (void)word();
      }
      values(times(tuples_, components), type);
    } else if (keyword == "VECTORS" || keyword == "NORMALS") {
      (void)word();
      values(times(tuples_, 3), word());
    } else if (keyword == "TENSORS" || keyword == "TENSORS6") {
      (void)word();
      values(times(tuples_, keyword == "TENSORS" ? 9 : 6), word());
    } else if (keyword == "TEXTURE_COORDINATES") {
      (void)word();
      const std::uint64_t components = count();
      values(times(tuples_, components), word());
    } else if (keyword == "COLOR_SCALARS") {
      (void)word();
      values(times(tuples_, count()), binary_ ? "unsigned_char" : "float", true);
    } else if (keyword == "LOOKUP_TABLE") {
      (void)word();
      values(times(count(), 4), binary_ ? "unsigned_char" : "float", true);
    } else if (keyword == "FIELD") {
      (void)word();
      const std::uint64_t arrays = count();
      for (std::uint64_t i = 0; i < arrays; ++i) {
        const std::string name(word());
        if (upper(name) == "METADATA") {
          skip_metadata();
          --i;
          continue;
        }
        if (name.empty())
          throw Impossible{place() + "the file ends after " + std::to_string(i) + " of " +
                           std::to_string(arrays) + " arrays"};
        keyword_ = name;
        section_place_ = place();
        const std::uint64_t components = count();
        const std::uint64_t tuples = count();
        const std::string type(word());
        const std::size_t start = at_;
        values(times(components, tuples), type);
        if (mesh_data_ && components == 1 && tuples == 1 &&
            (upper(name) == "TIME" || upper(name) == "TIMEVALUE"))
          time_ = binary_ ? big_endian_number(upper(type))
                          : palpate::number(trimmed(text_.substr(start, at_ - start)));
      }
    } else if (keyword == "METADATA") {
      skip_metadata();
    } else {
      static constexpr std::array<std::string_view, 5> kLeftToVtk{"GLOBAL_IDS", "PEDIGREE_IDS", "EDGE_FLAGS",
                                                                  "HIGHER_ORDER_DEGREES", "RATIONAL_WEIGHTS"};
      if (std::find(kLeftToVtk.begin(), kLeftToVtk.end(), keyword) == kLeftToVtk.end()) {
        throw Impossible{place() + "found '" + printable(keyword) + "', expected a keyword"};
      }
      throw Stop{};
    }
  }

  /// Passes over the lines behind METADATA, which end with an empty one.
  void skip_metadata() {
    (void)line();
    while (!line().empty()) {
    }
  }

  /// Passes over `size` integers that must be `cells` lists: a count, then as many points. VTK believes the
  /// counts.
  void cell_list(std::uint64_t cells, std::uint64_t size) {
    const std::size_t start = at_;
    const std::uint64_t start_line = lines_;
    values(size, "int");
    const std::size_t end = at_;
    const std::uint64_t end_line = lines_;
    at_ = binary_ ? end - 4 * size : start;
    lines_ = start_line;
    std::uint64_t used = 0;
    std::uint64_t list = 0;
    for (; list < cells && used < size; ++list) {
      const std::uint64_t points = binary_ ? big_endian_integer() : count();
      if (points > size - used - 1) break;
      if (binary_) {
        at_ += 4 * points;
      } else {
        for (std::uint64_t i = 0; i < points; ++i) (void)word();
      }
      used += 1 + points;
    }
    if (list != cells || used != size) {
      throw Impossible{section_place_ + keyword_ + " claims " + std::to_string(cells) + " cells in " +
                       std::to_string(size) + " integers, but cell " + std::to_string(list) +
                       " does not fit"};
    }
    at_ = end;
    lines_ = end_line;
  }

  /// The number that ends here.
  [[nodiscard]] std::optional<double> big_endian_number(const std::string& type) const {
    const std::size_t size = bits_of(type).value_or(0) / 8;
    std::uint64_t bits = 0;
    for (std::size_t i = at_ - size; i < at_; ++i) bits = bits << 8U | static_cast<unsigned char>(text_[i]);
    if (type == "DOUBLE") return std::bit_cast<double>(bits);
    if (type == "FLOAT") return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    if (type == "INT") return static_cast<std::int32_t>(static_cast<std::uint32_t>(bits));
    return std::nullopt;
  }

  std::uint64_t big_endian_integer() {
    std::uint64_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(text_[at_++]);
    return value;
  }

  /// Passes over `number` values, which must be there. @param colors they must be finite.
  void values(std::uint64_t number, std::string_view type, bool colors = false) {
    const auto bits = bits_of(type);
    const std::string name = upper(type);
    if (!bits && (name == "STRING" || name == "UTF8_STRING" || name == "VARIANT")) throw Stop{};
    if (!bits) {
      throw Impossible{section_place_ + keyword_.substr(0, 60) + ": found '" + printable(type) +
                       "', expected a number type"};
    }
    const std::uint64_t left = text_.size() - at_;
    if (!binary_) {
      // A value takes a character, and a separator before the next.
      if (number > left / 2 + 1) impossible(number, type, left);
      for (std::uint64_t i = 0; i < number; ++i) {
        const std::string_view value = word();
        if (value.empty()) {
          throw Impossible{place() + keyword_.substr(0, 60) + ": the file ends after " + std::to_string(i) +
                           " of " + std::to_string(number) + " values"};
        }
        if (!is_value(value, name, *bits, colors)) {
          throw Impossible{place() + keyword_.substr(0, 60) + ": found '" + printable(value) +
                           "', expected a number of type " + lowered(type)};
        }
      }
      return;
    }
    (void)line();
    // Up to 2^64 - 1 bits is never in a file either.
    const std::uint64_t bytes = times(number, *bits) == kHuge ? kHuge : (times(number, *bits) + 7) / 8;
    if (bytes > text_.size() - at_) impossible(number, type, text_.size() - at_);
    at_ += bytes;
    ++binary_sections_;
  }

  /// Whether `value` is one of the type `name`; where it is not finite, it is kept.
  bool is_value(std::string_view value, const std::string& name, std::uint64_t bits, bool colors) {
    if (name != "FLOAT" && name != "DOUBLE") {
      // Bytes are written with a sign or without.
      const bool with_sign = !name.starts_with("UNSIGNED") && name != "VTKTYPEUINT64";
      const auto width = static_cast<unsigned>(bits == 1 ? 8 : bits);
      return whole_number(value, width, with_sign).has_value() ||
             (width == 8 && whole_number(value, width, !with_sign).has_value());
    }
    const bool windows = value.find(".#") != std::string_view::npos;  // 1.#QNAN, -1.#IND, 1.#INF
    std::optional<double> number = real_number<double>(value);
    if (windows) {
      const double sign = value.front() == '-' ? -1.0 : 1.0;
      number = value.find("INF") != std::string_view::npos ? sign * std::numeric_limits<double>::infinity()
                                                           : std::numeric_limits<double>::quiet_NaN();
    } else if (name == "FLOAT" && !real_number<float>(value)) {
      return false;
    }
    if (!number) return false;
    if (std::isfinite(*number)) {
      for (const LegacyStandIn& stand_in : kStandIns)
        ambiguous_ = ambiguous_ || static_cast<float>(*number) == static_cast<float>(stand_in.number);
      return true;
    }
    const std::size_t kind = std::isnan(*number) ? 0 : (*number > 0.0 ? 1 : 2);
    not_finite_.push_back({as_size(value.data() - text_.data()), value.size(), kind});
    return !colors;
  }

  [[noreturn]] void impossible(std::uint64_t number, std::string_view type, std::uint64_t left) {
    throw Impossible{section_place_ + keyword_.substr(0, 60) + " claims " +
                     (number == kHuge ? "over 2^63" : std::to_string(number)) + " values of type " +
                     std::string(type.substr(0, 20)) + ", but " + std::to_string(left) +
                     " bytes are left in the file"};
  }

  std::uint64_t count() {
    std::string_view text = word();
    if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc::result_out_of_range) return kHuge;
    if (error != std::errc() || end != text.data() + text.size()) {
      throw Impossible{place() + "found '" + printable(text) + "' in " + keyword_.substr(0, 60) +
                       ", expected a count"};
    }
    return value;
  }

  /// A count on the rest of this line, if there is one.
  std::optional<std::uint64_t> same_line_count() {
    std::size_t at = at_;
    while (at < text_.size() && (text_[at] == ' ' || text_[at] == '\t')) ++at;
    if (at >= text_.size() || std::isdigit(static_cast<unsigned char>(text_[at])) == 0) return std::nullopt;
    return count();
  }

  std::string_view word() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) next();
    const std::size_t start = at_;
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) == 0) ++at_;
    return text_.substr(start, at_ - start);
  }

  std::string_view peek() {
    const std::size_t at = at_;
    const std::uint64_t lines = lines_;
    const std::string_view text = word();
    at_ = at;
    lines_ = lines;
    return text;
  }

  /// The rest of the line, without its end; also at the end of the file.
  std::string_view line() {
    const std::size_t start = at_;
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    std::string_view text = text_.substr(start, at_ - start);
    if (at_ < text_.size()) next();
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    return text;
  }

  void next() {
    if (text_[at_] == '\n') ++lines_;
    ++at_;
  }

  /// Lines can be counted until the first binary data.
  [[nodiscard]] std::string place() const {
    if (binary_sections_ > 0) return "byte " + std::to_string(at_) + ": ";
    return "line " + std::to_string(lines_) + ": ";
  }

  static std::string printable(std::string_view text) {
    std::string result(text.substr(0, 40));
    std::replace_if(
        result.begin(), result.end(), [](unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
    return result;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::uint64_t lines_ = 1;
  bool binary_ = false;
  bool dataset_ = false;
  int binary_sections_ = 0;
  std::uint64_t tuples_ = 0;
  std::string keyword_;
  std::string section_place_;  ///< where the keyword stands
  std::vector<LegacyWord> not_finite_;
  bool mesh_data_ = true;  ///< neither of points nor of cells
  std::optional<double> time_;
  bool ambiguous_ = false;  ///< a stand-in is a value of the file
};

}  // namespace

std::optional<double> legacy_time(std::string_view text) {
  Walk walk(text);
  try {
    walk.run();
  } catch (const Impossible&) {
  } catch (const Stop&) {
  }
  const std::optional<double> time = walk.time();
  return time && std::isfinite(*time) ? time : std::nullopt;
}

LegacyScan scan_legacy(std::string_view text) {
  LegacyScan scan;
  Walk walk(text);
  try {
    walk.run();
  } catch (const Impossible& impossible) {
    scan.problem = impossible.what;
  } catch (const Stop&) {
  }
  scan.not_finite = walk.not_finite();
  if (scan.problem.empty() && walk.ambiguous() && !scan.not_finite.empty())
    scan.problem =
        "holds NaN or infinity together with 1.2764e37, 1.2874e37 or 1.2984e37: these cannot be distinguished";
  return scan;
}

std::string with_stand_ins(std::string_view text, const std::vector<LegacyWord>& words) {
  std::string result;
  result.reserve(text.size() + words.size() * kStandIns.front().text.size());
  std::size_t from = 0;
  for (const LegacyWord& word : words) {
    result += text.substr(from, word.at - from);
    result += kStandIns[word.kind].text;
    from = word.at + word.size;
  }
  result += text.substr(from);
  return result;
}

}  // namespace palpate
