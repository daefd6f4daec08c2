/// The command line's spelling: which option is called what, and the help texts. With touch_command_line.h,
/// the only user of CLI11.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/cli/explorer.h"
#include "common/scene/options.h"

namespace palpate {

struct ParsedCommand {
  const Verb* verb = nullptr;  ///< null: `text` is to be printed and that is all (--help, --version)
  Options options;
  std::string text;
};

/// Reads `arguments` (without the program's name). Where no verb is named, explorer.default_verb is meant. A
/// session named by `--session` stands in front of what was typed, so typed options win.
/// @throws Error (usage), (bad input) for a session file.
[[nodiscard]] ParsedCommand parse_command_line(const Explorer& explorer,
                                               const std::vector<std::string>& arguments);

}  // namespace palpate
