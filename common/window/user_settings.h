/// What a user finds again the next time: how the window looks, and what was open lately.
///
///   $XDG_CONFIG_HOME/palpate/flow.toml         size of the window and preferences; made to be edited
///   $XDG_STATE_HOME/palpate/flow-recent.toml   inputs, the newest first
///   $XDG_CACHE_HOME/palpate/thumbnails         small pictures of inputs, which may be deleted at any time
///
/// where an unset variable means ~/.config, ~/.local/state and ~/.cache (XDG Base Directory Specification 0.8). Preferences
/// are settings (Setting::preferred) in the grammar of sessions. What the command line says wins, and so does a
/// session, also in what it leaves at the default.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/compose/window_model.h"
#include "common/scene/document/document.h"

namespace palpate {

/// Names of preferred settings, and their values as text.
using Preferences = std::vector<std::pair<std::string, std::string>>;

/// Takes them into `document` where nothing else was asked for. What a setting does not take is left out.
void take_preferences(const Preferences& preferences, Document& document);
/// What a user has changed between `before` and `after` is preferred from now on.
void note_preferences(const Document& before, const Document& after, Preferences& preferences);

struct UserSettings {
  static constexpr std::size_t kMostRecent = 10;

  int width = 1440, height = 900;  ///< [screen coordinates]
  Preferences appearance;
  std::vector<InputFiles> recent;  ///< newest first, each once

  bool operator==(const UserSettings&) const = default;
};

/// Puts `input` first; the oldest ones beyond UserSettings::kMostRecent are forgotten. Examples are not kept.
void remember(std::vector<InputFiles>& recent, const InputFiles& input);

/// Where a program keeps them.
struct UserFiles {
  std::filesystem::path settings;
  std::filesystem::path recent;
  std::filesystem::path thumbnails;  ///< a folder that all programs share
};
/// None where neither the variables nor HOME name an absolute folder.
[[nodiscard]] std::optional<UserFiles> user_files(const std::string& program);

/// What the files say, and the defaults for what they do not: a missing file, a wrong type or a size that no
/// window has is no error. A file that is no TOML is named in `notes`.
[[nodiscard]] UserSettings load_user_settings(const UserFiles& files, std::vector<std::string>& notes);

/// Writes the file whose part differs from `before`, making its folder where there is none.
/// @throws Error (work failed).
void save_user_settings(const UserFiles& files, const UserSettings& settings, const UserSettings& before);

}  // namespace palpate
