#include "common/device/tracked_hands.h"

#include <array>
#include <cmath>
#include <string_view>

#include "common/base/csv_reader.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// A pose from seven numbers; none where they are not all there.
std::optional<TrackerPose> pose_at(const CsvReader& table, const double* v) {
  for (int i = 0; i < 7; ++i) {
    if (std::isnan(v[i])) return std::nullopt;
  }
  const Quat q{v[3], v[4], v[5], v[6]};
  const double length = glm::length(q);
  constexpr double kSlack = 1e-3;
  if (!(std::abs(length - 1.0) <= kSlack))
    table.refuse("a quaternion of length " + short_number(length), "1");
  const Vec3 position{v[0], v[1], v[2]};
  if (!is_finite(position)) table.refuse("a place that is not finite", "metres");
  return TrackerPose{position, q / length};
}

}  // namespace

bool ReplayHands::read(double now, TrackedHands& hands) {
  if (hands_.empty()) return false;
  if (next_ == 0) {
    offset_ = now - hands_.front().time;
    next_ = 1;
  }
  while (next_ < hands_.size() && hands_[next_].time + offset_ <= now) ++next_;
  constexpr double kGone = 0.1;  // [s] after the last one
  if (next_ == hands_.size() && now - (hands_.back().time + offset_) > kGone) return false;
  hands = hands_[next_ - 1];
  return true;
}

std::vector<TrackedHands> read_hands(const std::string& file) {
  constexpr std::array<std::string_view, 8> kRequired{"t", "x", "y", "z", "qw", "qx", "qy", "qz"};
  constexpr std::array<std::string_view, 10> kOptional{"b0",  "b1",  "hx",  "hy",  "hz",
                                                       "hqw", "hqx", "hqy", "hqz", "h0"};
  CsvReader table(file, kRequired, kOptional,
                  "tracked hands with the header t,x,y,z,qw,qx,qy,qz, then b0, b1, hx,hy,hz,hqw,hqx,hqy,hqz "
                  "and h0 where there are such");
  const auto down = [](double button) { return !std::isnan(button) && button != 0.0; };
  std::vector<TrackedHands> hands;
  for (std::array<double, kRequired.size() + kOptional.size()> row{}; table.next(row);) {
    if (!std::isfinite(row[0]) || (!hands.empty() && !(row[0] > hands.back().time)))
      table.refuse("a time that does not rise", "seconds, later than those of the row before");
    hands.push_back({row[0], pose_at(table, &row[1]), pose_at(table, &row[10]), down(row[8]), down(row[9]),
                     down(row[17])});
  }
  return hands;
}

}  // namespace palpate
