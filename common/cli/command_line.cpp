#include "common/cli/command_line.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string_view>

#include <CLI/CLI.hpp>

#include "common/base/version.h"
#include "common/cli/verb_parser.h"
#include "common/scene/session.h"

namespace palpate {
namespace {

/// Options that may stand before the verb and take a value.
constexpr std::array<std::string_view, 5> kValuedBeforeVerb{"--threads", "--seed", "--field", "--example",
                                                            "--time"};

const Verb* find_verb(const Explorer& explorer, std::string_view name) {
  for (const Verb& verb : explorer.verbs) {
    if (verb.name == name) return &verb;
  }
  return nullptr;
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
  if (!alone) throw usage_error(word + ": no such verb; verbs are " + verbs);
  throw input_error({word, "", "there is no such file, and no such verb", "", "verbs are " + verbs});
}

/// Puts the verb first, whatever was written before it, and the default verb where there is none.
std::vector<std::string> with_verb_first(const Explorer& explorer, std::vector<std::string> arguments) {
  const auto is_valued = [](const std::string& text) {
    return std::find(kValuedBeforeVerb.begin(), kValuedBeforeVerb.end(), text) != kValuedBeforeVerb.end();
  };
  std::size_t i = 0;
  while (i < arguments.size() && arguments[i].starts_with("-")) i += is_valued(arguments[i]) ? 2 : 1;
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
        return a == "--help" || a == "-h" || a == "--version";
      });
  if (!only_asks) arguments.insert(arguments.begin(), explorer.default_verb);
  return arguments;
}

/// CLI11's help with the usage line that a user of verbs expects.
class HelpText : public CLI::Formatter {
 public:
  explicit HelpText(const Explorer& explorer) : explorer_(explorer) {}

  std::string make_usage(const CLI::App* app, std::string name) const override {
    if (const Verb* verb = find_verb(explorer_, app->get_name())) {
      return "Usage: " + name + (verb->groups.input ? " FILE... | --example NAME" : "") + " [options]\n";
    }
    return "Usage: " + name + " [VERB] FILE... [options]\n       " + name +
           " [VERB] --example NAME [options]\n";
  }

 private:
  const Explorer& explorer_;
};

/// Names of options that a session may hold: of the verb at hand, and of any verb.
struct SceneOptionNames {
  std::function<bool(const std::string&)> of_verb, of_any;
};

/// @param with_names called with the option names before everything is taken down.
ParsedCommand parse_once(
    const Explorer& explorer, std::vector<std::string> arguments,
    const std::function<void(const ParsedCommand&, const SceneOptionNames&)>& with_names = {}) {
  ParsedCommand parsed;
  CLI::App app(explorer.summary, explorer.name);
  app.set_help_flag("--help,-h", "print this help");
  app.set_version_flag("--version", version_text(explorer.name));
  app.require_subcommand(0, 1);
  app.formatter(std::make_shared<HelpText>(explorer));
  const std::string footer = "'" + explorer.name + " FILE' is '" + explorer.name + " " +
                             explorer.default_verb + " FILE'; '" + explorer.name +
                             " VERB --help' lists a verb's options.\n\n";
  app.footer(footer + examples_text(explorer.examples));

  std::map<const CLI::App*, std::unique_ptr<VerbParser>> parsers;
  for (const Verb& verb : explorer.verbs) {
    CLI::App* sub = app.add_subcommand(verb.name, verb.summary)->group("Verbs");
    sub->set_help_flag("--help,-h", "print this help");
    sub->set_version_flag("--version", version_text(explorer.name));
    parsers[sub] = std::make_unique<VerbParser>(*sub, explorer, verb, parsed.options);
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
  const CLI::App* chosen = app.get_subcommands().front();
  parsed.verb = find_verb(explorer, chosen->get_name());
  parsers.at(chosen)->check();
  parsed.options.given = parsers.at(chosen)->scene_options().given();
  if (with_names) {
    with_names(parsed,
               {[&](const std::string& name) { return parsers.at(chosen)->scene_options().knows(name); },
                [&](const std::string& name) {
                  return std::any_of(parsers.begin(), parsers.end(), [&](const auto& parser) {
                    return parser.second->scene_options().knows(name);
                  });
                }});
  }
  return parsed;
}

/// The arguments with the session's files and options in front, except what was typed.
std::vector<std::string> with_session(const std::vector<std::string>& arguments, const Options& typed,
                                      const SceneOptionNames& names) {
  const Session session = load_session(typed.session);
  std::vector<std::string> merged{arguments.front()};
  const auto is_typed = [&](const std::string& name) {
    return std::any_of(typed.given.begin(), typed.given.end(),
                       [&](const auto& option) { return option.first == name; });
  };
  const bool input_typed = !typed.input.files.empty() || !typed.input.example.empty();
  for (const auto& [name, value] : session.options) {
    if (!names.of_any(name)) {
      throw input_error(
          {typed.session.string(), "[scene]", "'" + name + "' is no option", "an option's name", ""});
    }
    if (is_typed(name) || !names.of_verb(name) || (name == "example" && input_typed)) continue;
    std::string option = "--";
    option.append(name).append("=").append(value);
    merged.push_back(std::move(option));
  }
  if (!input_typed) {
    for (const SessionInput& input : session.inputs) {
      if (input.solution) {
        if (!typed.input.solution) merged.push_back("--solution=" + input.file.string());
      } else {
        merged.push_back(input.file.string());
      }
    }
  }
  merged.insert(merged.end(), arguments.begin() + 1, arguments.end());
  return merged;
}

}  // namespace

ParsedCommand parse_command_line(const Explorer& explorer, const std::vector<std::string>& arguments) {
  const std::vector<std::string> ordered = with_verb_first(explorer, arguments);
  std::vector<std::string> merged;
  const auto merge = [&](const ParsedCommand& parsed, const SceneOptionNames& names) {
    if (!parsed.options.session.empty()) merged = with_session(ordered, parsed.options, names);
  };
  ParsedCommand parsed = parse_once(explorer, ordered, merge);
  return merged.empty() ? std::move(parsed) : parse_once(explorer, merged);
}

}  // namespace palpate
