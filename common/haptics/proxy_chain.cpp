#include "common/haptics/proxy_chain.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/haptics/perceived_stiffness.h"

namespace palpate {
namespace {

/// @param velocity of a link's probe  @param held_back what of it the proxy does not do  @param b [N s/m]
Vec3 coupling_damper(const Vec3& velocity, const Vec3& held_back, double b) noexcept {
  return b > 0.0 && glm::dot(velocity, held_back) > 0.0 ? -b * held_back : Vec3{0.0};
}

/// What a link pulls by in one step.
struct Pull {
  LinkUpdate link;
  Vec3 stretched{0.0}, damper{0.0};  ///< [m], [N]
  double factor = 1.0;               ///< c of the spring
};
/// What each link puts on the hand [N].
using Shares = std::array<Vec3, ChainStep::kMaxLinks>;

ChainForce added_up(std::span<const Pull> pulls, ChainForceForm form, double stiffness,
                    Shares& shares) noexcept {
  ChainForce springs(form);
  for (std::size_t i = 0; i < pulls.size(); ++i) {
    const Vec3 before = springs.force();
    springs.add(pulls[i].link, pulls[i].stretched, pulls[i].factor * stiffness, pulls[i].damper);
    shares[i] = springs.force() - before;
  }
  return springs;
}

/// The part of the other links' force that is across `share` [N].
double across(const Vec3& share, const Vec3& all) noexcept {
  const Vec3 rest = all - share;
  const double square = glm::dot(share, share);
  return glm::length(square > 0.0 ? rest - (glm::dot(rest, share) / square) * share : rest);
}

/// The least of what the springs that pull feel like [N/m]; 0: none does.
double softest(std::span<const Pull> pulls, const Shares& shares, const Vec3& all) noexcept {
  double least = 0.0;
  for (std::size_t i = 0; i < pulls.size(); ++i) {
    const double along = glm::length(shares[i]), stretch = glm::length(pulls[i].stretched);
    constexpr double kPulls = 1e-9;  // [m]
    if (!(along > 0.0 && stretch > kPulls)) continue;
    const double perceived = perceived_stiffness(along / stretch, along, across(shares[i], all));
    if (least == 0.0 || perceived < least) least = perceived;
  }
  return least;
}

}  // namespace

std::string_view name_of(HoldState state) noexcept {
  constexpr std::array<std::string_view, 6> kNames{"free",     "held",    "fell_back",
                                                   "released", "outside", "fault"};
  return kNames[as_size(state)];
}

ProxyChain::ProxyChain(std::vector<std::unique_ptr<Constraint>> links, const ChainSettings& settings)
    : links_(std::move(links)), settings_(settings) {
  PALPATE_CHECK(size() <= ChainStep::kMaxLinks);
  apply(settings);
}

void ProxyChain::apply(const ChainSettings& settings) noexcept {
  settings_ = settings;
  for (const auto& link : links_) link->apply(settings);
}

void ProxyChain::surround(std::vector<std::unique_ptr<Constraint>> before,
                          std::vector<std::unique_ptr<Constraint>> after) {
  for (auto& link : links_) before.push_back(std::move(link));
  for (auto& link : after) before.push_back(std::move(link));
  links_ = std::move(before);
  PALPATE_CHECK(size() <= ChainStep::kMaxLinks);
  apply(settings_);
}

void ProxyChain::advance(double seconds) noexcept {
  for (const auto& link : links_) link->advance(seconds);
}

void ProxyChain::reset() noexcept {
  for (const auto& link : links_) link->reset();
}

void ProxyChain::press(std::uint32_t buttons) noexcept {
  for (const auto& link : links_) link->press(buttons);
}

ChainStep ProxyChain::step(const Vec3& probe, const Vec3& velocity) noexcept {
  ChainStep result;
  std::array<Pull, ChainStep::kMaxLinks> pulls;
  Vec3 damper = -settings_.viscosity * velocity, pulled = probe, pulled_velocity = velocity;
  for (const auto& link : links_) {
    LinkUpdate update;
    link->update(pulled, budget_, update);
    const Vec3 passed_on = update.jacobian * pulled_velocity;
    pulls[as_size(result.links)] = {
        .link = update,
        .stretched = update.proxy - pulled,
        .damper = coupling_damper(pulled_velocity, pulled_velocity - passed_on, settings_.damping)};
    pulled_velocity = passed_on;
    if (update.damping != Vec3{0.0}) damper -= update.frame * (update.damping * (velocity * update.frame));
    result.proxies[as_size(result.links++)] = update.proxy;
    result.state = std::max(result.state, update.state);
    result.residual = update.residual;
    result.jumped = result.jumped || update.jumped;
    result.at_end = result.at_end || update.at_end;
    result.crossed = result.crossed || update.crossed;
    result.iterations += update.iterations;
    result.cells += update.cells;
    pulled = update.proxy;
  }
  const auto linked = std::span(pulls).first(as_size(result.links));
  Shares shares;
  ChainForce springs = added_up(linked, form_, settings_.stiffness, shares);
  if (settings_.even_stiffness > settings_.stiffness && settings_.stiffness > 0.0 && result.links > 1) {
    // What one makes up for presses across the others: a few rounds settle it to some per cent.
    constexpr int kRounds = 4;
    const double most = settings_.even_stiffness / settings_.stiffness;
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t i = 0; i < linked.size(); ++i)
        pulls[i].factor = stiffness_compensation(glm::length(shares[i]) / pulls[i].factor,
                                                 across(shares[i], springs.force()), most);
      springs = added_up(linked, form_, settings_.stiffness, shares);
    }
  }
  result.perceived_stiffness = softest(linked, shares, springs.force());
  result.force = springs.force() + damper;
  result.active = springs.active();
  return result;
}

}  // namespace palpate
