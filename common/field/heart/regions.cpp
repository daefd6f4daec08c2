#include "common/field/heart/regions.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {

std::vector<RegionCount> count_regions(const DataArray& numbers) {
  std::map<double, std::size_t> counts;
  for (std::size_t c = 0; c < numbers.tuples; ++c) {
    const double number = numbers.at(c);
    if (std::isfinite(number)) ++counts[number];
    if (counts.size() > kMostHeartRegions) return {};
  }
  std::vector<RegionCount> regions;
  regions.reserve(counts.size());
  for (const auto& [number, elements] : counts) regions.push_back({number, elements});
  return regions;
}

std::vector<double> parse_regions(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t count = split(text, ',').size();
  return parse_numbers(text, count, "--regions takes the numbers of regions with commas between: 1,2");
}

std::string regions_text(std::vector<double> numbers) {
  std::sort(numbers.begin(), numbers.end());
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ",") + exact_number(number);
  return text;
}

std::size_t hide_other_regions(DataSet& mesh, const DataArray& numbers, const std::vector<double>& chosen) {
  mesh.hidden_cells.resize(numbers.tuples);
  std::size_t hidden = 0;
  for (std::size_t c = 0; c < numbers.tuples; ++c) {
    if (std::find(chosen.begin(), chosen.end(), numbers.at(c)) != chosen.end() || mesh.hidden_cells[c] != 0)
      continue;
    mesh.hidden_cells[c] = 1;
    ++hidden;
  }
  return hidden;
}

}  // namespace palpate
