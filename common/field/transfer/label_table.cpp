#include "common/field/transfer/label_table.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// Far from those of the labels beside it: hues that the golden ratio parts.
Vec3f own_color(double value) {
  constexpr double kGolden = 0.618033988749895, kSaturation = 0.62, kLightest = 0.95;
  const double hue = 6.0 * (value * kGolden - std::floor(value * kGolden));
  const auto part = [hue](double from) {
    const double k = std::fmod(from + hue, 6.0);
    return static_cast<float>(kLightest -
                              kLightest * kSaturation * std::clamp(std::min(k, 4.0 - k), 0.0, 1.0));
  };
  return {part(5.0), part(3.0), part(1.0)};
}

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  std::string word;
  bool quoted = false, any = false;
  for (const char c : line) {
    const bool gap = !quoted && (c == ' ' || c == '\t');
    if (c == '"') {
      quoted = !quoted;
      any = true;
    } else if (gap) {
      if (any || !word.empty()) words.push_back(std::exchange(word, {}));
      any = false;
    } else {
      word += c;
    }
  }
  if (any || !word.empty()) words.push_back(word);
  return words;
}

std::optional<Vec3f> color_at(const std::vector<std::string>& words, std::size_t first) {
  Vec3f color{0.0F};
  if (words.size() < first + 3) return std::nullopt;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto part = parsed<double>(trimmed(words[first + c]));
    if (!part || !(*part >= 0.0 && *part <= 255.0)) return std::nullopt;
    color[static_cast<int>(c)] = static_cast<float>(*part / 255.0);
  }
  return color;
}

std::optional<Label> label_of(std::string_view line) {
  std::vector<std::string> words;
  const bool commas = line.find(',') != std::string_view::npos && line.find('"') == std::string_view::npos;
  if (commas) {
    for (const std::string_view part : split(line, ',')) words.emplace_back(trimmed(part));
  } else {
    words = words_of(line);
  }
  if (words.size() < 2) return std::nullopt;
  const auto value = parsed<double>(words[0]);
  if (!value || *value != std::round(*value)) return std::nullopt;
  if (commas && words.size() == 2) return Label{*value, words[1], own_color(*value)};
  const bool name_last = !commas && words.size() == 8 && parsed<double>(words[1]).has_value();
  const auto color = color_at(words, name_last ? 1 : 2);
  if (!color) return std::nullopt;
  return Label{*value, name_last ? words[7] : words[1], *color};
}

}  // namespace

LabelTable::LabelTable(std::vector<Label> labels) : labels_(std::move(labels)) {
  std::ranges::reverse(labels_);
  std::ranges::stable_sort(labels_, {}, &Label::value);
  // std::ranges::unique returns what Clang 14 cannot compile.
  const auto same = [](const Label& a, const Label& b) { return a.value == b.value; };
  labels_.erase(std::unique(labels_.begin(), labels_.end(), same), labels_.end());
}

const Label* LabelTable::find(double value) const noexcept {
  const auto at = std::ranges::lower_bound(labels_, value, {}, &Label::value);
  return at != labels_.end() && at->value == value ? &*at : nullptr;
}

Label LabelTable::at(double value) const {
  if (const Label* const known = find(value)) return *known;
  return {value, "label " + short_number(value), own_color(value)};
}

LabelTable read_label_table(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw input_error({file, "", "cannot be read", "names of labels", ""});
  std::vector<Label> labels;
  std::string line;
  for (int row = 1; std::getline(stream, line); ++row) {
    const std::string_view text = trimmed(line);
    if (text.empty() || text.front() == '#') continue;
    if (auto label = label_of(text)) {
      labels.push_back(std::move(*label));
    } else if (!labels.empty() || text.find(',') == std::string_view::npos) {
      throw input_error({file, "row " + std::to_string(row), "is no label",
                         "VALUE NAME R G B A, VALUE R G B A V M \"NAME\" or VALUE,NAME[,R,G,B]", ""});
    }
  }
  if (labels.empty()) throw input_error({file, "", "has no label", "a row for each", ""});
  return LabelTable(std::move(labels));
}

}  // namespace palpate
