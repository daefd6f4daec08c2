/// The command line: which verb is meant, and the document that its options and a session make. The only user
/// of CLI11 among the explorers; what an option is called and takes stands in the tables of settings
/// (scene/document/setting.h).
#pragma once

#include <string>
#include <vector>

#include "common/cli/explorer.h"
#include "common/scene/document/document.h"

namespace palpate {

struct ParsedCommand {
  const Verb* verb = nullptr;  ///< null: `text` is to be printed and that is all (--help, --version)
  Document options;
  std::string text;
  std::vector<std::string> notes;  ///< what of a session was left out
};

/// Reads `arguments` (without the program's name). Where no verb is named, explorer.default_verb is meant.
/// Options that were typed win over those of the session that `--session` names.
/// @throws Error (usage), (bad input) for a session file.
[[nodiscard]] ParsedCommand parse_command_line(const Explorer& explorer,
                                               const std::vector<std::string>& arguments);

}  // namespace palpate
