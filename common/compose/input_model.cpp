#include "common/compose/input_model.h"

#include <utility>

#include "common/base/error.h"
#include "common/scene/origin_of.h"

namespace palpate {

SceneInfo describe_open_input(const Input& input) {
  SceneInfo info;
  info.name = input.title();
  for (const auto& path : input.spec().files) info.files.files.push_back(std::filesystem::absolute(path));
  if (input.spec().solution) info.files.solution = std::filesystem::absolute(*input.spec().solution);
  info.files.example = input.spec().example;
  info.files.series = input.spec().series;
  info.fields = input.fields();
  info.origin = origin_of(input);
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

Document document_of_session(const InputFiles& files, const std::string& program, const Document& given,
                             std::vector<std::string>& notes, Progress& progress) {
  const Session session = load_session(files.session);
  if (!session.program.empty() && session.program != program) {
    throw input_error({files.session.string(), "program", "is a session of " + session.program,
                       "one of " + program, "open it with " + session.program});
  }
  Document document;
  document.common = given.common;
  document.common.session = std::filesystem::absolute(files.session);
  document.input.kind = given.input.kind;
  for (const Setting* row : take_settings(session, given.input.kind, files.session, document, notes))
    document.given.emplace_back(row->name);
  take_drawn_lines(session, document, notes);
  if (files.files.empty()) {
    take_inputs(session, document);
    for (std::string& change : changed_inputs(session, &progress)) notes.push_back(std::move(change));
  } else {
    document.input.files = files.files;
    document.input.solution = files.solution;
    document.input.example.clear();
  }
  take_tables(files, document);
  return document;
}

void take_tables(const InputFiles& files, Document& document) {
  const FieldKind kind = document.input.kind;
  if (!files.seeds.empty()) {
    if (kind == FieldKind::kScalar)
      throw usage_error(files.seeds.string() +
                        " is a table of seeds, and a volume has no lines to begin there");
    (kind == FieldKind::kTensor ? document.tracts.seeds : document.tracing.seeds) = files.seeds.string();
  }
  if (files.transfer.empty()) return;
  const bool no_volume = kind == FieldKind::kVector && document.volume.scalar.empty();
  if (no_volume || kind == FieldKind::kFibre) {
    throw usage_error(files.transfer.string() + " is a transfer function, and no volume is drawn" +
                      (no_volume ? "; choose one in the panel first (volume of)" : ""));
  }
  document.volume.transfer = files.transfer.string();
}

}  // namespace palpate
