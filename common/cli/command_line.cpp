#include "common/cli/command_line.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <memory>
#include <string_view>

#include <CLI/CLI.hpp>

#include "common/base/error.h"
#include "common/base/version.h"
#include "common/cli/pages/option_view.h"
#include "common/cli/pages/pages.h"
#include "common/scene/document/setting.h"
#include "common/scene/session.h"
#include "common/scene/session_of.h"

namespace palpate {
namespace {

/// Whether what follows `text` is its value, and no verb.
bool takes_value(const Explorer& explorer, std::string_view text) {
  return text == kCompletionOption.spelling || std::ranges::any_of(settings(), [&](const Setting& row) {
           return row.spelling == Spelling::kOption && row.kinds.has(explorer.kind) &&
                  (row.option() == text || (!row.alias.empty() && row.alias == text));
         });
}

/// Whether the verb that needs no name takes files.
bool opens_files(const Explorer& explorer) {
  const Verb* verb = find_verb(explorer, explorer.default_verb);
  return verb && verb->groups.has(Group::kInput);
}

/// A bare word that is no file was meant as a verb, or lacks its ending.
/// @param alone no other word follows it, so that a file may have been meant.
void refuse_unknown_verb(const Explorer& explorer, const std::string& word, bool alone) {
  const bool bare =
      std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
  std::error_code ignored;
  if (!bare || std::filesystem::exists(word, ignored)) return;
  std::string verbs;
  for (const Verb& verb : explorer.verbs) verbs += (verbs.empty() ? "" : ", ") + verb.name;
  if (!alone || !opens_files(explorer)) throw usage_error(word + ": no such verb; verbs are " + verbs);
  throw input_error({word, "", "there is no such file, and no such verb", "", "verbs are " + verbs});
}

/// Puts the verb first, whatever was written before it, and the default verb where there is none.
std::vector<std::string> with_verb_first(const Explorer& explorer, std::vector<std::string> arguments) {
  std::size_t i = 0;
  while (i < arguments.size() && arguments[i].starts_with("-"))
    i += takes_value(explorer, arguments[i]) ? 2 : 1;
  if (i < arguments.size() && find_verb(explorer, arguments[i])) {
    std::rotate(arguments.begin(), arguments.begin() + static_cast<std::ptrdiff_t>(i),
                arguments.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    return arguments;
  }
  if (i < arguments.size()) {
    const bool alone = i + 1 == arguments.size() || arguments[i + 1].starts_with("-");
    refuse_unknown_verb(explorer, arguments[i], alone);
  }
  const bool only_asks =
      i >= arguments.size() && std::any_of(arguments.begin(), arguments.end(), [](const auto& a) {
        return std::ranges::any_of(kProgramOptions, [&](const ProgramOption& option) {
          return a == option.spelling || (!option.alias.empty() && a == option.alias) ||
                 a.starts_with(std::string(option.spelling) + "=");
        });
      });
  if (!only_asks) arguments.insert(arguments.begin(), explorer.default_verb);
  return arguments;
}

/// CLI11's help with the usage line that a user of verbs expects.
class HelpText : public CLI::Formatter {
 public:
  explicit HelpText(const Explorer& explorer) : explorer_(explorer) {}

  std::string make_usage(const CLI::App* app, std::string name) const override {
    const Verb* verb = find_verb(explorer_, app->get_name());
    const Verb* meant = verb ? verb : find_verb(explorer_, explorer_.default_verb);
    return "Usage: " + name + (verb ? "" : " [VERB]") + (meant ? operands_text(explorer_, *meant) : "") +
           " [options]\n";
  }

 private:
  const Explorer& explorer_;
};

/// `before`, "Examples:" and what follows it in a help text; empty where there are none.
std::string examples_text(const std::string& before, const std::vector<UsageExample>& examples) {
  std::string text = before + (before.empty() || examples.empty() ? "" : "\n\n");
  if (!examples.empty()) text += "Examples:";
  for (const UsageExample& example : examples) text += "\n  " + example.command + "\n      " + example.what;
  return text;
}

/// An option and the setting whose value it gives.
struct Bound {
  const Setting* row = nullptr;
  CLI::Option* option = nullptr;
  std::string word;  ///< Spelling::kWords: that the flag stands for
};

/// "--out,-o"
std::string spelled(const Setting& row) {
  return row.option() + (row.alias.empty() ? "" : "," + std::string(row.alias));
}

/// Appends the option, or the options, of a setting.
void bind(CLI::App& app, const Setting& row, std::vector<Bound>& bound) {
  const auto add = [&](CLI::Option* option, const std::string& word = {}) {
    option->group(std::string(row.heading));
    bound.push_back({&row, option, word});
    return option;
  };
  const auto taken = [](const CLI::results_t&) { return true; };  // read once all are there
  switch (row.spelling) {
    case Spelling::kFlag:
      add(app.add_flag_callback(
          spelled(row), [] {}, row.full_help()));
      return;
    case Spelling::kWords:
      for (const std::string_view word : row.word_list()) {
        if (word == default_text(row)) continue;
        add(app.add_flag_callback(
                "--" + std::string(word), [] {}, std::string(row.help)),
            std::string(word));
      }
      return;
    case Spelling::kPositional:
      add(app.add_option(row.option(), taken, row.full_help()))
          ->type_name("")
          ->expected(1, row.several() ? -1 : 1)
          ->allow_extra_args(row.several());
      return;
    case Spelling::kOption:
      break;
    case Spelling::kNone:
      return;
  }
  CLI::Option* option = add(app.add_option(spelled(row), taken, row.full_help()));
  option->type_name(std::string(row.value_name()));
  if (!row.several()) return;
  option->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);  // or it would swallow the FILE behind it
}

/// The text that was typed for an option; the parts of a list with ';' between.
std::string typed_text(const Bound& bound) {
  if (!bound.word.empty()) return bound.word;
  if (!bound.row->several()) return bound.option->results().back();
  std::string text;
  for (const std::string& part : bound.option->results()) text += (text.empty() ? "" : ";") + part;
  return text;
}

/// What every verb answers, too.
void add_asking_options(CLI::App& app, const Explorer& explorer) {
  app.set_help_flag(std::string(kHelpOption.spelling) + "," + std::string(kHelpOption.alias),
                    std::string(kHelpOption.help));
  app.set_version_flag(std::string(kVersionOption.spelling), version_text(explorer.name),
                       std::string(kVersionOption.help));
}

/// Takes what a session has for the verb, but for what was typed.
void take_session(const Verb& verb, FieldKind kind, const std::vector<const Setting*>& typed,
                  ParsedCommand& parsed) {
  Document& document = parsed.options;
  const Session session = load_session(document.common.session);
  const bool input_typed = !document.input.files.empty() || !document.input.example.empty();
  Document with;
  for (const Setting* row : take_settings(session, kind, document.common.session, with, parsed.notes)) {
    if (!row->belongs(kind, groups_of(verb)) || std::ranges::find(typed, row) != typed.end()) continue;
    if (row->name == "example" && input_typed) continue;
    set_value(*row, document, value_text(*row, with));
    document.given.emplace_back(row->name);
  }
  const Setting& lines = setting("drawn-lines");
  if (lines.belongs(kind, groups_of(verb)) && std::ranges::find(typed, &lines) == typed.end()) {
    take_drawn_lines(session, document, parsed.notes);
  }
  if (!input_typed) take_inputs(session, document);
}

/// A session among the files opens like one of them: "carotid.palpate.toml". @throws Error (usage) for two.
void find_session(Document& document) {
  std::vector<std::filesystem::path>& files = document.input.files;
  const auto session = std::ranges::find_if(files, is_session);
  if (session == files.end()) return;
  if (!document.common.session.empty()) {
    throw usage_error(session->string() + " and " + document.common.session.string() +
                      " are two sessions; give one");
  }
  document.common.session = *session;
  files.erase(session);
  find_session(document);
}

}  // namespace

ParsedCommand parse_command_line(const Explorer& explorer, const std::vector<std::string>& typed_arguments) {
  std::vector<std::string> arguments = with_verb_first(explorer, typed_arguments);
  ParsedCommand parsed;
  CLI::App app(explorer.summary, explorer.name);
  add_asking_options(app, explorer);
  bool manual = false;
  std::string shell;
  app.add_flag(std::string(kManualOption.spelling), manual, std::string(kManualOption.help));
  app.add_option(std::string(kCompletionOption.spelling), shell, std::string(kCompletionOption.help))
      ->type_name(std::string(kCompletionOption.value));
  app.require_subcommand(0, 1);
  app.formatter(std::make_shared<HelpText>(explorer));
  const std::string file = opens_files(explorer) ? " FILE'" : "'";
  app.footer(examples_text("'" + explorer.name + file + " is '" + explorer.name + " " +
                               explorer.default_verb + file + "; '" + explorer.name +
                               " VERB --help' lists a verb's options.",
                           explorer.examples));

  std::map<const CLI::App*, std::vector<Bound>> options;
  for (const Verb& verb : explorer.verbs) {
    CLI::App* sub = app.add_subcommand(verb.name, verb.summary)->group("Verbs");
    add_asking_options(*sub, explorer);
    sub->footer(examples_text(verb.details, verb.examples));
    for (const Setting& row : settings()) {
      if (row.belongs(explorer.kind, groups_of(verb))) bind(*sub, row, options[sub]);
    }
  }

  try {
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes its arguments from the back
    app.parse(arguments);
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app.get_subcommands();
    parsed.text = (chosen.empty() ? app : *chosen.front()).help(chosen.empty() ? "" : explorer.name);
    return parsed;
  } catch (const CLI::CallForVersion&) {
    parsed.text = version_text(explorer.name) + "\n";
    return parsed;
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    const std::string verb = chosen.empty() ? std::string() : " " + chosen.front()->get_name();
    throw usage_error(std::string(error.what()) + "; see " + explorer.name + verb + " --help");
  }
  if (app.get_subcommands().empty()) {
    parsed.text = manual ? manual_page(explorer) : completion(explorer, shell);
    return parsed;
  }
  const CLI::App* chosen = app.get_subcommands().front();
  parsed.verb = find_verb(explorer, chosen->get_name());
  parsed.options.input.kind = explorer.kind;
  std::vector<const Setting*> typed;
  for (const Bound& bound : options[chosen]) {
    if (bound.option->count() == 0) continue;
    set_value(*bound.row, parsed.options, typed_text(bound));
    typed.push_back(bound.row);
    parsed.options.given.emplace_back(bound.row->name);
  }
  find_session(parsed.options);
  if (!parsed.options.common.session.empty()) take_session(*parsed.verb, explorer.kind, typed, parsed);
  return parsed;
}

}  // namespace palpate
