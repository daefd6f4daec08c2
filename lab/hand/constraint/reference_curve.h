/// A streamline to hold a proxy against: traced by another method than the one that is followed, a thousand
/// times tighter, and searched by brute force.
///
/// Points lie 2e-4 of the diagonal apart, and closer where the curve turns; between them the parabola through
/// three neighbours stands for it. All in data units.
#pragma once

#include <cstddef>
#include <vector>

#include "common/field/vector_field.h"
#include "common/math/vec.h"

namespace palpate {

class ReferenceCurve {
 public:
  /// The line through `seed`, `length` to either side; empty where none passes.
  ReferenceCurve(const VectorField& field, const Vec3& seed, double length);

  [[nodiscard]] bool empty() const noexcept { return points_.size() < 3; }
  /// The point at the seed.
  [[nodiscard]] std::size_t seed() const noexcept { return seed_; }

  struct Place {
    std::size_t point = 0;  ///< nearest point of the table
    double arc = 0.0;
    Vec3 position{0.0};
    bool beyond = false;  ///< at an end that is none of the flow's: nothing can be said there
  };
  /// The local minimum of the distance from `x` next to the point `from`, downhill. @pre !empty().
  [[nodiscard]] Place nearest(const Vec3& x, std::size_t from) const noexcept;
  /// The place nearest to `x` on the whole curve. @pre !empty().
  [[nodiscard]] Place nearest_of_all(const Vec3& x) const noexcept;

 private:
  struct Point {
    double arc = 0.0;  ///< signed, 0 at the seed
    Vec3 position{0.0};
  };
  void add(const VectorField& field, const Vec3& seed, double length, double spacing);
  [[nodiscard]] bool turns_sharply() const noexcept;
  [[nodiscard]] double squared_distance(std::size_t i, const Vec3& x) const noexcept;
  [[nodiscard]] Place refined(const Vec3& x, std::size_t i) const noexcept;
  [[nodiscard]] Vec3 at(std::size_t middle, double arc) const noexcept;

  std::vector<Point> points_;
  std::size_t seed_ = 0;
  bool open_begin_ = false, open_end_ = false;  ///< cut there by a limit
};

}  // namespace palpate
