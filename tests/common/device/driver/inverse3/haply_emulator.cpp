#include "tests/common/device/driver/inverse3/haply_emulator.h"

#include <cstdio>
#include <cstdlib>

namespace palpate::test {
namespace {

std::string digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// The number after `name` in `text`, from `at` on.
bool number_after(const std::string& text, const std::string& name, std::size_t& at, double& value) {
  const std::size_t found = text.find("\"" + name + "\":", at);
  if (found == std::string::npos) return false;
  const char* const begin = text.c_str() + found + name.size() + 3;
  char* end = nullptr;
  value = std::strtod(begin, &end);
  at = found;
  return end != begin;
}

}  // namespace

void HaplyEmulator::advance(double now) {
  if (heard_ >= 0.0 && now - heard_ > kIdleAfter) {
    arm.advance(heard_ + kIdleAfter);
    arm.push(Vec3{0.0});
  }
  arm.advance(now);
}

void HaplyEmulator::left(double now) {
  advance(now);
  arm.push(Vec3{0.0});
  heard_ = -1.0;
}

std::string HaplyEmulator::version_page() const {
  return R"({"build_time":"2024-08-07T16:05:12.345Z","version":")" + version + "\"}";
}

std::string HaplyEmulator::snapshot(double now) {
  advance(now);
  return state(true);
}

std::string HaplyEmulator::take(double now, const std::string& message) {
  advance(now);
  ++commands;
  const int minor = std::atoi(version.c_str() + version.find('.') + 1);
  const std::string key = minor >= 5 ? "\"vector\":{" : "\"values\":{";
  std::size_t at = message.find("\"device_id\":\"" + device + "\"");
  if (at != std::string::npos) at = message.find("\"set_cursor_force\":{" + key, at);
  double x = 0.0, y = 0.0, z = 0.0;
  if (at != std::string::npos && number_after(message, "x", at, x) && number_after(message, "y", at, y) &&
      number_after(message, "z", at, z)) {
    ++understood;
    heard_ = now;
    // x right, y forward, z up.
    last = {x, z, -y};
    wire.told(now, last);
    arm.push(plugged ? last : Vec3{0.0});
  } else {
    strange = message;
  }
  return state(false);
}

std::string HaplyEmulator::state(bool all) const {
  std::string text = all ? R"({"session_id":7,"inverse3":[)" : R"({"inverse3":[)";
  if (plugged) {
    const Vec3 p = arm.position(), v = arm.velocity();
    text += R"({"device_id":")" + device + "\",";
    if (all) {
      text += R"("config":{"type":"inverse3","handedness":"right","device_info":{"id":")" + device +
              R"(","major_version":7},"mount":{"position":{"x":9,"y":9,"z":9}}},)";
    }
    if (all || tells_status) {
      const auto word = [](bool value) { return std::string(value ? "true" : "false"); };
      text += R"("status":{"calibrated":)" + word(calibrated) + R"(,"in_use":false,"power_supply":)" +
              word(powered) + R"(,"ready":true},)";
    }
    text += R"("state":{"cursor_velocity":{"x":)" + digits(v.x) + ",\"y\":" + digits(-v.z) +
            ",\"z\":" + digits(v.y) + R"(},"cursor_position":{"x":)" + digits(kMiddle.x + p.x) +
            ",\"y\":" + digits(kMiddle.y - p.z) + ",\"z\":" + digits(kMiddle.z + p.y) +
            R"(},"control_mode":"idle","angular_position":{"a0":1.0,"a1":2.0,"a2":3.0}}})";
  }
  text += "]";
  if (grip) {
    text +=
        R"(,"wireless_verse_grip":[{"device_id":"61576","state":{"orientation":{"w":1.0,"x":0.0,"y":0.0,"z":0.0},)"
        R"("buttons":{)";
    const char* const names[2][4] = {{"a", "b", "c", "d"}, {"button_0", "button_1", "button_2", "button_3"}};
    for (unsigned i = 0; i < (old_buttons ? 4U : 3U); ++i) {
      text += std::string(i == 0 ? "" : ",") + "\"" + names[old_buttons ? 1 : 0][i] +
              "\":" + ((buttons >> i) & 1U ? "true" : "false");
    }
    text += "}}}]";
  }
  return text + "}";
}

}  // namespace palpate::test
