#include "common/trace/isosurface/isosurface_tets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/base/index.h"
#include "common/field/grid/tet_shape.h"

namespace palpate {
namespace {

/// Barycentric coordinates below this count as zero when the cells around a point are gathered: more cells
/// than those that touch it do no harm, fewer would stop the descent.
constexpr double kTouching = 0x1p-20;
constexpr int kMaxAround = 64;

/// A cell with what a search asks of it.
struct Cell {
  std::array<Vec3, 4> x;
  Vec4 f{0.0};  ///< s - s_0 at the vertices
  bool bad = false;
  bool flat = false;  ///< no volume
  bool crossed = false;
  std::array<Vec3, 4> normal;  ///< gradients of the barycentric coordinates
  Vec3 gradient{0.0};
  int alone = -1;  ///< a vertex that the level parts from all others: its opposite face holds no side

  [[nodiscard]] Vec4 barycentric(const Vec3& p) const noexcept {
    const Vec3 d = p - x[0];
    const double b1 = glm::dot(d, normal[1]), b2 = glm::dot(d, normal[2]), b3 = glm::dot(d, normal[3]);
    return {1.0 - b1 - b2 - b3, b1, b2, b3};
  }
  [[nodiscard]] Vec4 rates(const Vec3& d) const noexcept {
    return {glm::dot(d, normal[0]), glm::dot(d, normal[1]), glm::dot(d, normal[2]), glm::dot(d, normal[3])};
  }
};

/// What part of the cell's polygon the closest point lies on.
enum class Place : std::uint8_t { kInside, kEdge, kCorner };

struct Closest {
  Vec3 point{0.0};
  Vec4 b{0.0};
  Place place = Place::kInside;
  Vec3 along{0.0};           ///< of the edge
  double square = HUGE_VAL;  ///< of the distance
};

Cell load(const TetMesh& mesh, const PointScalars& values, std::int64_t index, double level) noexcept {
  Cell out;
  const auto c = as_size(index);
  const TetMesh::Tet& tet = mesh.cells()[c];
  const ScalarTet s = load_scalar_tet(values, tet);
  out.bad = s.bad_data;
  out.flat = mesh.zero_volume(static_cast<CellIndex>(index));
  for (std::size_t i = 0; i < 4; ++i) out.x[i] = mesh.points()[tet[i]];
  out.f = s.s - level;
  if (out.flat || out.bad) return out;
  const Mat3 gradients = mesh.barycentric_gradients(static_cast<CellIndex>(index));
  out.normal = {-(gradients[0] + gradients[1] + gradients[2]), gradients[0], gradients[1], gradients[2]};
  out.gradient = gradients * Vec3{out.f[1] - out.f[0], out.f[2] - out.f[0], out.f[3] - out.f[0]};
  int above = 0;
  for (int i = 0; i < 4; ++i) above += out.f[i] >= 0.0 ? 1 : 0;
  out.crossed = above != 0 && above != 4;
  for (int i = 0; i < 4; ++i) {
    if (above == (out.f[i] >= 0.0 ? 1 : 3)) out.alone = i;
  }
  return out;
}

/// Where the level lies between vertices `low` (below it) and `high`: the weight of `high`.
double weight_of_high(const Cell& cell, int low, int high) noexcept {
  return cell.f[low] / (cell.f[low] - cell.f[high]);
}

/// The closest point to `x` on the side of the polygon that lies in face `face`; leaves `best` where there is
/// no such side or it is no nearer.
void closest_on_face(const Cell& cell, int face, const Vec3& x, Closest& best) noexcept {
  std::array<int, 3> low{}, high{};
  int lows = 0, highs = 0;
  for (int i = 0; i < 4; ++i) {
    if (i == face) continue;
    if (cell.f[i] >= 0.0) {
      high[as_size(highs++)] = i;
    } else {
      low[as_size(lows++)] = i;
    }
  }
  if (lows == 0 || highs == 0) return;
  // One vertex stands against two: the side runs between its edges to them.
  std::array<Vec4, 2> end{Vec4{0.0}, Vec4{0.0}};
  for (std::size_t e = 0; e < 2; ++e) {
    const int a = low[lows == 2 ? e : 0], b = high[highs == 2 ? e : 0];
    const double w = weight_of_high(cell, a, b);
    end[e][b] = w;
    end[e][a] = 1.0 - w;
  }
  const auto at = [&cell](const Vec4& b) {
    return b[0] * cell.x[0] + b[1] * cell.x[1] + b[2] * cell.x[2] + b[3] * cell.x[3];
  };
  const Vec3 from = at(end[0]), side = at(end[1]) - from;
  const double length2 = glm::dot(side, side);
  const double along = length2 > 0.0 ? glm::dot(x - from, side) / length2 : 0.0;
  Closest found;
  if (along > 0.0 && along < 1.0) {
    found.b = (1.0 - along) * end[0] + along * end[1];
    found.place = Place::kEdge;
    found.along = side / std::sqrt(length2);
  } else {
    found.b = along >= 1.0 ? end[1] : end[0];
    found.place = Place::kCorner;
  }
  found.point = at(found.b);
  const Vec3 away = x - found.point;
  found.square = glm::dot(away, away);
  if (found.square < best.square) best = found;
}

/// The closest point to `x` of the cell's polygon. @pre cell.crossed.
Closest closest_in(const Cell& cell, const Vec3& x) noexcept {
  Closest out;
  const double slope2 = glm::dot(cell.gradient, cell.gradient);
  Vec4 b = cell.barycentric(x);
  if (slope2 > 0.0 && std::isfinite(slope2)) {
    // Eq. 6.16, which one step of makes exact here; twice, since x may be far away.
    Vec3 p = x;
    for (int i = 0; i < 2; ++i) {
      p -= cell.gradient * (glm::dot(cell.barycentric(p), cell.f) / slope2);
    }
    b = cell.barycentric(p);
    bool in = true;
    for (int i = 0; i < 4; ++i) in = in && (b[i] >= 0.0 || i == cell.alone);
    if (in) {
      const Vec3 away = x - p;
      return {p, b, Place::kInside, Vec3{0.0}, glm::dot(away, away)};
    }
  }
  // The closest point lies on a side that the projection is beyond; where rounding hides it, on any.
  for (int face = 0; face < 4; ++face) {
    if (b[face] < 0.0 && face != cell.alone) closest_on_face(cell, face, x, out);
  }
  if (out.square == HUGE_VAL) {
    for (int face = 0; face < 4; ++face) closest_on_face(cell, face, x, out);
  }
  return out;
}

Mat3 jacobian_of(const Cell& cell, const Closest& closest) noexcept {
  if (closest.place == Place::kCorner) return Mat3{0.0};
  if (closest.place == Place::kEdge) return glm::outerProduct(closest.along, closest.along);
  const double slope2 = glm::dot(cell.gradient, cell.gradient);
  return Mat3{1.0} - glm::outerProduct(cell.gradient, cell.gradient) * (1.0 / slope2);
}

/// Cells still to be looked at, each once.
struct Around {
  std::array<std::int64_t, kMaxAround> cell{};
  int count = 0;

  void add(std::int64_t index) noexcept {
    if (index < 0 || count == kMaxAround) return;
    for (int i = 0; i < count; ++i) {
      if (cell[as_size(i)] == index) return;
    }
    cell[as_size(count++)] = index;
  }
};

}  // namespace

TetIsosurfaceSearch::TetIsosurfaceSearch(std::shared_ptr<const ScalarField> field)
    : field_(std::move(field)), mesh_(*field_->tet_mesh()), scale_(*field_) {}

SurfaceFit TetIsosurfaceSearch::settle(const Vec3& x, SurfacePoint& point, SearchWork& work) const noexcept {
  SurfaceFit fit;
  Cell cell = load(mesh_, field_->values(), point.cell, point.level);
  Closest here;
  if (cell.flat || cell.bad) {
    fit.end = cell.bad ? SurfaceEnd::kBadData : SurfaceEnd::kFlat;
    return fit;
  }
  if (cell.crossed) {
    here = closest_in(cell, x);
  } else {  // a crossing at the very border of the cell: the polygon is in one beside it
    here.point = point.position;
    here.b = cell.barycentric(point.position);
    here.place = Place::kCorner;
  }
  for (;;) {
    const Vec3 d = x - here.point;
    fit.toward = glm::dot(cell.gradient, d);
    if (here.place == Place::kInside &&
        std::min(std::min(here.b[0], here.b[1]), std::min(here.b[2], here.b[3])) > kTouching) {
      break;
    }
    // Nearer by less than rounding is no reason to move: it would go to and fro.
    const double noise = 2.0 * scale_.distance * (std::sqrt(here.square) + scale_.distance);
    Closest best;
    if (cell.crossed) best.square = here.square - noise;
    Cell best_cell;
    std::int64_t best_index = -1;
    Around around;
    around.add(point.cell);
    bool bad = false, spent = false;
    for (int k = 0; k < around.count; ++k) {
      const std::int64_t index = around.cell[as_size(k)];
      const auto& behind = mesh_.neighbors()[as_size(index)];
      if (k > 0 && !work.take()) {
        spent = true;
        break;
      }
      const Cell each = k == 0 ? cell : load(mesh_, field_->values(), index, point.level);
      if (each.flat) {  // what lies behind is as good as beside
        for (const CellIndex other : behind) around.add(other);
        continue;
      }
      if (each.bad) {
        bad = true;
        continue;
      }
      const Vec4 b = k == 0 ? here.b : each.barycentric(here.point);
      const Vec4 rates = each.rates(d);
      bool touches = true, enters = true;
      for (int i = 0; i < 4; ++i) {
        touches = touches && b[i] >= -kTouching;
        enters = enters && (b[i] > kTouching || rates[i] >= 0.0);
      }
      if (!touches) continue;
      for (int i = 0; i < 4; ++i) {
        if (b[i] <= kTouching) around.add(behind[as_size(i)]);
      }
      // The sign of s - s_0 on the way to x is that of the cell which the way leads into.
      if (enters) fit.toward = each.crossed ? glm::dot(each.gradient, d) : each.f[0];
      if (k == 0 || !each.crossed) continue;
      const Closest other = closest_in(each, x);
      if (other.square < best.square) {
        best = other;
        best_cell = each;
        best_index = index;
      }
    }
    if (best_index >= 0) {
      point.cell = best_index;
      cell = best_cell;
      here = best;
    } else if (!spent && (bad || !cell.crossed)) {
      fit.end = bad ? SurfaceEnd::kBadData : SurfaceEnd::kFlat;
    }
    if (spent) fit.end = SurfaceEnd::kBudget;
    if (best_index < 0 || spent) break;
  }
  point.position = here.point;
  fit.gradient = cell.gradient;
  fit.error = glm::dot(here.b, cell.f);
  fit.jacobian = jacobian_of(cell, here);
  if (here.square == 0.0) fit.toward = 0.0;
  return fit;
}

bool TetIsosurfaceSearch::begin(SurfacePath& path, const SurfaceLevels& levels) const noexcept {
  TetPoint found;
  const auto hint = path.cell >= 0 ? static_cast<CellIndex>(path.cell) : kNoCell;
  if (!mesh_.locate(path.at, hint, found)) {
    path.cell = -1;
    path.side.fill(0);
    return false;
  }
  path.cell = found.cell;
  const ScalarTet tet = load_scalar_tet(field_->values(), mesh_.cells()[as_size(found.cell)]);
  for (int l = 0; l < levels.count; ++l) {
    const auto i = as_size(l);
    if (tet.bad_data) {
      path.side[i] = 0;
    } else if (path.side[i] == 0) {
      path.side[i] = glm::dot(found.b, tet.s) >= levels.value[i] ? 1 : -1;
    }
  }
  return true;
}

/// On to `to` where no walk leads there: past cells without volume, or over a gap in the mesh. What was
/// crossed on the way is found by halving.
int TetIsosurfaceSearch::jump(SurfacePath& path, const Vec3& to, const SurfaceLevels& levels,
                              SearchWork& work) const noexcept {
  const SurfacePath before = path;
  path = {.at = to, .cell = path.cell};
  if (!begin(path, levels)) return -1;
  for (int l = 0; l < levels.count; ++l) {
    const auto i = as_size(l);
    if (before.side[i] == 0 || path.side[i] == 0 || before.side[i] == path.side[i]) continue;
    SurfacePath near = before;
    Vec3 far = to;
    constexpr int kHalvings = 48;
    for (int n = 0; n < kHalvings; ++n) {
      if (!work.take()) {
        path = before;
        return -1;
      }
      SurfacePath middle{.at = 0.5 * (near.at + far), .cell = path.cell};
      if (!begin(middle, levels)) return -1;  // outside: nobody knows where
      if (middle.side[i] == before.side[i]) {
        near = middle;
      } else {
        far = middle.at;
        path = middle;
      }
    }
    return l;
  }
  return -1;
}

int TetIsosurfaceSearch::advance(SurfacePath& path, const Vec3& to, const SurfaceLevels& levels,
                                 SearchWork& work) const noexcept {
  if (!begin(path, levels)) return jump(path, to, levels, work);
  int entry = -1;
  for (;;) {
    const auto c = as_size(path.cell);
    const Cell cell = load(mesh_, field_->values(), path.cell, 0.0);
    if (cell.flat) return jump(path, to, levels, work);
    const Vec3 d = to - path.at;
    const Vec3 from = path.at - cell.x[0];
    Vec4 b, rate;
    if (cell.bad) {
      const TetShape shape(mesh_.points().data(), mesh_.cells()[c]);
      b = shape.barycentric(from);
      rate = shape.barycentric(from + d) - b;
      path.side.fill(0);
    } else {
      b = cell.barycentric(path.at);
      rate = cell.rates(d);
    }
    double leave = 1.0;
    int face = -1;
    for (int i = 0; i < 4; ++i) {
      if (i == entry || !(rate[i] < 0.0)) continue;
      const double at = std::max(b[i], 0.0) / -rate[i];
      if (at < leave) {
        leave = at;
        face = i;
      }
    }
    if (!cell.bad) {
      const double s = glm::dot(b, cell.f), slope = glm::dot(rate, cell.f);
      double first = 2.0;
      int crossed = -1;
      for (int l = 0; l < levels.count; ++l) {
        auto& side = path.side[as_size(l)];
        const double f = s - levels.value[as_size(l)];
        const double f_end = f + leave * slope;
        if (side == 0) {
          side = f_end >= 0.0 ? 1 : -1;
        } else if (side * f_end < -scale_.beyond()) {
          const double at = side * f > 0.0 ? f / (f - f_end) * leave : 0.0;
          if (at < first) {
            first = at;
            crossed = l;
          }
        }
      }
      if (crossed >= 0) {
        path.at += first * d;
        path.side[as_size(crossed)] *= -1;
        return crossed;
      }
    }
    if (face < 0) {
      path.at = to;
      return -1;
    }
    path.at += leave * d;
    const CellIndex next = mesh_.neighbors()[c][as_size(face)];
    if (next == kNoCell) return jump(path, to, levels, work);
    const auto& behind = mesh_.neighbors()[as_size(next)];
    entry = -1;
    for (int i = 0; i < 4; ++i) {
      if (behind[as_size(i)] == path.cell) entry = i;
    }
    path.cell = next;
    if (!work.take()) return -1;
  }
}

}  // namespace palpate
