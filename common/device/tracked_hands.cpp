#include "common/device/tracked_hands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "common/base/files/csv_reader.h"

namespace palpate {

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
  constexpr std::array<std::string_view, 17> kOptional{
      "b0", "b1",    "hx",    "hy",    "hz",     "hqw",    "hqx",    "hqy",   "hqz",
      "h0", "headx", "heady", "headz", "headqw", "headqx", "headqy", "headqz"};
  CsvReader table(file, kRequired, kOptional,
                  "tracked hands with the header t,x,y,z,qw,qx,qy,qz, then b0, b1, hx,hy,hz,hqw,hqx,hqy,hqz, "
                  "h0 and headx,heady,headz,headqw,headqx,headqy,headqz where there are such");
  const auto down = [](double button) { return !std::isnan(button) && button != 0.0; };
  std::vector<TrackedHands> hands;
  for (std::array<double, kRequired.size() + kOptional.size()> row{}; table.next(row);) {
    if (!std::isfinite(row[0]) || (!hands.empty() && !(row[0] > hands.back().time)))
      table.refuse("a time that does not rise", "seconds, later than those of the row before");
    hands.push_back({row[0], pose_of_row(table, &row[1]), pose_of_row(table, &row[10]), down(row[8]),
                     down(row[9]), down(row[17]), pose_of_row(table, &row[18])});
  }
  return hands;
}

std::vector<PoseSample> heads_of(const std::vector<TrackedHands>& hands) {
  const bool any = std::any_of(hands.begin(), hands.end(), [](const TrackedHands& h) { return h.head; });
  std::vector<PoseSample> heads;
  for (const TrackedHands& h : hands) {
    if (any) heads.push_back({h.time, h.head});
  }
  return heads;
}

}  // namespace palpate
