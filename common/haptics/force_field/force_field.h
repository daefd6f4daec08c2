/// The force-field modes (Ikits 2006, sec. 2.3.2) as constraints that constrain nothing: the proxy is the
/// probe, and what is felt is a force of the data there (force_field.h). They may stand in a chain like any
/// other.
///
/// Where the data says nothing there is no force, and the state is kOutside.
#pragma once

#include <memory>

#include "common/field/scalar_field.h"
#include "common/field/vector_field.h"
#include "common/field/vorticity_field.h"
#include "common/haptics/constraint.h"
#include "common/haptics/workspace.h"
#include "common/math/vec.h"

namespace palpate {

// Forces as functions of the data at the probe and of the hand's velocity (Ikits 2006, sec. 2.3.2).
//
//   density drag          f = -b h(r) xdot,   r = (s - s_min) / (s_max - s_min)            (2.3)
//   direct display        f = F v / v_max                                                  (2.4)
//   vortex pull           f = F w / max(1, |w|),   w = (omega x v) / W                     (2.5)
//   transverse damping    f = -b g(|v|) (xdot - (xdot . t) t),   t = v / |v|               (2.6)
//
// with the strength F [N] and the damping b [N s/m] of the hand, h a haptic transfer function, and v, omega
// and s over scales of their field: a mode feels the same on a cell and on a galaxy. Eq. 2.5 points to the
// core of a helix. Eq. 2.6 is printed without its sign, with which it would push the hand on, and jumps
// where v vanishes and t has no meaning: g fades it there.
//
// Drags are given as coefficients b_a >= 0 along the axes e_a of a frame (LinkUpdate::damping), which makes
// it plain that they only take energy from the hand.

/// The scales of a vector field by which forces are made free of its units.
struct FlowScale {
  double speed = 0.0;      ///< v_max, data units; 0: there is no force
  double vorticity = 0.0;  ///< unit of omega, data units [1 / time]
  double lamb = 0.0;       ///< W in units of both: |omega x v| of a strong vortex; 0: there is none
};

/// A drag  f = -sum_a b_a e_a e_a^T xdot.
struct AxisDrag {
  Mat3 frame{1.0};    ///< columns e_a
  Vec3 damping{0.0};  ///< b_a [N s/m], >= 0
};

/// r in [0, 1]; 0 where the values do not differ.
[[nodiscard]] double density_part(double value, double lowest, double highest) noexcept;

/// Eq. 2.4 [N].
[[nodiscard]] Vec3 direct_force(const Vec3& v, const FlowScale& scale, double strength) noexcept;

/// (omega x v) in units of speed and vorticity.
[[nodiscard]] Vec3 lamb_vector(const Vec3& omega, const Vec3& v, const FlowScale& scale) noexcept;
/// Eq. 2.5 [N], no more than |strength|.
[[nodiscard]] Vec3 vortex_force(const Vec3& omega, const Vec3& v, const FlowScale& scale,
                                double strength) noexcept;

/// Eq. 2.6.
/// @param fade_speed part of scale.speed below which it fades: g rises smoothly from 0 to 1 there.
[[nodiscard]] AxisDrag transverse_drag(const Vec3& v, const FlowScale& scale, double damping,
                                       double fade_speed) noexcept;

class ForceField : public Constraint {
 public:
  void apply(const ChainSettings& settings) noexcept final { settings_ = settings.force_field; }
  void reset() noexcept final { hint_ = {}; }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept final;

 protected:
  explicit ForceField(const Workspace& workspace) : workspace_(workspace) {}
  [[nodiscard]] const ForceFieldSettings& settings() const noexcept { return settings_; }

 private:
  /// Sets the force, or frame and damping, of `link`; leaves it alone unless the result is kOk.
  [[nodiscard]] virtual SampleStatus feel(const Vec3& x_data, CellHint& hint,
                                          LinkUpdate& link) const noexcept = 0;

  Workspace workspace_;
  ForceFieldSettings settings_;
  CellHint hint_;
};

/// Eq. 2.4: carried along by the flow.
class DirectDisplay final : public ForceField {
 public:
  DirectDisplay(std::shared_ptr<const VectorField> field, const Workspace& workspace);

 private:
  [[nodiscard]] SampleStatus feel(const Vec3& x_data, CellHint& hint, LinkUpdate& link) const noexcept final;

  std::shared_ptr<const VectorField> field_;
  FlowScale scale_;
};

/// Eq. 2.5: pulled to the cores of vortices, on the recovered vorticity (field/vorticity_field.h).
class VortexPull final : public ForceField {
 public:
  /// Measures how strong vortices are: W is what |omega x v| exceeds in a hundredth of the volume, and a
  /// twentieth of that of |omega| |v| at least, so that the noise of a flow without vortices is not felt.
  VortexPull(std::shared_ptr<const VectorField> field, const Workspace& workspace);

 private:
  [[nodiscard]] SampleStatus feel(const Vec3& x_data, CellHint& hint, LinkUpdate& link) const noexcept final;

  std::shared_ptr<const VectorField> field_;
  VorticityField vorticity_;
  FlowScale scale_;
};

/// Eq. 2.6: dragged when moving across the flow.
class TransverseDamping final : public ForceField {
 public:
  TransverseDamping(std::shared_ptr<const VectorField> field, const Workspace& workspace);

 private:
  [[nodiscard]] SampleStatus feel(const Vec3& x_data, CellHint& hint, LinkUpdate& link) const noexcept final;

  std::shared_ptr<const VectorField> field_;
  FlowScale scale_;
};

/// Eq. 2.3: dragged by value, the more the higher it is unless the transfer function says otherwise.
class DensityDrag final : public ForceField {
 public:
  DensityDrag(std::shared_ptr<const ScalarField> field, const Workspace& workspace);

 private:
  [[nodiscard]] SampleStatus feel(const Vec3& x_data, CellHint& hint, LinkUpdate& link) const noexcept final;

  std::shared_ptr<const ScalarField> field_;
};

}  // namespace palpate
