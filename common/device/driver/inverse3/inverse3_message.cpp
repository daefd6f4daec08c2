#include "common/device/driver/inverse3/inverse3_message.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>

#include <nlohmann/json.hpp>

#include "common/base/index.h"

namespace palpate {
namespace {

enum class HaplyKey : std::uint8_t {
  kOther,
  kElement,  // of an array
  kDevices,
  kGrips,
  kDeviceId,
  kState,
  kPosition,
  kButtons,
  kX,
  kY,
  kZ,
  kButton0,
  kButton1,
  kButton2,
  kButton3,
  kStatus,
  kCalibrated,
  kPowered
};

struct HaplyWord {
  std::string_view text;
  HaplyKey key;
};

constexpr std::array kHaplyWords{HaplyWord{"inverse3", HaplyKey::kDevices},
                                 HaplyWord{"verse_grip", HaplyKey::kGrips},
                                 HaplyWord{"wireless_verse_grip", HaplyKey::kGrips},
                                 HaplyWord{"device_id", HaplyKey::kDeviceId},
                                 HaplyWord{"state", HaplyKey::kState},
                                 HaplyWord{"cursor_position", HaplyKey::kPosition},
                                 HaplyWord{"buttons", HaplyKey::kButtons},
                                 HaplyWord{"x", HaplyKey::kX},
                                 HaplyWord{"y", HaplyKey::kY},
                                 HaplyWord{"z", HaplyKey::kZ},
                                 HaplyWord{"a", HaplyKey::kButton0},
                                 HaplyWord{"b", HaplyKey::kButton1},
                                 HaplyWord{"c", HaplyKey::kButton2},
                                 HaplyWord{"button_0", HaplyKey::kButton0},
                                 HaplyWord{"button_1", HaplyKey::kButton1},
                                 HaplyWord{"button_2", HaplyKey::kButton2},
                                 HaplyWord{"button_3", HaplyKey::kButton3},
                                 HaplyWord{"status", HaplyKey::kStatus},
                                 HaplyWord{"calibrated", HaplyKey::kCalibrated},
                                 HaplyWord{"power_supply", HaplyKey::kPowered}};

HaplyKey haply_key(std::string_view text) noexcept {
  const auto* const found = std::find_if(kHaplyWords.begin(), kHaplyWords.end(),
                                         [text](const HaplyWord& word) { return word.text == text; });
  return found != kHaplyWords.end() ? found->key : HaplyKey::kOther;
}

/// A device or a grip while it is read.
struct HaplyEntry {
  std::optional<HaplyId> id;
  std::array<std::optional<double>, 3> position;
  std::uint32_t buttons = 0;
  std::optional<bool> calibrated, powered;
};

/// Follows the parser through a message: no tree of it is built.
class HaplyReader {
 public:
  using Json = nlohmann::json;

  HaplyReader(std::string_view wanted, HaplyState& state) noexcept : wanted_(wanted), state_(state) {}

  bool null() noexcept { return rooted(); }
  bool boolean(bool value) noexcept {
    const HaplyKey key = key_;
    if (depth_ == 4 && path_[3] == HaplyKey::kStatus) {
      if (key == HaplyKey::kCalibrated) entry_.calibrated = value;
      if (key == HaplyKey::kPowered) entry_.powered = value;
    }
    if (within(HaplyKey::kButtons) && key >= HaplyKey::kButton0 && key <= HaplyKey::kButton3) {
      const auto bit = static_cast<unsigned>(key) - static_cast<unsigned>(HaplyKey::kButton0);
      if (value) entry_.buttons |= 1U << bit;
    }
    return rooted();
  }
  bool number_integer(Json::number_integer_t value) noexcept { return number(static_cast<double>(value)); }
  bool number_unsigned(Json::number_unsigned_t value) noexcept { return number(static_cast<double>(value)); }
  bool number_float(Json::number_float_t value, const Json::string_t& /*text*/) noexcept {
    return number(value);
  }
  bool string(const Json::string_t& value) noexcept {
    const bool of_entry = depth_ == 3 && (room() == HaplyKey::kDevices || room() == HaplyKey::kGrips);
    if (of_entry && key_ == HaplyKey::kDeviceId) entry_.id = HaplyId::from(value);
    return rooted();
  }
  bool binary(const Json::binary_t& /*value*/) noexcept { return false; }
  bool key(const Json::string_t& text) noexcept {
    key_ = haply_key(text);
    return true;
  }
  bool start_object(std::size_t /*size*/) noexcept {
    if (!enter()) return false;
    if (depth_ == 3) entry_ = {};
    return true;
  }
  bool end_object() noexcept {
    if (depth_ == 3) commit();
    --depth_;
    key_ = HaplyKey::kElement;
    return true;
  }
  bool start_array(std::size_t /*size*/) noexcept {
    if (depth_ == 0 || !enter()) return false;
    key_ = HaplyKey::kElement;
    return true;
  }
  bool end_array() noexcept {
    --depth_;
    key_ = HaplyKey::kElement;
    return true;
  }
  bool parse_error(std::size_t /*position*/, const std::string& /*token*/,
                   const Json::exception& /*what*/) noexcept {
    return false;
  }

 private:
  [[nodiscard]] bool rooted() const noexcept { return depth_ > 0; }
  [[nodiscard]] HaplyKey room() const noexcept { return depth_ > 1 ? path_[1] : HaplyKey::kOther; }
  /// In the object `inner` of the state of a device or grip.
  [[nodiscard]] bool within(HaplyKey inner) const noexcept {
    return depth_ == 5 && path_[3] == HaplyKey::kState && path_[4] == inner;
  }
  bool enter() noexcept {
    if (depth_ == kHaplyDeepest) return false;
    path_[depth_++] = key_;
    return true;
  }
  bool number(double value) noexcept {
    const bool axis = key_ >= HaplyKey::kX && key_ <= HaplyKey::kZ;
    const std::size_t i = as_size(key_) - as_size(HaplyKey::kX);
    if (axis && within(HaplyKey::kPosition)) entry_.position[i] = value;
    return rooted();
  }
  void commit() noexcept {
    if (room() == HaplyKey::kDevices) {
      const bool asked = entry_.id && (wanted_.empty() || entry_.id->view() == wanted_);
      if (!asked || state_.device) return;
      state_.device = entry_.id;
      state_.calibrated = entry_.calibrated;
      state_.powered = entry_.powered;
      const auto& [x, y, z] = entry_.position;
      if (x && y && z && is_finite({*x, *y, *z})) state_.position = Vec3{*x, *y, *z};
    } else if (room() == HaplyKey::kGrips) {
      if (grip_) return;
      grip_ = state_.grip = true;
      state_.buttons = entry_.buttons;
    }
  }

  std::string_view wanted_;
  HaplyState& state_;
  std::array<HaplyKey, kHaplyDeepest> path_{};
  std::size_t depth_ = 0;
  HaplyKey key_ = HaplyKey::kOther;
  HaplyEntry entry_;
  bool grip_ = false;
};

}  // namespace

std::optional<HaplySpelling> haply_spelling(std::string_view version_text) noexcept {
  constexpr std::string_view kWord = "version";
  const std::size_t word = version_text.find(kWord);
  std::string_view rest =
      word == std::string_view::npos ? version_text : version_text.substr(word + kWord.size());
  const std::size_t digit = rest.find_first_of("0123456789");
  // Between the word and its number there are quotes, a colon, blanks, perhaps a v.
  constexpr std::size_t kFarthest = 8;
  if (digit > kFarthest) return std::nullopt;
  rest.remove_prefix(digit);
  int major = 0, minor = 0;
  const char* const end = rest.data() + rest.size();
  const auto first = std::from_chars(rest.data(), end, major);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != '.') return std::nullopt;
  if (std::from_chars(first.ptr + 1, end, minor).ec != std::errc()) return std::nullopt;
  constexpr int kVectorMajor = 3, kVectorMinor = 5;
  const bool vector = major > kVectorMajor || (major == kVectorMajor && minor >= kVectorMinor);
  return vector ? HaplySpelling::kVector : HaplySpelling::kValues;
}

std::optional<HaplyId> HaplyId::from(std::string_view text) noexcept {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  if (text.empty() || text.size() > kLongest || !std::all_of(text.begin(), text.end(), fits))
    return std::nullopt;
  HaplyId id;
  std::copy(text.begin(), text.end(), id.letters_.begin());
  id.length_ = text.size();
  return id;
}

bool read_haply_state(std::string_view message, std::string_view wanted, HaplyState& state) noexcept {
  state = {};
  HaplyReader reader(wanted, state);
  try {
    return nlohmann::json::sax_parse(message.begin(), message.end(), &reader);
  } catch (const std::exception&) {  // no memory for one of its words
    return false;
  }
}

void write_haply_force(std::string& text, const HaplyId& device, const Vec3& force, HaplySpelling spelling) {
  constexpr int kDigits = 6;  // after the point: a thousandth of what a hand feels
  text = R"({"inverse3":[{"device_id":")";
  text += device.view();
  text += R"(","commands":{"set_cursor_force":{")";
  text += spelling == HaplySpelling::kVector ? "vector" : "values";
  text += "\":{";
  for (int axis = 0; axis < 3; ++axis) {
    std::array<char, 32> digits{};
    const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), force[axis],
                                       std::chars_format::fixed, kDigits);
    text += axis == 0 ? "\"x\":" : axis == 1 ? ",\"y\":" : ",\"z\":";
    if (written.ec == std::errc()) {
      text.append(digits.data(), written.ptr);
    } else {
      text += '0';
    }
  }
  text += "}}}}]}";
}

}  // namespace palpate
