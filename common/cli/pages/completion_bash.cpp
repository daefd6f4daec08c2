#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/cli/pages/option_view.h"
#include "common/cli/pages/pages.h"

namespace palpate {
namespace {

/// In single quotes of the shell.
std::string shell_quoted(std::string_view text) {
  std::string safe = "'";
  for (const char c : text) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return safe + "'";
}

/// What stands for the value: its words, and how names of files are proposed.
std::string value_commands(const OptionView& option) {
  std::string text;
  if (!option.words.empty()) text = "words=" + shell_quoted(joined(option.words, " ")) + " ";
  if (option.proposal == Proposal::kFile) text += "names=file ";
  if (option.proposal == Proposal::kFolder) text += "names=directory ";
  return text.empty() ? ":" : text.substr(0, text.size() - 1);
}

/// `case` branches of what verbs and options lead to, those that lead to the same in one.
std::string branches(const std::map<std::string, std::vector<std::string>>& patterns_of) {
  std::string text;
  for (const auto& [commands, patterns] : patterns_of) {
    text += "    ";
    for (std::size_t p = 0; p < patterns.size(); ++p) text += (p == 0 ? "" : " | ") + patterns[p];
    text += ") " + commands + " ;;\n";
  }
  return text;
}

/// All that is not said of a single program.
constexpr std::string_view kBody = R"(
  COMPREPLY=()
  local word cur=${COMP_WORDS[COMP_CWORD]} verb= option= words= names= i
  local -i operand=0
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    if [[ $word == = ]]; then
      :
    elif [[ $word == : || ${COMP_WORDS[i - 1]} == : ]]; then
      option=
    elif [[ -n $option ]]; then
      option=
    elif [[ $word == -* ]]; then
      NAME_value "$word" && option=$word
    elif [[ -z $verb && $operand == 0 && " $verbs " == *" $word "* ]]; then
      verb=$word
    else
      operand+=1
    fi
    words= names=
  done
  [[ $cur == = ]] && cur=
  if [[ $cur == : || ${COMP_WORDS[COMP_CWORD - 1]} == : ]]; then
    cur=${cur#:} names=file
  elif [[ -n $option ]]; then
    NAME_value "$option"
  elif [[ $cur == -* ]]; then
    NAME_options
  else
    NAME_operand "$operand"
    [[ -z $verb && $operand == 0 ]] && words="$verbs $words"
  fi
  mapfile -t COMPREPLY < <(
    compgen -W "$words" -- "$cur"
    [[ -n $names ]] && compgen -A "$names" -- "$cur"
  )
  [[ -n $names ]] && compopt -o filenames 2>/dev/null
  return 0
}
)";

std::string with_name(std::string_view text, const std::string& name) {
  std::string whole(text);
  for (std::size_t at = 0; (at = whole.find("NAME_", at)) != std::string::npos; at += name.size())
    whole.replace(at, 4, name);
  return whole;
}

}  // namespace

std::string bash_completion(const Explorer& explorer) {
  const std::string name = "_palpate_" + explorer.name;
  std::string verbs, options;
  std::map<std::string, std::map<std::string, std::vector<std::string>>>
      value_of;  // spelling, commands, verbs
  std::map<std::string, std::vector<std::string>> operands;
  for (const Verb& verb : explorer.verbs) {
    verbs += (verbs.empty() ? "" : " ") + verb.name;
    std::vector<std::string> spelled{"--help", "--version"};
    int operand = 0;
    for (const OptionView& option : options_of(explorer, verb)) {
      if (option.operand()) {
        const std::string place = option.row->several() ? "*" : std::to_string(operand);
        operands[value_commands(option)].push_back(verb.name + "," + place);
        ++operand;
        continue;
      }
      for (const std::string& spelling : option.spellings) {
        spelled.push_back(spelling);
        if (option.proposal != Proposal::kNone)
          value_of[spelling][value_commands(option)].push_back(verb.name);
      }
    }
    options += "    " + verb.name + ") words=" + shell_quoted(joined(spelled, " ")) + " ;;\n";
  }
  // An option that takes the same in all verbs that have it is one pattern.
  std::map<std::string, std::vector<std::string>> values;
  for (const auto& [spelling, commands_of] : value_of) {
    for (const auto& [commands, of_verbs] : commands_of) {
      if (commands_of.size() == 1) {
        values[commands].push_back("*," + spelling);
      } else {
        for (const std::string& verb : of_verbs) values[commands].push_back(verb + "," + spelling);
      }
    }
  }
  std::string own;
  for (const ProgramOption& option : kProgramOptions) {
    if (option.of_verbs) continue;
    own += " " + std::string(option.spelling);
    if (option.value.empty()) continue;
    std::string words(option.value);
    for (char& c : words) c = c == '|' ? ' ' : c;
    values["words=" + shell_quoted(words)].push_back("*," + std::string(option.spelling));
  }

  const std::string verb_or_usual = "${verb:-" + explorer.default_verb + "}";
  std::string text = "# Completes " + installed_name(explorer) + " in bash; made by '" + explorer.name + " " +
                     std::string(kCompletionOption.spelling) + " bash'.\n";
  text += "# Whether an option takes a value, and which.\n" + name + "_value() {\n  case " + verb_or_usual +
          ",$1 in\n" + branches(values) + "    *) return 1 ;;\n  esac\n}\n";
  text += "# The options of the verb.\n" + name + "_options() {\n  case " + verb_or_usual + " in\n" +
          options + "  esac\n  [[ -z $verb ]] && words+=" + shell_quoted(own) + "\n}\n";
  text += "# What stands at a place among the words without dashes.\n" + name + "_operand() {\n  case " +
          verb_or_usual + ",$1 in\n" + branches(operands) + "  esac\n}\n";
  text += name + "() {\n  local verbs=" + shell_quoted(verbs) + with_name(kBody, name);
  return text + "complete -F " + name + " " + installed_name(explorer) + " " + explorer.name + "\n";
}

std::string completion(const Explorer& explorer, std::string_view shell) {
  if (shell == "bash") return bash_completion(explorer);
  if (shell == "zsh") return zsh_completion(explorer);
  if (shell == "fish") return fish_completion(explorer);
  throw usage_error("--completion " + std::string(shell) + ": bash, zsh, fish are known");
}

}  // namespace palpate
