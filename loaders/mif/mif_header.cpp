#include "loaders/mif/mif_header.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/find_format.h"
#include "common/load/gzip_head.h"
#include "common/load/image/mrtrix_header.h"

namespace palpate {
namespace {

/// The most that a header may take: 4096 gradients need a quarter of it.
constexpr std::size_t kMostHeaderBytes = std::size_t{1} << 20;

class HeaderReader {
 public:
  explicit HeaderReader(const std::string& file) : file_(file) {}

  MifHeader read() {
    HeadOfFile head = read_head(file_, kMostHeaderBytes);
    header_.packed = is_gzip(head.bytes);
    if (header_.packed) head.bytes = gzip_head(head.bytes, kMostHeaderBytes);
    keys_ = read_mrtrix_header(file_, head.bytes, "mrtrix image");
    read_axes();
    read_type();
    read_place();
    read_scaling();
    read_gradients();
    find_data();
    return std::move(header_);
  }

 private:
  [[noreturn]] void refuse(const std::string& key, const std::string& found, const std::string& expected = "",
                           const std::string& remedy = "the file may be damaged") const {
    throw input_error({file_, "header, " + key, found, expected, remedy});
  }

  const std::string& value_of(const char* key) const {
    const std::string* const value = keys_.find(key);
    if (value == nullptr) refuse(key, "is missing");
    return *value;
  }

  std::vector<double> numbers_of(const std::string& key, std::string_view text) const {
    std::vector<double> numbers;
    for (const std::string_view word : split(text, ',')) {
      const std::optional<double> value = number(word);
      if (!value) refuse(key, "is '" + std::string(text.substr(0, 60)) + "'", "numbers with commas between");
      numbers.push_back(*value);
    }
    return numbers;
  }

  void read_axes() {
    for (const std::string_view word : split(value_of("dim"), ',')) {
      const auto size = parsed<std::uint64_t>(trimmed(word));
      constexpr std::uint64_t kMost = std::numeric_limits<int>::max();
      if (!size || *size == 0 || *size > kMost)
        refuse("dim", "is '" + value_of("dim").substr(0, 60) + "'", "sizes above zero");
      header_.axes.push_back({.size = *size});
    }
    read_layout();
    // Axes of one voxel behind the third say nothing; two of more are no image that is read.
    auto& axes = header_.axes;
    while (axes.size() > 3 && axes.back().size == 1) axes.pop_back();
    if (axes.size() == 2) axes.push_back({.rank = 2});
    if (axes.size() < 3 || axes.size() > 4)
      refuse("dim", "has " + std::to_string(axes.size()) + " axes", "two, three, and perhaps one of volumes",
             "");
    // Ranks without those of the axes that were left out.
    std::vector<int> ranks;
    ranks.reserve(axes.size());
    for (const MifAxis& axis : axes) ranks.push_back(axis.rank);
    std::sort(ranks.begin(), ranks.end());
    for (MifAxis& axis : axes)
      axis.rank = static_cast<int>(std::lower_bound(ranks.begin(), ranks.end(), axis.rank) - ranks.begin());
    for (int axis = 0; axis < 3; ++axis)
      header_.topology.points[axis] = static_cast<int>(axes[as_size(axis)].size);
  }

  /// "+0,-1,+2": the rank of each axis, with a minus sign where it is stored backwards.
  void read_layout() {
    const std::string& layout = value_of("layout");
    const auto words = split(layout, ',');
    auto& axes = header_.axes;
    std::vector<bool> seen(axes.size(), false);
    for (std::size_t axis = 0; axis < words.size() && words.size() == axes.size(); ++axis) {
      std::string_view word = trimmed(words[axis]);
      axes[axis].backwards = word.starts_with('-');
      if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
      const auto rank = parsed<std::uint64_t>(word);
      if (!rank || *rank >= axes.size() || seen[*rank]) break;
      seen[*rank] = true;
      axes[axis].rank = static_cast<int>(*rank);
    }
    if (std::find(seen.begin(), seen.end(), false) != seen.end())
      refuse("layout", "is '" + layout.substr(0, 60) + "'", "each rank from 0 on once, with a sign");
  }

  void read_type() {
    static const std::map<std::string, ScalarType, std::less<>> kTypes{
        {"int8", ScalarType::kInt8},      {"uint8", ScalarType::kUint8},   {"int16", ScalarType::kInt16},
        {"uint16", ScalarType::kUint16},  {"int32", ScalarType::kInt32},   {"uint32", ScalarType::kUint32},
        {"int64", ScalarType::kInt64},    {"uint64", ScalarType::kUint64}, {"float32", ScalarType::kFloat32},
        {"float64", ScalarType::kFloat64}};
    const MrtrixNumber number = parse_mrtrix_number(value_of("datatype"));
    header_.big_endian = number.big_endian;
    if (number.type == "bit") return;
    const auto found = kTypes.find(number.type);
    if (found == kTypes.end()) {
      refuse("datatype", "is '" + value_of("datatype").substr(0, 60) + "'", "real numbers or bits",
             "complex images are not read");
    }
    header_.type = found->second;
  }

  void read_place() {
    const std::vector<double> sizes = numbers_of("vox", value_of("vox"));
    Vec3 size{0.0};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = as_size(axis);
      if (a < sizes.size()) size[axis] = sizes[a];
      if (a == 2 && sizes.size() == 2 && header_.topology.points.z == 1)
        size[axis] = std::sqrt(sizes[0] * sizes[1]);  // a slice
      if (!(size[axis] > 0.0) || !std::isfinite(size[axis]))
        refuse("vox", "is '" + value_of("vox").substr(0, 60) + "'", "three sizes above zero");
    }
    Mat3 rotation{1.0};
    Vec3 shift{0.0};
    if (keys_.find("transform") == nullptr) {
      header_.notes.emplace_back("no transform: axes taken along RAS, with the image's centre at the origin");
      shift = -0.5 * size * (Vec3{header_.topology.points} - 1.0);
    } else {
      std::vector<double> numbers;
      for (const std::string& row : keys_.all("transform")) {
        for (const double value : numbers_of("transform", row)) numbers.push_back(value);
      }
      if (numbers.size() != 12 && numbers.size() != 16)
        refuse("transform", "has " + std::to_string(numbers.size()) + " numbers", "three rows of four");
      for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column)
          rotation[static_cast<int>(column)][static_cast<int>(row)] = numbers[4 * row + column];
        shift[static_cast<int>(row)] = numbers[4 * row + 3];
      }
    }
    UniformTopology& topology = header_.topology;
    for (int axis = 0; axis < 3; ++axis) topology.axes[axis] = rotation[axis] * size[axis];
    topology.origin = shift;
    constexpr double kFlat = 1e-6;  // of the volume that axes at right angles would span
    const double sides =
        glm::length(topology.axes[0]) * glm::length(topology.axes[1]) * glm::length(topology.axes[2]);
    if (!(std::abs(glm::determinant(topology.axes)) > kFlat * sides) || !std::isfinite(sides) ||
        !is_finite(shift)) {
      refuse("transform", "does not span space", "three axes");
    }
  }

  void read_scaling() {
    const std::string* const text = keys_.find("scaling");
    if (text == nullptr) return;
    const std::vector<double> numbers = numbers_of("scaling", *text);
    if (numbers.size() != 2 || !std::isfinite(numbers[0]) || !std::isfinite(numbers[1]) || numbers[1] == 0.0)
      refuse("scaling", "is '" + text->substr(0, 60) + "'", "offset and scale");
    header_.offset = numbers[0];
    header_.scale = numbers[1];
  }

  /// Rows of x, y, z, b.
  void read_gradients() {
    const std::vector<std::string> rows = keys_.all("dw_scheme");
    if (rows.empty()) return;
    if (rows.size() != header_.volumes() || rows.size() > kMostGradients) {
      header_.notes.push_back("dw_scheme has " + counted(rows.size(), "row") + " for " +
                              counted(header_.volumes(), "volume") + ", and is left out");
      return;
    }
    GradientTable table;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const std::vector<double> row = numbers_of("dw_scheme", rows[r]);
      const std::string place = "dw_scheme, row " + std::to_string(r + 1);
      if (row.size() < 4) refuse(place, "has " + counted(row.size(), "number"), "x, y, z and b");
      const Vec3 direction{row[0], row[1], row[2]};
      const double length = glm::length(direction);
      if (!is_finite(direction) || !(row[3] >= 0.0) || !std::isfinite(row[3]))
        refuse(place, "is '" + rows[r].substr(0, 60) + "'", "finite numbers, b not below zero");
      constexpr double kLongest = 1e9;
      if (!(length < kLongest))
        refuse(place, "has a direction of length " + short_number(length), "about one");
      table.weightings.push_back(row[3]);
      table.directions.push_back(direction);
    }
    header_.notes.emplace_back(kGradientsOfHeader);
    header_.gradients = std::move(table);
  }

  /// "file: . 123" in a .mif, "file: name.dat 0" in a .mih.
  void find_data() {
    const std::vector<std::string> files = keys_.all("file");
    if (files.size() != 1)
      refuse("file", files.empty() ? "is missing" : "names " + counted(files.size(), "data file"), "one", "");
    std::string_view name = files.front();
    std::uint64_t at = 0;
    if (const std::size_t blank = name.find_last_of(" \t"); blank != std::string_view::npos) {
      if (const auto count = parsed<std::uint64_t>(name.substr(blank + 1))) {
        at = *count;
        name = trimmed(name.substr(0, blank));
      }
    }
    const bool itself = name == ".";
    header_.data_at = at;
    header_.data_file = file_;
    if (itself && at < keys_.end) refuse("file", "the numbers cannot begin at byte " + std::to_string(at));
    if (!itself) {
      header_.data_file = (std::filesystem::path(file_).parent_path() / std::filesystem::path(name)).string();
      header_.packed = is_gzip(read_head(header_.data_file, 2).bytes);
    }
    check_size();
  }

  void check_size() {
    const std::uint64_t there = read_head(header_.data_file, 0).file_size;
    // A product of sizes that fits behind what is there cannot wrap: it is built up against that bound.
    const std::uint64_t most = header_.packed ? there * kGzipRatio : there;
    std::uint64_t numbers = 1;
    bool fits = header_.data_at <= most;
    for (const MifAxis& axis : header_.axes) {
      fits = fits && numbers <= 8 * most / axis.size;
      if (fits) numbers *= axis.size;
    }
    fits = fits && header_.data_bytes() <= most - header_.data_at;
    if (fits) return;
    std::string size;
    for (const MifAxis& axis : header_.axes) size += (size.empty() ? "" : " x ") + std::to_string(axis.size);
    throw input_error({header_.data_file, "",
                       "has " + std::to_string(there) + " bytes" + (header_.packed ? ", packed," : "") +
                           ", too few for " + size + " numbers from byte " + std::to_string(header_.data_at) +
                           " on",
                       "", "the file may be cut off"});
  }

  const std::string& file_;
  MrtrixHeader keys_;
  MifHeader header_;
};

}  // namespace

std::uint64_t MifHeader::data_bytes() const noexcept {
  const std::uint64_t numbers = voxels() * volumes();
  return type ? numbers * byte_size(*type) : (numbers + 7) / 8;
}

MifHeader read_mif_header(const std::string& file) { return HeaderReader(file).read(); }

}  // namespace palpate
