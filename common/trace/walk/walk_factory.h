/// Makes the walk that an integrator and a field call for.
#pragma once

#include <memory>

#include "common/trace/exact/exact_walk.h"
#include "common/trace/trace.h"
#include "common/trace/walk/line_walk.h"

namespace palpate {

class WalkFactory {
 public:
  /// Prepares what all walks share. @pre `field` outlives this; exact only on tetrahedra.
  WalkFactory(const VectorField& field, Integrator integrator, const WalkSettings& settings, int threads);

  /// A walk for one thread; it may be started again for any number of lines.
  [[nodiscard]] std::unique_ptr<LineWalk> make(TraceDirection direction) const;

 private:
  const VectorField& field_;
  Integrator integrator_;
  WalkSettings settings_;
  const ExactMesh* mesh_ = nullptr;  ///< of the field
};

/// Half a mean cell (a cube of the domain's volume over its number of cells); 1/200 of the diagonal for a
/// formula. Frame L.
[[nodiscard]] double default_fixed_step(const VectorField& field);

}  // namespace palpate
