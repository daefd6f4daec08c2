/// The simplest constraint that holds: the proxy is the point of a sphere nearest to the probe, as long as
/// that is nearer than the release distance.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/haptics/proxy_chain.h"

namespace palpate::test {

class SphereDrag final : public Constraint {
 public:
  explicit SphereDrag(double radius) : radius_(radius) {}

  void apply(const ChainSettings& settings) noexcept override {
    release_ = settings.streamline.release_distance;
  }
  void reset() noexcept override { held_ = false; }
  void update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept override {
    const double length = glm::length(probe);
    const Vec3 nearest = length > 0.0 ? probe * (radius_ / length) : Vec3{radius_, 0.0, 0.0};
    const bool holds = glm::distance(probe, nearest) < release_;
    link.jumped = held_ && !holds;
    held_ = holds;
    link.proxy = holds ? nearest : probe;
    link.state = holds ? HoldState::kHeld : (link.jumped ? HoldState::kReleased : HoldState::kFree);
  }

 private:
  double radius_;
  double release_ = 0.0;
  bool held_ = false;
};

inline std::unique_ptr<ProxyChain> sphere_chain(double radius, const ChainSettings& settings = {}) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<SphereDrag>(radius));
  return std::make_unique<ProxyChain>(std::move(links), settings);
}

}  // namespace palpate::test
