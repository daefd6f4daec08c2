/// What a program is to the command line: a name, a summary, examples, and verbs. Programs share everything
/// else.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/base/progress.h"
#include "common/cli/console.h"
#include "common/cli/interrupt.h"
#include "common/scene/document/document.h"
#include "common/scene/document/setting.h"
#include "common/scene/input.h"

namespace palpate {

/// A command line worth showing and what it does.
struct UsageExample {
  std::string command;
  std::string what;
};

struct Explorer;

/// What a verb works with besides its options.
struct VerbContext {
  const Explorer& explorer;
  Progress& progress;  ///< cancelled by Ctrl-C
  InterruptGuard& interrupt;
  Console& console;
  std::string command_line;  ///< as typed, for the text chunk of pictures
};

struct Verb {
  std::string name;
  std::string summary;
  std::string details = {};  ///< what the help says before the examples; may be empty
  Groups groups;             ///< of settings that it takes besides the common ones
  std::vector<UsageExample> examples;
  /// Does the work. @throws Error.
  std::function<ExitCode(const Document&, const VerbContext&)> run;
};

struct Explorer {
  std::string name;
  std::string summary;
  FieldKind kind = FieldKind::kVector;  ///< of the field that its verbs work on
  std::vector<UsageExample> examples;
  std::vector<Verb> verbs;
  /// The verb that `<app> FILE` and `<app>` alone stand for.
  std::string default_verb = "open";
  /// Completes options, once they are parsed, by what only the program knows; may be empty. @throws Error
  /// (usage).
  std::function<void(Document&)> complete = {};
};

/// Parses the command line, runs the verb and turns errors into one line and an exit code. Ctrl-C cancels the
/// verb's progress; a verb that has not returned within a second is ended.
int run_explorer(const Explorer& explorer, int argc, char** argv);

}  // namespace palpate
