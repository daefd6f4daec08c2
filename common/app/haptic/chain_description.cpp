#include "common/app/haptic/chain_description.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/servo/recording.h"

namespace palpate {
namespace {

constexpr std::string_view kFieldKey = " field=";
/// In the order of settings_fields().
constexpr std::array<std::string_view, 6> kSettingNames{"stiffness", "release", "drag",
                                                        "tick",      "kappa",   "speed"};

[[noreturn]] void refuse(const std::string& description, const std::string& what) {
  throw Error(ExitCode::kBadInput, "the recording's chain '" + description + "': " + what);
}

double number_of(const std::string& description, std::string_view name) {
  const std::string key = " " + std::string(name) + "=";
  const std::size_t at = description.find(key);
  double value = 0.0;
  if (at != std::string::npos) {
    const char* const begin = description.data() + at + key.size();
    const char* const end = description.data() + description.size();
    const auto parsed = std::from_chars(begin, end, value);
    if (parsed.ec == std::errc() && (parsed.ptr == end || *parsed.ptr == ' ')) return value;
  }
  refuse(description, "it lacks a number " + std::string(name) + "=");
}

}  // namespace

std::string field_key(const std::string& label, std::size_t time_step) {
  return label + " step " + std::to_string(time_step);
}

std::string describe_chain(const std::string& mode, double workspace_scale, const ChainSettings& settings,
                           const std::string& field_name) {
  std::string text = mode + " scale=" + exact_number(workspace_scale);
  const auto fields = settings_fields(settings);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    ((text += ' ').append(kSettingNames[i]) += '=') += exact_number(*fields[i]);
  }
  return text.append(kFieldKey) + field_name;
}

DescribedChain parse_chain(const std::string& description) {
  const std::size_t name_at = description.find(kFieldKey);
  if (name_at == std::string::npos) refuse(description, "it names no field");
  DescribedChain chain;
  chain.mode = description.substr(0, description.find(' '));
  chain.field_name = description.substr(name_at + kFieldKey.size());
  chain.workspace_scale = number_of(description, "scale");
  const auto fields = settings_fields(chain.settings);
  for (std::size_t i = 0; i < fields.size(); ++i) *fields[i] = number_of(description, kSettingNames[i]);
  const bool usable =
      chain.settings.valid() && chain.workspace_scale > 0.0 && std::isfinite(chain.workspace_scale);
  if (!usable) refuse(description, "its numbers make no chain");
  return chain;
}

HapticChain build_chain(const std::string& description, std::span<const HapticMode> modes,
                        const NamedField& open, int threads) {
  const DescribedChain chain = parse_chain(description);
  if (chain.field_name != open.name) {
    refuse(description, "it was recorded on field '" + chain.field_name + "', open is '" + open.name +
                            "'; give --field and --time as in the recording");
  }
  const auto mode = std::find_if(modes.begin(), modes.end(),
                                 [&](const HapticMode& each) { return each.name == chain.mode; });
  if (mode == modes.end()) refuse(description, "there is no mode '" + chain.mode + "'");
  return mode->make(
      {open.field, Workspace(chain.workspace_scale, open.field->frame()), chain.settings, threads});
}

}  // namespace palpate
