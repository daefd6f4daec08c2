#include "apps/dtmri/bundle_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "apps/dtmri/region_text.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/scene/document/setting.h"

namespace palpate {
namespace {

constexpr std::string_view kReserved = "|;";

/// Options of tracing, by name: those of the verb `trace`.
const Setting* tracing_setting(std::string_view name) {
  const auto found = std::ranges::find_if(settings(), [&](const Setting& row) {
    return row.name == name && row.heading == "Tracts" && row.belongs(FieldKind::kTensor, {Group::kLines});
  });
  return found == settings().end() ? nullptr : &*found;
}

std::string step_text(const BundleStep& step) { return step.key + "=" + step.value; }

/// `count` numbers, all finite.
std::vector<double> numbers_of(const BundleStep& step, std::size_t count, const std::string& expected) {
  const std::string refusal = "--bundle: " + step_text(step) + ": " + expected + " is expected";
  std::vector<double> numbers = parse_numbers(step.value, count, refusal);
  if (!std::ranges::all_of(numbers, [](double v) { return std::isfinite(v); })) throw usage_error(refusal);
  return numbers;
}

[[noreturn]] void refuse(const BundleStep& step, const std::string& expected) {
  throw usage_error("--bundle: " + step_text(step) + ": " + expected + " is expected");
}

bool counts(double number) { return number >= 1.0 && number == std::floor(number) && number < 1e15; }

void check_tracing(const BundleStep& step) {
  Document probe;
  set_value(*tracing_setting(step.key), probe, step.value);
}

void check_numbers(const BundleStep& step) {
  const std::size_t count = split(step.value, ',').size();
  if (step.key == "delete") {
    if (!std::ranges::all_of(numbers_of(step, count, "numbers of tracts"), counts))
      refuse(step, "numbers of tracts, from 1, with commas between,");
  } else if (step.key == "join") {
    const auto v = numbers_of(step, 2, "two numbers of tracts");
    if (!counts(v[0]) || !counts(v[1]) || v[0] == v[1]) refuse(step, "two numbers of tracts, from 1,");
  } else if (step.key == "cut") {
    if (!counts(numbers_of(step, 4, "the number of a tract and a place, N,x,y,z,")[0]))
      refuse(step, "the number of a tract, from 1, and a place, N,x,y,z,");
  } else if (step.key == "part") {
    const auto v = numbers_of(step, 4, "a plane nx,ny,nz,d");
    if (v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0) refuse(step, "a plane nx,ny,nz,d with a normal");
  } else if (step.key == "length") {
    const auto v = numbers_of(step, 2, "LEAST,MOST in mm");
    if (!(v[0] >= 0.0 && v[1] >= v[0])) refuse(step, "LEAST,MOST in mm, rising,");
  } else if (step.key == "line") {
    if (count < 6 || count % 3 != 0) refuse(step, "a line of two points and more, x,y,z,x,y,z,…");
    (void)numbers_of(step, count, "a line x,y,z,x,y,z,…");
  } else if (!(numbers_of(step, 1, "a length in mm")[0] > 0.0)) {
    refuse(step, "a length in mm above zero");
  }
}

/// Whether the key is known; its value is checked.
bool check(const BundleStep& step) {
  constexpr std::array<std::string_view, 8> kNumbers{"delete", "join", "cut",    "part",
                                                     "length", "line", "smooth", "resample"};
  if (std::ranges::find(kNumbers, step.key) != kNumbers.end()) {
    check_numbers(step);
  } else if (step.key == "keep" || step.key == "drop" || step.key == "crop") {
    (void)parse_region(step.value,
                       "--bundle: " + step_text(step) +
                           ": a region is mask:FILE, sphere:x,y,z,r, box:x,y,z,x,y,z, beyond:nx,ny,nz,d "
                           "or brush:r,x,y,z,…");
  } else if (step.key == "file") {
    if (step.value.empty()) refuse(step, "a file of tracts");
  } else if (step.key == "trace" || step.key == "also" || step.key == "all") {
    if (!step.value.empty()) refuse(step, "nothing behind '='");
  } else if (tracing_setting(step.key) != nullptr) {
    check_tracing(step);
  } else {
    return false;
  }
  return true;
}

/// Options end in trace=, which needs seeds; what also= opens, all= closes.
void check_order(const BundleText& bundle) {
  bool options = false, seeds = false;
  int open = 0;
  for (const BundleStep& step : bundle.steps) {
    const bool of_tracing = is_tracing(step);
    if (step.key == "trace" && !seeds) refuse(step, "seeds= before it");
    if (options && !of_tracing && step.key != "trace") refuse(step, "trace= before it");
    options = of_tracing;
    seeds = (seeds && of_tracing) || step.key == "seeds";
    open += step.key == "also" ? 1 : step.key == "all" ? -1 : 0;
    if (open < 0) refuse(step, "also= before it");
  }
  if (options || open > 0)
    throw usage_error("--bundle: " + std::string(options ? "trace=" : "all=") + " is expected at the end");
}

}  // namespace

bool is_tracing(const BundleStep& step) { return tracing_setting(step.key) != nullptr; }

BundleText parse_bundle(std::string_view text) {
  BundleText bundle;
  for (const std::string_view field : split(text, '|')) {
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos)
      throw usage_error("--bundle: '" + std::string(field) + "': NAME=VALUE is expected between '|'");
    BundleStep step{.key = std::string(trimmed(field.substr(0, equals))),
                    .value = std::string(field.substr(equals + 1))};
    if (step.key == "name") {
      bundle.name = step.value;
    } else if (step.key == "color") {
      if (step.value.empty() || (step.value.starts_with('#') && !color_of_text(step.value)))
        refuse(step, "direction, #rrggbb, or what slices show (fa, md)");
      bundle.color = step.value;
    } else if (step.key == "shown") {
      if (step.value != "on" && step.value != "off") refuse(step, "on or off");
      bundle.shown = step.value == "on";
    } else if (check(step)) {
      bundle.steps.push_back(std::move(step));
    } else {
      throw usage_error(
          "--bundle: '" + step.key +
          "' is no field: name, color, shown, file, line, trace and its options, delete, cut, part, join, "
          "smooth, resample, length, keep, drop, crop, also, all");
    }
  }
  check_order(bundle);
  return bundle;
}

std::string steps_text(std::span<const BundleStep> steps) {
  std::string text;
  for (const BundleStep& step : steps) {
    if (step.value.find_first_of(kReserved) != std::string::npos)
      throw usage_error("--bundle: " + step_text(step) + ": '|' and ';' stand between fields and bundles");
    text += (text.empty() ? "" : "|") + step_text(step);
  }
  return text;
}

std::string bundle_text(const BundleText& bundle) {
  std::vector<BundleStep> fields{{"name", bundle.name}, {"color", bundle.color}};
  if (!bundle.shown) fields.push_back({"shown", "off"});
  fields.insert(fields.end(), bundle.steps.begin(), bundle.steps.end());
  return steps_text(fields);
}

std::vector<BundleStep> steps_of(const TractTracingOptions& options) {
  Document document;
  document.tracts = options;
  std::vector<BundleStep> steps;
  for (const Setting& row : settings()) {
    if (tracing_setting(row.name) != &row || is_default(row, document)) continue;
    const std::string text = value_text(row, document);
    if (row.several()) {
      for (const std::string_view one : split(text, ';'))
        steps.push_back({std::string(row.name), std::string(one)});
    } else {
      steps.push_back({std::string(row.name), text});
    }
  }
  steps.push_back({"trace", ""});
  return steps;
}

TractTracingOptions tracing_of(std::span<const BundleStep> steps) {
  Document document;
  for (const BundleStep& step : steps) {
    const Setting& row = *tracing_setting(step.key);
    const std::string before = row.several() ? value_text(row, document) : std::string();
    set_value(row, document, before.empty() ? step.value : before + ';' + step.value);
  }
  return document.tracts;
}

bool takes_file(const std::vector<std::string>& texts, const std::filesystem::path& file) {
  const std::filesystem::path wanted = std::filesystem::weakly_canonical(file);
  return std::ranges::any_of(texts, [&](const std::string& text) {
    return std::ranges::any_of(parse_bundle(text).steps, [&](const BundleStep& step) {
      return step.key == "file" && std::filesystem::weakly_canonical(step.value) == wanted;
    });
  });
}

std::optional<Rgb> color_of_text(std::string_view text) {
  constexpr std::size_t kLength = 7;
  constexpr int kHex = 16;
  if (text.size() != kLength || text.front() != '#') return std::nullopt;
  std::uint32_t bits = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + kLength, bits, kHex);
  if (error != std::errc() || end != text.data() + kLength) return std::nullopt;
  const auto part = [bits](unsigned shift) { return static_cast<float>(bits >> shift & 255U) / 255.0F; };
  return Rgb{part(16U), part(8U), part(0U)};
}

std::string text_of_color(const Rgb& color) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "#";
  for (int i = 0; i < 3; ++i) {
    const auto part = static_cast<unsigned>(std::lround(255.0F * std::clamp(color[i], 0.0F, 1.0F)));
    text += kDigits[part >> 4U];
    text += kDigits[part & 15U];
  }
  return text;
}

std::string first_color(std::size_t i) {
  const auto category = static_cast<double>(i % kCategoryCount);
  return text_of_color(map_color(ColorMap::kCategorical, (category + 0.5) / kCategoryCount));
}

BundleText merged(const BundleText& a, const BundleText& b) {
  BundleText both = a;
  both.steps.push_back({"also", ""});
  both.steps.insert(both.steps.end(), b.steps.begin(), b.steps.end());
  both.steps.push_back({"all", ""});
  return both;
}

}  // namespace palpate
