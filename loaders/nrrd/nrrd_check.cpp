#include "loaders/nrrd/nrrd_check.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <type_traits>
#include <utility>

#include <zlib.h>
#ifdef PALPATE_WITH_BZIP2
#include <bzlib.h>
#endif

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/find_format.h"
#include "common/load/gzip_head.h"
#include "common/load/numbered_files.h"
#include "common/load/voxel_bytes.h"

namespace palpate {
namespace {

/// Headers with tens of thousands of key/value pairs still fit.
constexpr std::size_t kHeadBytes = std::size_t{4} << 20;
constexpr std::size_t kMaxAxes = 16;
constexpr std::size_t kMaxDataFiles = 100'000;
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 50;

/// How far bzip2 compresses at best (runs of one byte): some 45 000 : 1. For deflate see gzip_head.h.
constexpr std::uint64_t kBzip2Ratio = 50'000;

/// A NRRD type by any of its names; none of others.
std::optional<ScalarType> type_of(const std::string& name) {
  struct Type {
    ScalarType type;
    std::array<std::string_view, 8> names;
  };
  static constexpr std::array<Type, 10> kTypes{{
      {ScalarType::kInt8, {"signed char", "int8", "int8_t"}},
      {ScalarType::kUint8, {"uchar", "unsigned char", "uint8", "uint8_t"}},
      {ScalarType::kInt16, {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
      {ScalarType::kUint16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
      {ScalarType::kInt32, {"int", "signed int", "int32", "int32_t"}},
      {ScalarType::kUint32, {"uint", "unsigned int", "uint32", "uint32_t"}},
      {ScalarType::kInt64,
       {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64",
        "int64_t"}},
      {ScalarType::kUint64,
       {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}},
      {ScalarType::kFloat32, {"float"}},
      {ScalarType::kFloat64, {"double"}},
  }};
  for (const Type& type : kTypes) {
    if (!name.empty() && std::find(type.names.begin(), type.names.end(), name) != type.names.end())
      return type.type;
  }
  return std::nullopt;
}

template <typename T>
bool holds(std::string_view word) {
  if constexpr (std::is_integral_v<T>) {
    if (word.starts_with('+')) word.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size();
  } else {
    if (number(word)) return true;
    // Too small for a double is zero.
    double value = 1.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc::result_out_of_range && end == word.data() + word.size() &&
           word.find("e-") != std::string_view::npos;
  }
}

bool holds(ScalarType type, std::string_view word) {
  switch (type) {
    case ScalarType::kInt8:
      return holds<std::int8_t>(word);
    case ScalarType::kUint8:
      return holds<std::uint8_t>(word);
    case ScalarType::kInt16:
      return holds<std::int16_t>(word);
    case ScalarType::kUint16:
      return holds<std::uint16_t>(word);
    case ScalarType::kInt32:
      return holds<std::int32_t>(word);
    case ScalarType::kUint32:
      return holds<std::uint32_t>(word);
    case ScalarType::kInt64:
      return holds<std::int64_t>(word);
    case ScalarType::kUint64:
      return holds<std::uint64_t>(word);
    default:
      return holds<double>(word);
  }
}

/// A count; the largest number where it is larger than that.
std::optional<std::uint64_t> count_in(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) return ~std::uint64_t{0};
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// "name%03d.raw 1 20 1 [subdim]": the names that it stands for.
void add_numbered(const std::vector<std::string_view>& parts, NrrdClaims& claims) {
  NumberedFiles files = numbered_files(parts[0], parts[1], parts[2], parts[3], kMaxDataFiles);
  claims.problem = std::move(files.problem);
  claims.data_files.insert(claims.data_files.end(), files.names.begin(), files.names.end());
}

void read_field(const std::string& field, const std::string& value, NrrdClaims& claims, bool& list_follows) {
  if (field == "sizes") {
    claims.sizes.clear();
    for (const std::string_view word : words(value)) {
      const auto size = count_in(word);
      if (!size || *size == 0) {
        claims.problem = "'sizes' holds '" + std::string(word.substr(0, 40)) + "', expected counts above 0";
        return;
      }
      claims.sizes.push_back(*size);
    }
    if (claims.sizes.empty() || claims.sizes.size() > kMaxAxes)
      claims.problem = "'sizes' names no axes, or too many";
  } else if (field == "type") {
    claims.type = type_of(lowered(value));
    claims.bytes_per_value = claims.type ? byte_size(*claims.type) : 0;
    if (!claims.type) claims.problem = "has values of type '" + value.substr(0, 40) + "', expected numbers";
  } else if (field == "encoding") {
    claims.encoding = lowered(value);
  } else if (field == "byte skip" || field == "byteskip" || field == "line skip" || field == "lineskip") {
    claims.skips = claims.skips || value != "0";
    (field.starts_with("line") ? claims.line_skip : claims.byte_skip) = count_in(value).value_or(0);
    if (field.starts_with("byte")) claims.from_end = value.starts_with("-");
  } else if (field == "data file" || field == "datafile") {
    claims.detached = true;
    const std::vector<std::string_view> parts = words(value);
    if (!parts.empty() && parts[0] == "LIST") {
      list_follows = true;
    } else if (parts.size() >= 4 && parts[0].find('%') != std::string::npos) {
      add_numbered(parts, claims);
    } else {
      claims.data_files.push_back(value);
    }
  }
}

}  // namespace

NrrdClaims read_nrrd_claims(std::string_view head) {
  NrrdClaims claims;
  std::size_t at = 0;
  bool first = true;
  bool list_follows = false;
  bool ended = false;
  while (at < head.size() && claims.problem.empty()) {
    const std::size_t end = std::min(head.find('\n', at), head.size());
    const std::string_view line = trimmed(head.substr(at, end - at));
    at = std::min(end + 1, head.size());
    if (first) {
      first = false;  // the magic
      continue;
    }
    if (list_follows) {
      if (line.empty()) continue;
      claims.data_files.emplace_back(line);
      if (claims.data_files.size() > kMaxDataFiles) claims.problem = "names too many data files";
      continue;
    }
    if (line.empty()) {  // ends the header; attached data follows
      ended = true;
      break;
    }
    // "field: value"; comments begin with #, key/value pairs have ":=".
    const std::size_t colon = line.find(": ");
    if (line.front() == '#' || colon == std::string::npos) continue;
    read_field(lowered(line.substr(0, colon)), std::string(trimmed(line.substr(colon + 2))), claims,
               list_follows);
  }
  claims.header_bytes = at;
  if (!claims.problem.empty()) return claims;
  if (claims.sizes.empty()) claims.problem = "has no field 'sizes'";
  if (claims.bytes_per_value == 0) claims.problem = "has no field 'type'";
  if (!claims.detached && !ended) claims.problem = "its header does not end, and names no data file";
  return claims;
}

std::string nrrd_size_problem(const NrrdClaims& claims, std::uint64_t available) {
  std::uint64_t values = 1;
  bool huge = false;
  for (const std::uint64_t size : claims.sizes) huge = huge || __builtin_mul_overflow(values, size, &values);
  std::uint64_t bytes = 0;
  huge = huge || __builtin_mul_overflow(values, claims.bytes_per_value, &bytes) || bytes > kMaxBytes;
  std::uint64_t possible = available;
  std::string encoded = claims.encoding;
  if (encoded == "gz" || encoded == "gzip") {
    possible = std::min(available, kMaxBytes) * kGzipRatio;
  } else if (encoded == "bz2" || encoded == "bzip2") {
    possible = std::min(available, kMaxBytes >> 6) * kBzip2Ratio;
  } else if (encoded == "txt" || encoded == "text" || encoded == "ascii") {
    possible = (available / 2 + 1) * claims.bytes_per_value;  // a digit and a separator make a value
  } else if (encoded == "hex") {
    possible = available / 2;
  } else if (encoded != "raw") {
    return "has the unknown encoding '" + encoded.substr(0, 40) + "'";
  }
  if (!huge && bytes <= possible) return "";
  return "claims " + (huge ? std::string("over 2^50") : std::to_string(bytes)) +
         " bytes of values, but there are " + std::to_string(available) + " bytes of " + encoded + " data";
}

NrrdWords words_of(std::string_view text, ScalarType type, std::uint64_t wanted) {
  constexpr std::string_view kBlanks = " \t\r\n\v\f";
  NrrdWords words;
  for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    std::string_view word = text.substr(at, end - at);
    at = text.find_first_not_of(kBlanks, end);
    word.remove_prefix(std::min(word.find_first_not_of(','), word.size()));
    while (word.ends_with(',')) word.remove_suffix(1);
    if (word.empty()) continue;
    // What stands behind the numbers is nobody's business, unless it is one more.
    const bool good = holds(type, word);
    if (words.count == wanted) {
      words.count += good ? 1 : 0;
      return words;
    }
    if (!good) {
      words.wrong = word.substr(0, 40);
      return words;
    }
    ++words.count;
  }
  return words;
}

namespace {

/// Data without what the header says is to be passed over.
std::string_view after_skips(std::string_view text, const NrrdClaims& claims) {
  for (std::uint64_t line = 0; line < claims.line_skip && !text.empty(); ++line)
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  return text.substr(std::min<std::uint64_t>(claims.byte_skip, text.size()));
}

/// How many bytes stand behind the values of raw data: a value too many, or bytes in front, would move all.
std::string raw_rest(const std::string& name, std::uint64_t first, const NrrdClaims& claims,
                     std::uint64_t wanted) {
  const MappedFile mapped(name);
  const std::string_view data =
      after_skips(mapped.text().substr(std::min<std::uint64_t>(mapped.text().size(), first)), claims);
  if (data.size() <= wanted) return {};
  return counted(data.size() - wanted, "byte") + " behind the voxels left unread" +
         (claims.skips ? "" : ": if they belong before them, state a byte skip");
}

std::string behind_voxels(std::uint64_t bytes) {
  return counted(bytes, "byte") + " behind the voxels left unread";
}

/// The same of data whose bytes are two digits each; what is no digit counts for nothing.
std::string hex_rest(const std::string& name, std::uint64_t first, const NrrdClaims& claims,
                     std::uint64_t wanted) {
  const MappedFile mapped(name);
  const std::string_view data =
      after_skips(mapped.text().substr(std::min<std::uint64_t>(mapped.text().size(), first)), claims);
  const auto digits = static_cast<std::uint64_t>(
      std::ranges::count_if(data, [](unsigned char c) { return std::isxdigit(c) != 0; }));
  return digits / 2 > wanted ? behind_voxels(digits / 2 - wanted) : std::string();
}

/// The same of bzip2 data, of which a little more than `wanted` is unpacked at most.
std::string bzip2_rest(const std::string& name, std::uint64_t first, std::uint64_t wanted) {
#ifdef PALPATE_WITH_BZIP2
  const MappedFile mapped(name);
  std::string_view data = mapped.text().substr(std::min<std::uint64_t>(mapped.text().size(), first));
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) return {};
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  std::vector<char> out(kPiece);
  std::uint64_t unpacked = 0;
  int state = BZ_OK;
  while (state == BZ_OK && unpacked <= wanted && !(data.empty() && stream.avail_in == 0)) {
    if (stream.avail_in == 0) {
      stream.next_in = const_cast<char*>(data.data());
      stream.avail_in = static_cast<unsigned>(std::min(data.size(), kPiece));
      data.remove_prefix(stream.avail_in);
    }
    stream.next_out = out.data();
    stream.avail_out = static_cast<unsigned>(kPiece);
    state = BZ2_bzDecompress(&stream);
    unpacked += kPiece - stream.avail_out;
  }
  BZ2_bzDecompressEnd(&stream);
  return unpacked > wanted ? "the bzip2 data hold more than the voxels, which is left unread" : std::string();
#else
  (void)name, (void)first, (void)wanted;
  return "what stands behind the voxels in bzip2 data was not looked at";
#endif
}

/// Text in one file or several. @throws Error (bad input) where Teem would take its words for other numbers.
void check_text(const std::string& file, const NrrdClaims& claims, const std::vector<std::string>& names,
                std::uint64_t wanted) {
  std::uint64_t found = 0;
  for (const std::string& name : names) {
    const MappedFile mapped(name);
    const std::uint64_t first = claims.detached ? 0 : claims.header_bytes;
    const NrrdWords words = words_of(
        after_skips(mapped.text().substr(std::min<std::uint64_t>(mapped.text().size(), first)), claims),
        *claims.type, wanted - found);
    if (words.wrong) {
      throw input_error(
          {name, "value " + std::to_string(found + words.count), "is '" + *words.wrong + "'",
           "a number that the type of the header holds as it is written",
           "write whole numbers without points and exponents, others with points, or state another type"});
    }
    found += words.count;
    if (found > wanted) {
      throw input_error({file, "",
                         "has more numbers as text than the " + std::to_string(wanted) + " of the header", "",
                         "one too many moves all behind it"});
    }
  }
}

}  // namespace

std::string check_nrrd(const std::string& file) {
  const HeadOfFile head = read_head(file, kHeadBytes);
  NrrdClaims claims = read_nrrd_claims(head.bytes);
  if (!claims.problem.empty())
    throw input_error({file, "header", claims.problem, "", "the file may be damaged"});
  std::uint64_t available = head.file_size - claims.header_bytes;
  if (claims.detached) {
    if (claims.data_files.empty()) throw input_error({file, "header", "names no data file"});
    available = 0;
    for (const std::string& name : claims.data_files) {
      // Relative names start from the header's folder.
      const std::filesystem::path path = std::filesystem::path(file).parent_path() / name;
      try {
        available += read_head(path, 0).file_size;
      } catch (const Error& error) {
        throw input_error({file, "data file", error.what()});
      }
    }
  }
  const std::string problem = nrrd_size_problem(claims, available);
  if (!problem.empty()) throw input_error({file, "", problem, "", "the file may be truncated"});
  std::uint64_t wanted = claims.bytes_per_value;  // does not overflow: nrrd_size_problem()
  for (const std::uint64_t size : claims.sizes) wanted *= size;
  const std::string& encoding = claims.encoding;
  const bool text = encoding == "txt" || encoding == "text" || encoding == "ascii";
  if (text) {
    std::vector<std::string> names;
    for (const std::string& name : claims.data_files)
      names.push_back((std::filesystem::path(file).parent_path() / name).string());
    if (!claims.detached) names = {file};
    check_text(file, claims, names, wanted / claims.bytes_per_value);
    if (names.size() == 1) return text_end_note(names.front());
  }
  if (encoding == "raw" && claims.from_end && available > wanted)
    return taken_from_end_note(available - wanted);
  if (encoding == "raw" && !claims.from_end && claims.data_files.size() <= 1) {
    const std::filesystem::path data =
        claims.detached ? std::filesystem::path(file).parent_path() / claims.data_files.front()
                        : std::filesystem::path(file);
    return raw_rest(data.string(), claims.detached ? 0 : claims.header_bytes, claims, wanted);
  }
  const std::string only =
      !claims.detached ? file
      : claims.data_files.size() == 1
          ? (std::filesystem::path(file).parent_path() / claims.data_files.front()).string()
          : std::string();
  const std::uint64_t first = claims.detached ? 0 : claims.header_bytes;
  if (encoding == "hex" && !only.empty() && !claims.from_end) return hex_rest(only, first, claims, wanted);
  if ((encoding == "bz2" || encoding == "bzip2") && !only.empty() && !claims.skips)
    return bzip2_rest(only, first, wanted);
  const bool gzip = claims.encoding == "gz" || claims.encoding == "gzip";
  if (!gzip || claims.skips || claims.data_files.size() > 1) return {};
  if (!claims.detached) return gzip_rest(file, claims.header_bytes, wanted);
  return gzip_rest(std::filesystem::path(file).parent_path() / claims.data_files.front(), 0, wanted);
}

namespace {

/// zlib's state, ended with this.
struct InflateState {
  z_stream stream{};
  bool good = false;

  InflateState() {
    constexpr int kGzip = 16;
    good = inflateInit2(&stream, MAX_WBITS + kGzip) == Z_OK;
  }
  ~InflateState() {
    if (good) inflateEnd(&stream);
  }
  InflateState(const InflateState&) = delete;
  InflateState& operator=(const InflateState&) = delete;
};

}  // namespace

std::string gzip_rest(const std::filesystem::path& file, std::uint64_t first, std::uint64_t wanted) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(in.tellg());
  constexpr std::uint64_t kTrailer = 4;
  if (!in || size < first + kTrailer) return {};
  std::array<unsigned char, kTrailer> trailer{};
  in.seekg(static_cast<std::streamoff>(size - kTrailer));
  in.read(reinterpret_cast<char*>(trailer.data()), kTrailer);
  std::uint32_t stated = 0;
  for (std::size_t i = kTrailer; i-- > 0;) stated = stated << 8U | trailer[i];
  if (stated == static_cast<std::uint32_t>(wanted)) return {};

  InflateState inflater;
  if (!inflater.good) return {};
  in.seekg(static_cast<std::streamoff>(first));
  std::array<unsigned char, 1U << 16U> packed{}, unpacked{};
  std::uint64_t consumed = first, made = 0;
  z_stream& z = inflater.stream;
  int result = Z_OK;
  while (true) {
    if (z.avail_in == 0) {
      in.read(reinterpret_cast<char*>(packed.data()), packed.size());
      z.next_in = packed.data();
      z.avail_in = static_cast<uInt>(in.gcount());
      if (z.avail_in == 0) break;
    }
    // Another member may follow; anything else is no gzip data.
    if (result == Z_STREAM_END) {
      if (z.next_in[0] != 0x1f || inflateReset(&z) != Z_OK) break;
    }
    const uInt before = z.avail_in;
    z.next_out = unpacked.data();
    z.avail_out = static_cast<uInt>(unpacked.size());
    result = inflate(&z, Z_NO_FLUSH);
    consumed += before - z.avail_in;
    made += unpacked.size() - z.avail_out;
    if (made > wanted)
      return "its gzip data unpacks to more than the " + std::to_string(wanted) +
             " bytes that the header claims: the rest is left out";
    if (result != Z_OK && result != Z_STREAM_END) break;
    if (result == Z_STREAM_END && consumed == size) break;
  }
  // Teem keeps what it opened of packed data that it cannot read: these do not come to it.
  if (result != Z_STREAM_END || made < wanted) {
    throw input_error({file.string(), "",
                       "holds gzip data that " +
                           std::string(result == Z_STREAM_END ? "end"
                                       : result == Z_OK       ? "are cut off"
                                                              : "are damaged") +
                           " after " + std::to_string(made) + " bytes",
                       std::to_string(wanted) + " by the header", "the file may be truncated"});
  }
  return consumed == size ? std::string()
                          : counted(as_size(size - consumed), "byte") + " after its gzip data are left out";
}

}  // namespace palpate
