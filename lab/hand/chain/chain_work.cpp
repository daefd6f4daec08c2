#include "lab/hand/chain/chain_work.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <utility>

#include "common/base/index.h"
#include "common/field/analytic/analytic_scalar.h"
#include "common/haptics/constraint/anisotropy_drag.h"
#include "common/haptics/constraint/detent_marks.h"
#include "common/haptics/constraint/isosurface.h"
#include "common/haptics/constraint/shape.h"
#include "common/haptics/constraint/streamline.h"
#include "common/haptics/proxy_chain.h"
#include "lab/data/formula_flow.h"
#include "lab/hand/streamline_run.h"

namespace palpate {
namespace {

using Links = std::vector<std::unique_ptr<Constraint>>;

constexpr int kStepsPerTurn = 4000;
constexpr double kLoopSize = 0.004;  // m, from its middle
constexpr double kAngles[] = {5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 70.0, 80.0, 85.0};
constexpr double kNearlyFlat = 5.0;  // m, radius of a sphere that stands for a plane

/// A link with a weaker spring.
class Weakened final : public Constraint {
 public:
  Weakened(std::unique_ptr<Constraint> link, double factor) : link_(std::move(link)), factor_(factor) {}
  void apply(const ChainSettings& settings) noexcept override { link_->apply(settings); }
  void reset() noexcept override { link_->reset(); }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override {
    link_->update(probe, budget, link);
    link.kappa *= factor_;
  }

 private:
  std::unique_ptr<Constraint> link_;
  double factor_;
};

/// Chains and where their loops go around.
struct Subject {
  std::string name;
  double angle = 0.0;  ///< [degrees]
  Vec3 middle{0.0};    ///< [m]
  std::function<Links()> make;
  int steps = kStepsPerTurn;
};

std::unique_ptr<Constraint> line_at(double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  const Vec3 t{std::sin(angle), 0.0, std::cos(angle)};
  return std::make_unique<PolylineConstraint>(-0.1 * t, 0.1 * t);
}

/// Through the origin, its normal there along z.
std::unique_ptr<Constraint> sphere(double radius) {
  return std::make_unique<SphereConstraint>(Vec3{0.0, 0.0, -radius}, radius);
}

/// Through the origin along (1, 1, 1).
std::unique_ptr<Constraint> circle(double radius) {
  const Vec3 along = glm::normalize(Vec3{1.0}), across = glm::normalize(Vec3{1.0, -1.0, 0.0});
  return std::make_unique<CircleConstraint>(radius * across, glm::cross(along, across), radius);
}

/// Circles of the flow about the z axis, at a tenth of a metre a unit.
std::unique_ptr<StreamlineConstraint> helix_line() {
  const auto field = turning_flow(0.5);
  return std::make_unique<StreamlineConstraint>(
      std::make_shared<LiveLine>(field, LiveLine::kFollowTolerance, 1), Workspace(0.1, field->frame()));
}
constexpr Vec3 kOnStreamline{0.05, 0.0, 0.0};

/// Zero on a bent surface that meets the streamline through (0.5, 0, 0) at 43 degrees from its normal.
struct BentFormula {
  static constexpr const char* kName = "bent";
  static constexpr const char* kDescription = "y + 0.7 (x - 0.5) + 0.8 (z^2 + (x - 0.5)^2)";
  inline static const Box kBounds{Vec3{-2.0}, Vec3{2.0}};
  template <typename T>
  static T value(const T& x, const T& y, const T& z) {
    const T beside = x - 0.5;
    return y + 0.7 * beside + 0.8 * (z * z + beside * beside);
  }
};

/// That surface, felt from either side.
std::unique_ptr<Constraint> wall() {
  const auto field = make_scalar_field(std::make_shared<const FormulaScalar<BentFormula>>());
  return std::make_unique<IsosurfaceConstraint>(field, Workspace(0.1, field->frame()));
}

template <typename... Link>
Links links_of(std::unique_ptr<Link>... links) {
  Links all;
  (all.push_back(std::move(links)), ...);
  return all;
}

std::vector<Subject> subjects() {
  std::vector<Subject> all;
  for (const double angle : kAngles) {
    all.push_back({"line, then plane", angle, Vec3{0.0},
                   [angle] { return links_of(line_at(angle), sphere(kNearlyFlat)); }});
  }
  for (const double angle : kAngles) {
    all.push_back({"line, then plane with a quarter of the spring", angle, Vec3{0.0}, [angle] {
                     return links_of(line_at(angle), std::make_unique<Weakened>(sphere(kNearlyFlat), 0.25));
                   }});
  }
  const double angle = 45.0;
  all.push_back({"plane, then line", 0.0, Vec3{0.0},
                 [angle] { return links_of(sphere(kNearlyFlat), line_at(angle)); }});
  all.push_back({"circle of 20 mm, then sphere of 60 mm", 0.0, Vec3{0.0},
                 [] { return links_of(circle(0.02), sphere(0.06)); }});
  all.push_back({"sphere of 60 mm, then circle of 20 mm", 0.0, Vec3{0.0},
                 [] { return links_of(sphere(0.06), circle(0.02)); }});
  all.push_back({"sphere, then line, then circle", 0.0, Vec3{0.0},
                 [angle] { return links_of(sphere(0.06), line_at(angle), circle(0.02)); }});
  all.push_back({"streamline, then sphere", 0.0, kOnStreamline, [] {
                   return links_of(helix_line(), std::make_unique<SphereConstraint>(
                                                     kOnStreamline + Vec3{0.03, 0.04, 0.0}, 0.05));
                 }});
  constexpr int kManySteps = 16 * kStepsPerTurn;  // the force steps where a wall takes hold or lets go
  all.push_back({"streamline, then isosurface", 0.0, kOnStreamline,
                 [] { return links_of(helix_line(), wall()); }, kManySteps});
  all.push_back({"isosurface, then streamline", 0.0, kOnStreamline,
                 [] { return links_of(wall(), helix_line()); }, kManySteps});
  all.push_back({"streamline, then tick marks", 0.0, kOnStreamline, [] {
                   auto first = helix_line();
                   auto marks = std::make_unique<TickMarks>(*first);
                   return links_of(std::move(first), std::move(marks));
                 }});
  all.push_back({"drag, then sphere", 0.0, Vec3{0.0},
                 [] { return links_of(std::make_unique<IsotropicDrag>(), sphere(0.06)); }});
  all.push_back({"line, then drag", 0.0, Vec3{0.0},
                 [angle] { return links_of(line_at(angle), std::make_unique<IsotropicDrag>()); }});
  return all;
}

/// Nothing is let go on these loops.
ChainSettings settings_of_loops() {
  ChainSettings settings;
  settings.shape = {.snap_distance = 0.05, .release_distance = 0.1};
  settings.streamline.release_distance = 0.04;
  settings.drag.threshold = 0.001;
  settings.isosurface.isovalues.count = 1;
  settings.isosurface.depth = 0.04;
  settings.ticks.interval = 0.02;  // a millimetre apart, roughly
  return settings;
}

/// A closed curve: three harmonics with random directions.
class Loop {
 public:
  Loop(const Subject& subject, std::uint64_t seed) : middle_(subject.middle), steps_(subject.steps) {
    std::mt19937_64 random(seed);
    const auto unit = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1.0; };
    for (Vec3& part : parts_) {
      const double x = unit(), y = unit(), z = unit();
      part = Vec3{x, y, z};
    }
  }
  [[nodiscard]] int steps() const noexcept { return steps_; }
  [[nodiscard]] Vec3 at(int step) const {
    const double turn = 2.0 * std::numbers::pi * step / steps_;
    Vec3 x = middle_;
    for (std::size_t m = 0; m < kHarmonics; ++m) {
      const double n = static_cast<double>(m + 1);
      x += (kLoopSize / n) * (std::cos(n * turn) * parts_[2 * m] + std::sin(n * turn) * parts_[2 * m + 1]);
    }
    return x;
  }

 private:
  static constexpr std::size_t kHarmonics = 3;
  Vec3 middle_;
  int steps_;
  std::array<Vec3, 2 * kHarmonics> parts_{};
};

double energy_of(const Vec3& probe, const ChainStep& step, double stiffness) {
  double sum = 0.0;
  Vec3 pulled = probe;
  for (int i = 0; i < step.links; ++i) {
    const Vec3 stretch = step.proxies[as_size(i)] - pulled;
    sum += 0.5 * stiffness * glm::dot(stretch, stretch);
    pulled = step.proxies[as_size(i)];
  }
  return sum;
}

/// Leads a hand around once, and then once more that counts.
void lead_around(ProxyChain& chain, const Loop& loop, int direction, ChainWorkRow& row) {
  chain.reset();
  for (int n = 0; n < loop.steps(); ++n) (void)chain.step(loop.at(direction * n));
  Vec3 last = loop.at(0);
  Vec3 last_force = chain.step(last).force;
  double work = 0.0, energy = 0.0;
  const double before = thread_microseconds();
  for (int n = 1; n <= loop.steps(); ++n) {
    const Vec3 x = loop.at(direction * n);
    const ChainStep step = chain.step(x);
    work += glm::dot(0.5 * (last_force + step.force), x - last);
    energy = std::max(energy, energy_of(x, step, chain.settings().stiffness));
    if (!step.jumped) {
      row.steepest = std::max(row.steepest, glm::distance(step.force, last_force) / glm::distance(x, last));
    }
    last = x;
    last_force = step.force;
  }
  row.us_mean += thread_microseconds() - before;
  row.yield = std::max(row.yield, work / energy);
  row.taken = std::max(row.taken, -work / energy);
  ++row.turns;
}

ChainWorkRow measure(const Subject& subject, ChainForceForm form, int loops) {
  ProxyChain chain(subject.make(), settings_of_loops());
  chain.set_force_form(form);
  ChainWorkRow row{.chain = subject.name, .angle = subject.angle, .form = form};
  for (int n = 0; n < loops; ++n) {
    const Loop loop(subject, static_cast<std::uint64_t>(n) + 1);
    for (const int direction : {1, -1}) lead_around(chain, loop, direction, row);
  }
  row.us_mean /= static_cast<double>(row.turns) * subject.steps;
  return row;
}

int loops_of(Effort effort) {
  switch (effort) {
    case Effort::kQuick:
      return 3;
    case Effort::kThorough:
      return 30;
    default:
      return 10;
  }
}

}  // namespace

ChainWork run_chain_work(Effort effort, Progress* progress) {
  if (progress) progress->begin("chains on closed loops", 0);
  ChainWork work;
  for (const Subject& subject : subjects()) {
    if (progress) progress->check();
    for (const ChainForceForm form : {ChainForceForm::kSum, ChainForceForm::kConsistent}) {
      work.rows.push_back(measure(subject, form, loops_of(effort)));
    }
  }
  return work;
}

}  // namespace palpate
