/// Documents as sessions, and back.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/scene/document/document.h"
#include "common/scene/document/setting.h"
#include "common/scene/session.h"

namespace palpate {

/// The settings that sessions keep and that differ from their defaults, by name. Files that they name are
/// named by their full paths.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> saved_settings(const Document& document);

/// The inputs and drawn lines of `document` and what saved_settings() gives. @throws Error (bad input) where a
/// file cannot be read.
[[nodiscard]] Session session_of(const Document& document, const std::string& program);

/// What names of session files end with.
inline constexpr std::string_view kSessionEnding = ".palpate.toml";

/// Whether a file is to be opened as a session, by its name: no file of data ends with ".toml".
[[nodiscard]] bool is_session(const std::filesystem::path& file);

/// The name proposed for the session of `document`, without a folder: after its first input, or its example.
[[nodiscard]] std::string session_name(const Document& document, const std::string& program);

/// The file of drawn lines that goes with a session, beside it: "carotid.palpate.lines.csv".
[[nodiscard]] std::filesystem::path lines_of_session(std::filesystem::path session);

/// Takes the settings of `session` into `document`, for programs of `kind`.
/// @param file of the session, for messages. @param notes gets a sentence on each thing that was left out of a
/// newer session.
/// @return what was taken.
/// @throws Error (bad input) for a setting that is not known, with the one that is most like it; (usage) for
/// a value that a setting does not take.
std::vector<const Setting*> take_settings(const Session& session, FieldKind kind,
                                          const std::filesystem::path& file, Document& document,
                                          std::vector<std::string>& notes);

/// Takes the input files of `session` into `document`.
void take_inputs(const Session& session, Document& document);

/// Takes its drawn lines. @param notes gets a sentence where their file has changed; one that is missing is told
/// where it is read.
void take_drawn_lines(const Session& session, Document& document, std::vector<std::string>& notes);

}  // namespace palpate
