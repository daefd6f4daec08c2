#include "common/hand/drawn/drawn_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "common/base/files/csv_reader.h"

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

/// Why the line of the current row ends. @throws Error (bad input).
End end_in(const CsvReader& table) {
  const std::string_view word = table.text("termination");
  for (int i = 0; i < kEndCount; ++i) {
    if (word == name_of(static_cast<End>(i))) return static_cast<End>(i);
  }
  if (!word.empty()) table.refuse("has no reason in column termination", "a word such as left_domain");
  return End::kStoppedByRule;
}

DrawnLines::Entry entry_of(int number, DrawnTract line) {
  DrawnLines::Entry entry{.number = number,
                          .line = std::make_shared<const Line>(std::move(line.line)),
                          .forces = std::move(line.forces),
                          .measures = std::move(line.measures),
                          .image = line.image};
  for (const double force : entry.forces) entry.largest_force = std::fmax(entry.largest_force, force);
  return entry;
}

}  // namespace

std::vector<double> forces_along(const Line& line, std::span<const HapticForce> haptic) {
  std::vector<double> forces(line.points.size(), std::numeric_limits<double>::quiet_NaN());
  if (line.points.empty()) return forces;
  const auto distance = [&](std::size_t i, const Vec3& x) {
    return glm::distance(line.points[i].position, x);
  };
  std::size_t at = 0;
  bool found = false;
  std::size_t before = 0;
  for (const HapticForce& place : haptic) {
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
  Entries entries = *entries_;
  for (DrawnTract& line : lines) entries.push_back(entry_of(next_number_++, std::move(line)));
  put(std::make_shared<const Entries>(std::move(entries)));
}

bool DrawnLines::ends_with(const Line& line, const std::vector<double>& forces) const {
  return !entries().empty() && same_points(*entries().back().line, line) &&
         same_forces(entries().back().forces, forces);
}

void DrawnLines::remove(std::size_t index) {
  Entries entries = *entries_;
  entries.erase(entries.begin() + static_cast<std::ptrdiff_t>(index));
  put(std::make_shared<const Entries>(std::move(entries)));
}

void DrawnLines::put(std::shared_ptr<const Entries> entries) {
  entries_ = std::move(entries);
  auto drawn = std::make_shared<std::vector<DrawnLine>>();
  for (const Entry& entry : *entries_) {
    drawn->push_back({.line = entry.line, .number = entry.number});
    next_number_ = std::max(next_number_, entry.number + 1);
  }
  drawn_ = std::move(drawn);
}

void DrawnLines::clear() {
  put(std::make_shared<const Entries>());
  next_number_ = 1;
}

void DrawnLines::save(const std::filesystem::path& path, bool overwrite) const {
  std::vector<DrawnTract> lines;
  for (const Entry& entry : entries()) {
    lines.push_back({*entry.line, entry.forces, entry.measures, entry.image});
    lines.back().line.seed = static_cast<std::uint32_t>(entry.number);
  }
  write_drawn(path, lines, overwrite);
}

std::shared_ptr<const DrawnLines::Entries> read_drawn_lines(const std::filesystem::path& path) {
  enum : std::size_t {
    kLine,
    kNumber,
    kX,
    kY,
    kZ,
    kTime,
    kArc,
    kSpeed,
    kError,
    kForce,
    kLinear,
    kPlanar,
    kFa
  };
  constexpr std::array<std::string_view, kTime> kRequired{"line", "seed", "x", "y", "z"};
  constexpr std::array<std::string_view, 8> kOptional{"time",  "arc", "speed", "error",
                                                      "force", "cl",  "cp",    "fa"};
  CsvReader table(path.string(), kRequired, kOptional,
                  "lines as a window saves them: a table with the header line,seed,point,x,y,z,...");
  DrawnLines::Entries entries;
  DrawnTract tract;
  double line = -1.0;
  int number = 0;
  const auto finish = [&] {
    if (tract.line.points.size() == 1) table.refuse("follows a line of one point", "two points and more");
    if (!tract.line.points.empty()) entries.push_back(entry_of(number, std::exchange(tract, {})));
  };
  for (std::array<double, kRequired.size() + kOptional.size()> row{}; table.next(row);) {
    const Vec3 place{row[kX], row[kY], row[kZ]};
    if (!is_finite(place)) table.refuse("holds a place that is not finite", "three finite numbers x,y,z");
    constexpr double kMost = 1e9;
    if (!(row[kNumber] >= 0.0 && row[kNumber] <= kMost) || row[kNumber] != std::floor(row[kNumber]))
      table.refuse("has no whole number in column seed", "the number of a line");
    if (row[kLine] != line || tract.line.points.empty()) {
      finish();
      line = row[kLine];
      number = static_cast<int>(row[kNumber]);
      tract.line.end = end_in(table);
    }
    std::vector<LinePoint>& points = tract.line.points;
    const double step =
        points.empty() ? 0.0 : points.back().arc + glm::distance(points.back().position, place);
    const auto known = [](double value, double otherwise) {
      return std::isfinite(value) ? value : otherwise;
    };
    points.push_back({.position = place,
                      .time = known(row[kTime], 0.0),
                      .arc = known(row[kArc], step),
                      .speed = known(row[kSpeed], 0.0),
                      .error = known(row[kError], 0.0)});
    tract.forces.push_back(row[kForce]);
    if (!table.text("cl").empty())
      tract.measures.push_back({{row[kLinear], row[kPlanar], 1.0 - row[kLinear] - row[kPlanar]}, row[kFa]});
  }
  finish();
  return std::make_shared<const DrawnLines::Entries>(std::move(entries));
}

}  // namespace palpate
