#include "common/haptics/proxy_chain.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "common/base/check.h"

namespace palpate {

std::string_view name_of(HoldState state) noexcept {
  constexpr std::array<std::string_view, 6> kNames{"free",     "held",    "fell_back",
                                                   "released", "outside", "fault"};
  return kNames[static_cast<std::size_t>(state)];
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

void ProxyChain::reset() noexcept {
  for (const auto& link : links_) link->reset();
}

ChainStep ProxyChain::step(const Vec3& probe, const Vec3& velocity) noexcept {
  ChainStep result;
  ChainForce springs(form_);
  Vec3 damper{0.0}, pulled = probe;
  for (const auto& link : links_) {
    LinkUpdate update;
    link->update(pulled, budget_, update);
    springs.add(update, update.proxy - pulled, settings_.stiffness);
    if (update.damping != Vec3{0.0}) damper -= update.frame * (update.damping * (velocity * update.frame));
    result.proxies[static_cast<std::size_t>(result.links++)] = update.proxy;
    result.state = std::max(result.state, update.state);
    result.residual = update.residual;
    result.jumped = result.jumped || update.jumped;
    result.iterations += update.iterations;
    result.cells += update.cells;
    pulled = update.proxy;
  }
  result.force = springs.force() + damper;
  return result;
}

}  // namespace palpate
