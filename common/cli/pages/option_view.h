/// The options of a program's verbs, as its help, manual page and completions show them: made from the tables of
/// settings, so that none of these spells one of its own.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/cli/explorer.h"
#include "common/scene/document/setting.h"

namespace palpate {

/// What a shell may propose for the value of an option, besides its words.
enum class Proposal : std::uint8_t {
  kNone,    ///< there is no value: a flag
  kText,    ///< nothing: a number, a name, coordinates
  kFile,    ///< names of files
  kFolder,  ///< names of folders
};

/// An option, or an operand, of a verb.
struct OptionView {
  const Setting* row = nullptr;
  std::vector<std::string> spellings;  ///< "--out", "-o"; of an operand "FILE"
  std::string help;                    ///< with range and default
  Proposal proposal = Proposal::kNone;
  std::vector<std::string> words;  ///< that the value may be

  [[nodiscard]] bool operand() const noexcept { return row->spelling == Spelling::kPositional; }
};

/// What a program answers itself, whatever verb is named.
struct ProgramOption {
  std::string_view spelling;
  std::string_view alias;  ///< "-h", or none
  std::string_view value;  ///< "bash|zsh|fish", or none
  std::string_view help;
  bool of_verbs = false;  ///< verbs take it, too
};
inline constexpr ProgramOption kHelpOption{"--help", "-h", "", "print this help", true};
inline constexpr ProgramOption kVersionOption{"--version", "", "", "print name and version", true};
inline constexpr ProgramOption kManualOption{"--manual", "", "", "print the manual page, for 'man -l -'"};
inline constexpr ProgramOption kCompletionOption{"--completion", "", "bash|zsh|fish",
                                                 "print what completes command lines in that shell"};
inline constexpr std::array kProgramOptions{kHelpOption, kVersionOption, kManualOption, kCompletionOption};

/// The name under which a program is installed: "palpate-flow".
[[nodiscard]] std::string installed_name(const Explorer& explorer);
[[nodiscard]] const Verb* find_verb(const Explorer& explorer, std::string_view name);
/// What `verb` takes, with what all take.
[[nodiscard]] Groups groups_of(const Verb& verb);
/// The options of a verb in the order of the help; a setting each word of which is a flag gives one for each.
[[nodiscard]] std::vector<OptionView> options_of(const Explorer& explorer, const Verb& verb);
/// " FILE... | --example NAME"
[[nodiscard]] std::string operands_text(const Explorer& explorer, const Verb& verb);

}  // namespace palpate
