#include "common/trace/walk/walk_factory.h"

#include <algorithm>
#include <cmath>

#include "common/trace/walk/face_walk_factory.h"

namespace palpate {

double default_fixed_step(const VectorField& field) {
  constexpr double kOfCell = 0.5, kOfFormula = 1.0 / 200;
  if (const BoxGrid* grid = field.box_grid()) {
    const Vec3 size = grid->bounds().size();
    const Vec3 cells = Vec3(grid->points() - Index3(1));
    return kOfCell * std::cbrt((size.x / cells.x) * (size.y / cells.y) * (size.z / cells.z));
  }
  if (const TetMesh* mesh = field.tet_mesh()) {
    const Vec3 size = mesh->bounds().size();
    return kOfCell * std::cbrt(size.x * size.y * size.z / static_cast<double>(mesh->cells().size()));
  }
  return kOfFormula * field.analytic()->bounds().diagonal();
}

WalkFactory::WalkFactory(const VectorField& field, Integrator integrator, const WalkSettings& settings,
                         int threads)
    : field_(field), integrator_(integrator), settings_(settings) {
  if (field.tet_mesh() != nullptr) mesh_ = &ExactMesh::of(field, threads);
  // A fixed step comes no nearer to a point of rest than its own length.
  if (integrator == Integrator::kEuler || integrator == Integrator::kRk4) {
    settings_.rest_distance = std::max(settings_.rest_distance, settings_.fixed_step);
  }
  if (field.analytic() != nullptr) {
    // Long enough to be quick, short enough not to step over what the formula does in between.
    constexpr double kLargestStep = 1.0 / 32;
    settings_.largest_step = kLargestStep * field.analytic()->bounds().diagonal();
  }
}

std::unique_ptr<LineWalk> WalkFactory::make(TraceDirection direction) const {
  if (integrator_ == Integrator::kExact) {
    return std::make_unique<ExactWalk>(*mesh_, settings_.rest_distance, direction);
  }
  const double sign = direction == TraceDirection::kForward ? 1.0 : -1.0;
  if (field_.box_grid() != nullptr && field_.box_grid()->sheared())
    return make_sheared_walk(ShearedDomain(field_, sign), integrator_, settings_);
  if (field_.box_grid() != nullptr) return make_box_walk(BoxDomain(field_, sign), integrator_, settings_);
  if (mesh_ != nullptr) return make_tet_walk(TetDomain(*mesh_, sign), integrator_, settings_);
  return make_formula_walk(FormulaDomain(field_, sign), integrator_, settings_);
}

}  // namespace palpate
