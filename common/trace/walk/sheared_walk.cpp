#include "common/trace/walk/face_walk_factory.h"

namespace palpate {

std::unique_ptr<LineWalk> make_sheared_walk(const ShearedDomain& domain, Integrator integrator,
                                            const WalkSettings& settings) {
  return make_face_walk(domain, integrator, settings);
}

}  // namespace palpate
