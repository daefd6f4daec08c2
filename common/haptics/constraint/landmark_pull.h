/// Landmarks that pull: magnets, which catch a hand that comes near, and gravity wells, which lead it there from afar.
///
///   f = sum_m F_m h(|m - x| / w_m) (m - x) / |m - x|
///   magnet   h(u) = (25 sqrt(5) / 16) u (1 - u^2)^2      steep near m, and gone before its border
///   well     h(u) = (3 sqrt(3) / 2) u (1 - u^2)           wide                                 for u < 1, else 0
///
/// Each h has 1 as its largest value, is zero at the landmark and from the reach w on: the pull is that of a
/// potential, has no leap, and gives no energy on a closed way. The proxy is the probe.
#pragma once

#include <cstdint>
#include <vector>

#include "common/haptics/constraint.h"

namespace palpate {

struct Landmark {
  enum class Pull : std::uint8_t { kMagnet, kWell };

  Vec3 at{0.0};  ///< m [m]
  Pull pull = Pull::kMagnet;
  double reach = 0.0;  ///< w [m], > 0
  double force = 0.0;  ///< F [N], at most; negative: it pushes away

  bool operator==(const Landmark&) const = default;
};

class LandmarkPull final : public Constraint {
 public:
  static constexpr std::size_t kMost = 128;

  /// @param landmarks finite, kMost at most.  @throws std::length_error for more.
  explicit LandmarkPull(std::vector<Landmark> landmarks);

  void apply(const ChainSettings& /*settings*/) noexcept override {}
  void reset() noexcept override {}
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

 private:
  std::vector<Landmark> landmarks_;
};

}  // namespace palpate
