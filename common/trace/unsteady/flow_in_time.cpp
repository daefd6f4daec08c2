#include "common/trace/unsteady/flow_in_time.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <variant>

#include "common/base/index.h"
#include "common/field/field_grid.h"
#include "common/field/grid/box_grid.h"
#include "common/trace/walk/walk_factory.h"

namespace palpate {
namespace {

constexpr double kInside = -FlowInTime::kFace;  // barycentric
constexpr int kMostCells = 512;                 // of a walk; beyond it the index is quicker
// Frames round: a place on the border of one is beyond that of another. Part of a cell that it is kept inside.
constexpr double kBorder = 1e-12;

/// d/dt at times[at] of the parabola through three times, as weights of the values there.
std::array<double, 3> parabola_slope(const std::array<double, 3>& times, std::size_t at) {
  std::array<double, 3> slope{};
  for (std::size_t j = 0; j < 3; ++j) {
    const std::size_t a = (j + 1) % 3, b = (j + 2) % 3;
    slope[j] = (2.0 * times[at] - times[a] - times[b]) / ((times[j] - times[a]) * (times[j] - times[b]));
  }
  return slope;
}

bool same_boxes(const BoxGrid& a, const BoxGrid& b) {
  if (a.points() != b.points() || a.directions() != b.directions()) return false;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < a.points()[axis]; ++i) {
      if (a.coordinate(axis, i) != b.coordinate(axis, i)) return false;
    }
  }
  return true;
}

bool same_frames(const LocalFrame& a, const LocalFrame& b) {
  return a.length_exponent == b.length_exponent && a.rotation == b.rotation;
}

/// Whether the points of one are those of the other moved along the axes of both.
bool same_axes(const VectorField& a, const VectorField& b) {
  const BoxGrid &p = *a.box_grid(), &q = *b.box_grid();
  return p.points() == q.points() && p.directions() == q.directions() &&
         a.frame().rotation == b.frame().rotation && a.grid()->reversed == b.grid()->reversed;
}

/// Whether both are lattices of as many points along each axis, however these lie.
bool same_lattices(const VectorField& a, const VectorField& b) {
  const BoxGrid &p = *a.box_grid(), &q = *b.box_grid();
  return p.uniform() && q.uniform() && p.points() == q.points();
}

/// Where `x` is no farther beyond the border of images, rectilinear grids and formulas than FlowInTime::kFace of a cell, the
/// place `inset` of a cell within: a wall that lets nothing through keeps what rounding takes out. Else `x`.
Vec3 within_border(const VectorField& field, const Vec3& x, double inset) noexcept {
  const auto clamped = [inset](double at, double low, double high, double first, double last) {
    if (at < low && at >= low - FlowInTime::kFace * first) return low + inset * first;
    if (at > high && at <= high + FlowInTime::kFace * last) return high - inset * last;
    return at;
  };
  if (field.analytic() != nullptr) {
    Vec3 out = x;
    const Box& box = field.bounds();
    for (int axis = 0; axis < 3; ++axis) {
      const double width = box.upper[axis] - box.lower[axis];
      out[axis] = clamped(x[axis], box.lower[axis], box.upper[axis], width, width);
    }
    return out;
  }
  if (field.box_grid() == nullptr) return x;
  const BoxGrid& grid = *field.box_grid();
  Vec3 y = grid.along_axes(field.frame().local_from_data(x));
  for (int axis = 0; axis < 3; ++axis) {
    const int last = grid.points()[axis] - 1;
    const double low = grid.coordinate(axis, 0), high = grid.coordinate(axis, last);
    y[axis] =
        clamped(y[axis], low, high, grid.coordinate(axis, 1) - low, high - grid.coordinate(axis, last - 1));
  }
  return field.frame().data_from_local(grid.in_frame(y));
}

/// What `ask` says at `x`, or at the border that it is beyond by rounding. @param ask of a place, gives a status.
template <class Ask>
SampleStatus at_or_within(const VectorField& field, const Vec3& x, const Ask& ask) noexcept {
  SampleStatus status = ask(x);
  // Frames round: the border of one lies beyond that of another. A formula may say of its border what holds behind it.
  constexpr double kRounding = 1e-15;
  for (const double inset : {0.0, kRounding, kBorder}) {
    if (status != SampleStatus::kOutside) break;
    if (inset == 0.0 && field.analytic() != nullptr) continue;
    status = ask(within_border(field, x, inset));
  }
  return status;
}

/// Whether both have the same cells of the same points, whatever the order in which they lie.
bool same_cells(const TetMesh& a, const TetMesh& b) {
  if (a.points().size() != b.points().size() || a.cells().size() != b.cells().size()) return false;
  std::vector<CellIndex> of_b(b.cells().size());
  for (std::size_t c = 0; c < of_b.size(); ++c) of_b[b.cell_order()[c]] = static_cast<CellIndex>(c);
  for (std::size_t c = 0; c < a.cells().size(); ++c) {
    TetMesh::Tet x = a.cells()[c], y = b.cells()[as_size(of_b[a.cell_order()[c]])];
    std::ranges::sort(x);
    std::ranges::sort(y);
    if (x != y) return false;
  }
  return true;
}

}  // namespace

FlowInTime::FlowInTime(std::vector<Step> steps, std::size_t first) : steps_(std::move(steps)), first_(first) {
  const VectorField& field = *steps_[first_].field;
  cell_size_ = 2.0 * default_fixed_step(field) * field.frame().length_scale();
  for (const Step& step : steps_) {
    value_rounding_ = std::max(value_rounding_, step.field->value_rounding());
    if (step.field->grid()) point_rounding_ = std::max(point_rounding_, step.field->grid()->point_rounding);
  }
  compare_meshes();
}

void FlowInTime::compare_meshes() {
  const VectorField& own = *steps_[first_].field;
  bool fixed = true, moving = own.tet_mesh() != nullptr || own.box_grid() != nullptr;
  for (const Step& step : steps_) {
    const VectorField& other = *step.field;
    if (own.analytic() != nullptr && other.analytic() != nullptr) continue;
    if (own.grid() == other.grid()) continue;
    if (own.box_grid() != nullptr) {
      const bool along = other.box_grid() != nullptr && same_axes(own, other);
      const bool turned = !along && other.box_grid() != nullptr && same_lattices(own, other);
      boxes_turn_ = boxes_turn_ || turned;
      moving = moving && (along || turned);
      fixed = fixed && along && same_frames(own.frame(), other.frame()) &&
              same_boxes(*own.box_grid(), *other.box_grid());
      continue;
    }
    moving = moving && other.tet_mesh() != nullptr && same_cells(*own.tet_mesh(), *other.tet_mesh());
    fixed = fixed && moving && same_frames(own.frame(), other.frame()) &&
            std::ranges::equal(own.tet_mesh()->points(), other.tet_mesh()->points());
  }
  mesh_ = fixed ? Mesh::kFixed : moving ? Mesh::kMoving : Mesh::kOther;
  if (mesh_ == Mesh::kOther) return;
  tets_ = own.tet_mesh();
  boxes_move_ = mesh_ == Mesh::kMoving && own.box_grid() != nullptr;
  boxes_turn_ = boxes_turn_ && boxes_move_;
  if (mesh_ != Mesh::kMoving || boxes_move_) return;
  cell_of_data_.resize(tets_->cells().size());
  for (std::size_t c = 0; c < cell_of_data_.size(); ++c)
    cell_of_data_[tets_->cell_order()[c]] = static_cast<CellIndex>(c);
}

FlowInTime::Weights FlowInTime::weights(double t) const noexcept {
  Weights w{};
  const std::size_t k = first_, n = steps_.size();
  const double h = steps_[k + 1].time - steps_[k].time;
  const double s = (t - steps_[k].time) / h;
  if (n == 2) {
    w[k] = 1.0 - s;
    w[k + 1] = s;
    return w;
  }
  // Hermite: both values, and both slopes times h.
  w[k] = (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s);
  w[k + 1] = s * s * (3.0 - 2.0 * s);
  const std::array<double, 2> of_slope{h * s * (1.0 - s) * (1.0 - s), -h * s * s * (1.0 - s)};
  for (std::size_t end = 0; end < 2; ++end) {
    const std::size_t at = k + end;
    const std::size_t lowest = std::min(at == 0 ? 0 : at - 1, n - 3);
    const auto slope =
        parabola_slope({steps_[lowest].time, steps_[lowest + 1].time, steps_[lowest + 2].time}, at - lowest);
    for (std::size_t j = 0; j < 3; ++j) w[lowest + j] += of_slope[end] * slope[j];
  }
  return w;
}

Vec3 FlowInTime::position(const Weights& w, std::uint32_t point) const noexcept {
  if (mesh_ == Mesh::kFixed) return steps_[first_].field->frame().data_from_local(tets_->points()[point]);
  Vec3 sum{0.0};
  for (std::size_t j = 0; j < steps_.size(); ++j) {
    const VectorField& field = *steps_[j].field;
    sum += w[j] * field.frame().data_from_local(field.tet_mesh()->points()[point]);
  }
  return sum;
}

Vec3 FlowInTime::velocity(const Weights& w, std::uint32_t point) const noexcept {
  Vec3 sum{0.0};
  for (std::size_t j = 0; j < steps_.size(); ++j) {
    const VectorField& field = *steps_[j].field;
    const Vec3 stored = std::visit(
        [&](const auto& values) {
          const std::size_t i = 3 * std::size_t{point};
          return Vec3{static_cast<double>(values[i]), static_cast<double>(values[i + 1]),
                      static_cast<double>(values[i + 2])};
        },
        field.values().values);
    sum += w[j] * field.frame().data_from_local_velocity(field.values().scale * stored);
  }
  return sum;
}

bool FlowInTime::enter(const Weights& w, const Vec3& x, Cell& at) const noexcept {
  const TetMesh::Tet& tet = tets_->cells()[as_size(at.cell)];
  const Vec3 origin = position(w, tet[0]);
  const Mat3 edges{position(w, tet[1]) - origin, position(w, tet[2]) - origin, position(w, tet[3]) - origin};
  // Of numbers near one, or the determinant might overflow.
  const double unit = power_of_two(-steps_[first_].field->frame().length_exponent);
  at.inverse = unit * glm::inverse(unit * edges);
  const Vec3 b = at.inverse * (x - origin);
  at.b = {1.0 - b.x - b.y - b.z, b.x, b.y, b.z};
  return is_finite(b);
}

FlowInTime::Walk FlowInTime::walk(const Weights& w, const Vec3& x, Cell& at) const noexcept {
  for (int n = 0; n < kMostCells; ++n) {
    if (tets_->zero_volume(at.cell) || !enter(w, x, at)) return Walk::kLost;
    int lowest = 0;
    for (int i = 1; i < 4; ++i) {
      if (at.b[i] < at.b[lowest]) lowest = i;
    }
    if (at.b[lowest] >= kInside) return Walk::kFound;
    if (tets_->closed(at.cell, lowest)) return Walk::kWall;
    const CellIndex next = tets_->neighbors()[as_size(at.cell)][as_size(lowest)];
    if (next == kNoCell) return Walk::kLost;
    at.cell = next;
  }
  return Walk::kLost;
}

/// Without a place to begin with: by the index of the mesh as it stands at one of its steps.
bool FlowInTime::search(const Weights& w, const Vec3& x, Cell& at) const noexcept {
  const VectorField& field = *steps_[first_].field;
  TetPoint found;
  if (mesh_ == Mesh::kFixed) {
    if (!tets_->locate(field.frame().local_from_data(x), kNoCell, found)) return false;
    at.cell = found.cell;
    const bool sound = enter(w, x, at);
    at.b = found.b;
    return sound;
  }
  for (const std::size_t step : {first_, first_ + 1}) {
    const VectorField& other = *steps_[step].field;
    if (!other.tet_mesh()->locate(other.frame().local_from_data(x), kNoCell, found)) continue;
    at.cell = cell_of_data_[other.tet_mesh()->cell_order()[as_size(found.cell)]];
    if (walk(w, x, at) == Walk::kFound) return true;
  }
  // Where the walk met the border of a mesh that is not convex: the place at the first step that comes to lie at x.
  constexpr int kMostTried = 32;
  Vec3 before = x;
  for (int n = 0; n < kMostTried; ++n) {
    if (!tets_->locate(field.frame().local_from_data(before), found.cell, found)) return false;
    at.cell = found.cell;
    if (!enter(w, x, at)) return false;
    if (std::min(std::min(at.b[0], at.b[1]), std::min(at.b[2], at.b[3])) >= kInside) return true;
    Vec3 there{0.0};
    for (int i = 0; i < 4; ++i)
      there += found.b[i] * position(w, tets_->cells()[as_size(at.cell)][as_size(i)]);
    before += x - there;
  }
  return false;
}

bool FlowInTime::locate(const Weights& w, const Vec3& x, Place& place, Cell& at) const noexcept {
  const bool moving = mesh_ == Mesh::kMoving;
  const auto count = static_cast<std::int64_t>(tets_->cells().size());
  bool found = false;
  if (place.cell >= 0 && place.cell < count) {
    at.cell = moving ? cell_of_data_[as_size(place.cell)] : static_cast<CellIndex>(place.cell);
    const Walk walked = walk(w, x, at);
    if (walked == Walk::kWall) return false;
    found = walked == Walk::kFound;
  }
  if (!found && !search(w, x, at)) return false;
  place.cell = moving ? static_cast<std::int64_t>(tets_->cell_order()[as_size(at.cell)]) : at.cell;
  return true;
}

double FlowInTime::line_at(const Weights& w, int axis, int i) const noexcept {
  double sum = 0.0;
  for (std::size_t j = 0; j < steps_.size(); ++j) {
    const VectorField& field = *steps_[j].field;
    sum += w[j] * field.frame().length_scale() * field.box_grid()->coordinate(axis, i);
  }
  return sum;
}

Vec3 FlowInTime::lattice_point(std::size_t step, const Vec3& number) const noexcept {
  const VectorField& field = *steps_[step].field;
  const BoxGrid& grid = *field.box_grid();
  Vec3 y{0.0};
  for (int axis = 0; axis < 3; ++axis) {
    const int last = grid.points()[axis] - 1;
    const double first = grid.coordinate(axis, 0);
    const double i = field.grid()->reversed[as_size(axis)] ? last - number[axis] : number[axis];
    y[axis] = first + i * ((grid.coordinate(axis, last) - first) / last);
  }
  return field.frame().data_from_local(grid.in_frame(y));
}

Mat3 FlowInTime::lattice_axes(std::size_t step) const noexcept {
  const Index3& n = steps_[step].field->box_grid()->points();
  const Vec3 origin = lattice_point(step, Vec3{0.0});
  Mat3 out;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 last{0.0};
    last[axis] = n[axis] - 1;
    out[axis] = (lattice_point(step, last) - origin) / last[axis];
  }
  return out;
}

bool FlowInTime::locate_in_lattice(const Weights& w, const Vec3& x, BoxPlace& at) const noexcept {
  const VectorField& own = *steps_[first_].field;
  Vec3 origin{0.0};
  Mat3 axes{0.0};
  for (std::size_t j = 0; j < steps_.size(); ++j) {
    origin += w[j] * lattice_point(j, Vec3{0.0});
    axes += w[j] * lattice_axes(j);
  }
  const double unit = power_of_two(-own.frame().length_exponent);
  at.inverse = unit * glm::inverse(unit * axes);
  at.number = at.inverse * (x - origin);
  for (int axis = 0; axis < 3; ++axis) {
    const double last = own.box_grid()->points()[axis] - 1;
    if (!(at.number[axis] >= -kFace && at.number[axis] <= last + kFace)) return false;
    at.number[axis] = std::clamp(at.number[axis], kBorder, last - kBorder);
  }
  return true;
}

bool FlowInTime::locate_in_boxes(const Weights& w, const Vec3& x, BoxPlace& at) const noexcept {
  if (boxes_turn_) return locate_in_lattice(w, x, at);
  const VectorField& own = *steps_[first_].field;
  const BoxGrid& grid = *own.box_grid();
  const Vec3 y = own.frame().length_scale() * grid.along_axes(own.frame().local_from_data(x));
  for (int axis = 0; axis < 3; ++axis) {
    int low = 0, high = grid.points()[axis] - 1;
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      (line_at(w, axis, middle) <= y[axis] ? low : high) = middle;
    }
    const double lower = line_at(w, axis, low);
    at.cell[axis] = low;
    at.width[axis] = line_at(w, axis, low + 1) - lower;
    const double u = (y[axis] - lower) / at.width[axis];
    if (!(u >= -kFace && u <= 1.0 + kFace)) return false;
    at.u[axis] =
        std::clamp(u, low == 0 ? kBorder : 0.0, low + 2 == grid.points()[axis] ? 1.0 - kBorder : 1.0);
  }
  return true;
}

Vec3 FlowInTime::place_in_step(std::size_t step, const BoxPlace& at) const noexcept {
  if (boxes_turn_) return lattice_point(step, at.number);
  const VectorField& field = *steps_[step].field;
  const BoxGrid& grid = *field.box_grid();
  Vec3 y{0.0};
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = grid.coordinate(axis, at.cell[axis]);
    y[axis] = lower + at.u[axis] * (grid.coordinate(axis, at.cell[axis] + 1) - lower);
  }
  return field.frame().data_from_local(grid.in_frame(y));
}

Mat3 FlowInTime::motion_to_step(std::size_t step, const BoxPlace& at) const noexcept {
  if (boxes_turn_) return lattice_axes(step) * at.inverse;
  const VectorField& field = *steps_[step].field;
  const BoxGrid& grid = *field.box_grid();
  const Mat3 along = field.frame().rotation * grid.directions();
  Mat3 stretched = along;
  for (int axis = 0; axis < 3; ++axis) {
    const double width = grid.coordinate(axis, at.cell[axis] + 1) - grid.coordinate(axis, at.cell[axis]);
    stretched[axis] *= field.frame().length_scale() * width / at.width[axis];
  }
  return stretched * glm::inverse(along);
}

bool FlowInTime::find(double t, const Vec3& x, Place& place) const {
  place = {};
  Vec3 v;
  if (tets_ == nullptr) return sample(t, x, place, v) != SampleStatus::kOutside;
  const Weights w = weights(t);
  Cell at;
  if (locate(w, x, place, at)) return true;
  if (mesh_ != Mesh::kMoving) return false;
  // A mesh that moves by more than its size from step to step: no index knows where it is between them.
  Box bounds;
  for (std::uint32_t point = 0; point < tets_->points().size(); ++point) bounds.include(position(w, point));
  if (!bounds.contains(x)) return false;
  for (at.cell = 0; as_size(at.cell) < tets_->cells().size(); ++at.cell) {
    if (tets_->zero_volume(at.cell) || !enter(w, x, at)) continue;
    if (std::min(std::min(at.b[0], at.b[1]), std::min(at.b[2], at.b[3])) < kInside) continue;
    place.cell = tets_->cell_order()[as_size(at.cell)];
    return true;
  }
  return false;
}

SampleStatus FlowInTime::sample(double t, const Vec3& x, Place& place, Vec3& v) const noexcept {
  const Weights w = weights(t);
  v = Vec3{0.0};
  if (tets_ == nullptr) {
    BoxPlace box;
    if (boxes_move_ && !locate_in_boxes(w, x, box)) return SampleStatus::kOutside;
    for (std::size_t j = 0; j < steps_.size(); ++j) {
      if (w[j] == 0.0) continue;
      const Vec3 there = boxes_move_ ? place_in_step(j, box) : x;
      const VectorField& field = *steps_[j].field;
      VectorSample sample;
      const SampleStatus status = at_or_within(field, there, [&](const Vec3& at) {
        sample = field.sample(at, place.hints[j]);
        return sample.status;
      });
      if (status != SampleStatus::kOk) return status;
      v += w[j] * sample.value;
    }
    return SampleStatus::kOk;
  }
  Cell at;
  if (!locate(w, x, place, at)) return SampleStatus::kOutside;
  for (int i = 0; i < 4; ++i) v += at.b[i] * velocity(w, tets_->cells()[as_size(at.cell)][as_size(i)]);
  return is_finite(v) ? SampleStatus::kOk : SampleStatus::kBadData;
}

SampleStatus FlowInTime::jacobian(double t, const Vec3& x, Place& place, Mat3& m) const noexcept {
  const Weights w = weights(t);
  m = Mat3{0.0};
  if (tets_ == nullptr) {
    BoxPlace box;
    if (boxes_move_ && !locate_in_boxes(w, x, box)) return SampleStatus::kOutside;
    for (std::size_t j = 0; j < steps_.size(); ++j) {
      if (w[j] == 0.0) continue;
      Mat3 own{0.0};
      const Vec3 there = boxes_move_ ? place_in_step(j, box) : x;
      const VectorField& field = *steps_[j].field;
      const SampleStatus status =
          at_or_within(field, there, [&](const Vec3& at) { return field.jacobian(at, place.hints[j], own); });
      if (status != SampleStatus::kOk) {
        m = Mat3{0.0};
        return status;
      }
      m += w[j] * (boxes_move_ ? own * motion_to_step(j, box) : own);
    }
    return SampleStatus::kOk;
  }
  Cell at;
  if (!locate(w, x, place, at)) return SampleStatus::kOutside;
  const TetMesh::Tet& tet = tets_->cells()[as_size(at.cell)];
  const Mat3 gradients = glm::transpose(at.inverse);
  const Vec3 corner = velocity(w, tet[0]);
  for (int i = 0; i < 3; ++i) m += glm::outerProduct(velocity(w, tet[as_size(i + 1)]) - corner, gradients[i]);
  if (is_finite(m[0]) && is_finite(m[1]) && is_finite(m[2])) return SampleStatus::kOk;
  m = Mat3{0.0};
  return SampleStatus::kBadData;
}

}  // namespace palpate
