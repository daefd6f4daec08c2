#include <algorithm>
#include <filesystem>

#include "common/cli/json/json_output.h"
#include "common/cli/verbs.h"
#include "common/field/analytic/examples.h"
#include "common/scene/open_input.h"

namespace palpate {

bool list_examples(const Document& options, const VerbContext& context) {
  if (options.input.example != "list") return false;
  const std::vector<ExampleInfo> list = examples_of(context.explorer.kind);
  std::size_t widest = 0;
  for (const ExampleInfo& entry : list) widest = std::max(widest, entry.name.size());
  std::string text;
  for (const ExampleInfo& entry : list) {
    text += entry.name + std::string(widest + 2 - entry.name.size(), ' ') + entry.summary + "\n";
  }
  context.console.print(text);
  context.console.print_json(examples_json(list));
  return true;
}

Input open_input(const Document& options, const VerbContext& context) {
  return open_input(options, context.progress, [&](const std::string& line) { context.console.note(line); });
}

ExitCode headless_tour(const Verb& render, Document options, const VerbContext& context,
                       const std::string& next) {
  const std::string program = context.explorer.name;
  // The first name that is free: flow-tour.png, flow-tour-2.png, …
  options.output.file = program + "-tour.png";
  for (int n = 2; std::filesystem::exists(options.output.file); ++n)
    options.output.file = program + "-tour-" + std::to_string(n) + ".png";
  context.console.note("no display here, so no window: drawing example " + options.input.example + " into " +
                       options.output.file.string() + " instead");
  const ExitCode code = render.run(options, context);
  if (code == ExitCode::kDone) {
    context.console.note("next: " + program + " --example list, " + program +
                         " render FILE --out picture.png, " + program + " " + next);
  }
  return code;
}

void refuse_window(const Document& options, const VerbContext& context) {
  (void)Input::open(options.input, &context.progress);
  throw work_error("no display, so no window; '" + context.explorer.name +
                   " render' draws a picture without one: add --out picture.png");
}

}  // namespace palpate
