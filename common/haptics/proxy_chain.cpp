#include "common/haptics/proxy_chain.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "common/base/check.h"
#include "common/base/index.h"

namespace palpate {
namespace {

/// @param velocity of a link's probe  @param held_back what of it the proxy does not do  @param b [N s/m]
Vec3 coupling_damper(const Vec3& velocity, const Vec3& held_back, double b) noexcept {
  return b > 0.0 && glm::dot(velocity, held_back) > 0.0 ? -b * held_back : Vec3{0.0};
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
  ChainForce springs(form_);
  Vec3 damper = -settings_.viscosity * velocity, pulled = probe, pulled_velocity = velocity;
  for (const auto& link : links_) {
    LinkUpdate update;
    link->update(pulled, budget_, update);
    const Vec3 passed_on = update.jacobian * pulled_velocity;
    springs.add(update, update.proxy - pulled, settings_.stiffness,
                coupling_damper(pulled_velocity, pulled_velocity - passed_on, settings_.damping));
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
  result.force = springs.force() + damper;
  result.active = springs.active();
  return result;
}

}  // namespace palpate
