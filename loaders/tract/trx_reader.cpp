#include "loaders/tract/trx_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include <zip.h>

#include "common/base/error.h"
#include "common/base/files/file_numbers.h"
#include "common/base/files/mapped_file.h"
#include "common/base/index.h"
#include "common/base/json.h"
#include "common/base/text.h"
#include "common/load/gzip_head.h"

namespace palpate {
namespace {

/// IEEE 754 half precision.
double half(std::uint16_t bits) {
  const int exponent = bits >> 10U & 31U;
  const int fraction = bits & 1023U;
  double value = 0.0;
  if (exponent == 31) {
    value = fraction == 0 ? HUGE_VAL : std::numeric_limits<double>::quiet_NaN();
  } else {
    value = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  }
  return (bits & 0x8000U) != 0 ? -value : value;
}

template <typename T>
double plain(std::string_view bytes, std::size_t at) {
  return static_cast<double>(number_at<T>(bytes, at, false));
}

/// A type of number: its bytes, and how to read one.
struct NumberType {
  std::string_view name;
  std::size_t size;
  double (*read)(std::string_view bytes, std::size_t at);
};
/// Truth is a byte each, as NumPy has it.
double truth(std::string_view bytes, std::size_t at) { return bytes[at] != '\0' ? 1.0 : 0.0; }

constexpr std::array<NumberType, 12> kTypes{{{"bit", 1, truth},
                                             {"int8", 1, plain<std::int8_t>},
                                             {"uint8", 1, plain<std::uint8_t>},
                                             {"int16", 2, plain<std::int16_t>},
                                             {"uint16", 2, plain<std::uint16_t>},
                                             {"int32", 4, plain<std::int32_t>},
                                             {"uint32", 4, plain<std::uint32_t>},
                                             {"int64", 8, plain<std::int64_t>},
                                             {"uint64", 8, plain<std::uint64_t>},
                                             {"float16", 2,
                                              [](std::string_view bytes, std::size_t at) {
                                                return half(number_at<std::uint16_t>(bytes, at, false));
                                              }},
                                             {"float32", 4, plain<float>},
                                             {"float64", 8, plain<double>}}};

/// What the name of an array states: "dpv/color.3.uint8".
struct ArrayName {
  std::string folder;  ///< "dpv", or empty
  std::string name;
  std::size_t components = 1;
  const NumberType* type = nullptr;
};

std::optional<ArrayName> parse_name(std::string_view path) {
  ArrayName array;
  if (const std::size_t slash = path.rfind('/'); slash != std::string_view::npos) {
    array.folder = path.substr(0, slash);
    path.remove_prefix(slash + 1);
  }
  std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos) return {};
  const auto* const type = std::find_if(kTypes.begin(), kTypes.end(),
                                        [&](const NumberType& t) { return t.name == path.substr(dot + 1); });
  if (type == kTypes.end()) return {};
  array.type = type;
  path = path.substr(0, dot);
  dot = path.rfind('.');
  if (dot != std::string_view::npos) {
    const auto components = parsed<std::size_t>(path.substr(dot + 1));
    constexpr std::size_t kMost = 4096;
    if (components && *components > 0 && *components <= kMost) {
      array.components = *components;
      path = path.substr(0, dot);
    }
  }
  array.name = path;
  return array;
}

/// The members of a folder or zip file, read on demand.
class Members {
 public:
  /// @throws Error (bad input): no zip file, or a damaged one.
  explicit Members(const std::filesystem::path& path) : path_(path.string()) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) {
      list_folder(path);
    } else {
      open_archive();
    }
    std::sort(names_.begin(), names_.end());
  }

  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }

  /// @throws Error (bad input): damaged, encrypted, packed in a way that libzip does not know, or of another
  /// size than claimed.
  [[nodiscard]] std::string read(const std::string& name) const {
    if (archive_) return unpack(name);
    return std::string(MappedFile((std::filesystem::path(path_) / name).string()).text());
  }

 private:
  [[noreturn]] void refuse(const std::string& place, const std::string& found) const {
    throw input_error({path_, place, found, "", "the file may be damaged or cut off"});
  }

  void list_folder(const std::filesystem::path& path) {
    // What TRX describes lies at most three folders deep (dpg/group/name).
    constexpr int kDeepest = 3, kMostEntries = 100'000;
    std::error_code error;
    int entries = 0;
    for (auto it = std::filesystem::recursive_directory_iterator(path, error);
         !error && it != std::filesystem::recursive_directory_iterator() && entries < kMostEntries;
         it.increment(error), ++entries) {
      if (it.depth() >= kDeepest) it.disable_recursion_pending();
      std::error_code ignored;
      if (it->is_regular_file(ignored))
        names_.push_back(it->path().lexically_relative(path).generic_string());
    }
  }

  void open_archive() {
    mapped_ = std::make_unique<MappedFile>(path_);
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* const source =
        zip_source_buffer_create(mapped_->text().data(), mapped_->text().size(), 0, &error);
    if (source != nullptr) archive_.reset(zip_open_from_source(source, ZIP_RDONLY, &error));
    if (!archive_) {
      const std::string found = std::string("cannot be read as a zip file: ") + zip_error_strerror(&error);
      zip_error_fini(&error);
      zip_source_free(source);
      refuse("", found);
    }
    const zip_int64_t entries = zip_get_num_entries(archive_.get(), 0);
    for (zip_int64_t i = 0; i < entries; ++i) {
      const std::string_view name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), 0);
      if (!name.ends_with('/')) names_.emplace_back(name);
    }
  }

  // Nothing is allocated that the bytes of the file could not hold.
  [[nodiscard]] std::string unpack(const std::string& name) const {
    zip_stat_t claimed;
    zip_stat_init(&claimed);
    constexpr zip_uint64_t kNeeded = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD;
    if (zip_stat(archive_.get(), name.c_str(), 0, &claimed) != 0 || (claimed.valid & kNeeded) != kNeeded)
      refuse(name, "has no size");
    const bool possible =
        claimed.comp_size <= mapped_->text().size() &&
        (claimed.comp_method == ZIP_CM_STORE ? claimed.size == claimed.comp_size
                                             : claimed.size / kGzipRatio <= claimed.comp_size);
    if (!possible) {
      refuse(name, "claims " + std::to_string(claimed.size) + " bytes, packed in " +
                       std::to_string(claimed.comp_size));
    }
    const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> member(zip_fopen(archive_.get(), name.c_str(), 0),
                                                                   zip_fclose);
    if (!member) refuse(name, std::string("cannot be unpacked: ") + zip_strerror(archive_.get()));
    std::string bytes(claimed.size, '\0');
    std::size_t filled = 0;
    zip_int64_t got = 1;
    while (filled < bytes.size() && got > 0) {
      got = zip_fread(member.get(), bytes.data() + filled, bytes.size() - filled);
      filled += as_size(std::max<zip_int64_t>(got, 0));
    }
    // Only reading on at the end compares checksum and size.
    char beyond = 0;
    if (got >= 0) got = zip_fread(member.get(), &beyond, 1);
    if (got < 0) refuse(name, std::string("cannot be unpacked: ") + zip_file_strerror(member.get()));
    if (got > 0 || filled != bytes.size()) refuse(name, "has another size than it claims");
    return bytes;
  }

  std::string path_;
  std::unique_ptr<MappedFile> mapped_;
  std::unique_ptr<zip_t, void (*)(zip_t*)> archive_{nullptr, zip_discard};
  std::vector<std::string> names_;
};

class TrxReader {
 public:
  TrxReader(const std::filesystem::path& path, std::vector<std::string>& notes)
      : file_(path.string()), members_(path), notes_(notes) {}

  static bool is_line_array(std::string_view name) { return name == "positions" || name == "offsets"; }

  Tractogram read() {
    read_header();
    read_positions();
    read_offsets();
    std::size_t left_out = 0;
    std::string unknown;
    for (const std::string& path : members_.names()) {
      const auto array = parse_name(path);
      const std::string folder = path.substr(0, path.find('/'));
      const bool top = folder == path;
      if (top && (path == "header.json" || (array && is_line_array(array->name)))) continue;
      if (folder == "dpg" && array) {
        ++left_out;
        continue;
      }
      const bool known = folder == "dpv" || folder == "dps" || folder == "groups";
      if (!known || !array || array->folder != folder) {
        unknown += (unknown.empty() ? "" : ", ") + path;
        continue;
      }
      if (folder == "groups") {
        read_group(path, *array);
      } else {
        read_columns(path, *array, folder == "dpv");
      }
    }
    if (!unknown.empty()) notes_.push_back("left out, for they are no arrays that TRX describes: " + unknown);
    if (left_out > 0) notes_.push_back("numbers of groups (dpg) left out: " + std::to_string(left_out));
    return std::move(lines_);
  }

 private:
  [[noreturn]] void refuse(const std::string& place, const std::string& found,
                           const std::string& expected = "") const {
    throw input_error({file_, place, found, expected, "the file may be damaged or cut off"});
  }

  void read_header() {
    const auto& names = members_.names();
    if (std::find(names.begin(), names.end(), "header.json") == names.end())
      refuse("", "has no header.json", "a TRX folder or zip file");
    const Json header = parse_json(members_.read("header.json"));
    if (!header.is_object()) refuse("header.json", "is no JSON object");
    const auto count = [&](const char* key) {
      const auto value = header.find(key);
      if (value == header.end() || !value->is_number()) refuse("header.json", std::string("has no ") + key);
      // Some writers have 287.0.
      const double number = value->get<double>();
      constexpr double kMost = 0x1p60;
      if (!(number >= 0.0 && number <= kMost) || number != std::floor(number))
        refuse("header.json", std::string(key) + " is " + short_number(number), "a count");
      return static_cast<std::uint64_t>(number);
    };
    point_count_ = count("NB_VERTICES");
    line_count_ = count("NB_STREAMLINES");
    read_image(header);
  }

  /// The image, where the header describes it in full; lines need none.
  void read_image(const Json& header) {
    const auto matrix = header.find("VOXEL_TO_RASMM"), size = header.find("DIMENSIONS");
    if (matrix == header.end() || size == header.end()) return;
    TractogramImage image;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 4; ++column) {
        if (!matrix->is_array() || matrix->size() < 3 || !(*matrix)[row].is_array() ||
            (*matrix)[row].size() != 4 || !(*matrix)[row][column].is_number()) {
          refuse("header.json", "VOXEL_TO_RASMM is no matrix of 4 x 4");
        }
        const double value = (*matrix)[row][column].get<double>();
        (column < 3 ? image.axes[static_cast<int>(column)] : image.origin)[static_cast<int>(row)] = value;
      }
      if (!size->is_array() || size->size() != 3 || !(*size)[row].is_number()) return;
      constexpr double kMost = std::numeric_limits<int>::max();
      image.voxels[static_cast<int>(row)] =
          static_cast<int>(std::clamp((*size)[row].get<double>(), 0.0, kMost));
    }
    lines_.image = image;
  }

  /// The one array of the top folder with that name; none where there is no such one.
  [[nodiscard]] std::optional<std::pair<std::string, ArrayName>> find(const std::string& name) const {
    for (const std::string& path : members_.names()) {
      const auto array = parse_name(path);
      if (array && array->folder.empty() && array->name == name) return std::pair(path, *array);
    }
    return {};
  }

  /// The bytes of a member that holds `tuples` of what its name says.
  [[nodiscard]] std::string read_tuples(const std::string& path, const ArrayName& array,
                                        std::uint64_t tuples) const {
    std::string bytes = members_.read(path);
    const std::size_t tuple = array.components * array.type->size;
    if (bytes.size() % tuple != 0 || bytes.size() / tuple != tuples) {
      refuse(path, "has " + std::to_string(bytes.size()) + " bytes",
             std::to_string(tuples) + " times " + std::to_string(tuple));
    }
    return bytes;
  }

  void read_positions() {
    const auto found = find("positions");
    if (!found || found->second.components != 3) {
      if (point_count_ == 0) return;
      refuse("", "has no positions.3.float32 (or float16, float64)");
    }
    const auto& [path, array] = *found;
    const std::string bytes = read_tuples(path, array, point_count_);
    lines_.points.resize(bytes.size() / (3 * array.type->size));
    for (std::size_t p = 0; p < lines_.points.size(); ++p) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto x = static_cast<float>(array.type->read(bytes, (3 * p + axis) * array.type->size));
        if (!std::isfinite(x)) refuse(path, "point " + std::to_string(p + 1) + " is not finite");
        lines_.points[p][static_cast<int>(axis)] = x;
      }
    }
  }

  void read_offsets() {
    const auto found = find("offsets");
    if (!found) {
      if (line_count_ == 0 && point_count_ == 0) return;
      refuse("", "has no offsets.uint64 (or uint32)");
    }
    const auto& [path, array] = *found;
    const bool whole = array.type->name == "uint64" || array.type->name == "uint32" ||
                       array.type->name == "int64" || array.type->name == "int32";
    if (!whole || array.components != 1) refuse(path, "is of another type", "uint64 or uint32");
    const std::string bytes = members_.read(path);
    const std::size_t entries = bytes.size() / array.type->size;
    if (bytes.size() % array.type->size != 0 || (entries != line_count_ && entries != line_count_ + 1)) {
      refuse(path, "has " + std::to_string(bytes.size()) + " bytes",
             std::to_string(line_count_) + " numbers, or one more");
    }
    if (entries > 0) lines_.starts.clear();
    for (std::size_t l = 0; l < entries; ++l) {
      const double start = array.type->read(bytes, l * array.type->size);
      const double before = l == 0 ? 0.0 : static_cast<double>(lines_.starts.back());
      if (start < before || start > static_cast<double>(point_count_) || (l == 0 && start != 0.0))
        refuse(path, "entry " + std::to_string(l + 1) + " is " + short_number(start), "increasing from 0");
      lines_.starts.push_back(static_cast<std::uint64_t>(start));
    }
    if (entries == line_count_ && entries > 0) lines_.starts.push_back(point_count_);
    if (lines_.starts.back() != point_count_) {
      refuse(path, "ends at point " + std::to_string(lines_.starts.back()), std::to_string(point_count_));
    }
  }

  void read_columns(const std::string& path, const ArrayName& array, bool of_points) {
    const std::string bytes = read_tuples(path, array, of_points ? point_count_ : line_count_);
    auto& columns = of_points ? lines_.of_points : lines_.of_lines;
    const std::size_t tuples = of_points ? lines_.points.size() : lines_.line_count();
    for (std::size_t c = 0; c < array.components; ++c) {
      Tractogram::Column column;
      column.name = array.components > 1 ? array.name + " " + std::to_string(c + 1) : array.name;
      column.values.reserve(tuples);
      for (std::size_t t = 0; t < tuples; ++t) {
        column.values.push_back(
            static_cast<float>(array.type->read(bytes, (t * array.components + c) * array.type->size)));
      }
      columns.push_back(std::move(column));
    }
  }

  void read_group(const std::string& path, const ArrayName& array) {
    const std::string bytes = members_.read(path);
    if (bytes.size() % array.type->size != 0) refuse(path, "has part of a number");
    Tractogram::Column column{.name = "group " + array.name,
                              .values = std::vector<float>(lines_.line_count(), 0.0F)};
    for (std::size_t at = 0; at < bytes.size(); at += array.type->size) {
      const double line = array.type->read(bytes, at);
      if (!(line >= 0.0) || line >= static_cast<double>(lines_.line_count()))
        refuse(path, "names line " + short_number(line), "0 to " + std::to_string(lines_.line_count()));
      column.values[floor_size(line)] = 1.0F;
    }
    lines_.of_lines.push_back(std::move(column));
  }

  std::string file_;
  Members members_;
  std::vector<std::string>& notes_;
  std::uint64_t point_count_ = 0;
  std::uint64_t line_count_ = 0;
  Tractogram lines_;
};

}  // namespace

Tractogram read_trx(const std::filesystem::path& path, std::vector<std::string>& notes) {
  return TrxReader(path, notes).read();
}

}  // namespace palpate
