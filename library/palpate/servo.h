/// The servo: a chain on a device, stepped a thousand times a second by a thread of its own, in which nothing of its
/// user's runs. What the user reads are copies; who reads seldom loses steps, and is told how many.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <palpate/touch.h>

namespace palpate::api {

struct ArmOptions {
  std::string profile = {};      ///< "premium3", …; empty: the first of those that an error names
  std::string hand = "relaxed";  ///< or "firm"
};

/// What a hand is on. Cheap to copy; each servo makes one of its own from it.
class PALPATE_API Device {
 public:
  /// Shows no force; the hand goes where Servo::lead() says, as with a mouse.
  [[nodiscard]] static Device led();
  /// Shows no force; the hand moves along a path, data lengths, at its own pace.
  /// @param times of the points [s], rising; empty: a millisecond apart. @throws Error (usage) for another number of them.
  [[nodiscard]] static Device path(std::span<const Point> points, std::span<const double> times = {});
  /// A simulated arm in a simulated hand that follows Servo::lead().
  [[nodiscard]] static Device simulated(const ArmOptions& arm = {});
  /// The same, in a hand that follows a path.
  [[nodiscard]] static Device simulated(std::span<const Point> points, std::span<const double> times = {},
                                        const ArmOptions& arm = {});

 private:
  friend class Servo;
  std::shared_ptr<const struct DeviceData> data_;
};

/// The last step, and how the thread fares.
struct ServoNow {
  double time = 0.0;  ///< [s] of a steady clock
  bool present = false;
  Point probe{}, proxy{};  ///< of the last link; data lengths
  Point force{};           ///< [N] on the hand
  std::uint8_t state = 0;  ///< of state_names()
  bool armed = true;
  bool real_time = false;  ///< the thread has the priority that it asked for
  std::uint64_t steps = 0;
  std::uint64_t late = 0;     ///< begun more than half a period after their time
  std::uint64_t skipped = 0;  ///< whose time had passed
  std::uint64_t dropped = 0;  ///< that nobody took in time
};

class PALPATE_API Servo {
 public:
  /// Starts. @param rate [Hz], 100 to 10000. @throws Error (usage).
  Servo(const Device& device, const Chain& chain, double rate = 1000.0);
  /// Ends the thread; the device is told a zero force.
  ~Servo();
  Servo(Servo&&) noexcept;
  Servo& operator=(Servo&&) noexcept;

  // Called by one thread.

  /// Where the hand is to be, data lengths: the first call takes hold. @throws Error (usage) where the device has a path.
  void lead(const Point& x);
  void let_go();
  /// Another chain from the next step on; the force grows from zero. @throws Error (usage) for one of another scale or of
  /// other limits of the force.
  void set_chain(const Chain& chain);
  void arm() noexcept;        ///< force again, from zero
  void force_off() noexcept;  ///< none until arm()
  [[nodiscard]] ServoNow now();
  /// The steps since the last call, oldest first: 4 s of them are kept.
  [[nodiscard]] Touch steps();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate::api
