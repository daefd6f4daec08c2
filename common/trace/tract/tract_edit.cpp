#include "common/trace/tract/tract_edit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/base/index.h"

namespace palpate {
namespace {

using Columns = std::vector<Tractogram::Column>;

/// New lines of the points and the numbers of others.
class LineWriter {
 public:
  explicit LineWriter(const Tractogram& from) : from_(from) {
    for (const auto& column : from.of_points) out_.of_points.push_back({.name = column.name, .values = {}});
    for (const auto& column : from.of_lines) out_.of_lines.push_back({.name = column.name, .values = {}});
    out_.image = from.image;
  }

  /// `part` of the way from point `at` of all points to the next one.
  void add(std::size_t at, double part = 0.0) { add(at, part, place(at, part)); }
  void add(std::size_t at, double part, const Vec3& moved) {
    out_.points.emplace_back(moved);
    for (std::size_t c = 0; c < out_.of_points.size(); ++c) {
      const std::vector<float>& values = from_.of_points[c].values;
      const double value = part == 0.0 ? values[at] : (1.0 - part) * values[at] + part * values[at + 1];
      out_.of_points[c].values.push_back(static_cast<float>(value));
    }
  }
  [[nodiscard]] Vec3 place(std::size_t at, double part) const {
    const Vec3 here(from_.points[at]);
    return part == 0.0 ? here : here + part * (Vec3(from_.points[at + 1]) - here);
  }
  /// The points since the last call are a line, with the numbers of `line`; one point alone is none.
  void end(std::size_t line) {
    const std::size_t begun = out_.starts.back();
    if (out_.points.size() < begun + 2) {
      out_.points.resize(begun);
      for (auto& column : out_.of_points) column.values.resize(begun);
      return;
    }
    out_.starts.push_back(out_.points.size());
    for (std::size_t c = 0; c < out_.of_lines.size(); ++c)
      out_.of_lines[c].values.push_back(from_.of_lines[c].values[line]);
  }
  void copy(std::size_t line) {
    for (std::size_t p = from_.starts[line]; p < from_.starts[line + 1]; ++p) add(p);
    end(line);
  }
  [[nodiscard]] Tractogram take() { return std::move(out_); }

 private:
  const Tractogram& from_;
  Tractogram out_;
};

/// Lengths along a line from its first point.
std::vector<double> lengths_along(std::span<const Vec3f> line) {
  std::vector<double> along(line.size(), 0.0);
  for (std::size_t p = 1; p < line.size(); ++p)
    along[p] = along[p - 1] + glm::distance(Vec3(line[p - 1]), Vec3(line[p]));
  return along;
}

std::vector<std::size_t> all_but(std::size_t count, std::span<const std::size_t> numbers) {
  std::vector<bool> kept(count, true);
  for (const std::size_t n : numbers) {
    if (n < count) kept[n] = false;
  }
  std::vector<std::size_t> rest;
  for (std::size_t i = 0; i < count; ++i) {
    if (kept[i]) rest.push_back(i);
  }
  return rest;
}

/// How many equal steps of a piece of that length are none longer than kRegionStep. A piece longer than a metre is no
/// part of a head: it is looked at in steps of a thousandth of it.
int steps_of(double length) {
  constexpr double kMost = 4000.0;
  return static_cast<int>(std::clamp(std::ceil(length / kRegionStep), 1.0, kMost));
}

bool passes(std::span<const Vec3f> line, const TractRegion& region) {
  if (line.empty()) return false;
  if (region.contains(Vec3(line.front()))) return true;
  for (std::size_t p = 1; p < line.size(); ++p) {
    const Vec3 from(line[p - 1]), way = Vec3(line[p]) - from;
    const int steps = steps_of(glm::length(way));
    for (int s = 1; s <= steps; ++s) {
      if (region.contains(from + (static_cast<double>(s) / steps) * way)) return true;
    }
  }
  return false;
}

/// The points about `p` of `line`, weighted; the ends of the line stay.
Vec3 smoothed(std::span<const Vec3f> line, const std::vector<double>& along, std::size_t p,
              double deviation) {
  constexpr double kReach = 3.0;  // deviations
  const double to_end = std::min(along[p], along.back() - along[p]);
  const double own = std::min(deviation, to_end / kReach);
  if (!(own > 0.0)) return Vec3(line[p]);
  // Of the polyline, not of its points: these may be unevenly spread. Midpoints of equal steps.
  constexpr int kSteps = 24;
  Vec3 sum{0.0};
  double weights = 0.0;
  auto piece = as_size(std::upper_bound(along.begin(), along.end(), along[p] - kReach * own) - along.begin());
  piece = std::clamp<std::size_t>(piece, 1, line.size() - 1);
  for (int s = 0; s <= kSteps; ++s) {
    const double offset = kReach * own * (2.0 * s / kSteps - 1.0);
    const double at = std::clamp(along[p] + offset, 0.0, along.back());
    while (piece + 1 < line.size() && along[piece] < at) ++piece;
    const double length = along[piece] - along[piece - 1];
    const double part = length > 0.0 ? (at - along[piece - 1]) / length : 0.0;
    const double weight = std::exp(-0.5 * (offset / own) * (offset / own));
    sum += weight * (Vec3(line[piece - 1]) + part * (Vec3(line[piece]) - Vec3(line[piece - 1])));
    weights += weight;
  }
  return sum / weights;
}

void append_columns(const Columns& more, std::size_t before, std::size_t count, Columns& columns) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const auto& column : more) {
    auto found = std::ranges::find(columns, column.name, &Tractogram::Column::name);
    if (found == columns.end()) {
      columns.push_back({.name = column.name, .values = std::vector<float>(before, nan)});
      found = std::prev(columns.end());
    }
    found->values.resize(before, nan);
    found->values.insert(found->values.end(), column.values.begin(), column.values.end());
  }
  for (auto& column : columns) column.values.resize(before + count, nan);
}

template <typename Measure>
std::optional<LinePlace> least_place(const Tractogram& lines, std::size_t first, std::size_t last,
                                     const Measure& measure) {
  std::optional<LinePlace> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t l = first; l < last; ++l) {
    const std::span<const Vec3f> line = lines.line(l);
    for (std::size_t p = 0; p + 1 < line.size(); ++p) {
      LinePlace here{.line = l, .point = p};
      const double found = measure(Vec3(line[p]), Vec3(line[p + 1]), here);
      if (found < least) {
        least = found;
        best = here;
      }
    }
  }
  return best;
}

}  // namespace

std::optional<LinePlace> nearest_place_of(const Tractogram& lines, std::size_t line, const Vec3& x) {
  return least_place(lines, line, line + 1, [&](const Vec3& a, const Vec3& b, LinePlace& here) {
    const Vec3 way = b - a;
    const double square = glm::dot(way, way);
    here.part = square > 0.0 ? std::clamp(glm::dot(x - a, way) / square, 0.0, 1.0) : 0.0;
    here.place = a + here.part * way;
    return here.distance = glm::distance(x, here.place);
  });
}

std::optional<LinePlace> nearest_place(const Tractogram& lines, const Vec3& x) {
  std::optional<LinePlace> best;
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    const auto here = nearest_place_of(lines, l, x);
    if (here && (!best || here->distance < best->distance)) best = here;
  }
  return best;
}

std::optional<LinePlace> place_along_ray(const Tractogram& lines, const Vec3& origin, const Vec3& direction,
                                         double radius, double spread) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  return least_place(lines, 0, lines.line_count(), [&](const Vec3& a, const Vec3& b, LinePlace& here) {
    // Nearest to the ray where the piece, seen along the ray, comes nearest to its axis.
    const auto across = [&](const Vec3& x) { return x - glm::dot(x, direction) * direction; };
    const Vec3 from = across(a - origin), way = across(b - a);
    const double square = glm::dot(way, way);
    here.part = square > 0.0 ? std::clamp(-glm::dot(from, way) / square, 0.0, 1.0) : 0.0;
    here.place = a + here.part * (b - a);
    here.distance = glm::length(from + here.part * way);
    const double depth = glm::dot(here.place - origin, direction), allowed = radius + spread * depth;
    return depth > 0.0 && here.distance <= allowed ? here.distance / allowed : kNone;
  });
}

void append_lines(const Tractogram& more, Tractogram& lines) {
  const std::size_t points = lines.points.size(), count = lines.line_count();
  append_columns(more.of_points, points, more.points.size(), lines.of_points);
  append_columns(more.of_lines, count, more.line_count(), lines.of_lines);
  lines.points.insert(lines.points.end(), more.points.begin(), more.points.end());
  for (std::size_t l = 0; l < more.line_count(); ++l) lines.starts.push_back(points + more.starts[l + 1]);
  if (!lines.image) lines.image = more.image;
}

Tractogram take_lines(const Tractogram& lines, std::span<const std::size_t> numbers) {
  LineWriter out(lines);
  for (const std::size_t n : numbers) out.copy(n);
  return out.take();
}

Tractogram delete_lines(const Tractogram& lines, std::span<const std::size_t> numbers) {
  return take_lines(lines, all_but(lines.line_count(), numbers));
}

Tractogram cut_line(const Tractogram& lines, const LinePlace& at) {
  LineWriter out(lines);
  const std::size_t cut = lines.starts[at.line] + at.point;
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    if (l != at.line) {
      out.copy(l);
      continue;
    }
    for (std::size_t p = lines.starts[l]; p <= cut; ++p) out.add(p);
    if (at.part > 0.0) out.add(cut, at.part);
    out.end(l);
  }
  out.add(cut, at.part);
  for (std::size_t p = cut + 1; p < lines.starts[at.line + 1]; ++p) out.add(p);
  out.end(at.line);
  return out.take();
}

Tractogram part_lines(const Tractogram& lines, const HalfSpace& plane) {
  LineWriter out(lines);
  const auto above = [&](std::size_t p) {
    return glm::dot(plane.normal, Vec3(lines.points[p])) - plane.offset;
  };
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    for (std::size_t p = lines.starts[l]; p < lines.starts[l + 1]; ++p) {
      out.add(p);
      if (p + 1 == lines.starts[l + 1]) break;
      const double here = above(p), next = above(p + 1);
      if ((here > 0.0) == (next > 0.0)) continue;
      const double part = std::clamp(here / (here - next), 0.0, 1.0);
      out.add(p, part);
      out.end(l);
      out.add(p, part);
    }
    out.end(l);
  }
  return out.take();
}

Tractogram join_lines(const Tractogram& lines, std::size_t a, std::size_t b) {
  const auto end_of = [&](std::size_t l, bool last) {
    const std::span<const Vec3f> line = lines.line(l);
    return Vec3(last ? line.back() : line.front());
  };
  bool from_last = true, to_last = false;  // the ends that meet
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [first, second] :
       std::array<std::pair<bool, bool>, 4>{{{true, false}, {true, true}, {false, false}, {false, true}}}) {
    const double apart = glm::distance(end_of(a, first), end_of(b, second));
    if (!(apart < least)) continue;
    least = apart;
    from_last = first;
    to_last = second;
  }
  LineWriter out(lines);
  const auto add = [&](std::size_t l, bool forward) {
    const std::size_t first = lines.starts[l], last = lines.starts[l + 1];
    for (std::size_t p = first; p < last; ++p) out.add(forward ? p : last - 1 - (p - first));
  };
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    if (l == b) continue;
    if (l != a) {
      out.copy(l);
      continue;
    }
    add(a, from_last);
    add(b, !to_last);
    out.end(a);
  }
  return out.take();
}

Tractogram smooth_lines(const Tractogram& lines, double deviation) {
  LineWriter out(lines);
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    const std::span<const Vec3f> line = lines.line(l);
    const std::vector<double> along = lengths_along(line);
    for (std::size_t p = 0; p < line.size(); ++p)
      out.add(lines.starts[l] + p, 0.0, smoothed(line, along, p, deviation));
    out.end(l);
  }
  return out.take();
}

Tractogram resample_lines(const Tractogram& lines, double spacing) {
  LineWriter out(lines);
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    const std::span<const Vec3f> line = lines.line(l);
    if (line.size() < 2) continue;
    const std::vector<double> along = lengths_along(line);
    const double pieces = std::max(1.0, std::ceil(along.back() / spacing));
    const auto count = static_cast<std::size_t>(pieces);
    std::size_t piece = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double wanted = along.back() * static_cast<double>(i) / pieces;
      while (piece + 2 < line.size() && along[piece + 1] < wanted) ++piece;
      const double length = along[piece + 1] - along[piece];
      out.add(lines.starts[l] + piece,
              length > 0.0 ? std::clamp((wanted - along[piece]) / length, 0.0, 1.0) : 0.0);
    }
    out.add(lines.starts[l + 1] - 1);
    out.end(l);
  }
  return out.take();
}

Tractogram lines_of_length(const Tractogram& lines, double least, double most) {
  LineWriter out(lines);
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    const std::vector<double> along = lengths_along(lines.line(l));
    if (!along.empty() && along.back() >= least && along.back() <= most) out.copy(l);
  }
  return out.take();
}

Tractogram lines_through(const Tractogram& lines, const TractRegion& region, bool through) {
  LineWriter out(lines);
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    if (passes(lines.line(l), region) == through) out.copy(l);
  }
  return out.take();
}

Tractogram cropped_lines(const Tractogram& lines, const TractRegion& region) {
  LineWriter out(lines);
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    bool inside = false;
    for (std::size_t p = lines.starts[l]; p < lines.starts[l + 1]; ++p) {
      const bool here = region.contains(Vec3(lines.points[p]));
      if (here) out.add(p);
      if (!here && inside) out.end(l);
      inside = here;
      if (p + 1 == lines.starts[l + 1]) break;
      const double length = glm::distance(Vec3(lines.points[p]), Vec3(lines.points[p + 1]));
      const int steps = steps_of(length);
      for (int s = 1; s < steps; ++s) {
        const double part = static_cast<double>(s) / steps;
        const bool there = region.contains(out.place(p, part));
        if (there != inside) {
          out.add(p, there ? part : static_cast<double>(s - 1) / steps);
          if (!there) out.end(l);
        }
        inside = there;
      }
    }
    out.end(l);
  }
  return out.take();
}

}  // namespace palpate
