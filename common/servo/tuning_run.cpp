#include "common/servo/tuning_run.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/base/error.h"
#include "common/servo/hand_step.h"

namespace palpate {

std::unique_ptr<ProxyChain> tuning_chain(const TuningPlan& plan,
                                         const std::shared_ptr<StiffnessTuner::Channel>& news) {
  ChainSettings settings{.stiffness = plan.most};
  settings.passivity.from_links = ChainStep::kMaxLinks + 1.0;  // what is looked for is the device's own
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<StiffnessTuner>(plan, news));
  return std::make_unique<ProxyChain>(std::move(links), settings);
}

TuningNews run_tuning(Device& device, const TuningPlan& plan, Progress* progress) {
  const auto channel = std::make_shared<StiffnessTuner::Channel>();
  HandStepper stepper(tuning_chain(plan, channel), device.limits());
  TuningNews news;
  HandInput hand;
  if (progress) progress->begin("tuning", plan.places.size());
  std::size_t place = 0;
  for (std::uint64_t n = 0; !news.done; ++n) {
    hand.time = static_cast<double>(n) / plan.rate;
    hand.present = device.read(hand.time, hand.sample);
    const HandStep step = stepper.step(hand);
    device.command(step.force);
    (void)channel->read(news);
    if (!lets_tune(step.cut))
      throw work_error("there was no force (" + std::string(name_of(step.cut)) + "), so nothing is known");
    if (progress && news.place != place) progress->advance(news.place - std::exchange(place, news.place));
    constexpr std::uint64_t kBetweenChecks = 1024;
    if (progress && n % kBetweenChecks == 0) progress->check();
  }
  device.command(Vec3{0.0});
  return news;
}

std::vector<Vec3> tuning_places(const DeviceLimits& limits, int count) {
  constexpr double kPart = 0.5, kUnbounded = 0.04;  // [m]
  Vec3 middle{0.0}, way{kUnbounded};
  for (int a = 0; a < 3; ++a) {
    if (!(limits.reach_upper[a] - limits.reach_lower[a] <= TuningPlan::kFarthest)) continue;
    middle[a] = 0.5 * (limits.reach_lower[a] + limits.reach_upper[a]);
    way[a] = kPart * 0.5 * (limits.reach_upper[a] - limits.reach_lower[a]);
  }
  std::vector<Vec3> places;
  for (const double x : {0.0, -1.0, 1.0}) {
    for (const double y : {0.0, -1.0, 1.0}) {
      for (const double z : {0.0, -1.0, 1.0}) {
        const double aside = std::abs(x) + std::abs(y) + std::abs(z);
        if (aside > (count >= 27 ? 3.0 : count >= 7 ? 1.0 : 0.0)) continue;
        places.push_back(middle + way * Vec3{x, y, z});
      }
    }
  }
  return places;
}

std::optional<double> tuned_stiffness(const TuningNews& news, double margin) {
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < news.count; ++i) {
    if (says_something(news.results[i].end)) least = std::min(least, news.results[i].stable);
  }
  if (!std::isfinite(least) || !(least > 0.0)) return std::nullopt;
  return margin * least;
}

}  // namespace palpate
