#include "loaders/meta/meta_header.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/gzip_head.h"
#include "common/load/numbered_files.h"

namespace palpate {
namespace {

constexpr std::size_t kLongestLine = 1000;
constexpr std::size_t kMostPieces = 100'000;
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 50;

bool is_true(std::string_view text) { return text.starts_with('T') || text.starts_with('t') || text == "1"; }

/// MET_LONG has four bytes, whatever machine wrote it; several numbers in one element are its channels.
std::optional<ScalarType> type_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, ScalarType>, 12> kTypes{
      {{"MET_CHAR", ScalarType::kInt8},
       {"MET_UCHAR", ScalarType::kUint8},
       {"MET_SHORT", ScalarType::kInt16},
       {"MET_USHORT", ScalarType::kUint16},
       {"MET_INT", ScalarType::kInt32},
       {"MET_UINT", ScalarType::kUint32},
       {"MET_LONG", ScalarType::kInt32},
       {"MET_ULONG", ScalarType::kUint32},
       {"MET_LONG_LONG", ScalarType::kInt64},
       {"MET_ULONG_LONG", ScalarType::kUint64},
       {"MET_FLOAT", ScalarType::kFloat32},
       {"MET_DOUBLE", ScalarType::kFloat64}}};
  constexpr std::string_view kArray = "_ARRAY";
  if (name.ends_with(kArray)) name.remove_suffix(kArray.size());
  const auto* const found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& type) { return type.first == name; });
  return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

/// What is collected while the lines go by.
struct Fields {
  std::vector<std::string_view> size;
  bool typed = false;
  std::map<std::string, std::string> seen;  ///< what was stated, fields of one meaning by one name
  std::int64_t piece_axes = 0;              ///< of the files of a list; 0: not stated
  bool list = false;                        ///< their names follow
  bool numbered = false;
};

/// Whether a name stands for numbered ones: with one %d in it, a width before the d allowed. Any other % is a
/// character of the name.
bool is_numbered(std::string_view name) {
  const std::size_t percent = name.find('%');
  if (percent == std::string_view::npos || name.find('%', percent + 1) != std::string_view::npos)
    return false;
  const std::size_t end = name.find_first_not_of("0123456789", percent + 1);
  return end != std::string_view::npos && name[end] == 'd';
}

/// "file%03d.raw [FIRST [LAST [STEP]]]", by default as many from 1 on as the last axis has.
void read_numbered(const std::vector<std::string_view>& parts, Fields& fields, MetaHeader& header) {
  if (fields.size.empty()) {
    header.problem = "names numbered files before 'DimSize'";
    return;
  }
  const std::string_view first = parts.size() > 1 ? parts[1] : "1";
  const std::string_view step = parts.size() > 3 ? parts[3] : "1";
  const auto from = parsed<std::int64_t>(first), count = parsed<std::int64_t>(fields.size.back());
  constexpr std::int64_t kMost = std::int64_t{1} << 30;
  const bool counted = from && count && *from > -kMost && *from<kMost&& * count> 0 && *count <= kMost;
  const std::string last = parts.size() > 2 ? std::string(parts[2])
                           : counted        ? std::to_string(*from + *count - 1)
                                            : std::string();
  NumberedFiles files = numbered_files(parts[0], first, last, step, kMostPieces);
  header.problem = std::move(files.problem);
  header.pieces = std::move(files.names);
  fields.numbered = true;
}

void read_data_file(std::string_view value, Fields& fields, MetaHeader& header) {
  const std::vector<std::string_view> parts = words(value);
  if (parts.empty()) {
    header.problem = "'ElementDataFile' names no file";
  } else if (parts[0] == "LIST") {
    fields.list = true;
    std::string_view axes = parts.size() > 1 ? parts[1] : "0";
    if (axes.size() == 2 && (axes[1] == 'D' || axes[1] == 'd')) axes.remove_suffix(1);  // as ITK writes it
    const auto found = parsed<std::int64_t>(axes);
    if (!found || *found < 0 || *found > 4 || parts.size() > 2)
      header.problem = "'ElementDataFile' is '" + std::string(value.substr(0, 40)) + "'";
    fields.piece_axes = found.value_or(0);
  } else if (is_numbered(parts[0]) && parts.size() <= 4) {
    read_numbered(parts, fields, header);
    header.data_file = value;  // taken where a file has that very name
  } else if (value != "LOCAL" && value != "Local" && value != "local") {
    header.data_file = value;
  }
}

/// The key by which fields of one meaning are told from others: MetaIO has several names for some.
std::string_view meaning_of(std::string_view key) {
  if (key == "ElementByteOrderMSB") return "BinaryDataByteOrderMSB";
  if (key == "Rotation" || key == "Orientation") return "TransformMatrix";
  if (key == "Position" || key == "Origin") return "Offset";
  return key;
}

/// Whether a field says something of the voxels, which it can do once only.
bool is_single(std::string_view meaning) {
  constexpr std::array<std::string_view, 14> kSingle{
      "NDims",           "DimSize",        "ElementType",        "ElementNumberOfChannels",
      "BinaryData",      "CompressedData", "CompressedDataSize", "BinaryDataByteOrderMSB",
      "HeaderSize",      "Offset",         "TransformMatrix",    "ElementSpacing",
      "ElementDataFile", "DistanceUnits"};
  return std::find(kSingle.begin(), kSingle.end(), meaning) != kSingle.end();
}

std::vector<double> numbers_in(std::string_view key, std::string_view value, MetaHeader& header) {
  std::vector<double> numbers;
  for (const std::string_view word : words(value)) {
    const auto found = number(word);
    if (!found || !std::isfinite(*found))
      header.problem = "'" + std::string(key) + "' holds '" + std::string(word.substr(0, 40)) + "'";
    numbers.push_back(found.value_or(0.0));
  }
  return numbers;
}

void read_field(std::string_view key, std::string_view value, Fields& fields, MetaHeader& header) {
  const auto count = [&](std::int64_t least, std::int64_t most) {
    const auto found = parsed<std::int64_t>(value);
    if (found && *found >= least && *found <= most) return *found;
    header.problem = std::string("'").append(key) + "' is '" + std::string(value.substr(0, 40)) + "'";
    return least;
  };
  constexpr std::int64_t kMostChannels = 4096;
  if (key == "NDims") {
    header.axes = static_cast<int>(count(1, 10));
  } else if (key == "DimSize") {
    fields.size = words(value);
  } else if (key == "ElementType") {
    const auto type = type_of(value);
    fields.typed = true;
    header.type = type.value_or(header.type);
    header.is_long = value == "MET_LONG" || value == "MET_ULONG";
    if (!type)
      header.problem = "has values of type '" + std::string(value.substr(0, 40)) + "', expected numbers";
  } else if (key == "ElementNumberOfChannels") {
    header.channels = static_cast<int>(count(1, kMostChannels));
  } else if (key == "BinaryData") {
    header.binary = is_true(value);
  } else if (key == "BinaryDataByteOrderMSB" || key == "ElementByteOrderMSB") {
    header.big_endian = is_true(value);
  } else if (key == "CompressedData") {
    header.compressed = is_true(value);
  } else if (key == "CompressedDataSize") {
    header.compressed_bytes = static_cast<std::uint64_t>(count(0, static_cast<std::int64_t>(kMaxBytes)));
  } else if (key == "HeaderSize") {
    header.skip = count(-1, static_cast<std::int64_t>(kMaxBytes));
  } else if (key == "TransformMatrix" || key == "Rotation" || key == "Orientation") {
    header.matrix = numbers_in(key, value, header);
  } else if (key == "Offset" || key == "Position" || key == "Origin") {
    header.offset = numbers_in(key, value, header);
  } else if (key == "ElementSpacing") {
    header.spacing = numbers_in(key, value, header);
  } else if (key == "ElementSize") {
    header.element_size = numbers_in(key, value, header);
  } else if (key == "AnatomicalOrientation") {
    header.orientation = value;
  } else if (key == "DistanceUnits") {
    header.units = value;
  } else if (key == "ElementToIntensityFunctionSlope" || key == "ElementToIntensityFunctionOffset") {
    const auto found = number(value);
    const double nothing = key.ends_with("Slope") ? 1.0 : 0.0;
    header.intensity_function = header.intensity_function || (found && *found != nothing);
  } else if (key == "ElementDataFile") {
    read_data_file(value, fields, header);
  }
}

void combine(const Fields& fields, MetaHeader& header) {
  const auto axes = as_size(header.axes);
  const auto wrong_count = [&](const std::vector<double>& numbers, std::size_t count) {
    return !numbers.empty() && numbers.size() != count;
  };
  if (header.axes < 2 || header.axes > 4) {
    header.problem = "has " + std::to_string(header.axes) + " axes, expected 2, 3, or 4 with time";
  } else if (fields.size.size() != axes) {
    header.problem = "'DimSize' names " + std::to_string(fields.size.size()) + " counts for " +
                     std::to_string(header.axes) + " axes";
  } else if (!fields.typed) {
    header.problem = "has no field 'ElementType'";
  } else if (wrong_count(header.matrix, axes * axes) || wrong_count(header.offset, axes) ||
             wrong_count(header.spacing, axes)) {
    header.problem = "has not as many numbers in 'TransformMatrix', 'Offset' or 'ElementSpacing' as its " +
                     std::to_string(header.axes) + " axes need";
  }
  // As MetaIO has it: elements lie beside one another where nothing else is said.
  if (header.spacing.empty() && header.element_size.size() == axes) {
    header.spacing = header.element_size;
    header.spaced_by_size = true;
  }
  if (!header.problem.empty()) return;
  constexpr std::int64_t kMostVoxels = std::int64_t{1} << 30;
  for (std::size_t axis = 0; axis < fields.size.size(); ++axis) {
    const auto found = parsed<std::int64_t>(fields.size[axis]);
    if (!found || *found < 1 || *found > kMostVoxels) {
      header.problem = "'DimSize' holds '" + std::string(fields.size[axis].substr(0, 40)) + "'";
      return;
    }
    header.size[axis] = static_cast<std::uint64_t>(*found);
  }
  constexpr std::uint64_t kMostSteps = 1'000'000;
  if (header.size[3] > kMostSteps) header.problem = "has " + std::to_string(header.size[3]) + " time steps";
  if (header.compressed && header.skip < 0) header.problem = "has packed voxels, and 'HeaderSize' is -1";
  if (!fields.list && !fields.numbered) return;
  const bool stated = fields.piece_axes > 0 && fields.piece_axes <= header.axes;
  header.piece_count = 1;
  for (std::int64_t axis = stated ? fields.piece_axes : header.axes - 1; axis < header.axes; ++axis) {
    header.piece_count = std::min(header.piece_count * header.size[as_size(axis)], kMaxBytes >> 10U);
  }
  if (header.compressed || !header.binary) {
    header.problem = "has its voxels in a list of files, and not as plain bytes there";
  } else if (header.pieces.size() != header.piece_count) {
    header.problem = "names " + std::to_string(header.pieces.size()) + " files of voxels, expected " +
                     std::to_string(header.piece_count);
  }
}

}  // namespace

MetaHeader read_meta_header(std::string_view head) {
  MetaHeader header;
  Fields fields;
  bool ended = false;
  std::size_t at = 0;
  while (at < head.size() && header.problem.empty() && (!ended || fields.list)) {
    const std::size_t end = std::min(head.find('\n', at), head.size());
    const std::string_view line = head.substr(at, end - at);
    at = std::min(end + 1, head.size());
    if (line.size() > kLongestLine) {
      header.problem = "has a line of " + std::to_string(line.size()) + " bytes in its header";
      break;
    }
    if (ended) {
      if (trimmed(line).empty()) continue;
      header.pieces.emplace_back(trimmed(line));
      if (header.pieces.size() > kMostPieces) header.problem = "names too many data files";
      continue;
    }
    const std::size_t equals = line.find_first_of("=:");
    if (equals == std::string_view::npos) continue;
    const std::string_view key = trimmed(line.substr(0, equals));
    const std::string meaning(meaning_of(key));
    const std::string value(trimmed(line.substr(equals + 1)));
    const auto before = fields.seen.find(meaning);
    if (before != fields.seen.end() && before->second != value && is_single(meaning))
      header.problem = "states '" + meaning + "' twice, as '" + before->second.substr(0, 40) + "' and '" +
                       value.substr(0, 40) + "'";
    fields.seen.emplace(meaning, value);
    if (header.problem.empty()) read_field(key, trimmed(line.substr(equals + 1)), fields, header);
    ended = key == "ElementDataFile";
  }
  header.header_bytes = at;
  if (header.problem.empty() && !ended) header.problem = "its header does not name 'ElementDataFile'";
  if (header.problem.empty()) combine(fields, header);
  return header;
}

std::string meta_size_problem(const MetaHeader& header, std::uint64_t available) {
  std::uint64_t bytes = header.bytes_per_voxel();
  bool huge = false;
  for (const std::uint64_t size : header.size) huge = huge || __builtin_mul_overflow(bytes, size, &bytes);
  huge = huge || bytes > kMaxBytes;
  std::uint64_t possible = available;
  if (header.compressed) {
    possible = std::min(available, kMaxBytes) * kGzipRatio;
  } else if (!header.binary) {
    possible = (available / 2 + 1) * byte_size(header.type);  // a digit and a separator make a value
  }
  if (!huge && bytes <= possible) return "";
  return "claims " + (huge ? std::string("over 2^50") : std::to_string(bytes)) +
         " bytes of voxels, but there are " + std::to_string(available) +
         (header.compressed ? " packed" : "");
}

}  // namespace palpate
