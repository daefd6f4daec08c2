/// Reference directions of the data at a point: the orthonormal frame in which a linear constraint moves its
/// proxy (Ikits 2006, sec. 6.2 and 6.3).
///
/// Directions may be ill-defined, or have no sign, or leave open how two axes are turned about the third. A
/// sample therefore says how well its axes are defined, and continues the axes of the step before where the
/// data leaves a choice: axes never flip or leap for reasons that are not in the data.
#pragma once

#include <memory>

#include "common/field/sample.h"
#include "common/field/vector_field.h"
#include "common/haptics/workspace.h"
#include "common/math/vec.h"

namespace palpate {

struct FrameSample {
  Mat3 axes{1.0};          ///< orthonormal, columns e_1 e_2 e_3, workspace
  double certainty = 1.0;  ///< of e_1, in [0, 1]: 0 where it has no direction, and continuous there
  double split = 1.0;      ///< how well e_2 is told from e_3, in [0, 1]
  SampleStatus status = SampleStatus::kOk;  ///< the rest has no meaning unless kOk
};

class ReferenceFrame {
 public:
  ReferenceFrame() = default;
  ReferenceFrame(const ReferenceFrame&) = delete;
  ReferenceFrame& operator=(const ReferenceFrame&) = delete;
  virtual ~ReferenceFrame() = default;

  /// The axes at `x` in the workspace [m], those that are open turned as little as possible from `last`.
  /// @rt Safe.
  [[nodiscard]] virtual FrameSample at(const Vec3& x, const Mat3& last) noexcept = 0;
  /// What comes next does not go on from before: the next `last` says nothing. @rt Safe.
  virtual void forget() noexcept {}
};

/// The frame `last`, turned the shortest way that takes its first axis to the unit vector `e`; the very same
/// bits where that is there already. Continuous in `e`, but for the opposite of last[0].
[[nodiscard]] Mat3 carried_axes(const Mat3& last, const Vec3& e) noexcept;

/// The same axes everywhere.
class FixedFrame final : public ReferenceFrame {
 public:
  /// @param axes orthonormal.
  explicit FixedFrame(const Mat3& axes) : axes_(axes) {}
  [[nodiscard]] FrameSample at(const Vec3&, const Mat3&) noexcept override { return {.axes = axes_}; }

 private:
  Mat3 axes_;
};

/// e_1 along a vector field; e_2 and e_3 across it are open. Certain from the speed `certain_speed` on.
class FlowFrame final : public ReferenceFrame {
 public:
  /// Part of the largest speed from which on the direction counts as certain, by default.
  static constexpr double kCertainPart = 0.02;

  /// @param certain_part of the largest speed, > 0.
  FlowFrame(std::shared_ptr<const VectorField> field, const Workspace& workspace,
            double certain_part = kCertainPart);
  [[nodiscard]] FrameSample at(const Vec3& x, const Mat3& last) noexcept override;

 private:
  std::shared_ptr<const VectorField> field_;
  Workspace workspace_;
  double certain_speed_;  ///< data units
  CellHint hint_;
};

}  // namespace palpate
