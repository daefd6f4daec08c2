#include "common/device/probe_path.h"

#include <array>
#include <cmath>
#include <string_view>

#include "common/base/files/csv_reader.h"

namespace palpate {

std::vector<PathRow> read_probe_path(const std::string& file) {
  constexpr std::array<std::string_view, 4> kRequired{"t", "x", "y", "z"};
  constexpr std::array<std::string_view, 1> kOptional{"b0"};
  CsvReader table(file, kRequired, kOptional, "a probe path with the header t,x,y,z or t,x,y,z,b0");
  std::vector<PathRow> path;
  for (std::array<double, 5> row{}; table.next(row);) {
    const auto& [t, x, y, z, button] = row;
    path.push_back({t, {x, y, z}, !std::isnan(button) && button != 0.0 ? 1U : 0U});
  }
  return path;
}

std::vector<DeviceSample> samples_of(const std::vector<PathRow>& path, double scale) {
  std::vector<DeviceSample> samples;
  samples.reserve(path.size());
  for (const PathRow& row : path) samples.push_back({row.time, row.position * scale, row.buttons});
  return samples;
}

}  // namespace palpate
