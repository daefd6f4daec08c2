#include "tests/docs/command_blocks.h"

#include <array>
#include <sstream>
#include <stdexcept>

namespace palpate::test {
namespace {

bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

std::string without_ends(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t") + 1 - first));
}

/// Up to a `#` that begins a word. The commands of the pages quote none.
std::string without_comment(const std::string& line) {
  if (starts_with(line, "#")) return {};
  return without_ends(line.substr(0, line.find(" #")));
}

[[noreturn]] void refuse(int line, const std::string& why) {
  throw std::runtime_error("line " + std::to_string(line) + ": " + why);
}

}  // namespace

std::vector<PrintedCommand> printed_commands(std::string_view page) {
  constexpr std::array<std::string_view, 4> kNeeds{"", "data", "window", "device"};
  std::vector<PrintedCommand> commands;
  std::istringstream lines{std::string(page)};
  std::string line;
  std::string needs;
  bool in_block = false;
  bool in_shell = false;
  bool continued = false;
  int opened = 0;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (starts_with(line, "```")) {
      if (!in_block) {
        in_shell = line == "```sh" || starts_with(line, "```sh ");
        needs = in_shell ? without_ends(line.substr(5)) : "";
        bool known = false;
        for (const std::string_view word : kNeeds) known = known || needs == word;
        if (!known) refuse(number, "a block of the shell needs data, window or device, not '" + needs + "'");
        opened = number;
      }
      in_block = !in_block;
      continued = false;
      continue;
    }
    if (!in_block && starts_with(line, "    ./")) refuse(number, "commands stand in ```sh blocks");
    if (!in_block || !in_shell) continue;

    std::string text = without_comment(line);
    const bool goes_on = !text.empty() && text.back() == '\\';
    if (goes_on) text = without_ends(text.substr(0, text.size() - 1));
    if (continued) {
      commands.back().text += " " + text;
    } else if (!text.empty()) {
      commands.push_back({number, needs, text});
    }
    continued = goes_on;
  }
  if (in_block) refuse(opened, "the block does not end");
  return commands;
}

}  // namespace palpate::test
