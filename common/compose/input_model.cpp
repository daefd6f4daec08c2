#include "common/compose/input_model.h"

namespace palpate {

SceneInfo describe_open_input(const Input& input) {
  SceneInfo info;
  info.name = input.title();
  for (const auto& path : input.spec().files) info.files.files.push_back(std::filesystem::absolute(path));
  if (input.spec().solution) info.files.solution = std::filesystem::absolute(*input.spec().solution);
  info.files.example = input.spec().example;
  info.fields = input.fields();
  if (const FileInfo* file = input.file()) {
    info.facts.push_back(file->format);
    info.times = file->times;
  }
  return info;
}

SceneState begin_state(const Input& input, const Document& document) {
  SceneState state;
  state.document = document;
  state.lines = std::make_shared<const std::vector<Line>>();
  state.notes = input.notes();
  state.seconds_load = input.seconds_open() + input.seconds_read() + input.seconds_field();
  return state;
}

}  // namespace palpate
