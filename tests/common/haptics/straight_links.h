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

/// Holds the proxy on the plane n . x = offset, n of unit length.
class FlatPlane final : public Constraint {
 public:
  explicit FlatPlane(const Vec3& n, double kappa = 1.0, double offset = 0.0)
      : n_(n), kappa_(kappa), offset_(offset) {}
  void apply(const ChainSettings&) noexcept override {}
  void reset() noexcept override {}
  void update(const Vec3& probe, const UpdateBudget&, LinkUpdate& link) noexcept override {
    link.proxy = probe - (glm::dot(probe, n_) - offset_) * n_;
    link.jacobian = Mat3{1.0} - glm::outerProduct(n_, n_);
    link.kappa = Vec3{kappa_};
    link.state = HoldState::kHeld;
  }

 private:
  Vec3 n_;
  double kappa_, offset_;
};

/// Holds the proxy on the plane through the origin where the probe is behind it; free on the side of `n`.
class FlatWall final : public Constraint {
 public:
  explicit FlatWall(const Vec3& n) : n_(n) {}
  void apply(const ChainSettings&) noexcept override {}
  void reset() noexcept override {}
  void update(const Vec3& probe, const UpdateBudget&, LinkUpdate& link) noexcept override {
    const double height = glm::dot(probe, n_);
    link.proxy = height < 0.0 ? probe - height * n_ : probe;
    if (height < 0.0) link.jacobian = Mat3{1.0} - glm::outerProduct(n_, n_);
    link.state = height < 0.0 ? HoldState::kHeld : HoldState::kFree;
  }

 private:
  Vec3 n_;
};

[[nodiscard]] inline ProxyChain chain_of(std::vector<std::unique_ptr<Constraint>> links, ChainForceForm form,
                                         const ChainSettings& settings = {}) {
  ProxyChain chain(std::move(links), settings);
  chain.set_force_form(form);
  return chain;
}

}  // namespace palpate::test
