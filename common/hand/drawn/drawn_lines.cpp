#include "common/hand/drawn/drawn_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace palpate {
namespace {

bool same_points(const Line& a, const Line& b) {
  return a.points.size() == b.points.size() && a.points.front().position == b.points.front().position &&
         a.points.back().position == b.points.back().position;
}

/// NaN, for none felt, counts as equal to itself.
bool same_forces(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

}  // namespace

std::vector<double> forces_along(const Line& line, std::span<const HapticForce> felt) {
  std::vector<double> forces(line.points.size(), std::numeric_limits<double>::quiet_NaN());
  if (line.points.empty()) return forces;
  const auto distance = [&](std::size_t i, const Vec3& x) {
    return glm::distance(line.points[i].position, x);
  };
  std::size_t at = 0;
  bool found = false;
  std::size_t before = 0;
  for (const HapticForce& place : felt) {
    if (!found) {
      for (std::size_t i = 1; i < line.points.size(); ++i) {
        if (distance(i, place.position) < distance(at, place.position)) at = i;
      }
    } else {
      // The hand moves along the line: from the last point downhill.
      while (at + 1 < line.points.size() && distance(at + 1, place.position) <= distance(at, place.position))
        ++at;
      while (at > 0 && distance(at - 1, place.position) < distance(at, place.position)) --at;
    }
    // A hand that is faster than the points are dense has felt something at those it passed, too; what was
    // felt at the one before stays.
    const std::size_t low = found && at > before ? before + 1 : at;
    const std::size_t high = found && at < before ? before - 1 : at;
    for (std::size_t i = low; i <= high; ++i) forces[i] = place.force;
    before = at;
    found = true;
  }
  return forces;
}

void DrawnLines::keep(std::vector<DrawnTract> lines) {
  before_.push_back(entries_);
  for (DrawnTract& line : lines) {
    Entry entry{.number = next_number_++,
                .line = std::make_shared<const Line>(std::move(line.line)),
                .forces = std::move(line.forces),
                .measures = std::move(line.measures)};
    for (const double force : entry.forces) entry.largest_force = std::fmax(entry.largest_force, force);
    entries_.push_back(std::move(entry));
  }
  changed();
}

bool DrawnLines::ends_with(const Line& line, const std::vector<double>& forces) const {
  return !entries_.empty() && same_points(*entries_.back().line, line) &&
         same_forces(entries_.back().forces, forces);
}

void DrawnLines::remove(std::size_t index) {
  before_.push_back(entries_);
  entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(index));
  changed();
}

bool DrawnLines::undo() {
  if (before_.empty()) return false;
  entries_ = std::move(before_.back());
  before_.pop_back();
  changed();
  return true;
}

void DrawnLines::clear() {
  entries_.clear();
  before_.clear();
  next_number_ = 1;
  changed();
}

void DrawnLines::changed() {
  auto drawn = std::make_shared<std::vector<DrawnLine>>();
  for (const Entry& entry : entries_) drawn->push_back({.line = entry.line, .number = entry.number});
  drawn_ = std::move(drawn);
}

void DrawnLines::save(const std::filesystem::path& path, bool overwrite) const {
  std::vector<DrawnTract> lines;
  for (const Entry& entry : entries_) {
    lines.push_back({*entry.line, entry.forces, entry.measures});
    lines.back().line.seed = static_cast<std::uint32_t>(entry.number);
  }
  write_drawn(path, lines, overwrite);
}

}  // namespace palpate
