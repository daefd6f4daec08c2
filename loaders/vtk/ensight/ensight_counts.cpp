#include "loaders/vtk/ensight/ensight_counts.h"

#include <algorithm>
#include <cctype>
#include <cstdint>

#include "common/base/text.h"
#include "loaders/vtk/text_number.h"

namespace palpate {
namespace {

constexpr std::size_t kWord = 80, kNumber = 4, kHead = kWord + kNumber;  // "part" and its number

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

/// Whether the parts read are among those of the file, in their order. @param fits of a part and a count of tuples.
template <class Fits>
std::string missing_part(std::size_t parts, const EnsightCounts& due, const Fits& fits) {
  std::size_t part = 0;
  for (std::size_t i = 0; i < due.tuples.size(); ++i, ++part) {
    while (part < parts && !fits(part, due.tuples[i])) ++part;
    if (part == parts)
      return "has no part with " + std::to_string(due.tuples[i] * due.components) + " numbers, as part " +
             std::to_string(i + 1) + " of those that are read is to have";
  }
  return {};
}

std::string in_binary(std::string_view file, const EnsightCounts& due) {
  const auto part_from = [file](std::size_t at) {
    for (at = file.find("part", at); at != std::string_view::npos; at = file.find("part", at + 1))
      if (at + kHead <= file.size() && (file[at + 4] == '\0' || file[at + 4] == ' ')) break;
    return std::min(at, file.size());
  };
  std::vector<std::size_t> bytes;
  for (std::size_t at = part_from(kWord), next = 0; at < file.size(); at = next) {
    next = part_from(at + kWord);
    const bool undef = file.substr(at + kHead, kWord).find(" undef") != std::string_view::npos;
    bytes.push_back(next - at - (undef ? kNumber : 0));
  }
  const std::size_t tuple = kNumber * due.components;
  const bool of_nodes = due.association == Association::kPoint;
  for (std::size_t p = 0; of_nodes && p < bytes.size(); ++p) {
    if (bytes[p] < kHead + kWord || (bytes[p] - kHead - kWord) % tuple != 0)
      return "has a part, number " + std::to_string(p + 1) + ", of no whole number of values";
  }
  return missing_part(bytes.size(), due, [&](std::size_t part, std::size_t tuples) {
    constexpr std::size_t kMostKinds = 32;  // of elements in one part, a word each
    for (std::size_t words = 1; words <= (of_nodes ? 1 : kMostKinds); ++words)
      if (bytes[part] == kHead + words * kWord + tuples * tuple) return true;
    return false;
  });
}

std::string in_text(std::string_view file, const EnsightCounts& due) {
  std::vector<std::size_t> numbers;
  std::size_t line_number = 0;
  bool is_head = false;
  for (std::size_t at = 0; at < file.size();) {
    const std::size_t end = std::min(file.find('\n', at), file.size());
    const std::string_view line = trimmed(file.substr(at, end - at));
    at = end + 1;
    if (++line_number == 1 || line.empty()) continue;  // the first one describes
    if (is_head) {
      is_head = false;
    } else if (line == "part") {
      numbers.push_back(0);
      is_head = true;
    } else if (is_letter(line.front()) && !lowered(line.substr(0, 3)).starts_with("nan") &&
               !lowered(line.substr(0, 3)).starts_with("inf")) {
      // The kind of elements; "undef" is followed by the number that stands for none.
      is_head = line.ends_with(" undef");
    } else if (!real_number<double>(line)) {
      // VTK's reader takes of it what it can, and 0 where there is nothing.
      return "has '" + printable(line.substr(0, 24)) + "' in line " + std::to_string(line_number) +
             ", expected a number";
    } else if (!numbers.empty()) {
      ++numbers.back();
    }
  }
  for (std::size_t p = 0; due.association == Association::kPoint && p < numbers.size(); ++p) {
    if (numbers[p] % due.components != 0)
      return "has a part, number " + std::to_string(p + 1) + ", of " + std::to_string(numbers[p]) +
             " numbers, which are no whole number of values";
  }
  return missing_part(numbers.size(), due, [&](std::size_t part, std::size_t tuples) {
    return numbers[part] == tuples * due.components;
  });
}

}  // namespace

std::string gold_counts_problem(std::string_view file, bool text, const EnsightCounts& due) {
  for (const std::string_view word : {" partial", "BEGIN TIME STEP"})
    if (file.find(word) != std::string_view::npos) return {};
  const bool fortran =
      file.size() > kNumber && (file.substr(0, kNumber) == std::string_view("\x50\0\0\0", kNumber) ||
                                file.substr(0, kNumber) == std::string_view("\0\0\0\x50", kNumber));
  if (fortran || due.components == 0) return {};
  return text ? in_text(file, due) : in_binary(file, due);
}

std::string ensight6_counts_problem(std::string_view text, std::size_t values) {
  constexpr std::size_t kColumns = 12;
  std::size_t numbers = 0, line_number = 0;
  for (std::size_t at = 0; at < text.size(); ++line_number) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0) line.remove_suffix(1);
    if (line_number == 0 || line.empty()) continue;
    if (is_letter(trimmed(line).front())) return {};  // parts of their own
    for (; !line.empty(); line.remove_prefix(std::min(kColumns, line.size())), ++numbers) {
      const std::string_view word = trimmed(line.substr(0, kColumns));
      if (!real_number<double>(word))
        return "has '" + printable(word) + "' in line " + std::to_string(line_number + 1) +
               ", expected a number";
    }
  }
  if (numbers == values) return {};
  return "has " + std::to_string(numbers) + " numbers, expected " + std::to_string(values);
}

}  // namespace palpate
