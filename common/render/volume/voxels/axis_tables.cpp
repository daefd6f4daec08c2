#include "common/render/volume/voxels/axis_tables.h"

#include <algorithm>
#include <cmath>

#include "common/base/index.h"

namespace palpate {

AxisTables axis_tables(const VolumeImage& image) noexcept {
  constexpr double kFewestAPoint = 4.0, kMost = 0x1p18;
  AxisTables tables;
  for (int a = 0; image.lines && a < 3; ++a) {
    const auto axis = as_size(a);
    const auto points = static_cast<std::int32_t>(image.lines->at[axis].size());
    tables.first[axis] = tables.size;
    if (points < 2) continue;
    const double wanted = std::ceil((points - 1) / image.lines->finest(a));
    tables.buckets[axis] =
        static_cast<std::int32_t>(std::min(std::max(wanted, kFewestAPoint * points), kMost));
    tables.size += tables.buckets[axis] + points;
  }
  return tables;
}

int append_axis_tables(const VolumeImage& image, std::vector<float>& lines) {
  const AxisTables tables = axis_tables(image);
  int most = 1;
  for (int a = 0; a < 3; ++a) {
    const std::int32_t buckets = tables.buckets[as_size(a)];
    if (buckets == 0) continue;
    const std::vector<double>& at = image.lines->at[as_size(a)];
    const auto last = static_cast<int>(at.size()) - 2;
    constexpr double kRounding = 0.05;  // of a bucket: 2^18 of them in single precision
    const double bucket = static_cast<double>(last + 1) / buckets;
    int low = 0, high = 0;
    for (std::int32_t b = 0; b < buckets; ++b) {
      while (low < last && at[as_size(low + 1)] <= (b - kRounding) * bucket) ++low;
      while (high < last && at[as_size(high + 1)] <= (b + 1 + kRounding) * bucket) ++high;
      most = std::max(most, high - low);
      lines.push_back(static_cast<float>(low));
    }
    for (const double m : at) lines.push_back(static_cast<float>(m));
  }
  int halvings = 1;
  while ((1 << halvings) <= most) ++halvings;
  return halvings;
}

}  // namespace palpate
