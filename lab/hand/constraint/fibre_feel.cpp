#include "lab/hand/constraint/fibre_feel.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "common/base/text.h"
#include "common/field/analytic/ventricle.h"
#include "common/math/quaternion.h"
#include "lab/hand/streamline_run.h"
#include "lab/page/html.h"

namespace palpate {
namespace {

constexpr double kMillimetres = 1e3;
constexpr double kClearGap = 0.5;  // below it the threshold fades

double corrected_threshold(double u) {
  const FibreSettings settings;
  return (1.0 - u) * settings.least_friction + u * settings.most_friction;
}

}  // namespace

FibreFeel run_fibre_feel(const std::shared_ptr<const LayeredHeart>& heart, Effort effort,
                         Progress* progress) {
  constexpr std::size_t kQuick = 4000, kNormal = 20'000, kThorough = 200'000;
  constexpr std::size_t kOneWay = 250, kChecked = 1000;  // steps
  constexpr double kStride = 2e-4;                       // of the diagonal, a step
  FibreFeel feel;
  feel.steps = effort == Effort::kQuick ? kQuick : effort == Effort::kNormal ? kNormal : kThorough;
  FibreChain chain(heart);
  const ScalarField& layer = *heart->heart().layer;
  const LocalFrame& frame = heart->frame();
  const double diagonal = layer.diagonal();
  std::mt19937 random{5};
  std::uniform_real_distribution<double> part(0.15, 0.85);
  const Box box = layer.bounds();
  const auto somewhere = [&] {
    const double x = part(random), y = part(random), z = part(random);
    return box.lower + box.size() * Vec3{x, y, z};
  };
  Vec3 at = somewhere(), goal = at;
  CellHint hint;
  std::vector<double> times;
  times.reserve(feel.steps);
  if (progress != nullptr) progress->begin("feeling the layers", feel.steps);
  for (std::size_t i = 0; i < feel.steps; ++i) {
    if (i % kOneWay == 0) goal = somewhere();
    if (i % kChecked == 0 && progress != nullptr) progress->advance(i == 0 ? 0 : kChecked);
    const double left = glm::distance(goal, at);
    if (left > 0.0) at += std::min(1.0, kStride * diagonal / left) * (goal - at);
    const double before = thread_microseconds();
    const ChainStep step = chain.step(at);
    times.push_back(thread_microseconds() - before);
    if (chain.layer() < 0 || step.state != HoldState::kHeld) continue;
    ++feel.held;
    for (std::size_t link = 0; link < 3; ++link) {
      Jet3 here;
      const Vec3 local = frame.local_from_data(chain.proxy(step, link));
      if (layer.jet(local, hint, here) != SampleStatus::kOk) continue;
      const double steepness = glm::length(here.gradient);
      if (!(steepness > 0.0)) continue;
      const double off = std::abs(here.value - chain.level() * layer.value_scale()) / steepness;
      feel.off_layer = std::max(feel.off_layer, off * frame.length_scale() / diagonal);
    }
    const FibreSample fibre = heart->sample(frame.local_from_data(chain.proxy(step, 2)), hint);
    if (fibre.status != SampleStatus::kOk || fibre.gap < kClearGap) continue;
    const double expected = corrected_threshold(std::abs(glm::dot(fibre.normal, fibre.fibre)));
    feel.off_threshold = std::max(feel.off_threshold, kMillimetres * std::abs(chain.threshold() - expected));
  }
  constexpr double kRare = 0.999;
  feel.microseconds = errors_of(times);
  const auto rare =
      times.begin() + static_cast<std::ptrdiff_t>(kRare * static_cast<double>(times.size() - 1));
  std::nth_element(times.begin(), rare, times.end());
  feel.p999 = *rare;
  return feel;
}

std::vector<FrictionRow> run_friction(Effort effort, Progress* progress) {
  const std::vector<double> angles = effort == Effort::kQuick
                                         ? std::vector<double>{0.0, 45.0}
                                         : std::vector<double>{0.0, 15.0, 30.0, 45.0, 60.0, 75.0};
  constexpr int kSteps = 600, kFollowing = 200;  // it follows after so many
  constexpr double kTurn = 0.002;                // [rad] a step
  std::vector<FrictionRow> rows;
  if (progress != nullptr) progress->begin("dragging over fibres that leave their layer", angles.size());
  for (const double degrees : angles) {
    const Ventricle shape{.imbrication = degrees * kDegree};
    FibreChain chain(layered(ventricle_mesh(shape, {.wall = 8, .along = 40, .around = 80})));
    FrictionRow row{.degrees = degrees,
                    .expected = kMillimetres * corrected_threshold(std::abs(std::sin(shape.imbrication)))};
    // Down through the layer in the middle of the wall, where fibres run around, then around with them.
    (void)chain.step(shape.position({0.655, 1.2, 0.0}));
    (void)chain.step(shape.position({0.645, 1.2, 0.0}));
    for (int i = 1; i <= kSteps; ++i) {
      const ChainStep step = chain.step(shape.position({0.645, 1.2, kTurn * i}));
      if (i <= kFollowing) continue;
      const double lag = kMillimetres * chain.workspace().scale() *
                         glm::distance(chain.proxy(step, 1), chain.proxy(step, 2));
      row.lag += lag / (kSteps - kFollowing);
      row.worst = std::max(row.worst, std::abs(lag - row.expected));
    }
    rows.push_back(row);
    if (progress != nullptr) progress->advance(1);
  }
  return rows;
}

ReportSection fibre_feel_section(const std::string& subject, const FibreFeel& feel,
                                 const std::vector<FrictionRow>& friction) {
  ReportSection section;
  section.title = "Layers, grooves and friction in the hand";
  section.columns = {"fibres leave their layer by", "tau_f expected [mm]", "proxy stays behind [mm]",
                     "largest difference [mm]"};
  for (const FrictionRow& row : friction) {
    const std::string angle = short_number(row.degrees) + " degrees";
    section.table.push_back(
        {angle, three_digits(row.expected), three_digits(row.lag), three_digits(row.worst)});
    section.measurements.push_back({"ventricle", "friction", angle, "proxy stays behind [mm]", row.lag});
    section.measurements.push_back({"ventricle", "friction", angle, "tau_f expected [mm]", row.expected});
  }
  const std::string steps = counted(feel.steps, "step");
  const auto measured = [&](const char* quantity, double value) {
    section.measurements.push_back({subject, "layer, groove and friction", steps, quantity, value});
  };
  measured("largest distance of a proxy from its layer [diagonals]", feel.off_layer);
  measured("largest difference of the drag threshold from eq. 8.1 as corrected [mm]", feel.off_threshold);
  measured("time of a step, median [us]", feel.microseconds.median);
  measured("time of a step, 99 % [us]", feel.microseconds.p99);
  measured("time of a step, 99.9 % [us]", feel.p999);
  section.work_precision.push_back({subject + ", " + steps, "layer, groove and friction", "default budget",
                                    feel.off_layer, "largest distance of a proxy from its layer / diagonal",
                                    1e-6 * feel.microseconds.median});
  section.paragraphs = {
      "A slow hand strokes the heart at hand for " + steps + " (" + std::to_string(feel.held) +
          " of them held to a layer) with the chain of three proxies: layer, groove and friction. No proxy "
          "is "
          "farther than " +
          three_digits(feel.off_layer) + " diagonals from its layer. A step takes " +
          three_digits(feel.microseconds.median) + " us (99 %: " + three_digits(feel.microseconds.p99) +
          ", 99.9 %: " + three_digits(feel.p999) + ") of this thread's processor time.",
      "The table is of the built-in ventricle with fibres that rise out of their layer by one angle: a hand "
      "goes around it along the fibres, and friction keeps the last proxy tau_f = (1 - u) tau_min + u "
      "tau_max "
      "behind, u the sine of that angle: the harder to drag, the more the fibre leaves the layer."};
  return section;
}

std::vector<StabilityCase> fibre_feel_cases(const FibreFeel& feel, const std::vector<FrictionRow>& friction) {
  std::vector<StabilityCase> cases;
  const auto add = [&cases](std::string name, double measured, double limit, std::string unit,
                            std::string meaning) {
    cases.push_back(
        {{std::move(name), measured, limit, measured <= limit}, std::move(unit), std::move(meaning)});
  };
  constexpr double kOnLayer = 1e-9, kSameThreshold = 1e-3, kLag = 0.05, kLeast = 5e-5 * kMillimetres;
  add("proxies on their layers", feel.off_layer, kOnLayer, "of the diagonal",
      "largest distance over " + counted(feel.held, "held step"));
  add("friction on this heart", feel.off_threshold, kSameThreshold, "mm",
      "drag threshold against eq. 8.1 as corrected, where fibres are clear");
  double worst = 0.0;
  for (const FrictionRow& row : friction) worst = std::max(worst, row.worst / (kLag * row.expected + kLeast));
  add("friction on the ventricle", worst, 1.0, "of 5 % and 0.05 mm",
      "how far behind the last proxy stays, against eq. 8.1 as corrected");
  return cases;
}

}  // namespace palpate
