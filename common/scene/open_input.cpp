#include "common/scene/open_input.h"

#include "common/scene/session.h"

namespace palpate {

Input open_input(const Document& document, Progress& progress,
                 const std::function<void(const std::string&)>& note) {
  if (!document.common.session.empty()) {
    for (const std::string& line : changed_inputs(load_session(document.common.session), &progress))
      note(line);
  }
  progress.begin("opening", 0);
  Input input = Input::open(document.input, &progress);
  for (const std::string& line : input.notes()) note(input.title() + ": " + line);
  return input;
}

}  // namespace palpate
