#include "common/device/pose_source.h"

#include <array>
#include <cmath>
#include <string_view>

#include "common/base/files/csv_reader.h"
#include "common/base/text.h"

namespace palpate {

std::optional<TrackerPose> pose_of_row(const CsvReader& table, const double* values) {
  constexpr int kNumbers = 7;
  for (int i = 0; i < kNumbers; ++i) {
    if (std::isnan(values[i])) return std::nullopt;
  }
  const Quat q{values[3], values[4], values[5], values[6]};
  const double length = glm::length(q);
  constexpr double kSlack = 1e-3;
  if (!(std::abs(length - 1.0) <= kSlack))
    table.refuse("a quaternion of length " + short_number(length), "1");
  const Vec3 position{values[0], values[1], values[2]};
  if (!is_finite(position)) table.refuse("a place that is not finite", "metres");
  return TrackerPose{position, q / length};
}

bool ReplayPoses::next(double now, PoseSample& sample) {
  if (next_ == poses_.size()) return false;
  if (next_ == 0) offset_ = now - poses_.front().time;
  if (next_ > 0 && poses_[next_].time + offset_ > now) return false;
  sample = poses_[next_++];
  sample.time += offset_;
  return true;
}

std::vector<PoseSample> read_poses(const std::string& file) {
  constexpr std::array<std::string_view, 8> kColumns{"t", "x", "y", "z", "qw", "qx", "qy", "qz"};
  CsvReader table(file, kColumns, {}, "poses of a sensor with the header t,x,y,z,qw,qx,qy,qz");
  std::vector<PoseSample> poses;
  for (std::array<double, kColumns.size()> row{}; table.next(row);) {
    if (!std::isfinite(row[0]) || (!poses.empty() && !(row[0] > poses.back().time)))
      table.refuse("a time that does not rise", "seconds, later than those of the row before");
    poses.push_back({row[0], pose_of_row(table, &row[1])});
  }
  if (poses.empty()) table.refuse("no row", "at least one pose");
  return poses;
}

}  // namespace palpate
