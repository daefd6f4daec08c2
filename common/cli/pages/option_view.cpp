#include "common/cli/pages/option_view.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <variant>

#include "common/base/text.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/scene/input.h"

namespace palpate {
namespace {

bool names_a_path(const Setting& row) {
  using Path = std::filesystem::path;
  return row.file || std::holds_alternative<ValueAt<Path>>(row.place) ||
         std::holds_alternative<ValueAt<std::optional<Path>>>(row.place) ||
         std::holds_alternative<ValueAt<std::vector<Path>>>(row.place);
}

/// Of "first|last|T" the words that are typed as they stand: those in small letters.
std::vector<std::string> plain_words(std::string_view value) {
  std::vector<std::string> words;
  const std::vector<std::string_view> parts = split(value, '|');
  if (parts.size() < 2) return words;
  for (const std::string_view part : parts) {
    const bool plain = std::ranges::all_of(part, [](unsigned char c) { return std::islower(c) || c == '-'; });
    if (plain && part.size() > 1) words.emplace_back(part);
  }
  return words;
}

std::vector<std::string> words_of(const Explorer& explorer, const Setting& row) {
  std::vector<std::string> words;
  if (row.name == "example") {
    for (const ExampleInfo& example : examples_of(explorer.kind)) words.push_back(example.name);
    words.emplace_back("list");
  } else if (row.name == "mode" && row.words.empty()) {
    for (const HapticMode& mode : modes_of(explorer.kind)) words.push_back(mode.name);
  } else if (!row.words.empty()) {
    for (const std::string_view word : row.word_list()) words.emplace_back(word);
  } else {
    words = plain_words(row.value);
  }
  return words;
}

OptionView view_of(const Explorer& explorer, const Setting& row) {
  OptionView view{.row = &row, .spellings = {row.option()}, .help = row.full_help()};
  if (!row.alias.empty()) view.spellings.emplace_back(row.alias);
  if (row.spelling == Spelling::kFlag) return view;
  view.words = words_of(explorer, row);
  view.proposal = Proposal::kText;
  if (names_a_path(row)) view.proposal = row.value == "DIR" ? Proposal::kFolder : Proposal::kFile;
  return view;
}

}  // namespace

std::string installed_name(const Explorer& explorer) { return "palpate-" + explorer.name; }

const Verb* find_verb(const Explorer& explorer, std::string_view name) {
  for (const Verb& verb : explorer.verbs) {
    if (verb.name == name) return &verb;
  }
  return nullptr;
}

Groups groups_of(const Verb& verb) { return verb.groups.with(Group::kCommon); }

std::vector<OptionView> options_of(const Explorer& explorer, const Verb& verb) {
  std::vector<OptionView> views;
  for (const Setting& row : settings()) {
    if (!row.belongs(explorer.kind, groups_of(verb)) || row.spelling == Spelling::kNone) continue;
    if (row.spelling != Spelling::kWords) {
      views.push_back(view_of(explorer, row));
      continue;
    }
    for (const std::string_view word : row.word_list()) {
      if (word == default_text(row)) continue;
      views.push_back({.row = &row, .spellings = {"--" + std::string(word)}, .help = std::string(row.help)});
    }
  }
  return views;
}

std::string operands_text(const Explorer& explorer, const Verb& verb) {
  std::string text;
  for (const Setting& row : settings()) {
    if (row.spelling == Spelling::kPositional && row.belongs(explorer.kind, groups_of(verb)))
      text += " " + row.option() + (row.several() ? "..." : "");
  }
  return text + (verb.groups.has(Group::kInput) ? " | --example NAME" : "");
}

}  // namespace palpate
