#include "common/window/user_settings.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <utility>

#include <toml++/toml.h>

#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/files/user_folder.h"
#include "common/compose/appearance.h"
#include "common/scene/document/setting.h"

namespace palpate {
namespace {

constexpr int kSmallest = 200, kLargest = 20'000;  // [screen coordinates] of a window's edge

toml::table read_table(const std::filesystem::path& path, std::vector<std::string>& notes) {
  std::ifstream in(path);
  if (!in || std::filesystem::is_directory(path)) return {};
  std::ostringstream text;
  text << in.rdbuf();
  try {
    return toml::parse(text.str(), path.string());
  } catch (const toml::parse_error& error) {
    notes.push_back(path.string() + ": line " + std::to_string(error.source().begin.line) + ": " +
                    std::string(error.description()) + "; the defaults are used");
    return {};
  }
}

void read_edge(const toml::node_view<const toml::node>& node, int& edge) {
  const auto value = node.value<std::int64_t>();
  if (value && *value >= kSmallest && *value <= kLargest) edge = static_cast<int>(*value);
}

bool is_preference(const Setting& row, const Document& document) {
  return row.preferred && row.kinds.has(document.input.kind);
}

std::optional<InputFiles> read_input(const toml::node& node) {
  const toml::table* const table = node.as_table();
  const toml::array* const files = table != nullptr ? (*table)["files"].as_array() : nullptr;
  if (files == nullptr) return std::nullopt;
  InputFiles input;
  for (const toml::node& file : *files) {
    if (const auto name = file.value<std::string>()) input.files.emplace_back(*name);
  }
  if (const auto name = (*table)["solution"].value<std::string>()) input.solution = *name;
  if (const auto name = (*table)["series"].value<std::string>()) input.series = *name;
  return input.files.empty() ? std::nullopt : std::optional(input);
}

void write_table(const std::filesystem::path& path, const toml::table& table) {
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  if (error) throw work_error(path.parent_path().string() + ": cannot be made: " + error.message());
  std::ostringstream text;
  text << table << '\n';
  OutputFile file(path, true);
  file.write(text.str());
  file.finish();
}

toml::table settings_table(const UserSettings& settings) {
  toml::table appearance;
  for (const auto& [name, text] : settings.appearance) appearance.insert_or_assign(name, text);
  return toml::table{{"window", toml::table{{"width", settings.width}, {"height", settings.height}}},
                     {"appearance", std::move(appearance)}};
}

toml::table recent_table(const UserSettings& settings) {
  toml::array inputs;
  for (const InputFiles& input : settings.recent) {
    toml::array files;
    for (const auto& file : input.files) files.push_back(file.string());
    toml::table table{{"files", std::move(files)}};
    if (input.solution) table.insert("solution", input.solution->string());
    if (!input.series.empty()) table.insert("series", input.series);
    inputs.push_back(std::move(table));
  }
  return toml::table{{"input", std::move(inputs)}};
}

}  // namespace

void take_preferences(const Preferences& preferences, Document& document) {
  if (!document.common.session.empty()) return;
  for (const auto& [name, text] : preferences) {
    const auto known = [&document, &wanted = name](const Setting& row) {
      return is_preference(row, document) && row.name == wanted;
    };
    const auto row = std::ranges::find_if(settings(), known);
    if (row == settings().end() || std::ranges::find(document.given, name) != document.given.end()) continue;
    try {
      Document with = document;
      set_value(*row, with, text);
      SceneView unseen;
      apply_appearance(with, unseen);  // refuses what is no colour
      document = std::move(with);
    } catch (const Error&) {
      continue;
    }
  }
}

void note_preferences(const Document& before, const Document& after, Preferences& preferences) {
  for (const Setting& row : settings()) {
    if (!is_preference(row, after) || same_value(row, before, after)) continue;
    std::erase_if(preferences, [&](const auto& old) { return old.first == row.name; });
    if (!is_default(row, after)) preferences.emplace_back(row.name, value_text(row, after));
  }
}

void remember(std::vector<InputFiles>& recent, const InputFiles& input) {
  if (input.files.empty()) return;
  std::vector<InputFiles> now{input};
  for (InputFiles& old : recent) {
    if (now.size() < UserSettings::kMostRecent && !(old == input)) now.push_back(std::move(old));
  }
  recent = std::move(now);
}

std::optional<UserFiles> user_files(const std::string& program) {
  const auto config = user_folder("XDG_CONFIG_HOME", ".config");
  const auto state = user_folder("XDG_STATE_HOME", ".local/state");
  const auto cache = user_folder("XDG_CACHE_HOME", ".cache");
  if (!config || !state || !cache) return std::nullopt;
  return UserFiles{*config / "palpate" / (program + ".toml"), *state / "palpate" / (program + "-recent.toml"),
                   *cache / "palpate" / "thumbnails"};
}

UserSettings load_user_settings(const UserFiles& files, std::vector<std::string>& notes) {
  UserSettings settings;
  const toml::table table = read_table(files.settings, notes);
  read_edge(table["window"]["width"], settings.width);
  read_edge(table["window"]["height"], settings.height);
  if (const toml::table* appearance = table["appearance"].as_table()) {
    for (const auto& [name, value] : *appearance) {
      if (const auto text = value.value<std::string>()) settings.appearance.emplace_back(name.str(), *text);
    }
  }

  const toml::table recent = read_table(files.recent, notes);
  if (const toml::array* inputs = recent["input"].as_array()) {
    for (std::size_t i = inputs->size(); i-- > 0;) {
      if (const auto input = read_input((*inputs)[i])) remember(settings.recent, *input);
    }
  }
  return settings;
}

void save_user_settings(const UserFiles& files, const UserSettings& settings, const UserSettings& before) {
  const bool same_settings = settings.width == before.width && settings.height == before.height &&
                             settings.appearance == before.appearance;
  if (!same_settings) write_table(files.settings, settings_table(settings));
  if (settings.recent != before.recent) write_table(files.recent, recent_table(settings));
}

}  // namespace palpate
