/// Touch: what a hand feels that moves along a path. Constraints hold it, one after the other (Ikits 2006, sec. 6.7), as
/// `probe` of the programs computes it.
///
/// Paths and proxies are in the data's lengths; forces in newtons, times in seconds. The hand works in metres: a chain
/// lays the data over its workspace (ChainOptions::scale).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <palpate/palpate.h>

namespace palpate::api {

/// One constraint of a chain: what its proxy is held to. Cheap to copy; what it works on is shared.
class PALPATE_API Link {
 public:
  /// The streamline through the place where it was caught; stretched too far it is let go, and another one catches.
  [[nodiscard]] static Link streamline(const Field& field);
  /// Surfaces of equal value, at most eight. How they hold is a setting: "isosurface.hold", "isosurface.depth".
  [[nodiscard]] static Link isosurface(const Scalar& field, const std::vector<double>& values);
  /// A wall: free where (x - point) . outward > 0. @param outward not zero.
  [[nodiscard]] static Link plane(const Point& point, const Point& outward);
  /// Carried along by the flow: the force is `force_field.strength` [N] where it is fastest.
  [[nodiscard]] static Link flow(const Field& field);
  /// Pushed down a potential: the force is its negative gradient by metres of the hand. @param joules the potential [J].
  [[nodiscard]] static Link potential(const Scalar& joules);
  /// The same drag in all directions.
  [[nodiscard]] static Link drag();

 private:
  friend struct TouchAccess;
  std::shared_ptr<const struct LinkData> data_;
};

struct ChainOptions {
  double scale = 0.0;  ///< metres of the hand by length of the data; 0: the data's diagonal becomes 0.25 m
  /// By the names in chain_settings(), in SI units: {"stiffness", "400"}, {"isosurface.hold", "layer"}.
  std::vector<std::pair<std::string, std::string>> settings;
  double force_cap = 4.0;   ///< [N] largest force
  double slew_cap = 200.0;  ///< [N/s] fastest growth and turn of the force
};

/// The settings of a chain by name, with their values as `options` has them.
/// @throws Error (usage) for a name or value that there is not.
[[nodiscard]] PALPATE_API std::vector<std::pair<std::string, std::string>> chain_settings(
    const ChainOptions& options = {});

/// Why a chain does what it does, by the number in Touch::state(): "free", "held", …
[[nodiscard]] PALPATE_API const std::vector<std::string>& state_names();

/// What was felt along a path, by its points.
class PALPATE_API Touch {
 public:
  [[nodiscard]] std::size_t count() const noexcept;
  [[nodiscard]] std::size_t links() const noexcept;
  [[nodiscard]] std::span<const double> times() const noexcept;  ///< [s] of the steps
  [[nodiscard]] std::span<const Point> probes() const noexcept;  ///< where the hand was, data lengths
  /// The proxy of each link after the other at each point: links() of them a point. That of the last one is where the
  /// hand is shown to be.
  [[nodiscard]] std::span<const Point> proxies() const noexcept;
  [[nodiscard]] std::span<const Point> force() const noexcept;  ///< [N] on the hand, after the caps
  /// Of the last proxy from its own feature, data lengths.
  [[nodiscard]] std::span<const double> residual() const noexcept;
  [[nodiscard]] std::span<const std::uint8_t> state() const noexcept;  ///< of state_names()

 private:
  friend struct TouchAccess;
  std::shared_ptr<const struct TouchData> data_;
};

/// Constraints in a row: the proxy of each is the probe of the next. Cheap to copy.
class PALPATE_API Chain {
 public:
  /// @param links one to four. @throws Error (usage).
  explicit Chain(const std::vector<Link>& links, const ChainOptions& options = {});

  [[nodiscard]] double scale() const noexcept;  ///< metres of the hand by length of the data
  /// A hand that is where the path says, without a device: one step a point, from a fresh start. The same steps as those
  /// of `probe --path`.
  /// @param times of the points [s], rising; empty: a millisecond apart.
  /// @throws Error (usage) for another number of times than of points; (interrupted).
  [[nodiscard]] Touch run(std::span<const Point> path, std::span<const double> times = {},
                          const Watcher& watch = {}) const;

 private:
  friend struct TouchAccess;
  std::shared_ptr<const struct ChainData> data_;
};

}  // namespace palpate::api
