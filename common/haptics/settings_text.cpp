#include "common/haptics/settings_text.h"

#include <algorithm>
#include <charconv>
#include <vector>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/haptics/widget/widget_text.h"
#include "common/math/vec_text.h"

namespace palpate {
namespace {

// How a value of a setting is written and read: an overload each for every type that one may have.

std::string value_text(double value) { return exact_number(value); }

bool read_value(std::string_view text, double& value) noexcept {
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  return parsed.ec == std::errc() && parsed.ptr == end;
}

std::string value_text(bool value) { return value ? "yes" : "no"; }

bool read_value(std::string_view text, bool& value) noexcept {
  value = text == "yes";
  return value || text == "no";
}

std::string value_text(int value) { return std::to_string(value); }

bool read_value(std::string_view text, int& value) noexcept {
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  return parsed.ec == std::errc() && parsed.ptr == end;
}

/// "1,0.5,2"
std::string value_text(const Vec3& value) { return exact_text(value); }

bool read_value(std::string_view text, Vec3& value) {
  const std::vector<std::string_view> words = split(text, ',');
  return words.size() == 3 && read_value(words[0], value.x) && read_value(words[1], value.y) &&
         read_value(words[2], value.z);
}

std::string value_text(const GridFrame& frame) { return text_of(frame); }
bool read_value(std::string_view text, GridFrame& frame) { return !read_text(text, frame); }
std::string value_text(const GridMarks& marks) { return text_of(marks); }
bool read_value(std::string_view text, GridMarks& marks) { return !read_text(text, marks); }
std::string value_text(const PlanePoses& poses) { return text_of(poses); }
bool read_value(std::string_view text, PlanePoses& poses) { return !read_text(text, poses); }

/// "0.5,1.25", or nothing.
std::string value_text(const Isovalues& values) {
  std::string text;
  for (int i = 0; i < values.count; ++i) {
    (text += i > 0 ? "," : "") += exact_number(values.value[as_size(i)]);
  }
  return text;
}

bool read_value(std::string_view text, Isovalues& values) {
  values = {};
  if (text.empty()) return true;
  for (const std::string_view word : split(text, ',')) {
    if (values.count == Isovalues::kMax) return false;
    if (!read_value(word, values.value[as_size(values.count++)])) return false;
  }
  return true;
}

std::string value_text(const HapticTransferFunction& function) { return function.text(); }

bool read_value(std::string_view text, HapticTransferFunction& function) {
  return !HapticTransferFunction::read(text, function);
}

std::string value_text(AxisRule rule) { return std::string(name_of(rule)); }

bool read_value(std::string_view text, AxisRule& rule) noexcept {
  const auto found = axis_rule_of(text);
  if (found) rule = *found;
  return found.has_value();
}

/// Reads the name of one of `count` values of an enumeration that count from zero.
template <typename Enum>
bool read_name(std::string_view text, int count, Enum& value) noexcept {
  for (int i = 0; i < count; ++i) {
    value = static_cast<Enum>(i);
    if (text == name_of(value)) return true;
  }
  return false;
}

std::string value_text(IsosurfaceHold hold) { return std::string(name_of(hold)); }

bool read_value(std::string_view text, IsosurfaceHold& hold) noexcept {
  return read_name(text, kIsosurfaceHoldCount, hold);
}

std::string value_text(LinearReference reference) { return std::string(name_of(reference)); }

bool read_value(std::string_view text, LinearReference& reference) noexcept {
  return read_name(text, kLinearReferenceCount, reference);
}

std::string value_text(GridSwitch where) { return std::string(name_of(where)); }

bool read_value(std::string_view text, GridSwitch& where) noexcept {
  return read_name(text, kGridSwitchCount, where);
}

std::string value_text(LinearMeasure measure) { return std::string(name_of(measure)); }

bool read_value(std::string_view text, LinearMeasure& measure) noexcept {
  return read_name(text, kLinearMeasureCount, measure);
}

}  // namespace

std::string settings_text(const ChainSettings& settings) {
  std::string text;
  ChainSettings::each(settings, [&](std::string_view name, const auto& value) {
    if (!text.empty()) text += ' ';
    (text.append(name) += '=') += value_text(value);
  });
  return text;
}

std::optional<std::string> read_settings(std::string_view text, ChainSettings& settings) {
  std::vector<std::string_view> words = split(text, ' ');
  std::string problem;
  ChainSettings::each(settings, [&](std::string_view name, auto& value) {
    const auto at = std::find_if(words.begin(), words.end(), [&](std::string_view word) {
      return word.size() > name.size() && word.starts_with(name) && word[name.size()] == '=';
    });
    if (at == words.end()) {
      if (problem.empty()) problem = "it lacks " + std::string(name) + "=";
      return;
    }
    if (!read_value(at->substr(name.size() + 1), value) && problem.empty()) {
      problem = "'" + std::string(at->substr(0, 40)) + "' cannot be read";
    }
    words.erase(at);
  });
  if (problem.empty() && !words.empty()) {
    problem = "'" + std::string(words.front().substr(0, 40)) + "' is not known here, or stands there twice";
  }
  if (problem.empty() && !settings.valid()) problem = "its values make no chain";
  if (!problem.empty()) return problem;
  return std::nullopt;
}

}  // namespace palpate
