/// The border between the programs and driver modules: what a module gives, opened by its name.
///
/// A driver is a link to one device, worked in rounds by whoever has it: a thread of its own for the servo
/// (linked_device.h), a loop that shows its read-outs, a test in simulated time. It finds the device, prepares
/// it and, plugged out and in again, starts over by itself, without force.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "common/device/atoms.h"
#include "common/device/device_limits.h"
#include "common/math/quaternion.h"

namespace palpate {

enum class LinkPhase : std::uint8_t {
  kAbsent,         ///< not plugged in
  kRefused,        ///< there, but it cannot be opened
  kNeedsFirmware,  ///< waits for a file that the user has
  kLoading,        ///< takes its firmware
  kNeedsHoming,    ///< waits for the user to move it to its ends
  kReady           ///< samples come
};
[[nodiscard]] constexpr std::string_view name_of(LinkPhase phase) noexcept {
  switch (phase) {
    case LinkPhase::kAbsent:
      return "absent";
    case LinkPhase::kRefused:
      return "refused";
    case LinkPhase::kNeedsFirmware:
      return "needs_firmware";
    case LinkPhase::kLoading:
      return "loading";
    case LinkPhase::kNeedsHoming:
      return "needs_homing";
    case LinkPhase::kReady:
      return "ready";
  }
  return "";
}

struct LinkStatus {
  LinkPhase phase = LinkPhase::kAbsent;
  std::uint64_t rounds = 0;       ///< exchanges that were answered
  std::uint64_t lost = 0;         ///< that were not, in time
  std::uint64_t implausible = 0;  ///< answers that no hand could have made
  std::uint64_t dropped = 0;      ///< bytes that were of no answer
  std::uint64_t faults = 0;       ///< times that the device was given up, or lost its zero
  std::uint64_t opened = 0;       ///< times that it was found and opened
  std::uint64_t uploads = 0;      ///< tries to load the firmware
};

/// What force a link is to show.
class ForceSource {
 public:
  ForceSource() = default;
  ForceSource(const ForceSource&) = delete;
  ForceSource& operator=(const ForceSource&) = delete;
  virtual ~ForceSource() = default;

  /// The newest one that is asked for [N, frame D]. The one thread of a link that tells its device. @rt Safe.
  virtual Vec3 newest() noexcept = 0;
};

class DriverLink {
 public:
  DriverLink() = default;
  DriverLink(const DriverLink&) = delete;
  DriverLink& operator=(const DriverLink&) = delete;
  /// Leaves the device without force.
  virtual ~DriverLink() = default;

  /// Where the forces come from that the device is to show, from now on; null: there are none. Returns once the
  /// source before it is no longer asked.
  void obey(ForceSource* source) noexcept {
    source_.store(source);
    while (asking_.load()) std::this_thread::yield();
  }
  /// Does what is next, for some milliseconds with a device that is ready, for less than kLongestRound else.
  /// The source is asked at the moment at which the device is told, so that no force waits for a round. The
  /// device shows it if it is ready, the force is finite and every answer made sense, else none.
  /// @return whether atoms() or poses() are new. One thread.
  virtual bool round() noexcept = 0;
  [[nodiscard]] virtual const DeviceAtoms& atoms() const noexcept = 0;
  /// Of a tracker: all stations that it could have, those that it does not see as not valid. Null: it is
  /// none.
  [[nodiscard]] virtual const PoseAtoms* poses() const noexcept { return nullptr; }
  /// How the frame of poses() lies in frame D, by which the position of a tracker's station is one in D.
  [[nodiscard]] virtual Rigid device_from_poses() const noexcept { return {}; }
  [[nodiscard]] virtual const LinkStatus& status() const noexcept = 0;
  /// What the user should know or do now, one sentence; empty where there is nothing to say.
  [[nodiscard]] virtual std::string advice() const = 0;
  [[nodiscard]] virtual const DeviceLimits& limits() const noexcept = 0;
  /// From now on no force that the device is told is larger than the cap of `asked` or of limits(), or grows
  /// or turns faster than their slew limits, whatever is asked for. Before the first round.
  virtual void restrain(const DeviceLimits& asked) noexcept { (void)asked; }
  /// Bus and place, "usb 1-2.3", or empty while there is none.
  [[nodiscard]] virtual std::string place() const = 0;

  static constexpr double kLongestRound = 0.8;  ///< [s] a program that is told to end waits for it

 protected:
  /// What the source asks for now. @rt Safe.
  [[nodiscard]] Vec3 ordered() noexcept {
    asking_.store(true);
    ForceSource* const source = source_.load();
    const Vec3 force = source != nullptr ? source->newest() : Vec3{0.0};
    asking_.store(false);
    return force;
  }

 private:
  std::atomic<ForceSource*> source_{nullptr};
  std::atomic<bool> asking_{false};
};

/// What a driver is told: `falcon:firmware=FILE,gain=3500` as names and values.
using DriverOptions = std::vector<std::pair<std::string, std::string>>;

/// Something that a driver found on its bus.
struct FoundDevice {
  std::string name;    ///< "Novint Falcon"
  std::string id;      ///< "0403:cb48"
  std::string place;   ///< "usb 1-2.3"
  std::string access;  ///< "ok", or why it cannot be opened: "denied", "gone"
  std::string driver;  ///< for `--device`; empty where there is none
  std::string note;    ///< what the user should do; may be empty
};

/// The face of a module. Nothing is thrown across the border: what went wrong is in `error`, one line.
class DriverModule {
 public:
  DriverModule() = default;
  DriverModule(const DriverModule&) = delete;
  DriverModule& operator=(const DriverModule&) = delete;
  virtual ~DriverModule() = default;

  /// Of the options it knows: "firmware=FILE  …", a line each, for help.
  [[nodiscard]] virtual std::string help() const = 0;
  /// Null, with `error`, for options that make no sense or a bus that cannot be used.
  [[nodiscard]] virtual std::unique_ptr<DriverLink> make_link(const DriverOptions& options,
                                                              std::string& error) noexcept = 0;
  /// All devices of any kind that this bus has and some driver knows.
  [[nodiscard]] virtual std::vector<FoundDevice> find(std::string& error) noexcept = 0;
};

/// What a module exports by the name kDriverEntry: the build that it is of, and its face.
struct DriverEntry {
  const char* build = nullptr;  ///< must be driver_build() of the program that opens it
  /// Lives as long as the program. Null, with `error`, where the bus cannot be used.
  DriverModule* (*module)(std::string& error) noexcept = nullptr;
};
inline constexpr const char* kDriverEntry = "palpate_driver_entry";

/// Compiler, and a checksum of the headers that make the border: what a program and its modules must share.
[[nodiscard]] const char* driver_build() noexcept;

/// The button of some device that has to be held while there is force.
struct EnablingSwitch {
  int button = DeviceLimits::kNoButton;  ///< of the device, or of the one of `link`; kNoButton: none needed
  std::shared_ptr<DriverLink> link;      ///< of the device that has the button; null: the device itself

  /// The bit of a sample that says whether the button of another device is held: see linked_device.h.
  static constexpr int kOtherBit = DeviceLimits::kButtons - 1;

  /// The button of the samples that the safety stage looks at.
  [[nodiscard]] int sample_button() const noexcept { return link ? kOtherBit : button; }
};

}  // namespace palpate
