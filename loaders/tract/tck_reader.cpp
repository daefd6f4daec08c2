#include "loaders/tract/tck_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>

#include "common/base/error.h"
#include "common/base/text.h"
#include "loaders/tract/file_numbers.h"

namespace palpate {
namespace {

constexpr std::string_view kMark = "mrtrix tracks";
constexpr const char* kDamaged = "the file may be damaged or cut off";

/// The values of the header; of keys that come several times (comments), the last.
using Header = std::map<std::string, std::string, std::less<>>;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

/// @param end becomes the first byte behind the header.
Header read_header(const std::string& file, std::string_view bytes, std::size_t& end) {
  if (!bytes.starts_with(kMark))
    throw input_error({file, "byte 0", "is no MRtrix track file", "mrtrix tracks"});
  Header header;
  std::size_t at = bytes.find('\n');
  while (at != std::string_view::npos) {
    const std::size_t next = bytes.find('\n', at + 1);
    if (next == std::string_view::npos) break;
    const std::string_view line = trimmed(bytes.substr(at + 1, next - at - 1));
    at = next;
    if (line == "END") {
      end = next + 1;
      return header;
    }
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) continue;
    header[std::string(trimmed(line.substr(0, colon)))] = std::string(trimmed(line.substr(colon + 1)));
  }
  throw input_error({file, "header", "has no END", "", kDamaged});
}

std::optional<std::uint64_t> count_of(std::string_view text) {
  std::uint64_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return count;
}

/// Where the points begin: "file: . 123".
std::size_t start_of_points(const std::string& file, const Header& header, std::size_t header_end,
                            std::size_t file_size) {
  const auto found = header.find("file");
  if (found == header.end())
    throw input_error({file, "header", "does not say where the points are", "file: . 123"});
  const std::string_view value = found->second;
  if (!value.starts_with(". "))
    throw input_error(
        {file, "header, file", "names another file", "points in the file itself (file: . 123)"});
  const auto offset = count_of(trimmed(value.substr(2)));
  if (!offset || *offset < header_end || *offset > file_size) {
    throw input_error({file, "header, file",
                       "the points cannot begin at byte " + std::string(trimmed(value.substr(2))),
                       std::to_string(header_end) + " to " + std::to_string(file_size), kDamaged});
  }
  return static_cast<std::size_t>(*offset);
}

struct Numbers {
  bool big_endian = false;
  bool doubles = false;
};

Numbers numbers_of(const std::string& file, const Header& header) {
  const auto found = header.find("datatype");
  std::string type = found == header.end() ? "" : found->second;
  std::transform(type.begin(), type.end(), type.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  Numbers numbers;
  if (type.ends_with("be")) numbers.big_endian = true;
  if (type.ends_with("be") || type.ends_with("le")) type.resize(type.size() - 2);
  if (type != "float32" && type != "float64") {
    throw input_error({file, "header, datatype",
                       found == header.end() ? "is missing" : "is '" + found->second + "'",
                       "Float32LE, Float32BE, Float64LE or Float64BE"});
  }
  numbers.doubles = type == "float64";
  return numbers;
}

template <typename T>
Tractogram read_points(const std::string& file, std::string_view bytes, bool big_endian,
                       std::vector<std::string>& notes) {
  constexpr std::size_t kStride = 3 * sizeof(T);
  Tractogram lines;
  lines.points.reserve(bytes.size() / kStride);
  const auto place = [&lines] {
    return "line " + std::to_string(lines.starts.size()) + ", point " +
           std::to_string(lines.points.size() - lines.starts.back() + 1);
  };
  for (std::size_t at = 0; at + kStride <= bytes.size(); at += kStride) {
    Vec3f x{0.0F};
    int nan = 0, infinite = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const T value = number_at<T>(bytes, at + static_cast<std::size_t>(axis) * sizeof(T), big_endian);
      x[axis] = static_cast<float>(value);
      nan += std::isnan(x[axis]) ? 1 : 0;
      infinite += std::isinf(x[axis]) ? 1 : 0;
    }
    if (nan + infinite == 0) {
      lines.points.push_back(x);
    } else if (nan == 3) {
      lines.starts.push_back(lines.points.size());
    } else if (infinite == 3) {
      if (lines.starts.back() != lines.points.size())
        throw input_error({file, place(), "is not closed before the end of the file", "three NaN", kDamaged});
      const std::size_t behind = bytes.size() - at - kStride;
      if (behind > 0) notes.push_back(counted(behind, "byte") + " behind the last line left unread");
      return lines;
    } else {
      throw input_error({file, place(), "is not finite", "", kDamaged});
    }
  }
  throw input_error({file, place(), "the file ends without its end mark", "three infinities", kDamaged});
}

}  // namespace

Tractogram read_tck(const std::string& file, std::string_view bytes, std::vector<std::string>& notes) {
  std::size_t header_end = 0;
  const Header header = read_header(file, bytes, header_end);
  const Numbers numbers = numbers_of(file, header);
  const std::string_view points = bytes.substr(start_of_points(file, header, header_end, bytes.size()));
  Tractogram lines = numbers.doubles ? read_points<double>(file, points, numbers.big_endian, notes)
                                     : read_points<float>(file, points, numbers.big_endian, notes);
  if (const auto claimed = header.find("count"); claimed != header.end()) {
    const auto count = count_of(claimed->second);
    if (count && *count != lines.line_count()) {
      notes.push_back("the header counts " + counted(*count, "line") + ", the file holds " +
                      std::to_string(lines.line_count()));
    }
  }
  return lines;
}

}  // namespace palpate
