#include "common/trace/exact/exact_walk.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "common/base/index.h"
#include "common/trace/walk/tet_crossing.h"

namespace palpate {
namespace {

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();
// Coordinates are stored with 2^-53 of their size; that much is uncertain of every point.
constexpr double kRoundingOfPoint = 2.0;
constexpr double kNearRest = 16.0;  // resolutions of the values: slower is hardly told from rest

}  // namespace

ExactWalk::ExactWalk(const ExactMesh& mesh, double rest_distance, TraceDirection direction,
                     const ExactKernel& kernel)
    : mesh_(&mesh),
      kernel_(kernel),
      rest_distance_(rest_distance),
      sign_(direction == TraceDirection::kForward ? 1.0 : -1.0) {}

void ExactWalk::enter_cell() {
  finite_ = kernel_.load(cell_, mesh_->vertices(), mesh_->mesh().cells()[as_size(cell_index_)].data(), sign_);
  loaded_ = true;
}

bool ExactWalk::start(const Vec3& seed) {
  TetPoint found;
  if (!mesh_->mesh().locate(seed, kNoCell, found)) return false;
  cell_index_ = found.cell;
  entry_ = -1;
  exit_face_ = -1;
  pieces_in_cell_ = 0;
  standing_ = 0;
  seams_standing_ = crossings_ = 0;
  moved_ = 0.0;
  modes_.reset();
  robust_pieces_ = long_cells_ = 0;
  has_piece_ = false;
  b_ = Pack4{std::max(found.b[0], 0.0), std::max(found.b[1], 0.0), std::max(found.b[2], 0.0),
             std::max(found.b[3], 0.0)};
  enter_cell();
  w_ = rate(cell_, b_);
  const Vec3 v = velocity(cell_, w_).xyz();
  const double speed = finite_ ? glm::length(v) : 0.0;
  direction_ = speed > 0.0 ? v / speed : Vec3{0.0};
  const double rounding = kUlp * (cell_.size + glm::length(seed));
  error_.start(direction_, rounding);
  end_ = LinePoint{.position = seed, .time = 0.0, .arc = 0.0, .speed = speed, .error = rounding};
  begin_ = end_;
  return true;
}

void ExactWalk::save(StateWriter& out) const { each_member(*this, out); }

void ExactWalk::restore(StateReader& in) {
  each_member(*this, in);
  has_piece_ = false;
  modes_.reset();
  if (loaded_) enter_cell();
}

std::optional<End> ExactWalk::advance() {
  has_piece_ = false;
  work_ = 1;
  if (exit_face_ >= 0) {
    const int face = exit_face_;
    exit_face_ = -1;
    const bool stuck = ++crossings_ > kMaxCrossings;
    if (const std::optional<End> ended = stuck ? cross_standing(face) : cross(face)) return ended;
  }
  for (;;) {
    if (!loaded_) {
      enter_cell();
      w_ = rate(cell_, b_);
    }
    if (!finite_) return End::kBadData;
    if (end_.speed <= cell_.resolution) return End::kStagnation;
    if (modes_) return robust_piece();
    switch (fast_piece()) {
      case PieceOutcome::kPiece:
        return std::nullopt;
      case PieceOutcome::kStandstill:
        return End::kStagnation;
      case PieceOutcome::kRobust:
        enter_robust();
        break;
      case PieceOutcome::kCross: {
        const int face = exit_face_;
        exit_face_ = -1;
        if (const std::optional<End> ended = cross_standing(face)) return ended;
        break;
      }
    }
    if (work_ > kMaxWork) return std::nullopt;
  }
}

/// Crosses a face without having moved: on a vertex or an edge, where several cells meet. The cells around it
/// are walked through, and if that does not come to an end soon, the one that lies ahead is looked up.
std::optional<End> ExactWalk::cross_standing(int face) {
  constexpr int kWalk = 8;
  constexpr double kAhead = 1e-8;  // of the cell: beyond rounding, well within the next cell
  ++work_;
  const Vec3 x = position(cell_, b_).xyz();
  TetPoint ahead;
  if (++standing_ > kMaxStandingSteps) {
    // Out, about a point of rest on an edge, or where nobody can say: cells are folded there.
    constexpr double kOut = 1e-6, kSlow = 1e-6;  // of the cell, and of what the velocity changes over it
    if (!mesh_->mesh().locate(x + (kOut * cell_.size) * direction_, cell_index_, ahead))
      return End::kLeftDomain;
    return end_.speed <= kSlow * cell_.norm * cell_.size ? End::kStagnation : End::kBadData;
  }
  if (standing_ % kWalk != 0) return cross(face);
  const double distance = kAhead * cell_.size;
  if (!mesh_->mesh().locate(x + distance * direction_, cell_index_, ahead)) return cross(face);
  settle(ahead.cell, x);
  return std::nullopt;
}

PieceOutcome ExactWalk::fast_piece() {
  if (pieces_in_cell_ >= kMaxPiecesInCell) return PieceOutcome::kRobust;
  if (pieces_in_cell_ == 0) {
    rate_at_entry_ = max_abs(w_);
  } else if (max_abs(w_) < kSlowed * rate_at_entry_) {
    return PieceOutcome::kRobust;
  }
  b_.store(piece_.b);
  w_.store(piece_.w);
  piece_.speed = end_.speed;
  piece_.cell = cell_index_;
  piece_.entry = entry_;
  piece_.face = -1;
  const PieceOutcome outcome = kernel_.advance(cell_, mesh_->view(), piece_);
  exit_face_ = piece_.face;
  if (outcome == PieceOutcome::kPiece) {
    robust_piece_ = false;
    close_piece(Pack4::load(piece_.b_end), Pack4::load(piece_.w_end), piece_.time, piece_.arc,
                kRoundingPerCell * kUlp * cell_.size * (1.0 + piece_.theta));
  }
  return outcome;
}

void ExactWalk::close_piece(const Pack4& b, const Pack4& w, double time, double arc, double local_error) {
  // Slow as it is, the values at the vertices leave some of its speed open, in any direction.
  if (end_.speed < kNearRest * cell_.resolution) local_error += cell_.resolution * time;
  begin_ = end_;
  const Vec3 before = direction_;
  b_ = max(b, Pack4{});
  w_ = w;
  entry_ = -1;
  ++pieces_in_cell_;
  // What moves by rounding makes no progress, however often.
  if (arc > 16.0 * kUlp * cell_.size) seams_standing_ = 0;
  moved_ += arc;
  if (moved_ > kProgress * cell_.size) {
    moved_ = 0.0;
    standing_ = crossings_ = 0;
  }
  const Vec3 v = velocity(cell_, w).xyz();
  const double speed = glm::length(v);
  if (speed > 0.0) direction_ = v * (1.0 / speed);
  turn_cosine_ = glm::dot(before, direction_);

  // (1) of error_ellipse.h; on the robust path the modes carry it.
  if (!robust_piece_) {
    error_.carry([&](const Vec3& e) {
      const Pack4 d = along(cell_, Pack4{e, 0.0}), first = apply(cell_, d);
      const Pack4 change = velocity(cell_, time * first);
      constexpr double kSmall = 0.01;  // square of |time A e| / |e| below which one term is enough
      if (!(dot3(change, change) > kSmall * glm::dot(e, e))) return e + change.xyz();
      const double* power = piece_.power;
      return velocity(cell_, power[0] * d + (power[1] * first + power[2] * apply(cell_, first))).xyz();
    });
  }
  const double change = cell_.norm * cell_.size;  // of the velocity across the cell
  double of_values = mesh_->value_error() + mesh_->value_rounding() * (speed + change);
  // Points that lie elsewhere change the velocity as places do: by the steepest of the barycentric coordinates at most.
  if (mesh_->point_rounding() > 0.0) {
    const Pack4 x = Pack4::load(cell_.gradient[0]), y = Pack4::load(cell_.gradient[1]),
                z = Pack4::load(cell_.gradient[2]);
    of_values += mesh_->point_rounding() * change * std::sqrt(max_lane(x * x + (y * y + z * z)));
  }
  error_.add(local_error + of_values * time, direction_);
  end_.position = position(cell_, b_).xyz();
  end_.time = begin_.time + time;
  end_.arc = begin_.arc + arc;
  end_.speed = speed;
  const double of_point = std::abs(end_.position.x) + std::abs(end_.position.y) + std::abs(end_.position.z);
  // What this piece adds may lie in any direction, whatever that of the error so far.
  const double rate = speed > 0.0 ? glm::length(velocity(cell_, apply(cell_, w)).xyz()) / speed : 0.0;
  end_.error = error_.distance(direction_, speed, rate) + local_error + kRoundingOfPoint * kUlp * of_point;
  has_piece_ = true;
}

std::optional<End> ExactWalk::cross(int face) {
  const TetMesh& mesh = mesh_->mesh();
  const CellIndex from = cell_index_;
  // The exit lies on the face that it names, or nobody knows where it is.
  constexpr double kOnFace = 0x1p-20;
  if (!(b_[face] <= kOnFace)) return End::kBadData;
  const CellIndex next = neighbors(from)[as_size(face)];
  if (next == kNoCell || mesh.zero_volume(next)) {
    const Vec3 x = position(cell_, b_).xyz();
    const CellIndex beyond = next == kNoCell ? kNoCell : sound_cell_beyond(mesh, next, from, x);
    if (beyond != kNoCell) {
      settle(beyond, x);
      return std::nullopt;
    }
    const SeamCrossing there = cross_seam(*mesh_, from, face, x, sign_, seams_standing_++);
    if (there.cell == kNoCell) return End::kLeftDomain;
    if (there.opposed) return End::kOpposedCells;
    error_.carry([&](const Vec3& e) { return there.carried(e); });
    settle(there.cell, there.x);
    error_.add(there.error, direction_);
    end_.position = there.x;
    end_.speed = glm::length(there.v);
    end_.error += there.error;
    if (end_.speed > 0.0) direction_ = there.v / end_.speed;
    return std::nullopt;
  }
  modes_.reset();
  pieces_in_cell_ = 0;
  loaded_ = false;
  // The three shared vertices keep their coordinates under the neighbour's numbering; its own vertex,
  // opposite to the face of entry, is the one that none of them matches.
  TetMesh::Tet here = mesh.cells()[as_size(from)];
  here[as_size(face)] = kNoVertex;
  const std::uint32_t* const there = mesh.cells()[as_size(next)].data();
  Pack4 shared;
  unsigned matched = 0;
  for (int k = 0; k < 4; ++k) {
    const Mask4 same = equal(there, here[as_size(k)]);
    matched |= bits(same);
    shared += select(same, Pack4::all(b_[k]), Pack4{});
  }
  // Rounding must not let the sum drift over thousands of cells: 1/sum to first order.
  const double sum = (b_[0] + b_[1]) + (b_[2] + b_[3]);
  b_ = (2.0 - sum) * shared;
  cell_index_ = next;
  entry_ = std::countr_one(matched);
  return std::nullopt;
}

/// Begins in `cell` at its point nearest to x, as far as clamped coordinates tell.
void ExactWalk::settle(CellIndex cell, const Vec3& x) {
  const Vec4 b = mesh_->mesh().barycentric(cell, x);
  double kept[4];
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    kept[i] = std::max(b[i], 0.0);
    sum += kept[i];
  }
  b_ = (1.0 / sum) * Pack4{kept[0], kept[1], kept[2], kept[3]};
  cell_index_ = cell;
  entry_ = -1;
  modes_.reset();
  pieces_in_cell_ = 0;
  enter_cell();
  w_ = rate(cell_, b_);
  error_.add(glm::distance(position(cell_, b_).xyz(), x), direction_);
}

LinePoint ExactWalk::at(double theta) const {
  if (theta <= 0.0) return begin_;
  if (theta >= 1.0) return end_;
  LinePoint point = begin_;
  const double h = theta * piece_.time;
  Pack4 b, speeds;
  if (robust_piece_) {
    const RobustFlow flow = robust_flow(piece_start_, h, piece_start_ + h);
    b = flow.b;
    speeds = flow.speed;
  } else {
    Course begin{.b = Pack4::load(piece_.b), .w = Pack4::load(piece_.w), .a = {}, .j = {}};
    begin.a = apply(cell_, begin.w);
    begin.j = apply(cell_, begin.a);
    const Flow at_h = flow(cell_, begin, h, pair_count(h * cell_.norm));
    b = at_h.b;
    speeds = sqrt(at_h.squared_speed);
  }
  point.position = position(cell_, b).xyz();
  point.time += h;
  point.arc += arc_length(begin_.speed, speeds, h).length;
  point.speed = speeds[3];
  point.error += theta * (end_.error - begin_.error);
  return point;
}

}  // namespace palpate
