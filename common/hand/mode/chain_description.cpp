#include "common/hand/mode/chain_description.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/haptics/settings_text.h"
#include "common/haptics/widget/dial_chain.h"

namespace palpate {
namespace {

constexpr std::string_view kScaleKey = " scale=", kFixturesKey = " fixtures=", kFieldKey = " field=";

[[noreturn]] void refuse(const std::string& description, const std::string& what) {
  throw Error(ExitCode::kBadInput, "the recording's chain '" + description + "': " + what);
}

}  // namespace

std::string field_key(const std::string& label, std::size_t time_step) {
  return label + " step " + std::to_string(time_step);
}

std::string describe_chain(const std::string& mode, double workspace_scale, const ChainSettings& settings,
                           const std::string& field_name, const FixtureList& fixtures) {
  std::string text = mode;
  text.append(kScaleKey) += exact_number(workspace_scale);
  if (!fixtures.empty()) text.append(kFixturesKey) += fixture_word(fixtures);
  text += " " + settings_text(settings);
  return text.append(kFieldKey) + field_name;
}

DescribedChain parse_chain(const std::string& description) {
  const std::size_t name_at = description.find(kFieldKey);
  if (name_at == std::string::npos) refuse(description, "it names no field");
  DescribedChain chain;
  chain.mode = description.substr(0, description.find(' '));
  chain.field_name = description.substr(name_at + kFieldKey.size());

  std::string_view rest =
      std::string_view(description).substr(chain.mode.size(), name_at - chain.mode.size());
  if (!rest.starts_with(kScaleKey)) refuse(description, "it lacks a scale");
  rest.remove_prefix(kScaleKey.size());
  const auto scale = std::from_chars(rest.data(), rest.data() + rest.size(), chain.workspace_scale);
  if (scale.ec != std::errc() || !(chain.workspace_scale > 0.0) || !std::isfinite(chain.workspace_scale)) {
    refuse(description, "its scale is no number above zero");
  }
  rest.remove_prefix(as_size(scale.ptr - rest.data()));
  if (rest.starts_with(kFixturesKey)) {
    rest.remove_prefix(kFixturesKey.size());
    chain.fixtures = rest.substr(0, rest.find(' '));
    rest.remove_prefix(chain.fixtures.size());
  }
  if (!rest.starts_with(' ')) refuse(description, "it lacks settings");
  if (const auto problem = read_settings(rest.substr(1), chain.settings)) refuse(description, *problem);
  return chain;
}

HapticChain build_chain(const std::string& description, std::span<const HapticMode> modes,
                        const NamedField& open, int threads, FixtureStore* store) {
  const DescribedChain chain = parse_chain(description);
  if (chain.field_name != open.name) {
    refuse(description, "it was recorded on field '" + chain.field_name + "', open is '" + open.name +
                            "'; give --field and --time as in the recording");
  }
  const Workspace workspace(chain.workspace_scale, open.frame());
  if (names_dial(chain.mode)) {
    Dial dial;
    if (const auto problem = read_text(chain.mode, dial)) refuse(description, *problem);
    HapticChain made;
    made.chain = make_dial_chain(dial, chain.settings);
    return made;
  }
  const auto mode = std::find_if(modes.begin(), modes.end(),
                                 [&](const HapticMode& each) { return each.name == chain.mode; });
  if (mode == modes.end()) refuse(description, "there is no mode '" + chain.mode + "'");
  FixtureStore fresh;
  HapticScene scene{open.field, workspace, chain.settings, threads, open.scalar, open.tensor, open.noise};
  if (!chain.fixtures.empty())
    scene.fixtures = fixtures_of_word(chain.fixtures, store != nullptr ? *store : fresh);
  return make_chain(*mode, scene);
}

}  // namespace palpate
