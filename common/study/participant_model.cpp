#include "common/study/participant_model.h"

#include <algorithm>
#include <cmath>

#include "common/base/index.h"

namespace palpate {
namespace {

/// About `middle`, by a factor of `spread` for one standard deviation, two at most.
double varied(double middle, double spread, RandomStream& random) {
  return middle * std::exp(std::log(spread) * std::clamp(random.normal(), -2.0, 2.0));
}

}  // namespace

ParticipantTraits draw_traits(std::uint64_t seed, int number) {
  RandomStream random({seed, 11, static_cast<std::uint64_t>(number)});
  ParticipantTraits traits;
  traits.delay += 0.03 * std::clamp(random.normal(), -2.0, 2.0);
  traits.speed = varied(traits.speed, 1.3, random);
  traits.move_noise = varied(traits.move_noise, 1.25, random);
  traits.turn_noise = varied(traits.turn_noise, 1.23, random);
  traits.sight_noise = varied(traits.sight_noise, 1.2, random);
  traits.depth_noise = varied(traits.depth_noise, 1.3, random);
  traits.gain = varied(traits.gain, 1.2, random);
  traits.foresight = varied(traits.foresight, 1.2, random);
  return traits;
}

const std::vector<DataColumn>& trait_columns() {
  static const std::vector<DataColumn> kColumns{
      {"delay", "of a simulated participant: from seeing to moving", "s"},
      {"foresight", "likewise: time ahead at which the way is looked at", "s"},
      {"speed", "likewise: chosen speed", "m/s"},
      {"move_noise", "likewise: noise of the motion, as a part of its speed", ""},
      {"turn_noise", "likewise: noise of the direction", "rad"},
      {"sight_noise", "likewise: of the place that is seen, across the view", "m"},
      {"depth_noise", "likewise, along the view", "m"},
      {"gain", "likewise: with which a distance from the path is corrected", "1/s"}};
  return kColumns;
}

std::vector<double> values_of(const ParticipantTraits& t) {
  return {t.delay, t.foresight, t.speed, t.move_noise, t.turn_noise, t.sight_noise, t.depth_noise, t.gain};
}

ParticipantModel::ParticipantModel(const ParticipantTraits& traits, const Mat3& view_axes, bool flat,
                                   const Vec3& start, const RandomStream& random)
    : traits_(traits),
      axes_(view_axes),
      flat_(flat),
      random_(random),
      seen_(kMemory, start),
      aim_(start),
      speed_(0.0) {
  // Nobody is equally fast in all trials.
  constexpr double kTrialSpread = 1.15;
  speed_ = varied(traits.speed, kTrialSpread, random_);
  OperatorSettings settings{.reaction = 0.0, .lag = 0.0};
  settings.seed = static_cast<std::uint64_t>(random_.uniform() * 1e15);
  tremor_ = Operator(settings);
  tremor_.place(0.0, start);
}

Vec3 ParticipantModel::noise(Vec3& process, double deviation, double time_constant, int steps) {
  const double keep = std::exp(-kStep * steps / time_constant);
  const double fresh = std::sqrt(1.0 - keep * keep);
  process = keep * process + fresh * Vec3{random_.normal(), random_.normal(), random_.normal()};
  return deviation * process;
}

Vec3 ParticipantModel::aim(const StudyTrial& trial, const Vec3& x) {
  constexpr double kYield = 1.0;       // [s] T of (2)
  constexpr double kSightTime = 0.40;  // [s] over which noises change
  constexpr double kMoveTime = 0.15;
  constexpr double kPress = 0.10;  // [s] more until the key is down
  seen_[as_size(step_ % kMemory)] = x;
  const auto back = std::min<std::int64_t>(step_, std::llround(traits_.delay / kStep));
  if (step_ % kLook == 0) {
    const Vec3 error = noise(sight_, 1.0, kSightTime, kLook);
    const double depth = flat_ ? 0.0 : traits_.depth_noise;
    const Vec3 off = axes_ * (Vec3{traits_.sight_noise, traits_.sight_noise, depth} * error);
    cue_ = trial.cue(seen_[as_size((step_ - back) % kMemory)] + off, speed_ * traits_.foresight);
    const Vec3 turn = noise(turn_, traits_.turn_noise, kSightTime, kLook);
    if (cue_.along != Vec3{0.0})
      cue_.along = glm::normalize(cue_.along + axes_ * (flat_ ? Vec3{turn.x, turn.y, 0.0} : turn));
  }
  Vec3 move = noise(move_, traits_.move_noise, kMoveTime, 1);
  if (flat_) move.z = 0.0;
  const double going = cue_.arrived ? 0.0 : std::min(speed_, traits_.gain * cue_.left);
  aim_ += kStep * (going * (cue_.along + axes_ * move) + traits_.gain * cue_.off + (x - aim_) / kYield);
  ++step_;
  time_ = kStep * static_cast<double>(step_);
  if (cue_.arrived && arrived_ < 0.0) arrived_ = time_;
  done_ = arrived_ >= 0.0 && time_ >= arrived_ + kPress;
  if (!cue_.marks) marked_ = -1.0;
  if (cue_.marks && marked_ < 0.0) marked_ = time_;
  marks_ = marked_ >= 0.0 && time_ >= marked_ + kPress;
  return tremor_.follow(time_, aim_);
}

}  // namespace palpate
