#include <string>
#include <string_view>
#include <vector>

#include "common/cli/pages/option_view.h"
#include "common/cli/pages/pages.h"

namespace palpate {
namespace {

/// Within single quotes, with what _arguments and _describe read as signs taken literally.
std::string plain(std::string_view text, std::string_view signs) {
  std::string safe;
  for (const char c : text) {
    if (c == '\'') {
      safe += "'\\''";
      continue;
    }
    if (c == '\\' || signs.find(c) != std::string_view::npos) safe += '\\';
    safe += c;
  }
  return safe;
}

/// ":WHAT:ACTION" of a value.
std::string action(const OptionView& option) {
  std::string words;
  for (const std::string& word : option.words) words += (words.empty() ? "" : " ") + word;
  const std::string what = ":" + plain(option.row->value_name(), ":[]");
  const bool names = option.proposal == Proposal::kFile || option.proposal == Proposal::kFolder;
  const std::string files = option.proposal == Proposal::kFolder ? "_files -/" : "_files";
  if (names && !words.empty()) {
    return what + ":_alternative \"words:word:(" + words + ")\" \"names:name:" + files + "\"";
  }
  if (names) return what + ":" + files;
  return what + ":" + (words.empty() ? " " : "(" + words + ")");
}

/// An argument of _arguments.
std::string argument(const OptionView& option) {
  if (option.operand()) return "'" + std::string(option.row->several() ? "*" : "") + action(option) + "'";
  const std::string several = option.row->several() ? "*" : "";
  const std::string help = "[" + plain(option.help, "[]:") + "]";
  const std::string value = option.proposal == Proposal::kNone ? "" : action(option);
  std::string text;
  for (const std::string& spelling : option.spellings) {
    const bool valued = !value.empty() && spelling.starts_with("--");
    text += (text.empty() ? "'" : " '") + several + spelling + (valued ? "=" : "") + help + value + "'";
  }
  return text;
}

}  // namespace

std::string zsh_completion(const Explorer& explorer) {
  const std::string name = "_" + installed_name(explorer);
  std::string verbs, pattern, cases;
  for (const Verb& verb : explorer.verbs) {
    verbs += "    '" + verb.name + ":" + plain(verb.summary, ":") + "'\n";
    pattern += (pattern.empty() ? "" : "|") + verb.name;
    cases += "    (" + verb.name + ")\n      _arguments -s";
    for (const ProgramOption& option : kProgramOptions) {
      if (!option.of_verbs) continue;
      cases += " '" + std::string(option.spelling) + "[" + plain(option.help, "[]:") + "]'";
    }
    for (const OptionView& option : options_of(explorer, verb)) cases += " \\\n        " + argument(option);
    cases += "\n      ;;\n";
  }
  std::string own;
  for (const ProgramOption& option : kProgramOptions) {
    if (option.of_verbs) continue;
    own += "    '" + std::string(option.spelling) + ":" + plain(option.help, ":") + "'\n";
  }

  std::string text = "#compdef " + installed_name(explorer) + "\n# Completes " + installed_name(explorer) +
                     " in zsh; made by '" + explorer.name + " " + std::string(kCompletionOption.spelling) +
                     " zsh'.\n";
  text += name + "() {\n  local -a verbs own\n  verbs=(\n" + verbs + "  )\n  own=(\n" + own + "  )\n";
  text += "  local -i at=${words[(i)(" + pattern + ")]}\n  local verb=" + explorer.default_verb +
          "\n"
          "  if (( at < CURRENT )); then\n"
          "    verb=${words[at]}\n"
          "    words[at]=()\n"
          "    (( CURRENT -= 1 ))\n"
          "  elif (( CURRENT == 2 )); then\n"
          "    [[ $PREFIX == -* ]] || _describe verb verbs\n"
          "    [[ $PREFIX == -* ]] && _describe -o option own\n"
          "  elif [[ $words[CURRENT-1] == " +
          std::string(kCompletionOption.spelling) +
          " ]]; then\n"
          "    compadd bash zsh fish\n"
          "    return\n"
          "  fi\n"
          "  case $verb in\n" +
          cases + "  esac\n}\n";
  return text + "if [[ $funcstack[1] == " + name + " ]]; then\n  " + name + " \"$@\"\nelse\n  compdef " +
         name + " " + installed_name(explorer) + " " + explorer.name + "\nfi\n";
}

}  // namespace palpate
