#include "common/app/haptic/drawn_tract.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/load/write_lines.h"

namespace palpate {

TractPen::TractPen(std::shared_ptr<const TensorField> field, double spacing)
    : field_(std::move(field)), spacing_(spacing) {}

void TractPen::add(double time, const Vec3& proxy, double force) {
  if (!down_) {
    tracts_.emplace_back();
    tracts_.back().line.end = End::kStoppedByRule;
    tracts_.back().line.seed = static_cast<std::uint32_t>(tracts_.size() - 1);
    start_ = time;
    down_ = true;
  }
  DrawnTract& tract = tracts_.back();
  std::vector<LinePoint>& points = tract.line.points;
  if (!points.empty()) {
    const double step = glm::distance(points.back().position, proxy);
    if (!(step > spacing_)) {
      tract.forces.back() = std::max(tract.forces.back(), force);
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
                      .error = spacing_});
  } else {
    points.push_back({.position = proxy, .error = spacing_});
  }
  tract.forces.push_back(force);
  tract.measures.push_back(measures_at(*field_, proxy, hint_));
}

void TractPen::clear() {
  tracts_.clear();
  down_ = false;
}

std::size_t save_tracts(const std::filesystem::path& path, const std::vector<DrawnTract>& tracts,
                        bool overwrite) {
  std::vector<Line> lines;
  std::array<PointColumn, 4> columns{PointColumn{.name = "force", .values = {}},
                                     {.name = "cl", .values = {}},
                                     {.name = "cp", .values = {}},
                                     {.name = "fa", .values = {}}};
  for (const DrawnTract& tract : tracts) {
    if (tract.line.points.size() < 2) continue;
    lines.push_back(tract.line);
    columns[0].values.insert(columns[0].values.end(), tract.forces.begin(), tract.forces.end());
    for (const TensorMeasures& measures : tract.measures) {
      columns[1].values.push_back(measures.parts.linear);
      columns[2].values.push_back(measures.parts.planar);
      columns[3].values.push_back(measures.fractional_anisotropy);
    }
  }
  write_lines(path, lines, overwrite, columns);
  return lines.size();
}

}  // namespace palpate
