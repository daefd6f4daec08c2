/// Links whose proxies are known in closed form, for tests of what chains make of them.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/haptics/proxy_chain.h"

namespace palpate::test {

/// Holds the proxy on the line through the origin along `t`, of unit length.
class StraightLine final : public Constraint {
 public:
  explicit StraightLine(const Vec3& t, double kappa = 1.0) : t_(t), kappa_(kappa) {}
  void apply(const ChainSettings&) noexcept override {}
  void reset() noexcept override {}
  void update(const Vec3& probe, const UpdateBudget&, LinkUpdate& link) noexcept override {
    link.proxy = glm::dot(probe, t_) * t_;
    link.jacobian = glm::outerProduct(t_, t_);
    link.kappa = Vec3{kappa_};
    link.state = HoldState::kHeld;
  }

 private:
  Vec3 t_;
  double kappa_;
};

/// Holds the proxy on the plane through the origin with the unit normal `n`.
class FlatPlane final : public Constraint {
 public:
  explicit FlatPlane(const Vec3& n, double kappa = 1.0) : n_(n), kappa_(kappa) {}
  void apply(const ChainSettings&) noexcept override {}
  void reset() noexcept override {}
  void update(const Vec3& probe, const UpdateBudget&, LinkUpdate& link) noexcept override {
    link.proxy = probe - glm::dot(probe, n_) * n_;
    link.jacobian = Mat3{1.0} - glm::outerProduct(n_, n_);
    link.kappa = Vec3{kappa_};
    link.state = HoldState::kHeld;
  }

 private:
  Vec3 n_;
  double kappa_;
};

[[nodiscard]] inline ProxyChain chain_of(std::vector<std::unique_ptr<Constraint>> links, ChainForceForm form,
                                         const ChainSettings& settings = {}) {
  ProxyChain chain(std::move(links), settings);
  chain.set_force_form(form);
  return chain;
}

}  // namespace palpate::test
