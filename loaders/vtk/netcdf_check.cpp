#include "loaders/vtk/netcdf_check.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "common/base/error.h"
#include "common/load/find_format.h"

namespace palpate {
namespace {

/// Room for some ten thousand variables.
constexpr std::size_t kNetcdfHeadBytes = std::size_t{4} << 20;
constexpr std::uint32_t kDimensions = 10;
constexpr std::uint32_t kVariables = 11;
constexpr std::uint32_t kAttributes = 12;

/// The head ended before the header did.
struct EndOfHead {};
struct BrokenNetcdf {
  std::string what;
};

class Header {
 public:
  explicit Header(std::string_view head)
      : head_(head), version_(static_cast<unsigned char>(head[3])), at_(4) {}

  std::uint64_t number(std::size_t bytes) {
    if (bytes > head_.size() - at_) throw EndOfHead{};
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | static_cast<unsigned char>(head_[at_ + i]);
    at_ += bytes;
    return value;
  }
  /// Counts have 4 bytes, in CDF-5 8; offsets 4 bytes in CDF-1, else 8.
  std::uint64_t count() { return number(version_ == 5 ? 8 : 4); }
  std::uint64_t offset() { return number(version_ == 1 ? 4 : 8); }
  std::uint32_t tag() { return static_cast<std::uint32_t>(number(4)); }

  void skip(std::uint64_t bytes) {
    if (bytes > head_.size() - at_) throw EndOfHead{};
    at_ += bytes;
  }
  std::string name() {
    const std::uint64_t length = count();
    // NC_MAX_NAME: netCDF's library copies longer ones past the end of what its callers, VTK among them, keep for one.
    constexpr std::uint64_t kLongestName = 256;
    if (length > kLongestName)
      throw BrokenNetcdf{"its header has a name of " + std::to_string(length) + " bytes"};
    if (length > head_.size() - at_) throw EndOfHead{};
    std::string text(head_.substr(at_, length));
    skip(padded(length));
    return text;
  }
  /// Rounds up to a multiple of 4.
  static std::uint64_t padded(std::uint64_t bytes) {
    if (bytes > (std::uint64_t{1} << 60)) throw EndOfHead{};
    return (bytes + 3) / 4 * 4;
  }

  void skip_attributes() {
    const std::uint64_t attributes = list(kAttributes);
    for (std::uint64_t i = 0; i < attributes; ++i) {
      (void)name();
      const std::uint64_t size = type_size();
      const std::uint64_t values = count();
      if (values > head_.size()) throw EndOfHead{};
      skip(padded(values * size));
    }
  }
  /// The length of a list that begins here; an absent one is two zeros.
  std::uint64_t list(std::uint32_t expected) {
    const std::uint32_t found = tag();
    const std::uint64_t length = count();
    if (found == 0 && length == 0) return 0;
    if (found != expected) throw BrokenNetcdf{"its header is damaged"};
    return length;
  }
  std::uint64_t type_size() {
    static constexpr std::array<std::uint64_t, 12> kSizes{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    const std::uint32_t type = tag();
    if (type < 1 || type >= kSizes.size()) throw BrokenNetcdf{"its header names an unknown number type"};
    return kSizes[type];
  }

 private:
  std::string_view head_;
  int version_;
  std::size_t at_;
};

/// a * b, or the largest number.
std::uint64_t capped_product(std::uint64_t a, std::uint64_t b) {
  std::uint64_t product = 0;
  return __builtin_mul_overflow(a, b, &product) ? ~std::uint64_t{0} : product;
}

void check_variables(Header& header, std::uint64_t records, const std::vector<std::uint64_t>& dimensions,
                     std::uint64_t file_size) {
  struct Record {
    std::string name;
    std::uint64_t begin;
    std::uint64_t bytes;
  };
  std::vector<Record> recorded;
  std::uint64_t record_bytes = 0;
  const std::uint64_t variables = header.list(kVariables);
  for (std::uint64_t v = 0; v < variables; ++v) {
    const std::string name = header.name();
    const std::uint64_t rank = header.count();
    std::uint64_t values = 1;
    bool is_record = false;
    for (std::uint64_t d = 0; d < rank; ++d) {
      const std::uint64_t id = header.count();
      if (id >= dimensions.size())
        throw BrokenNetcdf{"variable '" + name + "' has a dimension that is not there"};
      if (d == 0 && dimensions[id] == 0) {
        is_record = true;  // the unlimited dimension has length 0 and comes first
      } else {
        values = capped_product(values, dimensions[id]);
      }
    }
    header.skip_attributes();
    const std::uint64_t bytes = capped_product(values, header.type_size());
    (void)header.count();  // vsize: redundant, and wrapped where it is large
    const std::uint64_t begin = header.offset();
    const bool outside =
        begin > file_size || (!is_record && bytes > file_size - begin) || bytes > (std::uint64_t{1} << 60);
    if (outside)
      throw BrokenNetcdf{"variable '" + name + "' does not fit into the file's " + std::to_string(file_size) +
                         " bytes"};
    if (is_record) {
      recorded.push_back({name, begin, bytes});
      record_bytes += Header::padded(bytes);
    }
  }
  if (records == 0 || recorded.empty()) return;
  // One variable alone is not padded.
  const std::uint64_t stride = recorded.size() == 1 ? recorded.front().bytes : record_bytes;
  for (const Record& record : recorded) {
    const std::uint64_t before = capped_product(records - 1, stride);
    if (before > file_size || record.bytes > file_size - before ||
        record.begin > file_size - before - record.bytes) {
      throw BrokenNetcdf{"variable '" + record.name + "' of " + std::to_string(records) +
                         " time steps does not fit into the file's " + std::to_string(file_size) + " bytes"};
    }
  }
}

}  // namespace

std::string netcdf_problem(std::string_view head, std::uint64_t file_size) {
  const bool classic =
      head.size() >= 4 && head.substr(0, 3) == "CDF" && (head[3] == 1 || head[3] == 2 || head[3] == 5);
  if (!classic) return "";
  try {
    Header header(head);
    std::uint64_t records = header.count();
    // All ones mean that the number of records follows from the file's size ("streaming").
    if (records == 0xffffffffU || records == ~std::uint64_t{0}) records = 0;
    std::vector<std::uint64_t> dimensions;
    const std::uint64_t count = header.list(kDimensions);
    for (std::uint64_t d = 0; d < count; ++d) {
      (void)header.name();
      dimensions.push_back(header.count());
    }
    header.skip_attributes();
    check_variables(header, records, dimensions, file_size);
  } catch (const EndOfHead&) {
    // The header goes on where the file does: nothing more can be said. Else it is cut off.
    if (head.size() >= file_size) return "its header is cut off";
  } catch (const BrokenNetcdf& broken) {
    return broken.what;
  }
  return "";
}

void check_netcdf(const std::string& file) {
  const HeadOfFile head = read_head(file, kNetcdfHeadBytes);
  const std::string problem = netcdf_problem(head.bytes, head.file_size);
  if (!problem.empty()) throw input_error({file, "", problem, "", "it may be truncated"});
}

}  // namespace palpate
