#include "common/load/numbered_files.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

std::optional<long long> whole_number(std::string_view text) {
  constexpr long long kLargest = 1'000'000'000;
  const auto value = parsed<long long>(text);
  return value && *value >= -kLargest && *value <= kLargest ? value : std::nullopt;
}

}  // namespace

NumberedFiles numbered_files(std::string_view format, std::string_view first, std::string_view last,
                             std::string_view step, std::size_t most) {
  constexpr std::size_t kMostDigits = 3;
  NumberedFiles files;
  const std::size_t percent = std::min(format.find('%'), format.size());
  std::size_t end = std::min(percent + 1, format.size());
  while (end < format.size() && std::isdigit(static_cast<unsigned char>(format[end])) != 0) ++end;
  const std::string_view digits = format.substr(std::min(percent + 1, end), end - std::min(percent + 1, end));
  const bool plain = end < format.size() && format[end] == 'd' && digits.size() <= kMostDigits &&
                     format.find('%', end) == std::string_view::npos;
  const auto from = whole_number(first), to = whole_number(last), by = whole_number(step);
  if (!plain || !from || !to || !by || *by == 0) {
    files.problem = "its list of data files makes no sense";
    return files;
  }
  const auto width = as_size(digits.empty() ? 0 : *whole_number(digits));
  const bool zeros = digits.starts_with('0');
  for (long long i = *from; *by > 0 ? i <= *to : i >= *to; i += *by) {
    if (files.names.size() == most) {
      files.problem = "names too many data files";
      return files;
    }
    std::string text = std::to_string(i);
    // As printf has it: zeros stand behind the sign.
    if (text.size() < width) text.insert(zeros && i < 0 ? 1 : 0, width - text.size(), zeros ? '0' : ' ');
    files.names.push_back(std::string(format.substr(0, percent)) + text +
                          std::string(format.substr(end + 1)));
  }
  return files;
}

}  // namespace palpate
