/// Long runs of links in simulated time while everything goes wrong, all of it drawn from one seed.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "common/device/driver_link.h"
#include "tests/common/device/driver/round_with.h"

namespace palpate::test {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
inline constexpr bool kSanitized = __has_feature(address_sanitizer);
#else
inline constexpr bool kSanitized = false;
#endif

/// How long: PALPATE_SOAK_SECONDS [s of simulated time] where that is set, else `usual`, and half of it under
/// sanitizers, which take ten times as long and look at each access, not at each hour.
inline double soak_seconds(double usual) {
  const char* const asked = std::getenv("PALPATE_SOAK_SECONDS");  // NOLINT(concurrency-mt-unsafe): read only
  const double whole = kSanitized ? 0.5 * usual : usual;
  return asked != nullptr ? std::atof(asked) : whole;  // NOLINT(cert-err34-c)
}

constexpr double kTwoHours = 7200.0;  ///< [s]

class Soak {
 public:
  explicit Soak(std::uint64_t seed) : random_(seed) {}

  double part() { return unit_(random_); }  ///< in [0, 1)
  bool chance(double probability) { return part() < probability; }
  std::uint64_t below(std::uint64_t count) { return random_() % count; }
  std::uint64_t seed() { return random_(); }  ///< of something else
  /// In a cube about the origin, to either side up to half of `side`.
  Vec3 within(double side) { return side * Vec3{part() - 0.5, part() - 0.5, part() - 0.5}; }
  /// In half of the episodes (see begin()) a rate up to `most`, mostly small, or none; else none.
  double rate(double most) { return bad_ && chance(0.4) ? most * part() * part() : 0.0; }
  /// Another episode, in which rate() gives something or nothing.
  void begin() { bad_ = chance(0.5); }
  /// What a servo may ask for: now and then nothing, now and then no number, else up to `most` an axis [N].
  Vec3 force(double most) {
    if (chance(0.1)) return Vec3{std::numeric_limits<double>::quiet_NaN()};
    return chance(0.2) ? Vec3{0.0} : within(2.0 * most);
  }

  /// Works a link for up to `longest` [s of `now()`]: no round takes long, no position is no number, and
  /// `connections()` is never above one. @return rounds that brought something.
  template <class Now, class Connections>
  std::uint64_t work(DriverLink& link, const Now& now, double longest, const Vec3& force,
                     const Connections& connections) {
    std::uint64_t fresh = 0;
    for (const double until = now() + longest * part(); now() < until;) {
      const double began = now();
      fresh += round_with(link, force) ? 1U : 0U;
      EXPECT_LT(now() - began, DriverLink::kLongestRound);
      EXPECT_TRUE(is_finite(link.atoms().position));
      EXPECT_LE(connections(), 1);
      if (::testing::Test::HasFailure()) break;
    }
    return fresh;
  }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> unit_;
  bool bad_ = false;
};

}  // namespace palpate::test
