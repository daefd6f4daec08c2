/// What a program is to the command line: a name, a summary, examples, and verbs. `flow`, `cardiac`, `dtmri`
/// and `grid` share everything else.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/base/progress.h"
#include "common/cli/console.h"
#include "common/cli/interrupt.h"
#include "common/scene/input.h"
#include "common/scene/options.h"

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

/// Groups of options that a verb takes besides the common ones.
struct VerbGroups {
  bool input = true;
  bool tracing = false;
  bool tracts = false;        ///< seeds, regions and limits of tracts
  bool fibres = false;        ///< seeds and limits of lines along fibres
  bool layer = false;         ///< --layer of a heart
  bool angle = false;         ///< --angle, --convention, --axis
  bool contours = false;      ///< --contours, --contour-spacing of a layer
  bool mesh_picture = false;  ///< --picture of a made mesh
  bool series = false;        ///< --value, --at, --along
  bool plot = false;          ///< --plot
  bool view = false;
  bool touch = false;
  bool path = false;    ///< --path
  bool hand = false;    ///< --device and --rate, for a hand on that path
  bool record = false;  ///< --record
  bool replay = false;  ///< --replay
  bool notes = false;   ///< --annotation
  bool out = false;
  bool picture = false;  ///< --size, --repeat
  bool effort = false;   ///< --quick, --thorough
  bool image = false;    ///< --convention of an image that is written
  bool measure = false;  ///< --measure
  bool slice = false;    ///< --plane and how a slice is written
  bool part = false;     ///< --box of a volume
  bool focal = false;    ///< --focal without `view`: of a view that a hand moves over a haptic grid
  bool turn = false;     ///< --tracts and --turn
};

struct Verb {
  std::string name;
  std::string summary;
  VerbGroups groups;
  std::vector<UsageExample> examples;
  /// Does the work. @throws Error.
  std::function<ExitCode(const Options&, const VerbContext&)> run;
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
  std::function<void(Options&)> complete = {};
};

/// Parses the command line, runs the verb and turns errors into one line and an exit code. Ctrl-C cancels the
/// verb's progress; a verb that has not returned within a second is ended.
int run_explorer(const Explorer& explorer, int argc, char** argv);

}  // namespace palpate
