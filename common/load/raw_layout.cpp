#include "common/load/raw_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <regex>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// Three numbers with `separator` between them.
template <typename T>
bool parse_three(std::string_view text, char separator, std::array<T, 3>& values) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t end = i < 2 ? text.find(separator) : text.size();
    if (end == std::string_view::npos) return false;
    const std::optional<T> value = parsed<T>(text.substr(0, end));
    if (!value) return false;
    values[i] = *value;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return true;
}

Vec3 parse_vector(const std::string& text, const char* option, const char* expected) {
  std::array<double, 3> v{};
  if (!parse_three(text, ',', v) || !is_finite(Vec3{v[0], v[1], v[2]}))
    throw usage_error(std::string(option) + " " + text + ": " + expected);
  return {v[0], v[1], v[2]};
}

constexpr std::array<std::pair<std::string_view, ScalarType>, 16> kTypeNames{
    {{"uint8", ScalarType::kUint8},
     {"int8", ScalarType::kInt8},
     {"uint16", ScalarType::kUint16},
     {"int16", ScalarType::kInt16},
     {"uint32", ScalarType::kUint32},
     {"int32", ScalarType::kInt32},
     {"uint64", ScalarType::kUint64},
     {"int64", ScalarType::kInt64},
     {"float32", ScalarType::kFloat32},
     {"float64", ScalarType::kFloat64},
     {"uchar", ScalarType::kUint8},
     {"char", ScalarType::kInt8},
     {"ushort", ScalarType::kUint16},
     {"short", ScalarType::kInt16},
     {"float", ScalarType::kFloat32},
     {"double", ScalarType::kFloat64}}};

}  // namespace

RawLayout parse_raw_layout(const RawSpec& spec) {
  RawLayout layout;
  if (spec.size.empty() || spec.type.empty())
    throw usage_error(
        "voxels without a header need --raw-size and --raw-type, such as 256x256x178 and uint16");
  std::array<int, 3> size{};
  if (!parse_three(spec.size, 'x', size) || *std::min_element(size.begin(), size.end()) < 1) {
    throw usage_error("--raw-size " + spec.size +
                      ": voxels along three axes are expected, such as 256x256x178");
  }
  layout.size = {size[0], size[1], size[2]};
  const auto* const type = std::find_if(kTypeNames.begin(), kTypeNames.end(),
                                        [&](const auto& known) { return known.first == spec.type; });
  if (type == kTypeNames.end()) {
    throw usage_error(
        "--raw-type " + spec.type +
        ": known are uint8, int8, uint16, int16, uint32, int32, uint64, int64, float32, float64");
  }
  layout.type = type->second;
  if (!spec.endian.empty() && spec.endian != "little" && spec.endian != "big")
    throw usage_error("--raw-endian " + spec.endian + ": little or big is expected");
  layout.big_endian = spec.endian == "big";
  if (!spec.spacing.empty()) {
    constexpr const char* kExpected = "three steps above zero are expected, such as 0.5,0.5,1";
    layout.spacing = parse_vector(spec.spacing, "--raw-spacing", kExpected);
    if (!(std::min({layout.spacing.x, layout.spacing.y, layout.spacing.z}) > 0.0))
      throw usage_error("--raw-spacing " + spec.spacing + ": " + kExpected);
  }
  if (!spec.origin.empty()) {
    layout.origin =
        parse_vector(spec.origin, "--raw-origin", "the place of the first voxel is expected, such as 0,0,0");
  }
  constexpr std::uint64_t kMostSkipped = std::uint64_t{1} << 46;
  if (!spec.skip.empty()) {
    const auto skip = parsed<std::uint64_t>(spec.skip);
    if (!skip || *skip > kMostSkipped)
      throw usage_error("--raw-skip " + spec.skip + ": a count of bytes is expected");
    layout.skip = *skip;
  }
  return layout;
}

std::uint64_t byte_count(const RawLayout& layout) noexcept {
  std::uint64_t bytes = byte_size(layout.type);
  for (int axis = 0; axis < 3; ++axis) {
    if (__builtin_mul_overflow(bytes, static_cast<std::uint64_t>(layout.size[axis]), &bytes))
      return std::numeric_limits<std::uint64_t>::max();
  }
  return bytes;
}

RawSpec raw_spec_of_name(const std::string& name) {
  static const std::regex kPattern(R"((?:.*_)?([0-9]+x[0-9]+x[0-9]+)_([a-z]+[0-9]*)\.raw)");
  std::smatch parts;
  // A name is short; a hostile one would send the matcher deep.
  constexpr std::size_t kLongestName = 255;
  if (name.size() > kLongestName || !std::regex_match(name, parts, kPattern)) return {};
  return {.size = parts[1], .type = parts[2], .endian = {}, .spacing = {}, .origin = {}, .skip = {}};
}

}  // namespace palpate
