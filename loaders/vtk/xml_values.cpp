#include "loaders/vtk/xml_values.h"

#include <algorithm>
#include <array>
#include <optional>

#include "common/base/text.h"
#include "loaders/vtk/saturated.h"
#include "loaders/vtk/text_number.h"

namespace palpate {
namespace {

constexpr std::array<std::uint8_t, 256> kBase64 = [] {
  std::array<std::uint8_t, 256> values{};
  values.fill(64);
  std::uint8_t value = 0;
  for (const char c : std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"))
    values[static_cast<unsigned char>(c)] = value++;
  return values;
}();
/// Of a character of base64; 64 where it is none.
std::uint8_t base64_value(char c) { return kBase64[static_cast<unsigned char>(c)]; }

/// As many bytes as whole groups of four characters give, at most `most` and two more.
std::string decoded_base64(std::string_view text, std::size_t most) {
  std::string bytes;
  for (std::size_t at = 0; at + 4 <= text.size() && bytes.size() < most; at += 4) {
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t value = base64_value(text[at + i]);
      if (value == 64 && text[at + i] != '=') return bytes;
      group = group << 6U | value % 64;
    }
    for (unsigned shift = 24; shift > 0; shift -= 8)
      bytes += static_cast<char>(static_cast<unsigned char>(group >> (shift - 8)));
  }
  return bytes;
}

/// Characters of base64 for so many bytes, in whole groups; kHuge where they do not fit in 64 bits.
std::uint64_t base64_size(std::uint64_t bytes) { return times(bytes / 3 + (bytes % 3 == 0 ? 0 : 1), 4); }

/// Whether `text` begins with base64 for so many bytes: padding stands where the last of them ends, not before.
bool has_base64(std::string_view text, std::uint64_t bytes) {
  const std::uint64_t size = base64_size(bytes);
  if (size > text.size()) return false;
  const std::uint64_t digits = size - (bytes % 3 == 0 ? 0 : 3 - bytes % 3);
  for (std::uint64_t i = 0; i < size; ++i) {
    if (base64_value(text[i]) == 64 && (i < digits || text[i] != '=')) return false;
  }
  return true;
}

std::uint64_t plus(std::uint64_t a, std::uint64_t b) {
  std::uint64_t sum = 0;
  return __builtin_add_overflow(a, b, &sum) ? kHuge : sum;
}

/// What a header says.
struct Claim {
  std::uint64_t header = 0;  ///< bytes of the header
  std::uint64_t stored = 0;  ///< bytes that follow
  std::uint64_t values = 0;  ///< bytes of the values, uncompressed
  std::uint64_t block = 0;   ///< BinaryArray::block
};

/// Numbers that lie past the end of `data` are kHuge.
Claim claim_of(std::string_view data, const BinaryHeader& header) {
  const auto number = [&](std::uint64_t index) {
    const std::uint64_t offset = times(index, header.number_bytes);
    std::uint64_t value = 0;
    if (offset > data.size() || data.size() - offset < header.number_bytes) return kHuge;
    for (std::uint64_t i = 0; i < header.number_bytes; ++i) {
      const std::uint64_t at = header.big_endian ? offset + i : offset + header.number_bytes - 1 - i;
      value = value << 8U | static_cast<unsigned char>(data[at]);
    }
    return value;
  };
  const std::uint64_t first = number(0);
  if (!header.compressed) return {header.number_bytes, first, first, 0};
  // Block count, block size, size of a last partial block, then the compressed size of every block.
  Claim claim;
  const std::uint64_t block = number(1);
  const std::uint64_t partial = number(2);
  const std::uint64_t full = first - (partial > 0 && first > 0 ? 1 : 0);
  claim.values = plus(times(full, block), partial);
  if (first > 1) claim.block = block;
  claim.header = times(plus(first, 3), header.number_bytes);
  if (claim.header > data.size()) return {claim.header, kHuge, claim.values, claim.block};
  for (std::uint64_t b = 0; b < first; ++b) claim.stored = plus(claim.stored, number(3 + b));
  return claim;
}

/// Base64 text has its header and its values in one run of groups, or each in its own; compressed ones always so.
BinaryArray base64_array(std::string_view text, const BinaryHeader& header) {
  const std::uint64_t fixed = (header.compressed ? 3 : 1) * header.number_bytes;
  Claim claim = claim_of(decoded_base64(text, fixed), header);
  if (header.compressed && claim.header <= text.size())
    claim = claim_of(decoded_base64(text, claim.header), header);
  const std::uint64_t head = base64_size(claim.header);
  if (!has_base64(text, claim.header)) return {claim.values, head, false, claim.block};
  const bool apart = header.compressed || text.substr(0, head).ends_with('=');
  if (!apart) {
    const std::uint64_t bytes = plus(claim.header, claim.stored);
    return {claim.values, base64_size(bytes), has_base64(text, bytes), claim.block};
  }
  return {claim.values, plus(head, base64_size(claim.stored)), has_base64(text.substr(head), claim.stored),
          claim.block};
}

}  // namespace

std::uint64_t bytes_of_xml_type(const std::string& type) {
  if (type.find("64") != std::string::npos || type == "vtkIdType") return 8;
  if (type.find("32") != std::string::npos) return 4;
  if (type.find("16") != std::string::npos) return 2;
  return 1;
}

bool is_xml_number(const std::string& type) {
  return type.starts_with("Float") || type.starts_with("Int") || type.starts_with("UInt") ||
         type == "vtkIdType";
}

TextValues text_values(std::string_view text, const std::string& type) {
  const bool real = type.starts_with("Float");
  const bool no_sign = type.starts_with("UInt");
  const std::uint64_t bytes = bytes_of_xml_type(type);
  TextValues found;
  for (std::size_t at = 0;;) {
    while (at < text.size() && is_blank(text[at])) ++at;
    if (at == text.size()) return found;
    std::size_t end = at;
    while (end < text.size() && !is_blank(text[end])) ++end;
    const std::string_view written = text.substr(at, end - at);
    at = end;
    std::optional<std::int64_t> value;
    if (!real) value = whole_number(written, static_cast<unsigned>(8 * bytes), !no_sign);
    if (real &&
        (bytes == 4 ? real_number<float>(written).has_value() : real_number<double>(written).has_value()))
      value = 0;
    if (!value) {
      found.wrong = printable(written.substr(0, 40));
      return found;
    }
    found.largest = std::max(found.largest, static_cast<std::uint64_t>(std::max<std::int64_t>(0, *value)));
    ++found.count;
  }
}

BinaryArray binary_array(std::string_view data, const BinaryHeader& header) {
  if (header.base64) return base64_array(data, header);
  const Claim claim = claim_of(data, header);
  const std::uint64_t size = plus(claim.header, claim.stored);
  return {claim.values, size, size <= data.size(), claim.block};
}

}  // namespace palpate
