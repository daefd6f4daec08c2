#include "common/hand/drawn/drawn_tract.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "common/load/write/write_lines.h"

namespace palpate {
namespace {

constexpr std::size_t kLeastPoints = 2;  // of a line

/// The other way round, arc and time counted from its new first point.
void turn_round(DrawnTract& tract) {
  std::vector<LinePoint>& points = tract.line.points;
  const double arc = points.back().arc, time = points.back().time;
  for (LinePoint& point : points) {
    point.arc = arc - point.arc;
    point.time = time - point.time;
  }
  std::reverse(points.begin(), points.end());
  std::reverse(tract.forces.begin(), tract.forces.end());
  std::reverse(tract.measures.begin(), tract.measures.end());
}

}  // namespace

TractPen::TractPen(std::shared_ptr<const TensorField> field, double spacing, double reach)
    : field_(std::move(field)), spacing_(spacing), reach_(reach) {}

void TractPen::begin(double time, const Vec3& proxy) {
  ++edits_;
  down_ = true;
  added_ = 0;
  if (use_ == StrokeUse::kReplace && fresh_) tracts_.clear();
  fresh_ = false;

  double nearest = reach_;
  auto joined = tracts_.end();
  bool at_front = false;
  for (auto tract = tracts_.begin(); tract != tracts_.end(); ++tract) {
    for (const bool front : {true, false}) {
      const std::vector<LinePoint>& points = tract->line.points;
      const double away = glm::distance((front ? points.front() : points.back()).position, proxy);
      if (!(away < nearest)) continue;
      nearest = away;
      joined = tract;
      at_front = front;
    }
  }
  joining_ = joined != tracts_.end();
  if (!joining_) {
    tracts_.emplace_back();
    tracts_.back().line.end = End::kStoppedByRule;
    tracts_.back().line.seed = static_cast<std::uint32_t>(tracts_.size() - 1);
    if (const auto& voxels = field_->voxels())
      tracts_.back().image = TractogramImage{voxels->points, voxels->axes, voxels->origin};
    start_ = time;
    return;
  }
  if (at_front) turn_round(*joined);
  turned_ = at_front;
  std::rotate(joined, std::next(joined), tracts_.end());
  start_ = time - tracts_.back().line.points.back().time;
}

/// Whether the line may go on to `proxy` from the end that the stroke joins: ahead of it, or away from it for
/// good. What the hand draws beside the end before would be a kink, or a way back.
bool TractPen::goes_on(const Vec3& proxy) const {
  constexpr double kSlope = 0.25;  // aside for the way ahead: a turn of 14 degrees
  const std::vector<LinePoint>& points = tracts_.back().line.points;
  const Vec3 end = points.back().position, way = proxy - end;
  // The way that the line came over the reach, in which a kink would be seen.
  auto from = points.rbegin();
  while (std::next(from) != points.rend() && glm::distance(from->position, end) < reach_) ++from;
  const Vec3 came = end - from->position;
  const double length = glm::length(came);
  if (!(length > 0.0)) return true;
  const double ahead = glm::dot(way, came) / length;
  const double aside = std::sqrt(std::max(glm::dot(way, way) - ahead * ahead, 0.0));
  return aside <= kSlope * ahead || glm::length(way) > reach_ / kSlope;
}

void TractPen::add(double time, const Vec3& proxy, double force) {
  if (!down_) begin(time, proxy);
  DrawnTract& tract = tracts_.back();
  std::vector<LinePoint>& points = tract.line.points;
  if (!points.empty()) {
    const double step = glm::distance(points.back().position, proxy);
    if (!(step > spacing_) || (joining_ && !goes_on(proxy))) {
      tract.forces.back() = std::fmax(tract.forces.back(), force);
      return;
    }
    const double elapsed = time - start_ - points.back().time;
    const double speed = elapsed > 0.0 ? step / elapsed : 0.0;
    if (points.size() == 1) points.back().speed = speed;
    // The way between two points is not kept: the line may leave it by their distance.
    points.push_back({.position = proxy,
                      .time = time - start_,
                      .arc = points.back().arc + step,
                      .speed = speed,
                      .error = joining_ ? step : spacing_});
    joining_ = false;
  } else {
    points.push_back({.position = proxy, .error = spacing_});
  }
  ++added_;
  tract.forces.push_back(force);
  tract.measures.push_back(measures_at(*field_, proxy, hint_));
}

void TractPen::lift() {
  if (!down_) return;
  down_ = false;
  // A hand that has not moved has drawn nothing.
  if (reach_ > 0.0 && (added_ == 0 || tracts_.back().line.points.size() < kLeastPoints)) {
    put(drawn_);
    return;
  }
  // What was drawn from the first point of a tract stands before it, and tracts stand in their order again.
  const auto by_seed = [](const DrawnTract& a, const DrawnTract& b) { return a.line.seed < b.line.seed; };
  if (turned_) turn_round(tracts_.back());
  if (turned_ || !std::ranges::is_sorted(tracts_, by_seed)) {
    turned_ = false;
    std::ranges::sort(tracts_, by_seed);
    ++edits_;
  }
  note_drawn();
}

void TractPen::note_drawn() {
  if (reach_ > 0.0) drawn_ = std::make_shared<const std::vector<DrawnTract>>(tracts_);
}

void TractPen::let_go() {
  lift();
  fresh_ = true;
}

void TractPen::cut(std::size_t points) {
  if (!down_ || tracts_.back().forces.size() <= points) return;
  DrawnTract& tract = tracts_.back();
  tract.line.points.resize(points);
  tract.forces.resize(points);
  tract.measures.resize(points);
  ++edits_;
}

std::vector<DrawnTract> TractPen::take() {
  lift();
  if (tracts_.empty()) return {};
  ++edits_;
  std::vector<DrawnTract> taken = std::exchange(tracts_, {});
  note_drawn();
  std::erase_if(taken, [](const DrawnTract& tract) { return tract.line.points.size() < kLeastPoints; });
  return taken;
}

void TractPen::put(std::shared_ptr<const std::vector<DrawnTract>> drawn) {
  down_ = turned_ = false;
  drawn_ = std::move(drawn);
  tracts_ = *drawn_;
  ++edits_;
}

void write_drawn(const std::filesystem::path& path, std::span<const DrawnTract> lines, bool overwrite) {
  std::vector<Line> written;
  std::vector<PointColumn> columns{{.name = "force", .values = {}}};
  const bool measured =
      std::any_of(lines.begin(), lines.end(), [](const DrawnTract& line) { return !line.measures.empty(); });
  if (measured) {
    for (const char* name : {"cl", "cp", "fa"}) columns.push_back({.name = name, .values = {}});
  }
  for (const DrawnTract& line : lines) {
    written.push_back(line.line);
    columns[0].values.insert(columns[0].values.end(), line.forces.begin(), line.forces.end());
    for (const TensorMeasures& measures : line.measures) {
      columns[1].values.push_back(measures.parts.linear);
      columns[2].values.push_back(measures.parts.planar);
      columns[3].values.push_back(measures.fractional_anisotropy);
    }
  }
  const auto placed =
      std::find_if(lines.begin(), lines.end(), [](const DrawnTract& line) { return line.image.has_value(); });
  write_lines(path, written, overwrite, columns, placed == lines.end() ? nullptr : &*placed->image);
}

std::size_t save_tracts(const std::filesystem::path& path, const std::vector<DrawnTract>& tracts,
                        bool overwrite) {
  std::vector<DrawnTract> lines;
  std::copy_if(tracts.begin(), tracts.end(), std::back_inserter(lines),
               [](const DrawnTract& tract) { return tract.line.points.size() >= kLeastPoints; });
  write_drawn(path, lines, overwrite);
  return lines.size();
}

}  // namespace palpate
