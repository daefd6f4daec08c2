#include "common/trace/exact_walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/base/parallel.h"
#include "common/trace/tet_crossing.h"

namespace palpate {
namespace {

constexpr double kUlp = std::numeric_limits<double>::epsilon();
// Rounding of one cell's gather, series and hand-over, in units of 2^-52 of the cell's size.
constexpr double kRoundingPerCell = 16.0;
// Coordinates are stored with 2^-53 of their size; that much is uncertain of every point.
constexpr double kRoundingOfPoint = 2.0;
// Cost of the robust path, in fast pieces.
constexpr int kRobustWork = 32;
// A rate of a barycentric coordinate below this part of the largest one is zero but for rounding.
constexpr double kTangent = 1e-14;

Pack4 to_pack(const AffineModes::Four& b) {
  return {static_cast<double>(b[0]), static_cast<double>(b[1]), static_cast<double>(b[2]),
          static_cast<double>(b[3])};
}

/// For each face the smallest t > 0 with b + w t + a t^2 / 2 = 0, by a formula for both signs of w; negative,
/// infinite or NaN where there is none, and where b is 0.
Pack4 quadratic_exits(const Pack4& b, const Pack4& w, const Pack4& a) {
  const Pack4 disc = w * w - 2.0 * (a * b);
  const Pack2 root_lo{std::sqrt(disc.lo[0]), std::sqrt(disc.lo[1])};
  const Pack2 root_hi{std::sqrt(disc.hi[0]), std::sqrt(disc.hi[1])};
  return {2.0 * b.lo / (root_lo - w.lo), 2.0 * b.hi / (root_hi - w.hi)};
}

}  // namespace

ExactMesh::ExactMesh(const VectorField& field, int threads) : mesh_(field.tet_mesh()) {
  const std::span<const Vec3> points = mesh_->points();
  vertices_.resize(points.size());
  const PointVectors& values = field.values();
  std::visit(
      [&](const auto& stored) {
        parallel_for(points.size(), threads, [&](std::size_t first, std::size_t last) {
          for (std::size_t i = first; i < last; ++i) {
            vertices_[i].x = points[i];
            vertices_[i].v = values.scale * Vec3{stored[3 * i], stored[3 * i + 1], stored[3 * i + 2]};
          }
        });
      },
      values.values);
}

ExactWalk::ExactWalk(const ExactMesh& mesh, double rest_distance, TraceDirection direction)
    : mesh_(&mesh),
      rest_distance_(rest_distance),
      sign_(direction == TraceDirection::kForward ? 1.0 : -1.0) {}

void ExactWalk::load_cell() {
  finite_ =
      cell_.load(mesh_->vertices(), mesh_->mesh().cells()[static_cast<std::size_t>(cell_index_)], sign_);
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
  ignored_face_ = -1;
  modes_.reset();
  robust_pieces_ = 0;
  has_piece_ = false;
  b_ = Pack4{std::max(found.b[0], 0.0), std::max(found.b[1], 0.0), std::max(found.b[2], 0.0),
             std::max(found.b[3], 0.0)};
  load_cell();
  w_ = cell_.rate(b_);
  const Vec3 v = cell_.velocity(w_);
  const double speed = finite_ ? glm::length(v) : 0.0;
  direction_ = speed > 0.0 ? v / speed : Vec3{0.0};
  const double rounding = kUlp * (cell_.size() + glm::length(seed));
  error_.start(direction_, rounding);
  end_ = LinePoint{.position = seed, .time = 0.0, .arc = 0.0, .speed = speed, .error = rounding};
  begin_ = end_;
  return true;
}

std::optional<End> ExactWalk::advance() {
  has_piece_ = false;
  work_ = 1;
  if (exit_face_ >= 0) {
    const int face = exit_face_;
    exit_face_ = -1;
    if (const std::optional<End> ended = cross(face)) return ended;
  }
  for (;;) {
    if (!loaded_) {
      load_cell();
      w_ = cell_.rate(b_);
    }
    if (!finite_) return End::kBadData;
    if (modes_) return robust_piece();
    switch (fast_piece()) {
      case Outcome::kPiece:
        return std::nullopt;
      case Outcome::kStandstill:
        return End::kStagnation;
      case Outcome::kRobust:
        enter_robust();
        break;
      case Outcome::kCross: {
        const int face = exit_face_;
        exit_face_ = -1;
        if (const std::optional<End> ended = cross_standing(face)) return ended;
        break;
      }
    }
  }
}

/// Crosses a face without having moved: on a vertex or an edge, where several cells meet. The cells around it
/// are walked through, and if that does not come to an end soon, the one that lies ahead is looked up.
std::optional<End> ExactWalk::cross_standing(int face) {
  constexpr int kWalk = 8;
  constexpr double kAhead = 1e-8;  // of the cell: beyond rounding, well within the next cell
  if (++standing_ > kMaxStandingSteps) return End::kStagnation;
  if (standing_ % kWalk != 0) return cross(face);
  const Vec3 x = cell_.position(b_);
  TetPoint ahead;
  const double distance = kAhead * cell_.size();
  if (!mesh_->mesh().locate(x + distance * direction_, cell_index_, ahead)) return cross(face);
  modes_.reset();
  ignored_face_ = -1;
  pieces_in_cell_ = 0;
  settle(ahead.cell, x);
  return std::nullopt;
}

ExactWalk::Outcome ExactWalk::fast_piece() {
  const double fastest = max_abs(w_);
  if (!(fastest > 0.0)) return Outcome::kStandstill;
  if (pieces_in_cell_ >= kMaxPiecesInCell) return Outcome::kRobust;

  // Already on a face and on the way out: cross it without a piece. By the face of entry only the robust path
  // may send a line back.
  for (int i = 0; i < 4; ++i) {
    if (b_[i] <= 0.0 && w_[i] < -kTangent * fastest) {
      if (i == entry_) return Outcome::kRobust;
      exit_face_ = i;
      return Outcome::kCross;
    }
  }

  const Pack4 a = cell_.apply(w_);
  const double longest = AffineCell::kMaxRate / cell_.norm();
  double h = longest;
  int face = -1;
  const Pack4 exits = quadratic_exits(b_, w_, a);
  for (int i = 0; i < 4; ++i) {
    const double t = b_[i] > 0.0 ? exits[i] : -2.0 * w_[i] / a[i];
    if (t > 0.0 && t < h && (b_[i] > 0.0 || w_[i] > kTangent * fastest)) {
      h = t;
      face = i;
    }
  }
  if (face < 0 && !(h < HUGE_VAL)) return Outcome::kRobust;
  if (face >= 0) {
    // One Newton step on the cubic.
    const Pack4 j = cell_.apply(a);
    const double value = b_[face] + h * (w_[face] + h * (0.5 * a[face] + h * (1.0 / 6.0) * j[face]));
    const double slope = w_[face] + h * (a[face] + 0.5 * h * j[face]);
    const double better = h - value / slope;
    if (better > 0.5 * h && better < 2.0 * h && better < longest) h = better;
  }

  // The cell beyond the predicted exit lies anywhere in memory: fetch it while this one is computed.
  if (face >= 0) {
    const CellIndex next = neighbors(cell_index_)[static_cast<std::size_t>(face)];
    if (next != kNoCell) {
      __builtin_prefetch(&mesh_->mesh().cells()[static_cast<std::size_t>(next)]);
      __builtin_prefetch(&neighbors(next));
    }
  }
  for (int attempt = 0; attempt < kMaxHalvings; ++attempt) {
    AffineCell::Flow flow = cell_.flow(b_, w_, h);
    bool sound = false;
    double arc = cell_.arc(end_.speed, flow, h, sound);
    double time = h;
    Pack4 a_end = cell_.apply(flow.w);
    if (face >= 0) {
      // From the predicted crossing to the true one, by the series about the end of the flow.
      const double wf = flow.w[face];
      if (!(wf < 0.0)) {  // the curve turns back before the face, or has come in again
        h *= 0.5;
        face = -1;
        continue;
      }
      double delta = -flow.b[face] / wf;
      delta -= 0.5 * delta * delta * a_end[face] / wf;
      constexpr double kNear = 0.004;  // |delta C|: its fifth power over 5! is rounding
      if (!(std::abs(delta) * cell_.norm() <= kNear && std::abs(delta) <= 0.5 * h)) {
        h += delta;
        if (!(h > 0.0)) return Outcome::kRobust;
        if (h > longest) {  // the face is beyond the reach of the series: a piece on the way to it
          h = longest;
          face = -1;
        }
        continue;
      }
      const double speed_before = glm::length(cell_.velocity(flow.w));
      const double remaining = flow.b[face];
      Pack4 b = flow.b;
      // Newton on the series itself: three passes settle it to rounding, since delta is small.
      const Pack4 j_end = cell_.apply(a_end);
      const Pack4 k_end = cell_.apply(j_end);
      for (int i = 0; i < 2; ++i) {
        const double f =
            remaining +
            delta * (wf + delta * (0.5 * a_end[face] +
                                   delta * (j_end[face] * (1.0 / 6.0) + delta * k_end[face] * (1.0 / 24.0))));
        const double df =
            wf + delta * (a_end[face] + delta * (0.5 * j_end[face] + delta * k_end[face] * (1.0 / 6.0)));
        delta -= f / df;
      }
      const Pack4 w_middle = flow.w + (0.5 * delta) * (a_end + (0.25 * delta) * j_end);
      b += delta *
           (flow.w + delta * (0.5 * a_end + delta * ((1.0 / 6.0) * j_end + (delta * (1.0 / 24.0)) * k_end)));
      flow.w += delta * (a_end + delta * (0.5 * j_end + (delta * (1.0 / 6.0)) * k_end));
      flow.b = b;
      a_end += delta * (j_end + (0.5 * delta) * k_end);
      time = h + delta;
      // Simpson's rule over the last bit.
      arc +=
          delta * (1.0 / 6.0) *
          (speed_before + 4.0 * glm::length(cell_.velocity(w_middle)) + glm::length(cell_.velocity(flow.w)));
    }

    // Certificate: Bernstein coefficients of the quintic that shares value, slope and curvature with b_i at
    // both ends. If the inner ones exceed the interpolation error, b_i > 0 in between; ends at zero are
    // the faces of entry and exit.
    const Pack4 b0 = b_, b5 = flow.b;
    const Pack4 s0 = (time / 5.0) * w_, s1 = (time / 5.0) * flow.w;
    const Pack4 c0 = (time * time / 20.0) * a, c1 = (time * time / 20.0) * a_end;
    const Pack4 b1 = b0 + s0, b2 = b1 + s0 + c0, b4 = b5 - s1, b3 = b4 - s1 + c1;
    const double theta = time * cell_.norm();
    const double theta2 = theta * theta;
    const double interpolation = theta2 * theta2 * theta * time * fastest * (1.0 / 46080.0) *
                                 (1.0 + 3.2 * theta);  // the last factor bounds exp(theta) up to kMaxRate
    const auto smaller = [](double x, double y) { return x < y ? x : y; };
    double lowest = HUGE_VAL;
    for (int i = 0; i < 4; ++i) {
      // A line that lies in a face stays there.
      if (b0[i] <= 0.0 && std::abs(w_[i]) <= kTangent * fastest &&
          std::abs(a[i]) * time <= kTangent * fastest)
        continue;
      lowest = smaller(lowest, smaller(smaller(b1[i], b2[i]), smaller(b3[i], b4[i])));
    }
    // Another face may have been crossed shortly before: then that one is the exit.
    int earlier = -1;
    double deepest = 0.0;
    for (int i = 0; i < 4; ++i) {
      if (i != face && b5[i] < deepest - kUlp) {
        deepest = b5[i];
        earlier = i;
      }
    }
    if (earlier >= 0 && flow.w[earlier] < 0.0) {
      face = earlier;
      h = std::max(time - deepest / flow.w[earlier], 0.5 * time);
      continue;
    }
    if (!(lowest > interpolation) || earlier >= 0 || !sound) {
      h = 0.5 * time;
      face = -1;
      continue;
    }

    if (face >= 0) {
      flow.b.set(face, 0.0);
      exit_face_ = face;
      const CellIndex next = neighbors(cell_index_)[static_cast<std::size_t>(face)];
      if (next != kNoCell) {
        for (const std::uint32_t vertex : mesh_->mesh().cells()[static_cast<std::size_t>(next)]) {
          __builtin_prefetch(mesh_->vertices() + vertex);
        }
      }
    }
    piece_b_ = b_;
    piece_w_ = w_;
    piece_time_ = time;
    piece_robust_ = false;
    close_piece(flow.b, flow.w, time, arc, kRoundingPerCell * kUlp * cell_.size() * (1.0 + theta));
    return Outcome::kPiece;
  }
  return Outcome::kRobust;
}

void ExactWalk::close_piece(const Pack4& b, const Pack4& w, double time, double arc, double local_error) {
  begin_ = end_;
  const Vec3 before = direction_;
  b_ = Pack4{std::fmax(b[0], 0.0), std::fmax(b[1], 0.0), std::fmax(b[2], 0.0), std::fmax(b[3], 0.0)};
  w_ = w;
  entry_ = -1;
  ++pieces_in_cell_;
  standing_ = 0;
  const Vec3 v = cell_.velocity(w);
  const double speed = glm::length(v);
  if (speed > 0.0) direction_ = v * (1.0 / speed);
  turn_cosine_ = glm::dot(before, direction_);

  // (1) of error_transport.h by two terms; on the robust path the modes carry it.
  if (!piece_robust_) {
    const Vec3& e = error_.vector();
    Vec3 change = time * cell_.gradient_times(e);
    constexpr double kSmall = 0.01;  // square of |time A e| / |e| below which the second term is left out
    if (glm::dot(change, change) > kSmall * glm::dot(e, e))
      change += 0.5 * time * cell_.gradient_times(change);
    error_.set(e + change);
  }
  error_.add(local_error);
  end_.position = cell_.position(b_);
  end_.time = begin_.time + time;
  end_.arc = begin_.arc + arc;
  end_.speed = speed;
  const double of_point = std::abs(end_.position.x) + std::abs(end_.position.y) + std::abs(end_.position.z);
  end_.error = error_.across(direction_) + kRoundingOfPoint * kUlp * of_point;
  has_piece_ = true;
}

std::optional<End> ExactWalk::cross(int face) {
  const TetMesh& mesh = mesh_->mesh();
  const CellIndex from = cell_index_;
  const CellIndex next = neighbors(from)[static_cast<std::size_t>(face)];
  if (next == kNoCell) return End::kLeftDomain;
  modes_.reset();
  ignored_face_ = -1;
  pieces_in_cell_ = 0;
  loaded_ = false;
  if (mesh.zero_volume(next)) {
    const Vec3 x = cell_.position(b_);
    const CellIndex beyond = sound_cell_beyond(mesh, next, from, x);
    if (beyond == kNoCell) return End::kLeftDomain;
    settle(beyond, x);
    return std::nullopt;
  }
  // The three shared vertices keep their coordinates under the neighbour's numbering; what is left of its
  // four numbers is its own vertex, opposite to the face of entry.
  const TetMesh::Tet& here = mesh.cells()[static_cast<std::size_t>(from)];
  const TetMesh::Tet& there = mesh.cells()[static_cast<std::size_t>(next)];
  double shared[4] = {0.0, 0.0, 0.0, 0.0};
  int entry = 0 + 1 + 2 + 3;
  double sum = 0.0;
  for (int k = 0; k < 4; ++k) {
    if (k == face) continue;
    const std::uint32_t vertex = here[static_cast<std::size_t>(k)];
    const int j = (there[1] == vertex ? 1 : 0) + (there[2] == vertex ? 2 : 0) + (there[3] == vertex ? 3 : 0);
    shared[j] = b_[k];
    sum += b_[k];
    entry -= j;
  }
  // Rounding must not let the sum drift over thousands of cells: 1/sum to first order.
  b_ = (2.0 - sum) * Pack4{shared[0], shared[1], shared[2], shared[3]};
  cell_index_ = next;
  entry_ = entry;
  return std::nullopt;
}

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
  loaded_ = false;
}

void ExactWalk::enter_robust() {
  work_ += kRobustWork;
  AffineModes::Four b{};
  AffineModes::Real sum = 0.0L;
  for (int i = 0; i < 4; ++i) sum += b[static_cast<std::size_t>(i)] = b_[i];
  for (AffineModes::Real& value : b) value /= sum;
  modes_.emplace(mesh_->vertices(), mesh_->mesh().cells()[static_cast<std::size_t>(cell_index_)], sign_, b,
                 ignored_face_);
  mode_time_ = 0.0L;
  mode_step_ = 0.25L / modes_->rate();
}

std::optional<End> ExactWalk::robust_piece() {
  using Real = AffineModes::Real;
  ++robust_pieces_;
  work_ += kRobustWork;
  const AffineModes::Exit exit = modes_->exit();
  const bool leaves = exit.face >= 0;
  if (leaves && !(exit.time > mode_time_)) {
    // Sent on at once. Where two cells send the line back and forth it slides along their common face: the
    // second time it stays, and leaves by another face.
    if (exit.face == entry_ && standing_ > 1) {
      ++standing_;
      ignored_face_ = entry_;
      modes_.reset();
      enter_robust();
      return advance();
    }
    const int face = exit.face;
    if (const std::optional<End> ended = cross_standing(face)) return ended;
    return advance();
  }

  // Rest within reach: the line is drawn to the distance asked for and ends.
  const Vec3 x0 = end_.position;
  std::optional<Vec3> rest;
  if (modes_->rest()) rest = cell_.position(to_pack(*modes_->rest()));
  if (rest && glm::distance(*rest, x0) <= rest_distance_) return End::kStagnation;

  constexpr int kMaxTries = 200;
  constexpr double kMaxTurn = 0.9;  // cosine of 26 degrees
  const Real remaining = leaves ? exit.time - mode_time_ : HUGE_VALL;
  Real h = std::min(2.0L * mode_step_, remaining);
  for (int attempt = 0; attempt < kMaxTries; ++attempt, h *= 0.5L) {
    const bool last = leaves && h >= remaining;
    const Real stop = last ? exit.time : mode_time_ + h;
    // Velocities at the nodes of the Lobatto rule.
    constexpr std::array<Real, 3> kNodes{0.17267316464601142810L, 0.5L, 0.82732683535398857190L};
    AffineCell::Flow flow;
    flow.b = to_pack(modes_->at(stop));
    flow.w = to_pack(modes_->rate_at(stop));
    Vec3 before = direction_;
    double turn = 1.0;
    const auto turned = [&](const Pack4& w) {
      const Vec3 v = cell_.velocity(w);
      const double speed = glm::length(v);
      if (speed > 0.0) {
        turn = std::min(turn, glm::dot(before, v) / speed);
        before = v / speed;
      }
    };
    for (std::size_t m = 0; m < 3; ++m) {
      flow.inner[m] = to_pack(modes_->rate_at(mode_time_ + kNodes[m] * h));
      turned(flow.inner[m]);
    }
    turned(flow.w);
    bool sound = false;
    const double arc = cell_.arc(end_.speed, flow, static_cast<double>(h), sound);
    const bool still = max_abs(flow.w) <= 0.0 || arc <= kUlp * cell_.size();
    if ((turn < kMaxTurn || !sound) && !still && attempt + 1 < kMaxTries) continue;
    // A step that no longer moves the line, away from any exit: it has come to rest to rounding.
    if (arc <= kUlp * kUlp * cell_.size() && !last) return End::kStagnation;

    piece_b_ = b_;
    piece_w_ = w_;
    piece_time_ = static_cast<double>(h);
    piece_mode_start_ = mode_time_;
    piece_robust_ = true;
    // The error is carried by the modes themselves.
    const Vec3& e = error_.vector();
    AffineModes::Four d{};
    for (std::size_t i = 0; i < 3; ++i) {
      d[i] = glm::dot(cell_.barycentric_gradient(static_cast<int>(i)), e);
      d[3] -= d[i];
    }
    const Pack4 carried = to_pack(modes_->carried(d, h));
    error_.set(cell_.velocity(carried));
    if (last) {
      flow.b.set(exit.face, 0.0);
      exit_face_ = exit.face;
    }
    mode_time_ = stop;
    mode_step_ = h;
    const int entry = entry_;
    close_piece(flow.b, flow.w, static_cast<double>(h), arc, kRoundingPerCell * kUlp * cell_.size());
    if (!last) entry_ = entry;
    if (rest && glm::distance(*rest, end_.position) <= rest_distance_) return End::kStagnation;
    return std::nullopt;
  }
  return End::kStagnation;
}

LinePoint ExactWalk::at(double theta) const {
  if (theta <= 0.0) return begin_;
  if (theta >= 1.0) return end_;
  LinePoint point = begin_;
  const double h = theta * piece_time_;
  AffineCell::Flow flow;
  if (piece_robust_) {
    constexpr std::array<double, 3> kNodes{0.17267316464601142810, 0.5, 0.82732683535398857190};
    flow.b = to_pack(modes_->at(piece_mode_start_ + h));
    flow.w = to_pack(modes_->rate_at(piece_mode_start_ + h));
    for (std::size_t m = 0; m < 3; ++m) {
      flow.inner[m] = to_pack(modes_->rate_at(piece_mode_start_ + kNodes[m] * h));
    }
  } else {
    flow = cell_.flow(piece_b_, piece_w_, h);
  }
  bool sound = false;
  point.position = cell_.position(flow.b);
  point.time += h;
  point.arc += cell_.arc(begin_.speed, flow, h, sound);
  point.speed = glm::length(cell_.velocity(flow.w));
  point.error += theta * (end_.error - begin_.error);
  return point;
}

}  // namespace palpate
