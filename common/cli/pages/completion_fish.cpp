#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "common/cli/pages/option_view.h"
#include "common/cli/pages/pages.h"

namespace palpate {
namespace {

/// In single quotes, in which fish reads \\ and \'.
std::string fish_quoted(std::string_view text) {
  std::string safe = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') safe += '\\';
    safe += c;
  }
  return safe + "'";
}

/// " -l out -s o"
std::string spelled(const std::vector<std::string>& spellings) {
  std::string text;
  for (const std::string& spelling : spellings) {
    text += spelling.starts_with("--") ? " -l " + spelling.substr(2) : " -s " + spelling.substr(1);
  }
  return text;
}

/// What is proposed for the value.
std::string value(const OptionView& option) {
  std::string words;
  for (const std::string& word : option.words) words += (words.empty() ? "" : " ") + word;
  std::string text;
  if (option.proposal == Proposal::kText) text = " -x";
  if (option.proposal == Proposal::kFile) text = " -r -F";
  if (option.proposal == Proposal::kFolder) text = " -x -a '(__fish_complete_directories)'";
  return text + (words.empty() ? "" : " -a " + fish_quoted(words));
}

/// An option or operand and the verbs that take it.
struct FishLine {
  std::string text;
  std::string verbs;
};

void add(std::vector<FishLine>& lines, std::string text, const std::string& verb) {
  const auto known = std::ranges::find(lines, text, &FishLine::text);
  if (known == lines.end()) {
    lines.push_back({std::move(text), verb});
  } else {
    known->verbs += " " + verb;
  }
}

}  // namespace

std::string fish_completion(const Explorer& explorer) {
  const std::string name = installed_name(explorer), helper = "__palpate_" + explorer.name;
  std::string verbs, proposals;
  std::vector<FishLine> lines;
  for (const Verb& verb : explorer.verbs) {
    verbs += " " + verb.name;
    proposals += "    complete -c $program -n '" + helper + "_without_verb' -a " + verb.name + " -d " +
                 fish_quoted(verb.summary) + "\n";
    for (const OptionView& option : options_of(explorer, verb)) {
      std::string text;
      if (!option.operand()) {
        text = spelled(option.spellings) + value(option) + " -d " + fish_quoted(option.help);
      } else if (option.proposal == Proposal::kFile) {
        text = " -F";
      } else {
        text = value({.row = option.row, .proposal = option.proposal, .words = option.words}).substr(3);
      }
      add(lines, text, verb.name);
    }
  }
  std::string text = "# Completes " + name + " in fish; made by '" + explorer.name + " " +
                     std::string(kCompletionOption.spelling) + " fish'.\n";
  text += "# The verb that is typed, or the one that no verb stands for.\nfunction " + helper +
          "_verb\n  set -l words (commandline -opc)\n  for word in $words[2..-1]\n    if contains -- $word" +
          verbs + "\n      echo $word\n      return\n    end\n  end\n  echo " + explorer.default_verb +
          "\nend\n";
  text += "function " + helper + "_takes\n  contains -- (" + helper + "_verb) $argv\nend\n";
  text += "function " + helper +
          "_without_verb\n  test (count (commandline -opc)) -eq 1\nend\n"
          "for program in " +
          name + " " + explorer.name + "\n    complete -c $program -f\n";
  for (const ProgramOption& option : kProgramOptions) {
    std::vector<std::string> spellings{std::string(option.spelling)};
    if (!option.alias.empty()) spellings.emplace_back(option.alias);
    std::string words(option.value);
    std::ranges::replace(words, '|', ' ');
    text += "    complete -c $program" +
            (option.of_verbs ? std::string() : " -n '" + helper + "_without_verb'") + spelled(spellings) +
            (words.empty() ? "" : " -x -a " + fish_quoted(words)) + " -d " + fish_quoted(option.help) + "\n";
  }
  text += proposals;
  for (const FishLine& line : lines)
    text += "    complete -c $program -n '" + helper + "_takes " + line.verbs + "'" + line.text + "\n";
  return text + "end\n";
}

}  // namespace palpate
