/// The path that the proxy has taken, with the force at each of its points. It only grows, so that what
/// is drawn of it is uploaded once.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// Points of a path in the order of time, in pieces: a gap parts what a jump would join.
class ProbePath {
 public:
  /// @param spacing [data units] a point no farther than this from the one before it along every axis is
  /// left out: a resting hand adds nothing.
  explicit ProbePath(double spacing = 0.0) noexcept : spacing_(spacing) {}

  /// Adds a point and the size of the force there [N]. A position that is not finite begins a new piece; a
  /// force that is not finite is drawn grey.
  void append(const Vec3& position, double force);

  [[nodiscard]] std::size_t size() const noexcept { return positions_.size(); }
  [[nodiscard]] std::span<const Vec3> positions() const noexcept { return positions_; }
  [[nodiscard]] std::span<const double> forces() const noexcept { return forces_; }
  /// Index of the first point of each piece, rising from 0; empty where there are no points.
  [[nodiscard]] std::span<const std::size_t> pieces() const noexcept { return pieces_; }

 private:
  double spacing_;
  bool gap_ = true;  // the next point begins a piece
  std::vector<Vec3> positions_;
  std::vector<double> forces_;
  std::vector<std::size_t> pieces_;
};

/// The path through `positions` with `forces` [N], one a position.
/// @throws Error (work failed) where their numbers differ.
[[nodiscard]] std::shared_ptr<const ProbePath> make_probe_path(std::span<const Vec3> positions,
                                                               std::span<const double> forces,
                                                               double spacing = 0.0);

}  // namespace palpate
