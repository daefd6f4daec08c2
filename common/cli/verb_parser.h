/// The options that one verb takes, on the command line and in a session, from the groups that it names.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/cli/explorer.h"
#include "common/cli/scene_options.h"
#include "common/scene/options.h"

namespace palpate {

/// "Examples:" and what follows it in a help text; empty where there are none.
[[nodiscard]] std::string examples_text(const std::vector<UsageExample>& examples);

/// The options of one verb, bound to `options`, which it keeps a reference to, as to `app`.
class VerbParser {
 public:
  VerbParser(CLI::App& app, const Explorer& explorer, const Verb& verb, Options& options);

  [[nodiscard]] const SceneOptions& scene_options() const noexcept { return scene_options_; }
  /// @throws Error (usage) for a number that its option does not take.
  void check() const;

 private:
  template <typename T>
  CLI::Option* scene(const std::string& name, T& value, const std::string& text, const std::string& type,
                     const std::string& group) {
    return scene_options_.add(name, value, text, type, group);
  }
  void add_common();
  void add_input(FieldKind kind);
  void add_tracing();
  void add_notes();
  void add_path();
  void add_workbench();
  void add_tract();
  void add_operator();
  void add_rate();
  void add_record();
  void add_replay();
  void add_out(const Verb& verb);
  void add_mesh_picture();
  void add_picture();
  void add_head(const char* what);
  void add_image();
  void add_measure();
  void add_slice();
  void add_part();
  void add_turn();
  void add_effort();

  CLI::App& app_;
  Options& options_;
  SceneOptions scene_options_;
};

}  // namespace palpate
