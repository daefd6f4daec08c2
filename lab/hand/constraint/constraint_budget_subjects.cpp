#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "common/field/analytic/analytic_scalar.h"
#include "common/haptics/constraint/anisotropy_drag.h"
#include "common/haptics/constraint/detent_marks.h"
#include "common/haptics/constraint/grid_axis.h"
#include "common/haptics/constraint/isosurface.h"
#include "common/haptics/constraint/linear.h"
#include "common/haptics/constraint/shape.h"
#include "common/haptics/constraint/streamline.h"
#include "common/haptics/reference_frame.h"
#include "lab/data/formula_flow.h"
#include "lab/data/made_data.h"
#include "lab/hand/constraint/constraint_budget.h"

namespace palpate {
namespace {

constexpr double kRadius = 0.05;  // m, of round features, and metres a unit of data
constexpr double kRise = 0.5;     // of the helix, radii a radian
constexpr double kFar = 0.04;     // m: no hand here is pulled that far off

const Vec3 kPlaneNormal = glm::normalize(Vec3{0.31, 0.47, 0.83});
constexpr double kPlaneOffset = 0.0137;  // units of data, from the origin

template <typename Made>
std::unique_ptr<Constraint> ready(std::unique_ptr<Made> constraint,
                                  const ChainSettings& all = budget_settings()) {
  constraint->apply(all);
  return constraint;
}

/// To and fro along an angle, at up to 0.2 m/s on a radius of kRadius.
double swing(double time) {
  constexpr double kAngle = 2.0, kRate = 2.0;  // rad, rad/s
  return kAngle * std::sin(kRate * time);
}

Vec3 on_helix(double u, double rise = kRise) { return kRadius * Vec3{std::cos(u), std::sin(u), rise * u}; }

/// Parameter of the local minimum of the distance of `x` from the helix, downhill from `u`: small steps while
/// they lead nearer, then golden sections.
double down_to(const Vec3& x, double u, double rise) {
  const auto distance = [&](double at) { return glm::distance(on_helix(at, rise), x); };
  constexpr double kStep = 2e-3, kGolden = 0.6180339887498949;
  constexpr int kSections = 60;
  while (distance(u + kStep) < distance(u)) u += kStep;
  while (distance(u - kStep) < distance(u)) u -= kStep;
  double low = u - kStep, high = u + kStep;
  for (int n = 0; n < kSections; ++n) {
    const double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
    (distance(left) < distance(right) ? high : low) = distance(left) < distance(right) ? right : left;
  }
  return 0.5 * (low + high);
}

double off_helix(const Vec3& x, double rise) {
  // The turn next to x: the helix here stays within one, so the angle about its axis begins the search.
  const double u = rise > 0.0 ? x.z / (kRadius * rise) : std::atan2(x.y, x.x);
  return glm::distance(on_helix(down_to(x, u, rise), rise), x);
}

std::unique_ptr<StreamlineConstraint> helix_streamline() {
  const auto field = turning_flow(kRise);
  return std::make_unique<StreamlineConstraint>(
      std::make_shared<LiveLine>(field, LiveLine::kFollowTolerance, 1), Workspace(kRadius, field->frame()));
}

BudgetSubject streamline() {
  return {.name = "streamline",
          .make = [] { return ready(helix_streamline()); },
          .make_ideal =
              [] { return [u = 0.0](const Vec3& x) mutable { return on_helix(u = down_to(x, u, kRise)); }; },
          .off_feature = [](const Vec3& x) { return off_helix(x, kRise); },
          .guide = [](double t) { return on_helix(swing(t)); }};
}

/// A streamline with tick marks behind it, as one link.
class MarkedStreamline final : public Constraint {
 public:
  void apply(const ChainSettings& all) noexcept override {
    line_->apply(all);
    marks_.apply(all);
  }
  void reset() noexcept override {
    line_->reset();
    marks_.reset();
  }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override {
    LinkUpdate first;
    line_->update(probe, budget, first);
    marks_.update(first.proxy, budget, link);
    link.iterations += first.iterations;
    link.state = std::max(link.state, first.state);
  }

 private:
  std::unique_ptr<StreamlineConstraint> line_ = helix_streamline();
  TickMarks marks_{*line_};
};

BudgetSubject tick_marks() {
  const double interval = budget_settings().ticks.interval;  // one radian a unit of time
  return {.name = "tick marks",
          .make = [] { return ready(std::make_unique<MarkedStreamline>()); },
          .make_ideal =
              [interval] {
                return [interval, u = 0.0, mark = 0.0](const Vec3& x) mutable {
                  u = down_to(x, u, kRise);
                  while (u - mark > interval) mark += interval;
                  while (mark - u > interval) mark -= interval;
                  return on_helix(mark);
                };
              },
          .off_feature = [](const Vec3& x) { return off_helix(x, kRise); },
          .guide = [](double t) { return on_helix(swing(t)); }};
}

/// 1 - sum (x_a / r_a)^2.
struct EllipsoidFormula {
  static constexpr const char* kName = "ellipsoid";
  static constexpr const char* kDescription = "1 - x^2 - (y / 0.8)^2 - (z / 0.7)^2";
  inline static const Box kBounds{Vec3{-2.0}, Vec3{2.0}};
  inline static const Vec3 kHalfAxes{1.0, 0.8, 0.7};
  template <typename T>
  static T value(const T& x, const T& y, const T& z) {
    return 1.0 - x * x - y * y / 0.64 - z * z / 0.49;
  }
};

/// The point of the ellipsoid nearest to `x`: q_a = r_a^2 x_a / (r_a^2 + m) with the one m > -min r_a^2 that
/// puts it there, by bisection (Eberly 2011).
Vec3 nearest_on_ellipsoid(const Vec3& x) {
  const Vec3 squared = EllipsoidFormula::kHalfAxes * EllipsoidFormula::kHalfAxes;
  const Vec3 y = x / kRadius;
  double low = -squared.z, high = 4.0 * glm::dot(y, y) + 1.0;
  constexpr int kHalvings = 200;
  for (int n = 0; n < kHalvings; ++n) {
    const double m = 0.5 * (low + high);
    const Vec3 part = EllipsoidFormula::kHalfAxes * y / (squared + m);
    (glm::dot(part, part) > 1.0 ? low : high) = m;
  }
  return kRadius * squared * y / (squared + 0.5 * (low + high));
}

BudgetSubject isosurface() {
  return {
      .name = "isosurface, formula",
      .make =
          [] {
            const auto field = make_scalar_field(std::make_shared<const FormulaScalar<EllipsoidFormula>>());
            return ready(std::make_unique<IsosurfaceConstraint>(field, Workspace(kRadius, field->frame())));
          },
      .make_ideal = [] { return nearest_on_ellipsoid; },
      .off_feature = [](const Vec3& x) { return glm::distance(x, nearest_on_ellipsoid(x)); },
      .guide =
          [](double t) {
            const double u = swing(t), up = 0.4 * std::sin(1.3 * t);
            return kRadius * EllipsoidFormula::kHalfAxes *
                   Vec3{std::cos(up) * std::cos(u), std::cos(up) * std::sin(u), std::sin(up)};
          }};
}

/// A plane through cells: their interpolant is s = n . x - c itself, so that only the way from cell to cell
/// counts.
BudgetSubject plane_in_cells(std::string name, const DataSet& data) {
  const auto field = make_scalar_field({data}, {.array = "velocity", .component = 0}, "made data");
  const Vec3 n = kPlaneNormal, across = glm::normalize(glm::cross(n, Vec3{1.0, 0.0, 0.0}));
  const double offset = kRadius * kPlaneOffset;
  const auto flat = [n, offset](const Vec3& x) { return x - (glm::dot(x, n) - offset) * n; };
  return {
      .name = std::move(name),
      .make =
          [field] {
            return ready(std::make_unique<IsosurfaceConstraint>(field, Workspace(kRadius, field->frame())));
          },
      .make_ideal = [flat]() -> IdealProxy { return flat; },
      .off_feature = [n, offset](const Vec3& x) { return std::abs(glm::dot(x, n) - offset); },
      .guide =
          [n, across, offset](double t) {
            return offset * n +
                   0.3 * kRadius * (swing(t) * across + std::sin(1.7 * t) * glm::cross(n, across));
          }};
}

BudgetSubject isosurface_in_boxes() {
  constexpr int kPoints = 33;
  return plane_in_cells("isosurface, boxes",
                        uniform_data(kPoints, {Vec3{-1.0}, Vec3{1.0}}, [](const Vec3& x) {
                          return Vec3{glm::dot(x, kPlaneNormal) - kPlaneOffset, 0.0, 0.0};
                        }));
}

BudgetSubject isosurface_in_tetrahedra() {
  constexpr int kPoints = 33;
  const auto even = even_coordinates(kPoints);
  return plane_in_cells("isosurface, tets", tetrahedral_data(even, even, even, [](const Vec3& x) {
                          return Vec3{glm::dot(x, kPlaneNormal) - kPlaneOffset, 0.0, 0.0};
                        }));
}

ChainSettings line_settings() {
  ChainSettings all = budget_settings();
  all.linear.axes[1].rule = all.linear.axes[2].rule = AxisRule::kFixed;
  return all;
}

constexpr std::array kTau{0.001, 0.002, 0.003};  // m
ChainSettings drag_settings() {
  ChainSettings all = budget_settings();
  for (std::size_t a = 0; a < kTau.size(); ++a) {
    all.linear.axes[a].rule = AxisRule::kDrag;
    all.linear.axes[a].tau = kTau[a];
  }
  return all;
}

/// Held across the flow of circles, free along it.
BudgetSubject linear_line() {
  const auto along = [](const Vec3& p) { return glm::normalize(Vec3{-p.y, p.x, 0.0}); };
  return {.name = "linear, line",
          .settings = line_settings(),
          .make =
              [] {
                const auto field = turning_flow(0.0);
                return ready(std::make_unique<LinearConstraint>(
                                 std::make_unique<FlowFrame>(field, Workspace(kRadius, field->frame()))),
                             line_settings());
              },
          .make_ideal =
              [along] {
                return [along, p = Vec3{kRadius, 0.0, 0.0}](const Vec3& x) mutable {
                  // Where it comes to rest depends on the steps it takes: full ones of eq. 6.13, as there.
                  constexpr int kSteps = 100;
                  for (int n = 0; n < kSteps; ++n) p += glm::dot(x - p, along(p)) * along(p);
                  return p;
                };
              },
          .off_feature = nullptr,  // it has no line of its own: linear_drift.h says what becomes of one
          .guide = [](double t) { return on_helix(swing(t), 0.0); }};
}

/// Dragged along three fixed axes at once, each at its own threshold.
BudgetSubject linear_drag() {
  return {.name = "linear, drag",
          .settings = drag_settings(),
          .make =
              [] {
                return ready(std::make_unique<LinearConstraint>(std::make_unique<FixedFrame>(Mat3{1.0})),
                             drag_settings());
              },
          .make_ideal =
              [] {
                return [p = Vec3{kRadius, 0.0, 0.0}](const Vec3& x) mutable {
                  // The point of the ellipsoid about x that is nearest to p, by the same formula as above.
                  const Vec3 tau{kTau[0], kTau[1], kTau[2]}, y = p - x, inside = y / tau;
                  if (glm::dot(inside, inside) <= 1.0) return p;
                  double low = 0.0, high = 4.0 * glm::length(y) * tau.z + 4.0 * glm::dot(y, y);
                  constexpr int kHalvings = 200;
                  for (int n = 0; n < kHalvings; ++n) {
                    const double m = 0.5 * (low + high);
                    const Vec3 part = tau * y / (tau * tau + m);
                    (glm::dot(part, part) > 1.0 ? low : high) = m;
                  }
                  p = x + tau * tau * y / (tau * tau + 0.5 * (low + high));
                  return p;
                };
              },
          .off_feature = nullptr,
          .guide = [](double t) { return on_helix(swing(t), 0.0); }};
}

BudgetSubject isotropic_drag() {
  const double tau = budget_settings().drag.threshold;
  return {.name = "isotropic drag",
          .make = [] { return ready(std::make_unique<IsotropicDrag>()); },
          .make_ideal =
              [tau] {
                return [tau, p = Vec3{kRadius, 0.0, 0.0}](const Vec3& x) mutable {
                  const double distance = glm::distance(x, p);
                  if (distance > tau) p = x - (tau / distance) * (x - p);
                  return p;
                };
              },
          .off_feature = nullptr,
          .guide = [](double t) { return on_helix(swing(t), 0.0); }};
}

BudgetSubject sphere() {
  return {.name = "sphere",
          .make = [] { return ready(std::make_unique<SphereConstraint>(Vec3{0.0}, kRadius)); },
          .make_ideal = [] { return [](const Vec3& x) { return kRadius * glm::normalize(x); }; },
          .off_feature = [](const Vec3& x) { return std::abs(glm::length(x) - kRadius); },
          .guide = [](double t) { return on_helix(swing(t), 0.0); }};
}

BudgetSubject circle() {
  return {.name = "circle",
          .make =
              [] {
                return ready(std::make_unique<CircleConstraint>(Vec3{0.0}, Vec3{0.0, 0.0, 1.0}, kRadius));
              },
          .make_ideal =
              [] {
                return [](const Vec3& x) {
                  const double angle = std::atan2(x.y, x.x);
                  return on_helix(angle, 0.0);
                };
              },
          .off_feature = [](const Vec3& x) { return off_helix(x, 0.0); },
          .guide = [](double t) { return on_helix(swing(t), 0.0); }};
}

/// The polygon about the helix with vertices every 0.05 radians, of which the nearest point is looked for on
/// the segments within two radians of where it was.
BudgetSubject polyline() {
  std::vector<Vec3> vertices;
  constexpr int kHalf = 60;
  constexpr double kSpacing = 0.05;
  for (int n = -kHalf; n <= kHalf; ++n) vertices.push_back(on_helix(kSpacing * n));
  const auto nearest = [vertices](const Vec3& x) {
    Vec3 best = vertices.front();
    for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
      const Vec3 chord = vertices[i + 1] - vertices[i];
      const double t = glm::dot(x - vertices[i], chord) / glm::dot(chord, chord);
      const Vec3 place = vertices[i] + std::clamp(t, 0.0, 1.0) * chord;
      if (glm::distance(place, x) < glm::distance(best, x)) best = place;
    }
    return best;
  };
  return {.name = "polyline",
          .make = [vertices] { return ready(std::make_unique<PolylineConstraint>(vertices)); },
          .make_ideal = [nearest]() -> IdealProxy { return nearest; },
          .off_feature = [nearest](const Vec3& x) { return glm::distance(nearest(x), x); },
          .guide = [](double t) { return on_helix(swing(t)); }};
}

BudgetSubject grid_axis() {
  constexpr double kSpacing = 0.03;  // m
  return {.name = "grid axis",
          .make = [] { return ready(std::make_unique<GridAxis>(Vec3{0.0}, Mat3{1.0}, Vec3{kSpacing})); },
          .make_ideal = [] { return [](const Vec3& x) {
                               return Vec3{x.x, 0.0, 0.0};
                             }; },
          .off_feature = [](const Vec3& x) { return std::hypot(x.y, x.z); },
          .guide =
              [](double t) {
                return Vec3{kRadius * swing(t), 0.0, 0.0};
              }};
}

}  // namespace

ChainSettings budget_settings() {
  ChainSettings all;
  all.streamline.release_distance = kFar;
  all.shape = {.snap_distance = kFar, .release_distance = 2.0 * kFar};
  all.isosurface.isovalues.count = 1;
  all.isosurface.isovalues.value[0] = 0.0;
  all.isosurface.hold = IsosurfaceHold::kLayer;
  all.isosurface.depth = all.isosurface.snap_distance = kFar;
  all.grid_axis.threshold = kFar;
  all.ticks.interval = 0.1;
  return all;
}

std::vector<BudgetSubject> budget_subjects() {
  return {streamline(),  tick_marks(),  isosurface(), isosurface_in_boxes(), isosurface_in_tetrahedra(),
          linear_line(), linear_drag(), polyline(),   isotropic_drag(),      sphere(),
          circle(),      grid_axis()};
}

}  // namespace palpate
