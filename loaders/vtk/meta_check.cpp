#include "loaders/vtk/meta_check.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <zlib.h>

#include "common/base/error.h"
#include "common/base/mapped_file.h"
#include "common/base/text.h"
#include "common/load/find_format.h"
#include "common/load/gzip_head.h"
#include "common/load/numbered_files.h"

namespace palpate {
namespace {

constexpr std::size_t kMetaHeadBytes = std::size_t{4} << 20;  // with a long list of files
constexpr std::size_t kLongestLine = 1000;
constexpr std::size_t kMostPieces = 100'000;
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 50;

bool is_true(std::string_view text) { return text.starts_with('T') || text.starts_with('t') || text == "1"; }

/// Bytes of one value of a MetaImage type that is read, or 0.
std::uint64_t bytes_of_type(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::uint64_t>, 10> kTypes{{{"MET_CHAR", 1},
                                                                               {"MET_UCHAR", 1},
                                                                               {"MET_SHORT", 2},
                                                                               {"MET_USHORT", 2},
                                                                               {"MET_INT", 4},
                                                                               {"MET_UINT", 4},
                                                                               {"MET_LONG_LONG", 8},
                                                                               {"MET_ULONG_LONG", 8},
                                                                               {"MET_FLOAT", 4},
                                                                               {"MET_DOUBLE", 8}}};
  const auto* const found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& type) { return type.first == name; });
  return found == kTypes.end() ? 0 : found->second;
}

/// What is collected while the lines go by.
struct Fields {
  std::int64_t axes = 0;
  std::vector<std::string_view> size;
  std::uint64_t bytes = 0;
  std::int64_t channels = 1;
  std::int64_t piece_axes = 0;  ///< of the files of a list; 0: not stated
  bool list = false;            ///< their names follow
  bool numbered = false;
};

/// "file%03d.raw [FIRST [LAST [STEP]]]", by default as many from 1 on as the last axis has. The names are
/// made when that is known.
void read_numbered(const std::vector<std::string_view>& parts, Fields& fields, MetaClaims& claims) {
  if (fields.size.empty()) {
    claims.problem = "names numbered files before 'DimSize'";
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
  claims.problem = std::move(files.problem);
  claims.pieces = std::move(files.names);
  fields.numbered = true;
}

void read_data_file(std::string_view value, Fields& fields, MetaClaims& claims) {
  const std::vector<std::string_view> parts = words(value);
  if (parts.empty()) {
    claims.problem = "'ElementDataFile' names no file";
  } else if (parts[0] == "LIST") {
    fields.list = true;
    const auto axes = parts.size() > 1 ? parsed<std::int64_t>(parts[1]) : std::optional<std::int64_t>(0);
    if (!axes || *axes < 0 || *axes > 3 || parts.size() > 2)
      claims.problem = "'ElementDataFile' is '" + std::string(value.substr(0, 40)) + "'";
    fields.piece_axes = axes.value_or(0);
  } else if (parts[0].find('%') != std::string_view::npos && parts.size() <= 4) {
    read_numbered(parts, fields, claims);
  } else if (value != "LOCAL" && value != "Local" && value != "local") {
    claims.data_file = value;
  }
}

void read_field(std::string_view key, std::string_view value, Fields& fields, MetaClaims& claims) {
  const auto count = [&](std::int64_t least, std::int64_t most) {
    const auto found = parsed<std::int64_t>(value);
    if (found && *found >= least && *found <= most) return *found;
    claims.problem = std::string("'").append(key) + "' is '" + std::string(value.substr(0, 40)) + "'";
    return least;
  };
  constexpr std::int64_t kMostChannels = 4096;
  if (key == "NDims") {
    fields.axes = count(1, 10);
  } else if (key == "DimSize") {
    fields.size = words(value);
  } else if (key == "ElementType") {
    fields.bytes = bytes_of_type(value);
    if (fields.bytes == 0)
      claims.problem = "has values of type '" + std::string(value.substr(0, 40)) + "', expected numbers";
  } else if (key == "ElementNumberOfChannels") {
    fields.channels = count(1, kMostChannels);
  } else if (key == "BinaryData") {
    claims.binary = is_true(value);
  } else if (key == "CompressedData") {
    claims.compressed = is_true(value);
  } else if (key == "CompressedDataSize") {
    claims.compressed_bytes = static_cast<std::uint64_t>(count(0, static_cast<std::int64_t>(kMaxBytes)));
  } else if (key == "HeaderSize") {
    claims.skip = count(-1, static_cast<std::int64_t>(kMaxBytes));
  } else if (key == "ElementDataFile") {
    read_data_file(value, fields, claims);
  }
}

void combine(const Fields& fields, MetaClaims& claims) {
  if (fields.axes < 2 || fields.axes > 3) {
    claims.problem = "has " + std::to_string(fields.axes) + " axes, expected 3";
  } else if (fields.size.size() != static_cast<std::size_t>(fields.axes)) {
    claims.problem = "'DimSize' names " + std::to_string(fields.size.size()) + " counts for " +
                     std::to_string(fields.axes) + " axes";
  } else if (fields.bytes == 0) {
    claims.problem = "has no field 'ElementType'";
  }
  if (!claims.problem.empty()) return;
  constexpr std::int64_t kMostVoxels = std::int64_t{1} << 30;
  for (std::size_t axis = 0; axis < fields.size.size(); ++axis) {
    const auto found = parsed<std::int64_t>(fields.size[axis]);
    if (!found || *found < 1 || *found > kMostVoxels) {
      claims.problem = "'DimSize' holds '" + std::string(fields.size[axis].substr(0, 40)) + "'";
      return;
    }
    claims.size[axis] = static_cast<std::uint64_t>(*found);
  }
  claims.bytes_per_voxel = fields.bytes * static_cast<std::uint64_t>(fields.channels);
  if (!fields.list && !fields.numbered) return;
  const bool stated = fields.piece_axes > 0 && fields.piece_axes <= fields.axes;
  claims.piece_count = 1;
  for (std::int64_t axis = stated ? fields.piece_axes : fields.axes - 1; axis < fields.axes; ++axis)
    claims.piece_count *= claims.size[static_cast<std::size_t>(axis)];  // 2^30 each, of two at most
  if (claims.compressed || !claims.binary) {
    claims.problem = "has its voxels in a list of files, and not as plain bytes there";
  } else if (claims.pieces.size() != claims.piece_count) {
    claims.problem = "names " + std::to_string(claims.pieces.size()) + " files of voxels, expected " +
                     std::to_string(claims.piece_count);
  }
}

// Relative names start from the header's folder.
std::string beside(const std::string& file, const std::string& name) {
  return (std::filesystem::path(file).parent_path() / name).string();
}

/// Of each piece, without what is passed over. @pre meta_size_problem() of all of it is empty.
std::uint64_t piece_bytes(const MetaClaims& claims) {
  return claims.bytes_per_voxel * claims.size[0] * claims.size[1] * claims.size[2] / claims.piece_count;
}

void check_pieces(const MetaClaims& claims, const std::string& file) {
  std::uint64_t there = 0;
  std::vector<std::uint64_t> sizes;
  for (const std::string& name : claims.pieces) {
    try {
      sizes.push_back(read_head(beside(file, name), 0).file_size);
    } catch (const Error& error) {
      throw input_error({file, "ElementDataFile", error.what()});
    }
    there += sizes.back();
  }
  const std::string problem = meta_size_problem(claims, there);
  if (!problem.empty()) throw input_error({file, "", problem, "", "the file may be truncated"});
  const std::uint64_t wanted = piece_bytes(claims);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::uint64_t skip = claims.skip > 0 ? static_cast<std::uint64_t>(claims.skip) : 0;
    const bool right = sizes[i] >= wanted && (claims.skip < 0 || sizes[i] - wanted == skip);
    if (right) continue;
    throw input_error(
        {file, "ElementDataFile", claims.pieces[i] + " has " + std::to_string(sizes[i]) + " bytes",
         std::to_string(wanted) + " of voxels behind " + std::to_string(skip) + " of HeaderSize",
         "HeaderSize = -1 takes the last ones of each file"});
  }
}

/// Where the voxels lie: the file, and how many bytes of it are before them.
struct VoxelPlace {
  std::string file;
  std::uint64_t offset = 0;
};

VoxelPlace place_of(const MetaClaims& claims, const std::string& file) {
  if (claims.data_file.empty()) return {file, claims.header_bytes};
  return {beside(file, claims.data_file), claims.skip > 0 ? static_cast<std::uint64_t>(claims.skip) : 0};
}

MetaClaims claims_of(const std::string& file) {
  MetaClaims claims = read_meta_claims(read_head(file, kMetaHeadBytes).bytes);
  if (!claims.problem.empty())
    throw input_error({file, "header", claims.problem, "", "the file may be damaged"});
  return claims;
}

}  // namespace

MetaClaims read_meta_claims(std::string_view head) {
  MetaClaims claims;
  Fields fields;
  bool ended = false;
  std::size_t at = 0;
  while (at < head.size() && claims.problem.empty() && (!ended || fields.list)) {
    const std::size_t end = std::min(head.find('\n', at), head.size());
    const std::string_view line = head.substr(at, end - at);
    at = std::min(end + 1, head.size());
    if (line.size() > kLongestLine) {
      claims.problem = "has a line of " + std::to_string(line.size()) + " bytes in its header";
      break;
    }
    if (ended) {
      if (trimmed(line).empty()) continue;
      claims.pieces.emplace_back(trimmed(line));
      if (claims.pieces.size() > kMostPieces) claims.problem = "names too many data files";
      continue;
    }
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) continue;
    const std::string_view key = trimmed(line.substr(0, equals));
    read_field(key, trimmed(line.substr(equals + 1)), fields, claims);
    ended = key == "ElementDataFile";
  }
  claims.header_bytes = at;
  if (claims.problem.empty() && !ended) claims.problem = "its header does not name 'ElementDataFile'";
  if (claims.problem.empty()) combine(fields, claims);
  return claims;
}

std::string meta_size_problem(const MetaClaims& claims, std::uint64_t available) {
  std::uint64_t bytes = claims.bytes_per_voxel;
  bool huge = false;
  for (const std::uint64_t size : claims.size) huge = huge || __builtin_mul_overflow(bytes, size, &bytes);
  huge = huge || bytes > kMaxBytes;
  std::uint64_t possible = available;
  if (claims.compressed) {
    possible = std::min(available, kMaxBytes) * kGzipRatio;
    if (claims.compressed_bytes > available)
      return "claims " + std::to_string(claims.compressed_bytes) + " packed bytes, but there are " +
             std::to_string(available);
  } else if (!claims.binary) {
    possible = (available / 2 + 1) * claims.bytes_per_voxel;  // a digit and a separator make a value
  }
  if (!huge && bytes <= possible) return "";
  return "claims " + (huge ? std::string("over 2^50") : std::to_string(bytes)) +
         " bytes of voxels, but there are " + std::to_string(available) +
         (claims.compressed ? " packed" : "");
}

std::vector<std::byte> read_meta_pieces(const std::string& file) {
  const MetaClaims claims = claims_of(file);
  std::vector<std::byte> voxels;
  if (claims.piece_count == 0) return voxels;
  check_pieces(claims, file);
  const std::uint64_t bytes = piece_bytes(claims);
  voxels.reserve(bytes * claims.piece_count);
  for (const std::string& name : claims.pieces) {
    const MappedFile mapped(beside(file, name));
    const std::string_view text = mapped.text();
    const std::uint64_t skip =
        claims.skip >= 0 ? static_cast<std::uint64_t>(claims.skip) : text.size() - bytes;
    if (text.size() < bytes || text.size() - bytes < skip)
      throw input_error(
          {file, "ElementDataFile", name + " has changed while it was read", "", "open it again"});
    const auto part = std::as_bytes(std::span(text.substr(skip, bytes)));
    voxels.insert(voxels.end(), part.begin(), part.end());
  }
  return voxels;
}

void check_meta(const std::string& file) {
  const MetaClaims claims = claims_of(file);
  if (claims.piece_count > 0) return check_pieces(claims, file);
  const VoxelPlace place = place_of(claims, file);
  std::uint64_t there = 0;
  try {
    there = read_head(place.file, 0).file_size;
  } catch (const Error& error) {
    if (claims.data_file.empty()) throw;
    throw input_error({file, "ElementDataFile", error.what()});
  }
  const std::string problem = meta_size_problem(claims, there - std::min(there, place.offset));
  if (!problem.empty()) throw input_error({file, "", problem, "", "the file may be truncated"});
}

void check_meta_stream(const std::string& file) {
  const MetaClaims claims = claims_of(file);
  if (!claims.compressed) return;
  const VoxelPlace place = place_of(claims, file);
  const MappedFile mapped(place.file);
  std::string_view packed = mapped.text().substr(std::min<std::size_t>(place.offset, mapped.text().size()));
  z_stream stream{};
  constexpr int kAnyWrapper = 32;  // added to the size of the window: zlib's or gzip's header
  if (inflateInit2(&stream, MAX_WBITS + kAnyWrapper) != Z_OK) throw work_error("zlib cannot be started");
  std::vector<unsigned char> out(std::size_t{256} << 10);
  std::uint64_t unpacked = 0;
  int state = Z_OK;
  while (state == Z_OK) {
    if (stream.avail_in == 0 && !packed.empty()) {
      const std::size_t part = std::min(packed.size(), std::size_t{1} << 20);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
      stream.avail_in = static_cast<uInt>(part);
      packed.remove_prefix(part);
    }
    stream.next_out = out.data();
    stream.avail_out = static_cast<uInt>(out.size());
    state = inflate(&stream, Z_NO_FLUSH);
    unpacked += out.size() - stream.avail_out;
  }
  inflateEnd(&stream);
  const std::uint64_t wanted = claims.bytes_per_voxel * claims.size[0] * claims.size[1] * claims.size[2];
  if (state == Z_STREAM_END && unpacked >= wanted) return;
  throw input_error({file, "", "only " + std::to_string(unpacked) + " bytes of voxels can be unpacked",
                     std::to_string(wanted), "the file may be truncated"});
}

}  // namespace palpate
