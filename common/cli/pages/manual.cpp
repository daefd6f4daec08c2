#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/version.h"
#include "common/cli/pages/option_view.h"
#include "common/cli/pages/pages.h"

namespace palpate {
namespace {

/// Text as troff shows it unchanged. @param typed what is typed or copied: no sign may become a typographic one.
std::string escaped(std::string_view text, bool typed = false) {
  std::string safe;
  for (const char c : text) {
    const bool starts_line = safe.empty() || safe.back() == '\n';
    if (starts_line && (c == '.' || c == '\'')) safe += "\\&";  // or it would be a request
    switch (c) {
      case '\\':
        safe += "\\e";
        break;
      case '^':
        safe += "\\(ha";
        break;
      case '~':
        safe += "\\(ti";
        break;
      case '`':
        safe += "\\(ga";
        break;
      case '-':
        safe += typed ? "\\-" : "-";
        break;
      case '\'':
        safe += typed ? "\\(aq" : "'";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string bold(std::string_view text) { return "\\fB" + escaped(text, true) + "\\fR"; }

std::string sentence(std::string_view text) {
  std::string whole(text);
  if (!whole.empty() && whole.back() != '.' && whole.back() != '?') whole += '.';
  return whole;
}

/// A command of the examples, which begin with the program's short name.
std::string installed_command(const Explorer& explorer, std::string_view command) {
  const bool named = command == explorer.name || command.starts_with(explorer.name + " ");
  return (named ? installed_name(explorer) : explorer.name) +
         std::string(named ? command.substr(explorer.name.size()) : " " + std::string(command));
}

std::string term(std::string_view tag, std::string_view text) {
  return ".TP\n" + std::string(tag) + "\n" + escaped(text) + "\n";
}

std::string option_tag(const OptionView& option) {
  std::string tag;
  for (const std::string& spelling : option.spellings) tag += (tag.empty() ? "" : ", ") + bold(spelling);
  if (option.proposal != Proposal::kNone && !option.operand())
    tag += " \\fI" + escaped(option.row->value_name(), true) + "\\fR";
  return tag;
}

/// An option and the verbs that take it.
struct Listed {
  OptionView option;
  std::vector<std::string> verbs;
};

std::vector<Listed> listed(const Explorer& explorer) {
  std::vector<Listed> all;
  for (const Verb& verb : explorer.verbs) {
    for (OptionView& option : options_of(explorer, verb)) {
      const auto known = std::ranges::find_if(all, [&](const Listed& entry) {
        return entry.option.row == option.row && entry.option.spellings == option.spellings;
      });
      if (known == all.end()) {
        all.push_back({std::move(option), {verb.name}});
      } else {
        known->verbs.push_back(verb.name);
      }
    }
  }
  // In the order of the tables, which is that of the help.
  std::ranges::stable_sort(all, {}, [](const Listed& entry) { return entry.option.row; });
  return all;
}

std::string option_entry(const Explorer& explorer, const Listed& entry) {
  std::string text = sentence(entry.option.help);
  if (!entry.option.words.empty() && entry.option.row->words.empty()) {
    std::string words;
    for (const std::string& word : entry.option.words) words += (words.empty() ? "" : ", ") + word;
    text += " Words: " + words + ".";
  }
  if (entry.verbs.size() != explorer.verbs.size()) {
    std::string verbs;
    for (const std::string& verb : entry.verbs) verbs += (verbs.empty() ? "" : ", ") + verb;
    text += (entry.verbs.size() == 1 ? " Verb: " : " Verbs: ") + verbs + ".";
  }
  return term(option_tag(entry.option), text);
}

std::string options_section(const Explorer& explorer) {
  const std::vector<Listed> all = listed(explorer);
  std::string text = ".SH OPTIONS\n";
  for (const ProgramOption& option : kProgramOptions) {
    std::string tag = bold(option.spelling);
    if (!option.alias.empty()) tag += ", " + bold(option.alias);
    if (!option.value.empty()) tag += " \\fI" + escaped(option.value, true) + "\\fR";
    text += term(tag, sentence(option.help));
  }
  std::vector<std::string_view> headings;
  for (const Listed& entry : all) {
    if (std::ranges::find(headings, entry.option.row->heading) == headings.end())
      headings.push_back(entry.option.row->heading);
  }
  for (const std::string_view heading : headings) {
    text += ".SS " + escaped(heading) + "\n";
    for (const Listed& entry : all) {
      if (entry.option.row->heading == heading) text += option_entry(explorer, entry);
    }
  }
  return text;
}

std::string verbs_section(const Explorer& explorer) {
  std::string text = ".SH VERBS\n";
  for (const Verb& verb : explorer.verbs) {
    text += term(bold(verb.name) + escaped(operands_text(explorer, verb), true), sentence(verb.summary));
    if (!verb.details.empty()) text += ".IP\n.nf\n" + escaped(verb.details) + "\n.fi\n";
  }
  return text;
}

std::string examples_section(const Explorer& explorer) {
  std::string text = ".SH EXAMPLES\n";
  const auto add = [&](const std::vector<UsageExample>& examples) {
    for (const UsageExample& example : examples)
      text += term(bold(installed_command(explorer, example.command)), sentence(example.what));
  };
  add(explorer.examples);
  for (const Verb& verb : explorer.verbs) add(verb.examples);
  return text;
}

constexpr std::string_view kExitStatus =
    ".SH EXIT STATUS\n.TP\n0\nDone.\n.TP\n1\nThe work failed, or an output could not be written.\n"
    ".TP\n2\nBad usage.\n.TP\n3\nAn input file is missing or broken.\n.TP\n130\nInterrupted.\n";

}  // namespace

std::string manual_page(const Explorer& explorer) {
  const std::string name = installed_name(explorer);
  std::string title = name;
  std::ranges::transform(title, title.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const Verb* usual = find_verb(explorer, explorer.default_verb);
  const std::string operands = usual ? operands_text(explorer, *usual) : "";

  std::string text = ".\\\" Made by '" + explorer.name + " " + std::string(kManualOption.spelling) + "'.\n";
  text += ".TH " + escaped(title, true) + " 1 \"\" \"Palpate " + version() + "\" \"Palpate\"\n";
  text += ".SH NAME\n" + escaped(name, true) + " \\- " + escaped(explorer.summary) + "\n";
  text +=
      ".SH SYNOPSIS\n" + bold(name) + " [\\fIVERB\\fR]" + escaped(operands, true) + " [\\fIoptions\\fR]\n";
  text += ".SH DESCRIPTION\n" + escaped(sentence(explorer.summary)) + "\nWhere no verb is named, " +
          bold(explorer.default_verb) + " is meant. " + bold(name + " VERB --help") +
          " lists the options of a verb.\n";
  return text + verbs_section(explorer) + options_section(explorer) + std::string(kExitStatus) +
         examples_section(explorer) + ".SH SEE ALSO\n\\fBpalpate\\fR(1)\n";
}

}  // namespace palpate
