#include "common/scene/session_of.h"

#include <utility>

#include "common/base/error.h"
#include "common/base/files/output_file.h"

namespace palpate {

std::vector<std::pair<std::string, std::string>> saved_settings(const Document& document) {
  std::vector<std::pair<std::string, std::string>> kept;
  for (const Setting& row : settings()) {
    if (!row.saved || !row.kinds.has(document.input.kind) || is_default(row, document)) continue;
    std::string text = value_text(row, document);
    std::error_code ignored;
    if (row.file && std::filesystem::is_regular_file(text, ignored))
      text = std::filesystem::absolute(text).lexically_normal().string();
    kept.emplace_back(row.name, std::move(text));
  }
  return kept;
}

Session session_of(const Document& document, const std::string& program) {
  Session session{.program = program};
  for (const auto& file : document.input.files) session.inputs.push_back(describe_input(file, false));
  if (document.input.solution) session.inputs.push_back(describe_input(*document.input.solution, true));
  if (const auto& lines = document.touch.drawn_lines; !lines.empty())
    session.lines = describe_input(lines, false);
  session.options = saved_settings(document);
  return session;
}

bool is_session(const std::filesystem::path& file) { return file.extension() == ".toml"; }

std::string session_name(const Document& document, const std::string& program) {
  const auto& files = document.input.files;
  const std::string stem =
      files.empty() ? program + "-" + document.input.example : files.front().stem().string();
  return stem + std::string(kSessionEnding);
}

std::filesystem::path lines_of_session(std::filesystem::path session) {
  return session.replace_extension(".lines.csv");
}

std::vector<const Setting*> take_settings(const Session& session, FieldKind kind,
                                          const std::filesystem::path& file, Document& document,
                                          std::vector<std::string>& notes) {
  std::vector<const Setting*> taken;
  const auto leave_out = [&](const std::string& name, const std::string& why) {
    notes.push_back(file.string() + ": '" + name + "' is left out: " + why);
  };
  if (session.newer)
    notes.push_back(file.string() + " was saved by a newer version; it is read as far as this one knows it");
  for (const auto& [name, value] : session.options) {
    const Setting* row = find_setting(name, kind);
    if (row == nullptr && session.newer) {
      leave_out(name, "this version has no such setting");
      continue;
    }
    if (row == nullptr) {
      throw input_error({file.string(), "[scene]", "'" + name + "' is no setting",
                         "a setting's name, such as '" + std::string(nearest_setting(name, kind)) + "'", ""});
    }
    try {
      set_value(*row, document, value);
    } catch (const Error& error) {
      if (!session.newer) throw;
      leave_out(name, error.what());
      continue;
    }
    taken.push_back(row);
  }
  return taken;
}

void take_inputs(const Session& session, Document& document) {
  for (const SessionInput& input : session.inputs) {
    if (!input.solution) document.input.files.push_back(input.file);
    if (input.solution && !document.input.solution) document.input.solution = input.file;
  }
}

void take_drawn_lines(const Session& session, Document& document, std::vector<std::string>& notes) {
  if (!session.lines) return;
  document.touch.drawn_lines = session.lines->file;
  std::string change = std::filesystem::exists(session.lines->file) ? change_of(*session.lines) : "";
  if (!change.empty()) notes.push_back(std::move(change));
}

}  // namespace palpate
