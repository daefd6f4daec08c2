#include "common/geometry/tractogram.h"

#include <algorithm>
#include <vector>

#include "common/base/index.h"

namespace palpate {

TractogramLengths lengths_of(const Tractogram& lines) {
  TractogramLengths result;
  for (const Vec3f& x : lines.points) result.bounds.include(Vec3{x});
  std::vector<double> lengths;
  lengths.reserve(lines.line_count());
  double sum = 0.0;
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    const auto line = lines.line(l);
    double length = 0.0;
    for (std::size_t p = 1; p < line.size(); ++p) length += glm::distance(Vec3{line[p - 1]}, Vec3{line[p]});
    lengths.push_back(length);
    sum += length;
  }
  if (lengths.empty()) return result;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  result.median = *middle;
  result.mean = sum / static_cast<double>(lengths.size());
  const auto [least, most] = std::minmax_element(lengths.begin(), lengths.end());
  result.least = *least;
  result.most = *most;
  result.bin = result.most / static_cast<double>(TractogramLengths::kBins);
  for (const double length : lengths) {
    const auto bin = result.bin > 0.0 ? floor_size(length / result.bin) : 0;
    ++result.histogram[std::min(bin, TractogramLengths::kBins - 1)];
  }
  return result;
}

}  // namespace palpate
