#include "common/load/series_list.h"

#include <algorithm>

#include "common/base/text.h"

namespace palpate {
namespace {

constexpr const char* kHolds = ": holds ";
constexpr const char* kSeries = " series: ";
constexpr const char* kChoose = "; choose one by --series NUMBER";

}  // namespace

std::string series_list(std::span<const ListedSeries> series) {
  std::string text;
  for (std::size_t i = 0; i < series.size(); ++i) {
    text += (i > 0 ? ", " : "") + std::to_string(i + 1) + " (" + series[i].title + ", " +
            counted(series[i].files, "file") + ")";
  }
  return text;
}

std::string series_question(const std::string& folder, std::span<const ListedSeries> series) {
  return folder + kHolds + std::to_string(series.size()) + kSeries + series_list(series) + kChoose;
}

std::vector<std::string> asked_series(const std::string& line) {
  std::vector<std::string> series;
  const std::size_t end = line.rfind(std::string(")") + kChoose);
  const std::size_t list = line.find(kSeries, line.find(kHolds));
  if (end == std::string::npos || list == std::string::npos || list > end) return series;
  std::size_t at = line.find("1 (", list);
  while (at != std::string::npos && at < end) {
    const std::size_t first = line.find('(', at) + 1;
    const std::string next = "), " + std::to_string(series.size() + 2) + " (";
    const std::size_t last = std::min(line.find(next, first), end);
    series.push_back(line.substr(first, last - first));
    at = last == end ? std::string::npos : last + 3;
  }
  return series;
}

}  // namespace palpate
