#include "loaders/vtk/xml_values.h"

#include <algorithm>
#include <optional>

#include "common/base/text.h"
#include "loaders/vtk/saturated.h"
#include "loaders/vtk/text_number.h"

namespace palpate {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

/// As many bytes as whole groups of four characters give, at most `most`.
std::string decoded_base64(std::string_view text, std::size_t most) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  for (std::size_t at = 0; at + 4 <= text.size() && bytes.size() < most; at += 4) {
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t digit = kDigits.find(text[at + i]);
      if (digit == std::string_view::npos && text[at + i] != '=') return bytes;
      group = group << 6U | static_cast<std::uint32_t>(digit == std::string_view::npos ? 0 : digit);
    }
    for (unsigned shift = 24; shift > 0; shift -= 8)
      bytes += static_cast<char>(static_cast<unsigned char>(group >> (shift - 8)));
  }
  return bytes;
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

BinaryClaim claim_of(std::string_view data, const BinaryHeader& header) {
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
  if (!header.compressed) return {header.number_bytes, first, first};
  // Block count, block size, size of a last partial block, then the compressed size of every block.
  BinaryClaim claim;
  const std::uint64_t block = number(1);
  const std::uint64_t partial = number(2);
  const std::uint64_t full = first - (partial > 0 && first > 0 ? 1 : 0);
  claim.values = times(full, block);
  if (__builtin_add_overflow(claim.values, partial, &claim.values)) claim.values = kHuge;
  if (first > data.size()) return {kHuge, kHuge, claim.values};
  claim.header = (3 + first) * header.number_bytes;
  for (std::uint64_t b = 0; b < first; ++b) {
    const std::uint64_t size = number(3 + b);
    if (__builtin_add_overflow(claim.stored, size, &claim.stored)) claim.stored = kHuge;
  }
  return claim;
}

std::uint64_t claim_of_base64(std::string_view text, const BinaryHeader& header) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  const std::uint64_t numbers = (header.compressed ? 3 : 1) * header.number_bytes;
  return claim_of(decoded_base64(text, numbers), header).values;
}

}  // namespace palpate
