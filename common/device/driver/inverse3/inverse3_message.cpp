#include "common/device/driver/inverse3/inverse3_message.h"

#include <algorithm>
#include <charconv>
#include <cmath>

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

/// Follows the scan of a message: no tree of it is built.
class HaplyReader {
 public:
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
  bool number(double value) noexcept {
    const bool axis = key_ >= HaplyKey::kX && key_ <= HaplyKey::kZ;
    const std::size_t i = as_size(key_) - as_size(HaplyKey::kX);
    if (axis && within(HaplyKey::kPosition)) entry_.position[i] = value;
    return rooted();
  }
  bool string(std::string_view value) noexcept {
    const bool of_entry = depth_ == 3 && (room() == HaplyKey::kDevices || room() == HaplyKey::kGrips);
    if (of_entry && key_ == HaplyKey::kDeviceId) entry_.id = HaplyId::from(value);
    return rooted();
  }
  void key(std::string_view text) noexcept { key_ = haply_key(text); }
  bool start_object() noexcept {
    if (!enter()) return false;
    if (depth_ == 3) entry_ = {};
    return true;
  }
  void end_object() noexcept {
    if (depth_ == 3) commit();
    --depth_;
    key_ = HaplyKey::kElement;
  }
  bool start_array() noexcept {
    if (depth_ == 0 || !enter()) return false;
    key_ = HaplyKey::kElement;
    return true;
  }
  void end_array() noexcept {
    --depth_;
    key_ = HaplyKey::kElement;
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

/// Scans a text by the grammar of JSON (RFC 8259) and tells `reader` of its values in their order. It neither
/// allocates nor copies: words are told as they are written, with their escapes. The reader bounds the nesting.
class JsonScan {
 public:
  JsonScan(std::string_view text, HaplyReader& reader) noexcept : rest_(text), reader_(reader) {}

  /// Whether all of the text is one value that the reader took.
  bool run() noexcept {
    if (!value()) return false;
    skip_blanks();
    return rest_.empty();
  }

 private:
  void skip_blanks() noexcept {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
  }
  bool take(std::string_view word) noexcept {
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  bool value() noexcept {
    skip_blanks();
    if (rest_.empty()) return false;
    switch (rest_.front()) {
      case '{':
        return object();
      case '[':
        return array();
      case '"': {
        std::string_view text;
        return word(text) && reader_.string(text);
      }
      case 't':
        return take("true") && reader_.boolean(true);
      case 'f':
        return take("false") && reader_.boolean(false);
      case 'n':
        return take("null") && reader_.null();
      default:
        return number();
    }
  }
  bool object() noexcept {
    rest_.remove_prefix(1);
    if (!reader_.start_object()) return false;
    skip_blanks();
    for (bool first = true; !take("}"); first = false) {
      if (!first && !take(",")) return false;
      skip_blanks();
      std::string_view key;
      if (!word(key)) return false;
      reader_.key(key);
      skip_blanks();
      if (!take(":") || !value()) return false;
      skip_blanks();
    }
    reader_.end_object();
    return true;
  }
  bool array() noexcept {
    rest_.remove_prefix(1);
    if (!reader_.start_array()) return false;
    skip_blanks();
    for (bool first = true; !take("]"); first = false) {
      if (!first && !take(",")) return false;
      if (!value()) return false;
      skip_blanks();
    }
    reader_.end_array();
    return true;
  }
  std::size_t digits() noexcept {
    const std::size_t count = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
    rest_.remove_prefix(count);
    return count;
  }
  bool number() noexcept {
    const std::string_view from = rest_;
    (void)take("-");
    const bool zero = rest_.starts_with('0');
    const std::size_t whole = digits();
    if (whole == 0 || (zero && whole > 1)) return false;
    if (take(".") && digits() == 0) return false;
    bool small = zero;
    if (take("e") || take("E")) {
      small = rest_.starts_with('-');
      if (!take("-")) (void)take("+");
      if (digits() == 0) return false;
    }
    const std::string_view text = from.substr(0, from.size() - rest_.size());
    double value = 0.0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    // Too small to be told from zero is zero; too large is no number.
    if (read.ec == std::errc::result_out_of_range && small) value = 0.0;
    return (read.ec == std::errc() || small) && reader_.number(value);
  }
  /// A string, without its quotes.
  bool word(std::string_view& text) noexcept {
    if (!take("\"")) return false;
    const std::string_view from = rest_;
    while (!rest_.empty() && rest_.front() != '"') {
      if (!letter()) return false;
    }
    text = from.substr(0, from.size() - rest_.size());
    return take("\"");
  }
  bool letter() noexcept {
    const auto c = static_cast<unsigned char>(rest_.front());
    constexpr unsigned kBlank = 0x20, kPlain = 0x80;
    if (c < kBlank) return false;
    if (c >= kPlain) return utf8();
    rest_.remove_prefix(1);
    return c != '\\' || escape();
  }
  bool escape() noexcept {
    if (rest_.empty()) return false;
    const char kind = rest_.front();
    rest_.remove_prefix(1);
    if (kind != 'u') return std::string_view("\"\\/bfnrt").find(kind) != std::string_view::npos;
    constexpr unsigned kHigh = 0xD800, kLow = 0xDC00, kEnd = 0xE000;
    const unsigned code = four_digits();
    if (code < kHigh || (code >= kEnd && code <= kMostCode)) return true;
    if (code >= kLow || !take("\\u")) return false;  // half of a pair
    const unsigned second = four_digits();
    return second >= kLow && second < kEnd;
  }
  static constexpr unsigned kMostCode = 0xFFFF;
  /// More than kMostCode where there are none.
  unsigned four_digits() noexcept {
    unsigned code = 0;
    constexpr std::size_t kDigits = 4;
    const std::string_view text = rest_.substr(0, kDigits);
    const auto read = std::from_chars(text.data(), text.data() + text.size(), code, 16);
    if (text.size() != kDigits || read.ec != std::errc() || read.ptr != text.data() + kDigits)
      return kMostCode + 1;
    rest_.remove_prefix(kDigits);
    return code;
  }
  /// One code of two to four bytes, in its shortest form and no half of a pair (RFC 3629).
  bool utf8() noexcept {
    const auto byte = [this](std::size_t i) {
      return i < rest_.size() ? static_cast<unsigned char>(rest_[i]) : 0U;
    };
    const unsigned lead = byte(0);
    const std::size_t length = lead >= 0xC2 && lead < 0xE0   ? 2
                               : lead >= 0xE0 && lead < 0xF0 ? 3
                               : lead >= 0xF0 && lead < 0xF5 ? 4
                                                             : 0;
    if (length == 0) return false;
    const unsigned least = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
    const unsigned most = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
    if (byte(1) < least || byte(1) > most) return false;
    for (std::size_t i = 2; i < length; ++i) {
      if (byte(i) < 0x80 || byte(i) > 0xBF) return false;
    }
    rest_.remove_prefix(length);
    return true;
  }

  std::string_view rest_;
  HaplyReader& reader_;
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
  return JsonScan(message, reader).run();
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
