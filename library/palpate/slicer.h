/// To 3D Slicer, while it happens: places, touch and lines as messages of OpenIGTLink, which Slicer's module
/// OpenIGTLinkIF connects to as a client.
///
/// Slicer takes coordinates for RAS+ millimetres. Tracts are in them; of other data SlicerOptions::scale says how many
/// millimetres a length is, and their axes are taken as they are.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <palpate/palpate.h>
#include <palpate/servo.h>
#include <palpate/tensors.h>

namespace palpate::api {

struct SlicerOptions {
  int port = 18944;         ///< of this machine; 0: one that is free
  bool everywhere = false;  ///< other machines may connect, too: whoever can reach the port sees the data
  double scale = 1.0;       ///< millimetres by length of the data
  double newton = 10.0;     ///< millimetres of the line that shows a force of a newton
};

/// A place with a name.
struct Mark {
  std::string name;
  Point position{};
  std::array<std::uint8_t, 4> color{255, 255, 0, 255};  ///< red, green, blue, opacity
};

/// Sends to whoever is connected; what nobody takes is not kept. Used by one thread.
class PALPATE_API Slicer {
 public:
  /// Listens. @throws Error (work failed) where the port is taken.
  explicit Slicer(const SlicerOptions& options = {});
  ~Slicer();
  Slicer(Slicer&&) noexcept;
  Slicer& operator=(Slicer&&) noexcept;

  [[nodiscard]] int port() const noexcept;
  /// Takes who has come since; who does not read for a second is let go.
  int clients();

  /// TRANSFORM: a place without a turn. Names have 20 bytes at most in all messages. @throws Error (usage) for longer ones.
  void send_place(const std::string& name, const Point& x);
  /// POINT. Names of marks have 63 bytes at most.
  void send_marks(const std::string& name, const std::vector<Mark>& marks);
  /// POLYDATA with the error of each point.
  void send_lines(const std::string& name, const Lines& lines);
  void send_lines(const std::string& name, const Tracts& tracts);
  /// TRANSFORM "Probe" and "Proxy", and "Force", a line from the proxy (POLYDATA), with `name` before each.
  void send_touch(const std::string& name, const ServoNow& now);
  /// STATUS: 1 is well, others as the protocol lists them.
  void send_status(const std::string& name, int code, const std::string& words);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate::api
