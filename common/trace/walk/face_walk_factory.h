/// The general methods on one kind of domain; each function is compiled in a file of its own.
#pragma once

#include <memory>

#include "common/base/check.h"
#include "common/trace/trace.h"
#include "common/trace/walk/face_walk.h"
#include "common/trace/walk/sheared_domain.h"

namespace palpate {

[[nodiscard]] std::unique_ptr<LineWalk> make_box_walk(const BoxDomain& domain, Integrator integrator,
                                                      const WalkSettings& settings);
[[nodiscard]] std::unique_ptr<LineWalk> make_sheared_walk(const ShearedDomain& domain, Integrator integrator,
                                                          const WalkSettings& settings);
[[nodiscard]] std::unique_ptr<LineWalk> make_tet_walk(const TetDomain& domain, Integrator integrator,
                                                      const WalkSettings& settings);
[[nodiscard]] std::unique_ptr<LineWalk> make_formula_walk(const FormulaDomain& domain, Integrator integrator,
                                                          const WalkSettings& settings);

/// @pre `integrator` is not exact.
template <class Domain>
[[nodiscard]] std::unique_ptr<LineWalk> make_face_walk(const Domain& domain, Integrator integrator,
                                                       const WalkSettings& settings) {
  switch (integrator) {
    case Integrator::kEuler:
      return std::make_unique<FaceWalk<Domain, ExplicitMethod<Euler>>>(domain, settings);
    case Integrator::kRk4:
      return std::make_unique<FaceWalk<Domain, ExplicitMethod<Rk4>>>(domain, settings);
    case Integrator::kBs32:
      return std::make_unique<FaceWalk<Domain, ExplicitMethod<Bs32>>>(domain, settings);
    case Integrator::kRk34:
      return std::make_unique<FaceWalk<Domain, ExplicitMethod<Rk34>>>(domain, settings);
    case Integrator::kDp54:
      return std::make_unique<FaceWalk<Domain, SwitchingMethod>>(domain, settings);
    case Integrator::kRodas4:
      return std::make_unique<FaceWalk<Domain, RodasMethod>>(domain, settings);
    case Integrator::kExact:
      break;
  }
  PALPATE_CHECK(integrator != Integrator::kExact);
  return nullptr;
}

}  // namespace palpate
