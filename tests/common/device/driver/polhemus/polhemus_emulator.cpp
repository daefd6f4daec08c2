#include "tests/common/device/driver/polhemus/polhemus_emulator.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>

namespace palpate::test {
namespace {

void add(std::vector<std::uint8_t>& out, const void* from, std::size_t bytes) {
  const auto* const at = static_cast<const std::uint8_t*>(from);
  out.insert(out.end(), at, at + bytes);
}
void add_float(std::vector<std::uint8_t>& out, double value) {
  const auto single = static_cast<float>(value);
  add(out, &single, sizeof single);
}
void add_number(std::vector<std::uint8_t>& out, std::uint32_t value) { add(out, &value, sizeof value); }

/// "1,0,0" as numbers.
std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) numbers.push_back(std::atof(part.c_str()));
  return numbers;
}

}  // namespace

Vec3 PolhemusEmulator::position(int station, double time) {
  const double phase = 0.7 * station;
  return {0.5 + 0.1 * std::sin(2.0 * time + phase), 0.15 * std::cos(1.3 * time + phase),
          -0.2 + 0.1 * std::sin(0.9 * time + 2.0 * phase)};
}

Quat PolhemusEmulator::orientation(int station, double time) {
  const double angle = 0.8 * time + station, lean = 0.3 * std::sin(0.5 * time);
  const Quat about_z{std::cos(angle / 2), 0.0, 0.0, std::sin(angle / 2)};
  const Quat about_x{std::cos(lean / 2), std::sin(lean / 2), 0.0, 0.0};
  return about_z * about_x;
}

TrackerPose PolhemusEmulator::distorted(const TrackerPose& actual) {
  // A plate below pulls places to it, and turns them, with the square of the distance.
  constexpr Vec3 kPlate{0.7, 0.3, 0.4};  // [m]
  constexpr double kPull = 0.010, kTurn = 0.025;
  const Vec3 away = actual.position - kPlate;
  const double r = std::sqrt(away.x * away.x + away.y * away.y + away.z * away.z);
  const Vec3 field = (1.0 / (r * r * r)) * away;
  return {actual.position - kPull * field,
          rotation_by(kTurn * Vec3{field.y, field.z, field.x}) * actual.orientation};
}

/// A magnetic field has the same strength and direction at opposite places: it says the one that is in the
/// hemisphere, rightly or not. In the units that it was told.
TrackerPose PolhemusEmulator::said_pose(double time, int station) const {
  const double when = frozen_ ? 0.0 : time;
  TrackerPose pose{position(station, when), orientation(station, when)};
  if (distorts_) pose = distorted(pose);
  const Vec3& p = pose.position;
  const double along = p.x * zenith_.x + p.y * zenith_.y + p.z * zenith_.z;
  const double sign = along < 0.0 ? -1.0 : 1.0;
  pose.position *= sign * (centimetres_ ? 100.0 : 1.0 / 0.0254);
  return pose;
}

void PolhemusEmulator::hear(double now, std::span<const std::uint8_t> bytes) {
  if (hangs_ || deaf_) return;
  for (const std::uint8_t byte : bytes) {
    const char c = static_cast<char>(byte);
    const std::string at_once = settings_.fastrak ? "cCPfFuU" : "Pp";
    if (half_.empty() && at_once.find(c) != std::string::npos) {
      obey(now, std::string(1, c));
    } else if (c == '\r') {
      obey(now, half_);
      half_.clear();
    } else {
      half_ += c;
    }
  }
}

void PolhemusEmulator::obey(double now, const std::string& line) {
  if (line.empty()) return;
  if (settings_.fastrak) {
    obey_fastrak(line);
  } else {
    obey_liberty(now, line);
  }
}

void PolhemusEmulator::obey_liberty(double now, const std::string& line) {
  const int command = std::toupper(static_cast<unsigned char>(line[0]));
  const std::string rest = line.substr(1);
  if (command == 'P' && rest.empty()) {
    if (!continuous_) say_records(now, 'P', answers_);
    continuous_ = false;
  } else if (command == 'C' && rest.empty()) {
    continuous_ = true;
    next_ = now;
  } else if (command == 'F' && (rest == "0" || rest == "1")) {
    binary_ = rest == "1";
  } else if (command == 'U' && (rest == "0" || rest == "1")) {
    centimetres_ = rest == "1";
  } else if (command == 'O' && rest.rfind("*,", 0) == 0) {
    order_ = rest.substr(2);
  } else if (command == 'H' && rest.rfind("*,", 0) == 0 && numbers_of(rest.substr(2)).size() == 3) {
    const std::vector<double> zenith = numbers_of(rest.substr(2));
    zenith_ = {zenith[0], zenith[1], zenith[2]};
  } else if (line ==
             "\x15"
             "0") {
    if (!binary_) return;
    add(answers_, settings_.tag.data(), 2);
    for (const int byte : {0, 21, int{' '}, 0, 4, 0}) answers_.push_back(static_cast<std::uint8_t>(byte));
    add(answers_, &settings_.detected, 2);
    add(answers_, &settings_.detected, 2);
  } else {
    ++bad_commands_;
    const std::string said = "LYx*?\r\n*INVALID COMMAND*\r\n";
    add(answers_, said.data(), said.size());
  }
}

void PolhemusEmulator::obey_fastrak(const std::string& line) {
  const std::string rest = line.substr(1);
  const bool of_station = rest.size() > 2 && rest[0] >= '1' && rest[0] <= '4' && rest[1] == ',';
  if (line == "c" || line == "C") {
    continuous_ = line == "C";
  } else if (line == "f" || line == "F") {
    binary_ = line == "f";
  } else if (line == "u" || line == "U") {
    centimetres_ = line == "u";
  } else if (line == "P") {
    say_fastrak(next_, 1, answers_);
  } else if (line[0] == 'O' && of_station) {
    order_ = rest.substr(2);
  } else if (line[0] == 'H' && of_station && numbers_of(rest.substr(2)).size() == 3) {
    const std::vector<double> zenith = numbers_of(rest.substr(2));
    zenith_ = {zenith[0], zenith[1], zenith[2]};
  } else if (line != "e1,0") {
    ++bad_commands_;
  }
}

void PolhemusEmulator::speak(double now, std::vector<std::uint8_t>& bytes) {
  std::vector<std::uint8_t> data;
  speak(now, bytes, data);
  add(bytes, data.data(), data.size());
}

void PolhemusEmulator::speak(double now, std::vector<std::uint8_t>& answers,
                             std::vector<std::uint8_t>& data) {
  if (hangs_) {
    next_ = now;
    return;
  }
  add(answers, answers_.data(), answers_.size());
  answers_.clear();
  if (!continuous_) {
    next_ = now;
    return;
  }
  constexpr double kKept = 0.1;  // [s] a tracker keeps no more for a host that does not listen
  next_ = std::max(next_, now - kKept);
  for (; next_ <= now; next_ += 1.0 / settings_.rate) {
    ++frame_;
    say_records(next_, 'C', data);
  }
}

void PolhemusEmulator::say_records(double time, char command, std::vector<std::uint8_t>& out) {
  const int stations = settings_.fastrak ? 4 : 16;
  const auto there = [this](int station) { return ((settings_.detected >> (station - 1)) & 1) != 0; };
  if (!settings_.fastrak) {
    for (int station = 1; station <= stations; ++station) {
      if (there(station)) say_liberty(time, command, station, out);
    }
    return;
  }
  // A Fastrak measures one station after the other.
  for (int n = 0; n < stations; ++n) {
    turn_ = turn_ % stations + 1;
    if (!there(turn_)) continue;
    say_fastrak(time, turn_, out);
    return;
  }
}

void PolhemusEmulator::say_liberty(double time, char command, int station, std::vector<std::uint8_t>& out) {
  const auto index = static_cast<std::size_t>(station - 1);
  const auto [p, q] = said_pose(time, station);
  if (!binary_) {
    std::ostringstream text;
    text << "0" << station << " " << p.x << " " << p.y << " " << p.z << "\r\n";
    const std::string line = text.str();
    return add(out, line.data(), line.size());
  }
  std::vector<std::uint8_t> body;
  for (const double item : numbers_of(order_)) {
    switch (static_cast<int>(item)) {
      case 0:
        body.push_back(' ');
        break;
      case 2:
      case 3:
        for (const double x : {p.x, p.y, p.z}) add_float(body, x);
        break;
      case 7:
        for (const double x : {q.w, q.x, q.y, q.z}) add_float(body, x);
        break;
      case 8:
        add_number(body, static_cast<std::uint32_t>(1e3 * time));
        break;
      case 9:
        add_number(body, frame_);
        break;
      case 10:
        add_number(body, pressed_[index] ? 1 : 0);
        break;
      case 11:
        add_number(body, 0);
        break;
      default:
        ++bad_commands_;
    }
  }
  add(out, settings_.tag.data(), 2);
  out.push_back(static_cast<std::uint8_t>(station));
  out.push_back(static_cast<std::uint8_t>(command));
  out.push_back(static_cast<std::uint8_t>(errors_[index]));
  out.push_back(0);
  out.push_back(static_cast<std::uint8_t>(body.size() % 256));
  out.push_back(static_cast<std::uint8_t>(body.size() / 256));
  add(out, body.data(), body.size());
}

void PolhemusEmulator::say_fastrak(double time, int station, std::vector<std::uint8_t>& out) {
  const auto index = static_cast<std::size_t>(station - 1);
  const auto [p, q] = said_pose(time, station);
  out.push_back('0');
  out.push_back(static_cast<std::uint8_t>('0' + station));
  out.push_back(static_cast<std::uint8_t>(errors_[index]));
  for (const double item : numbers_of(order_)) {
    if (item == 2.0) {
      for (const double x : {p.x, p.y, p.z}) add_float(out, x);
    } else if (item == 11.0) {
      for (const double x : {q.w, q.x, q.y, q.z}) add_float(out, x);
    } else if (item == 16.0) {
      out.push_back(' ');
      out.push_back(pressed_[index] ? '1' : '0');
    } else if (item == 0.0) {
      out.push_back(' ');
    }
  }
}

UsbDevice PolhemusOnUsb::description() const {
  UsbDevice device{.id = id_, .path = {}, .endpoints = {}};
  const bool high_speed = id_.product == 0xff20 || id_.product == 0xef20;
  const auto out = static_cast<std::uint8_t>(high_speed ? 0x04 : 0x02);
  const auto in = static_cast<std::uint8_t>(high_speed ? 0x88 : 0x82);
  device.endpoints = {{.interface = 0, .address = out, .packet = 64, .interrupt = false},
                      {.interface = 0, .address = in, .packet = 64, .interrupt = false}};
  if (fastrak())
    device.endpoints.push_back({.interface = 0, .address = 0x84, .packet = 64, .interrupt = true});
  return device;
}

void PolhemusOnUsb::opened(double now) {
  answers_.clear();
  data_.clear();
  tracker_->opened(now);
}

void PolhemusOnUsb::write(double now, std::uint8_t endpoint, std::span<const std::uint8_t> data) {
  if (endpoint == 0x02 || endpoint == 0x04) tracker_->hear(now, data);
}

std::size_t PolhemusOnUsb::read(double now, std::uint8_t endpoint, std::span<std::uint8_t> data) {
  tracker_->speak(now, answers_, fastrak() ? data_ : answers_);
  std::vector<std::uint8_t>& waiting = fastrak() && endpoint == 0x84 ? data_ : answers_;
  std::size_t bytes = std::min(waiting.size(), data.size());
  if (splits_ && bytes > 1) bytes = 1 + random_() % bytes;
  std::copy_n(waiting.begin(), bytes, data.begin());
  waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(bytes));
  return bytes;
}

}  // namespace palpate::test
