/// Anisotropy drag (Ikits 2006, sec. 8.4): a linear constraint in the eigenframe of a diffusion tensor whose
/// drag thresholds follow the anisotropy. Either of two constructions, with tau(x) rising from tau(0) = 0:
///
///                                                  tau_1                  tau_2           tau_3
///   free in isotropic places (eqs. 8.6 to 8.8)     0                      tau(c_l)        tau(c_l + c_p)
///   held to a point there (eqs. 8.9 to 8.11)       tau(1 - c_l - c_p)     tau(1 - c_p)    tau(1)
///
/// so a line along e_1 where diffusion is linear, a plane where it is planar. Where eigenvalues are equal
/// their axes may be turned freely; with both constructions these axes then have the same threshold, and as
/// drag acts jointly along them (motion_rule.h) the hold does not depend on how they are turned. With the
/// axis-by-axis rule of the reference it would, by up to 41 %. A threshold that falls by more than the proxy
/// moves (with the second construction, at the border of a bundle that is sharper than tau(1) is long) lets
/// the proxy catch up at once: no rule without a speed could do else, and the slew limit smooths the force.
#pragma once

#include <cmath>
#include <memory>
#include <utility>

#include "common/field/tensor/diffusion_measures.h"
#include "common/field/tensor/tensor_field.h"
#include "common/haptics/constraint.h"
#include "common/haptics/constraint/linear.h"
#include "common/haptics/measure.h"
#include "common/haptics/reference_frame.h"
#include "common/haptics/workspace.h"

namespace palpate {

// What a diffusion tensor says to a linear constraint: its eigenframe, and measures of its anisotropy.

/// Tensors in the workspace, taken apart. The measures do not depend on how much diffuses, and so jump where
/// that goes to zero, at the border of a mask: here anisotropy fades to isotropy over the last quarter of the
/// typical trace. Frame and measures ask for the same place one after the other,
/// which is then worked out once. Of a field with peaks the one is read that is nearest to the way of the last frame,
/// at first the longest. One thread.
class TensorReader {
 public:
  struct Reading {
    Mat3 axes{1.0};    ///< e_1 to e_3, by falling eigenvalues; their signs have no meaning
    Anisotropy parts;  ///< faded
    SampleStatus status = SampleStatus::kOutside;
  };

  static constexpr double kFullPart = 0.25;  ///< of TensorField::typical_trace()

  TensorReader(std::shared_ptr<const TensorField> field, const Workspace& workspace);
  /// @param x [m]. @rt Safe.
  [[nodiscard]] const Reading& at(const Vec3& x) noexcept;
  /// The way [workspace, unit] along which peaks are read from now on; zero: the longest.
  void go(const Vec3& toward) noexcept;

 private:
  [[nodiscard]] TensorSample sample(const Vec3& x_data) noexcept;

  std::shared_ptr<const TensorField> field_;
  Workspace workspace_;
  double full_trace_;  ///< from which on measures are as they are
  CellHint hint_;
  Vec3 place_{NAN};
  Vec3 toward_{0.0};
  Reading reading_;
};

/// e_1 to e_3 of the tensor, their signs as those of the step before. Always certain: thresholds make up for
/// axes that are not.
class TensorFrame final : public ReferenceFrame {
 public:
  explicit TensorFrame(std::shared_ptr<TensorReader> tensors) : tensors_(std::move(tensors)) {}
  [[nodiscard]] FrameSample at(const Vec3& x, const Mat3& last) noexcept override;
  void forget() noexcept override { begun_ = false; }

 private:
  std::shared_ptr<TensorReader> tensors_;
  bool begun_ = false;  ///< the last frame is of the same touch
};

/// A sum of the barycentric measures of the tensor (diffusion_measures.h), faded as above, in [0, 1].
class AnisotropyMeasure final : public SampledMeasure {
 public:
  enum class Sum : unsigned char {
    kLinear,        ///< c_l
    kLinearPlanar,  ///< c_l + c_p
    kNotPlanar,     ///< 1 - c_p = c_l + c_s
    kSpherical      ///< 1 - c_l - c_p = c_s
  };
  AnisotropyMeasure(std::shared_ptr<TensorReader> tensors, Sum sum)
      : tensors_(std::move(tensors)), sum_(sum) {}
  [[nodiscard]] ScalarSample at(const Vec3& x) noexcept override;

 private:
  std::shared_ptr<TensorReader> tensors_;
  Sum sum_;
};

/// What an isotropic place does to the hand.
enum class IsotropicPlaces : unsigned char { kFree, kPoint };

class AnisotropyDrag final : public Constraint {
 public:
  AnisotropyDrag(std::shared_ptr<const TensorField> field, const Workspace& workspace,
                 IsotropicPlaces isotropic);

  /// Takes the drag thresholds from `settings.anisotropy`, and the fade distance of linear constraints.
  void apply(const ChainSettings& settings) noexcept override;
  void reset() noexcept override { linear_.reset(); }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override {
    linear_.update(probe, budget, link);
  }

 private:
  AnisotropyDrag(const std::shared_ptr<TensorReader>& tensors, IsotropicPlaces isotropic);

  IsotropicPlaces isotropic_;
  LinearConstraint linear_;
};

class IsotropicDrag final : public Constraint {
 public:
  void apply(const ChainSettings& settings) noexcept override { tau_ = settings.drag.threshold; }
  void reset() noexcept override { caught_ = false; }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

 private:
  double tau_ = 0.0;
  Vec3 proxy_{0.0};
  bool caught_ = false;
};

}  // namespace palpate
