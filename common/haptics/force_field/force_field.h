/// The force-field modes (Ikits 2006, sec. 2.3.2) as constraints that constrain nothing: the proxy is the
/// probe, and what is felt is a force of the data there (force_law.h). They may stand in a chain like any
/// other.
///
/// Where the data says nothing there is no force, and the state is kOutside.
#pragma once

#include <memory>

#include "common/field/scalar_field.h"
#include "common/field/vector_field.h"
#include "common/field/vorticity_field.h"
#include "common/haptics/constraint.h"
#include "common/haptics/force_field/force_law.h"
#include "common/haptics/workspace.h"

namespace palpate {

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
