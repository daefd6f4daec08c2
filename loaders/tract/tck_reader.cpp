#include "loaders/tract/tck_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "common/base/error.h"
#include "common/base/files/file_numbers.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/image/mrtrix_header.h"
#include "loaders/tract/tract_loader.h"

namespace palpate {
namespace {

/// Where the points begin: "file: . 123".
std::size_t start_of_points(const std::string& file, const MrtrixHeader& header, std::size_t file_size) {
  const std::string* const found = header.find("file");
  if (found == nullptr)
    throw input_error({file, "header", "does not say where the points are", "file: . 123", ""});
  if (!found->starts_with(". "))
    throw input_error(
        {file, "header, file", "names another file", "points in the file itself (file: . 123)", ""});
  const std::string_view place = trimmed(std::string_view(*found).substr(2));
  const auto offset = parsed<std::uint64_t>(place);
  if (!offset || *offset < header.end || *offset > file_size) {
    throw input_error({file, "header, file", "the points cannot begin at byte " + std::string(place),
                       std::to_string(header.end) + " to " + std::to_string(file_size), kDamagedTracts});
  }
  return as_size(*offset);
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
      const T value = number_at<T>(bytes, at + as_size(axis) * sizeof(T), big_endian);
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
        throw input_error(
            {file, place(), "is not closed before the end of the file", "three NaN", kDamagedTracts});
      const std::size_t behind = bytes.size() - at - kStride;
      if (behind > 0) notes.push_back(counted(behind, "byte") + " behind the last line left unread");
      return lines;
    } else {
      throw input_error({file, place(), "is not finite", "", kDamagedTracts});
    }
  }
  // The file ends without its end mark, three infinities: what is there is shown.
  const std::size_t last = lines.points.size() - lines.starts.back();
  if (last > 0) lines.starts.push_back(lines.points.size());
  notes.push_back("WARNING: the file is cut off: it ends without its end mark" +
                  (last > 0 ? ", within line " + std::to_string(lines.line_count()) + ", which ends there"
                            : " after line " + std::to_string(lines.line_count())));
  return lines;
}

}  // namespace

Tractogram read_tck(const std::string& file, std::string_view bytes, std::vector<std::string>& notes) {
  const MrtrixHeader header = read_mrtrix_header(file, bytes, "mrtrix tracks");
  const std::string* const datatype = header.find("datatype");
  const MrtrixNumber number = parse_mrtrix_number(datatype != nullptr ? *datatype : "");
  if (number.type != "float32" && number.type != "float64") {
    throw input_error({file, "header, datatype",
                       datatype == nullptr ? "is missing" : "is '" + *datatype + "'",
                       "Float32LE, Float32BE, Float64LE or Float64BE", ""});
  }
  const std::string_view points = bytes.substr(start_of_points(file, header, bytes.size()));
  Tractogram lines = number.type == "float64" ? read_points<double>(file, points, number.big_endian, notes)
                                              : read_points<float>(file, points, number.big_endian, notes);
  const bool lps = std::any_of(header.entries.begin(), header.entries.end(), [](const auto& entry) {
    const auto& [key, value] = entry;
    return (lowered(key) == "space" && lowered(value) == "lps") ||
           value.find("SPACE=LPS") != std::string::npos;
  });
  if (lps) {
    for (Vec3f& x : lines.points) x = {-x.x, -x.y, x.z};
    notes.emplace_back("the header states SPACE=LPS: turned into RAS");
  }
  const std::string* const claimed = header.find("count");
  const auto count = claimed != nullptr ? parsed<std::uint64_t>(*claimed) : std::nullopt;
  if (count && *count != lines.line_count()) {
    notes.push_back("the header counts " + counted(*count, "line") + ", the file holds " +
                    std::to_string(lines.line_count()));
  }
  return lines;
}

}  // namespace palpate
