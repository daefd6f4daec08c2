#include "loaders/cardiac/chaste_binary.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/file_numbers.h"
#include "common/base/text.h"
#include "loaders/cardiac/packed_file.h"

namespace palpate {
namespace {

constexpr std::size_t kNodeBytes = 4, kNumberBytes = 8;

}  // namespace

std::optional<ChasteBinary> ChasteBinary::open(const std::string& file) {
  constexpr std::size_t kLongestLine = 200;
  std::string head(kLongestLine, '\0');
  head.resize(PackedFile(file).read(head.data(), head.size()));
  const std::size_t end = head.find('\n');
  if (end == std::string::npos) return std::nullopt;
  head.resize(end);
  std::vector<std::string_view> found = words(head);
  if (found.size() < 2 || found.back() != "BIN") return std::nullopt;
  found.pop_back();
  ChasteBinary binary;
  binary.file_ = file;
  binary.begin_ = end + 1;
  for (const std::string_view word : found) {
    const auto value = parsed<std::uint64_t>(word);
    constexpr std::uint64_t kMost = 2'000'000'000;
    if (!value || *value > kMost)
      throw input_error(
          {file, "line 1", "has \"" + std::string(word.substr(0, 20)) + "\"", "counts, and BIN"});
    binary.counts_.push_back(*value);
  }
  return binary;
}

void ChasteBinary::read(std::size_t nodes_a_row, std::size_t numbers_a_row) {
  nodes_ = nodes_a_row;
  numbers_ = numbers_a_row;
  const std::uint64_t row = nodes_ * kNodeBytes + numbers_ * kNumberBytes;
  const std::uint64_t all = unpacked_bytes(file_), body = all > begin_ ? all - begin_ : 0;
  if (row == 0 || counts_.front() > body / row)
    refuse("is cut off after " + counted(row == 0 ? 0 : body / row, "row"),
           std::to_string(counts_.front()) + " as its first line says");
  bytes_.resize(body);
  PackedFile in(file_);
  if (!in.go_to(0) || !in.go_to(begin_) || in.read(bytes_.data(), bytes_.size()) < bytes_.size())
    refuse("cannot be read to its end", "a whole file");
  // Remarks are lines that begin with '#'.
  std::string_view rest = std::string_view(bytes_).substr(counts_.front() * row);
  while (!rest.empty() && std::isspace(static_cast<unsigned char>(rest.front())) != 0) rest.remove_prefix(1);
  if (!rest.empty() && rest.front() != '#')
    refuse("goes on after " + counted(counts_.front(), "row") + " of " + counted(row, "byte"),
           "its end, or remarks behind '#'");
}

std::uint32_t ChasteBinary::node(std::size_t row, std::size_t at) const {
  return number_at<std::uint32_t>(
      bytes_, row * (nodes_ * kNodeBytes + numbers_ * kNumberBytes) + at * kNodeBytes, false);
}

double ChasteBinary::number(std::size_t row, std::size_t at) const {
  return number_at<double>(bytes_, (row + 1) * nodes_ * kNodeBytes + (row * numbers_ + at) * kNumberBytes,
                           false);
}

void ChasteBinary::refuse(const std::string& found, const std::string& expected) const {
  throw input_error({file_, "", found, expected});
}

}  // namespace palpate
