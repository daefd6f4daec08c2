/// Tracts drawn by hand: where the proxy went while the tensors held it, with what was felt and measured at
/// each point (Ikits 2006, figure 8.4).
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "common/field/tensor/measures_at.h"
#include "common/field/tensor/tensor_field.h"
#include "common/geometry/line.h"

namespace palpate {

/// A tract and the columns that are saved with it, one number a point.
struct DrawnTract {
  Line line;                   ///< data coordinates; time since its first point [s]
  std::vector<double> forces;  ///< the largest felt at the point [N]
  std::vector<TensorMeasures> measures;
};

/// Grows tracts from the steps of the servo. One thread.
class TractPen {
 public:
  /// @param spacing of points [data units]: steps closer to the last point than this are taken together.
  TractPen(std::shared_ptr<const TensorField> field, double spacing);

  /// The proxy is at `proxy` [data coordinates] and the force on the hand is `force` [N]; time in seconds.
  void add(double time, const Vec3& proxy, double force);
  /// The hand is off, or the proxy has jumped: the next add() begins another tract.
  void lift() noexcept { down_ = false; }
  void clear();

  /// In the order of time, those of one point too.
  [[nodiscard]] const std::vector<DrawnTract>& tracts() const noexcept { return tracts_; }

 private:
  std::shared_ptr<const TensorField> field_;
  double spacing_;
  CellHint hint_;
  double start_ = 0.0;  ///< time of the first point of the last tract
  bool down_ = false;
  std::vector<DrawnTract> tracts_;
};

/// Writes those of at least two points, with the columns `force`, `cl`, `cp` and `fa` where the format has
/// columns.
/// @return how many these are.
/// @throws Error as write_lines().
std::size_t save_tracts(const std::filesystem::path& path, const std::vector<DrawnTract>& tracts,
                        bool overwrite);

}  // namespace palpate
