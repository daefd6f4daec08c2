/// Options of a verb that describe the scene: those that a session file may hold.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace palpate {

class SceneOptions {
 public:
  /// @param app of the verb; outlives this.
  explicit SceneOptions(CLI::App& app) : app_(app) {}

  /// An option with a value. @param type what stands for the value in the help, such as "MM".
  template <typename T>
  CLI::Option* add(const std::string& name, T& value, const std::string& text, const std::string& type,
                   const std::string& group) {
    options_.push_back(app_.add_option(name, value, text)->type_name(type)->group(group));
    return options_.back();
  }

  /// One that may be repeated; a session has its values with ';' between.
  void add_several(const std::string& name, std::vector<std::string>& values, const std::string& text,
                   const std::string& type, const std::string& group) {
    add(name, values, text, type, group)
        ->delimiter(';')
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false);  // or it would swallow the FILE behind it
  }

  void add_flag(const std::string& name, bool& value, const std::string& text, const std::string& group) {
    options_.push_back(app_.add_flag(name, value, text)->group(group));
  }

  /// Those that were given, with their text; several values with a ';' between.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> given() const {
    std::vector<std::pair<std::string, std::string>> values;
    for (const CLI::Option* option : options_) {
      if (option->count() == 0) continue;
      std::string text;
      for (const std::string& part : option->results()) text += (text.empty() ? "" : ";") + part;
      values.emplace_back(option->get_lnames().front(), std::move(text));
    }
    return values;
  }

  /// Whether a session may hold this option. @param name without dashes.
  [[nodiscard]] bool knows(const std::string& name) const {
    return std::any_of(options_.begin(), options_.end(),
                       [&](const CLI::Option* option) { return option->get_lnames().front() == name; });
  }

 private:
  CLI::App& app_;
  std::vector<CLI::Option*> options_;
};

}  // namespace palpate
