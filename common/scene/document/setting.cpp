#include "common/scene/document/setting.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>
#include <type_traits>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/scene/document/tables.h"

namespace palpate {
namespace {

constexpr char kBetween = ';';

/// The value at a place of a document that is not to be changed: places lead to values of both kinds.
template <typename T>
const T& value_at(ValueAt<T> at, const Document& document) {
  return at(const_cast<Document&>(document));
}

std::string text_of(bool value) { return value ? "on" : "off"; }
std::string text_of(double value) { return exact_number(value); }
template <std::integral T>
std::string text_of(T value) {
  return std::to_string(value);
}
std::string text_of(const std::string& value) { return value; }
std::string text_of(const std::filesystem::path& value) { return value.string(); }
template <typename T>
std::string text_of(const std::optional<T>& value) {
  return value ? text_of(*value) : std::string();
}
template <typename T>
std::string text_of(const std::vector<T>& values) {
  std::string text;
  for (const T& value : values) {
    if (!text.empty()) text += kBetween;
    text += text_of(value);
  }
  return text;
}

[[noreturn]] void refuse(const Setting& setting, std::string_view text, const std::string& expected) {
  throw usage_error(setting.option() + " " + std::string(text) + ": " + expected + " is expected");
}

/// "a number from 0 to 1"
std::string number_in(const Setting& setting, const char* what) {
  const std::string range = setting.range.text();
  return what + (range.empty() ? range : " " + range);
}

void take(const Setting& setting, std::string_view text, double& value) {
  const std::optional<double> read = number(text);
  if (!read || !std::isfinite(*read) || !setting.range.contains(*read))
    refuse(setting, text, number_in(setting, "a number"));
  value = *read;
}

template <std::integral T>
void take(const Setting& setting, std::string_view text, T& value) {
  const std::string_view digits = trimmed(text);
  T read{};
  const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), read);
  if (parsed.ec != std::errc() || parsed.ptr != digits.data() + digits.size() ||
      !setting.range.contains(static_cast<double>(read)))
    refuse(setting, text, number_in(setting, "a whole number"));
  value = read;
}

void take(const Setting& setting, std::string_view text, bool& value) {
  constexpr std::array<std::string_view, 4> kOn{"on", "true", "yes", "1"}, kOff{"off", "false", "no", "0"};
  const bool on = std::ranges::find(kOn, text) != kOn.end();
  if (!on && std::ranges::find(kOff, text) == kOff.end()) refuse(setting, text, "on or off");
  value = on;
}

void take(const Setting& setting, std::string_view text, std::string& value) {
  if (!setting.words.empty()) {
    const std::vector<std::string_view> words = setting.word_list();
    const bool none = text.empty() && default_text(setting).empty();
    if (!none && std::ranges::find(words, text) == words.end()) {
      std::string known;
      for (const std::string_view word : words) known += (known.empty() ? "" : ", ") + std::string(word);
      throw usage_error(setting.option() + " " + std::string(text) + ": " + known + " are known");
    }
  }
  value = text;
}

void take(const Setting& /*setting*/, std::string_view text, std::filesystem::path& value) { value = text; }

template <typename T>
void take(const Setting& setting, std::string_view text, std::optional<T>& value) {
  value.reset();
  if (text.empty()) return;
  T read{};
  take(setting, text, read);
  value = std::move(read);
}

template <typename T>
void take(const Setting& /*setting*/, std::string_view text, std::vector<T>& values) {
  values.clear();
  if (text.empty()) return;
  for (const std::string_view part : split(text, kBetween)) values.emplace_back(part);
}

/// How many letters are to be put in, left out or changed to make one of the other.
std::size_t letters_apart(std::string_view a, std::string_view b) {
  constexpr std::size_t kLongest = 63;  // no setting's name comes near to it
  std::array<std::size_t, kLongest + 1> row{};
  b = b.substr(0, kLongest);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t corner = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = corner + (a[i] == b[j] ? 0 : 1);
      corner = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string Range::text() const {
  const bool below = std::isfinite(upper);
  if (!std::isfinite(lower)) return below ? "up to " + short_number(upper) : std::string();
  if (above) return "above " + short_number(lower) + (below ? " and at most " + short_number(upper) : "");
  return below ? "from " + short_number(lower) + " to " + short_number(upper)
               : "of " + short_number(lower) + " or more";
}

std::string Setting::label() const {
  std::string text(title.empty() ? name : title);
  if (!title.empty()) return text;
  std::ranges::replace(text, '-', ' ');
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

std::string Setting::option() const {
  return spelling == Spelling::kPositional ? std::string(value) : "--" + std::string(name);
}

std::string Setting::full_help() const {
  std::string text(help);
  if (!otherwise.empty()) return text + "; default: " + std::string(otherwise);
  const std::string usual = default_text(*this);
  if (usual.empty() || spelling != Spelling::kOption) return text;
  return text + "; default " + usual;
}

std::vector<std::string_view> Setting::word_list() const {
  return words.empty() ? std::vector<std::string_view>() : split(words, '|');
}

bool Setting::several() const noexcept {
  return std::holds_alternative<ValueAt<std::vector<std::string>>>(place) ||
         std::holds_alternative<ValueAt<std::vector<std::filesystem::path>>>(place);
}

const std::vector<Setting>& settings() {
  static const std::vector<Setting> kAll = [] {
    std::vector<Setting> all;
    for (const auto table : {input_settings(), tracing_settings(), view_settings(), volume_settings(),
                             panes_settings(), touch_settings(), mode_settings(), hand_settings(),
                             output_settings(), study_settings(), device_settings()})
      all.insert(all.end(), table.begin(), table.end());
    return all;
  }();
  return kAll;
}

const Setting* find_setting(std::string_view name, FieldKind kind) {
  const auto found = std::ranges::find_if(
      settings(), [&](const Setting& row) { return row.saved && row.name == name && row.kinds.has(kind); });
  return found == settings().end() ? nullptr : &*found;
}

const Setting& setting(std::string_view name) {
  const auto found = std::ranges::find(settings(), name, &Setting::name);
  PALPATE_CHECK(found != settings().end());
  return *found;
}

std::string_view nearest_setting(std::string_view name, FieldKind kind) {
  std::string_view nearest;
  for (const Setting& row : settings()) {
    if (!row.saved || !row.kinds.has(kind)) continue;
    if (nearest.empty() || letters_apart(name, row.name) < letters_apart(name, nearest)) nearest = row.name;
  }
  return nearest;
}

std::string value_text(const Setting& setting, const Document& document) {
  return std::visit([&](auto at) { return text_of(value_at(at, document)); }, setting.place);
}

void set_value(const Setting& setting, Document& document, std::string_view text) {
  std::visit([&](auto at) { take(setting, text, at(document)); }, setting.place);
}

bool same_value(const Setting& setting, const Document& a, const Document& b) {
  return std::visit([&](auto at) { return value_at(at, a) == value_at(at, b); }, setting.place);
}

bool is_default(const Setting& setting, const Document& document) {
  static const Document kNew;
  return same_value(setting, document, kNew);
}

std::string default_text(const Setting& setting) {
  static const Document kNew;
  return value_text(setting, kNew);
}

bool operator==(const Document& a, const Document& b) {
  return std::ranges::all_of(settings(), [&](const Setting& row) { return same_value(row, a, b); });
}

}  // namespace palpate
