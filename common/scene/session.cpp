#include "common/scene/session.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <utility>

#include <toml++/toml.h>

#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/scene/sha256.h"

namespace palpate {
namespace {

constexpr std::int64_t kFormat = 1;

std::filesystem::path folder_of(const std::filesystem::path& session) {
  return std::filesystem::absolute(session).parent_path();
}

/// Inputs beside or below the session move with it; others keep their full path.
std::string stored_path(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const auto absolute = std::filesystem::absolute(file).lexically_normal();
  const auto relative = absolute.lexically_relative(folder);
  const bool below = !relative.empty() && *relative.begin() != "..";
  return (below ? relative : absolute).string();
}

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& place, const std::string& found,
                       const std::string& expected) {
  throw input_error(
      {path.string(), place, found, expected, "save the session again, or give the options by hand"});
}

SessionInput read_input(const toml::node& node, const std::filesystem::path& path) {
  const std::string place = "line " + std::to_string(node.source().begin.line);
  const toml::table* table = node.as_table();
  const auto file = table ? (*table)["file"].value<std::string>() : std::nullopt;
  if (!file || file->empty()) fail(path, place, "an input without a file", "file = \"…\"");
  SessionInput input;
  input.file = (folder_of(path) / *file).lexically_normal();
  input.bytes =
      static_cast<std::uint64_t>(std::max<std::int64_t>(0, (*table)["bytes"].value_or<std::int64_t>(0)));
  input.sha256 = (*table)["sha256"].value_or(std::string());
  input.solution = (*table)["solution"].value_or(false);
  return input;
}

toml::table table_of(const SessionInput& input, const std::filesystem::path& folder) {
  toml::table table{{"file", stored_path(input.file, folder)},
                    {"bytes", static_cast<std::int64_t>(input.bytes)},
                    {"sha256", input.sha256}};
  if (input.solution) table.insert("solution", true);
  return table;
}

/// Its files, by name; not those of its own folders.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code unreadable;  // a folder that cannot be read has no files, and so another checksum
  for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable)) {
    if (entry.is_regular_file(unreadable)) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace

SessionInput describe_input(const std::filesystem::path& file, bool solution, const Progress* progress) {
  SessionInput input{.file = file, .bytes = 0, .sha256 = {}, .solution = solution};
  std::error_code ignored;
  if (!std::filesystem::is_directory(file, ignored)) {
    input.sha256 = sha256_of_file(file, progress);
    input.bytes = std::filesystem::file_size(file, ignored);
    return input;
  }
  std::string lines;
  for (const std::filesystem::path& part : files_of(file)) {
    lines += sha256_of_file(part, progress) + "  " + part.filename().string() + "\n";
    input.bytes += std::filesystem::file_size(part, ignored);
  }
  input.sha256 = sha256_of(lines);
  return input;
}

void save_session(const std::filesystem::path& path, const Session& session) {
  toml::array inputs;
  for (const SessionInput& input : session.inputs) inputs.push_back(table_of(input, folder_of(path)));
  toml::table scene;
  for (const auto& [name, value] : session.options) scene.insert_or_assign(name, value);
  toml::table root{{"format", kFormat}, {"program", session.program}};
  if (!inputs.empty()) root.insert("input", std::move(inputs));
  if (session.lines) root.insert("lines", table_of(*session.lines, folder_of(path)));
  root.insert("scene", std::move(scene));

  std::ostringstream text;
  text << root << '\n';
  OutputFile file(path, true);
  file.write(text.str());
  file.finish();
}

Session load_session(const std::filesystem::path& path) {
  std::ifstream in(path);
  if (!in || std::filesystem::is_directory(path)) {
    throw input_error({path.string(), "", "cannot be opened", "a session file saved by this program", ""});
  }
  std::ostringstream text;
  text << in.rdbuf();

  toml::table root;
  try {
    root = toml::parse(text.str(), path.string());
  } catch (const toml::parse_error& error) {
    fail(path, "line " + std::to_string(error.source().begin.line), std::string(error.description()), "TOML");
  }
  const auto format = root["format"].value_or<std::int64_t>(0);
  if (format < kFormat) fail(path, "format", "not a session", "format = 1");
  Session session;
  session.newer = format > kFormat;
  session.program = root["program"].value_or(std::string());
  if (const toml::array* inputs = root["input"].as_array()) {
    for (const toml::node& node : *inputs) session.inputs.push_back(read_input(node, path));
  }
  if (const toml::table* lines = root["lines"].as_table()) session.lines = read_input(*lines, path);
  const toml::table* scene = root["scene"].as_table();
  if (!scene) fail(path, "[scene]", "is missing", "a table of settings");
  for (const auto& [key, node] : *scene) {
    const std::string name(key.str());
    const auto value = node.value<std::string>();
    if (!value && session.newer) {
      session.options.emplace_back(name, std::string());
      continue;
    }
    if (!value) {
      fail(path, "line " + std::to_string(node.source().begin.line), "'" + name + "' is no text",
           "the setting's value in quotes");
    }
    session.options.emplace_back(name, *value);
  }
  return session;
}

std::string change_of(const SessionInput& input, const Progress* progress) {
  std::error_code error;
  const auto status = std::filesystem::status(input.file, error);
  const auto bytes =
      std::filesystem::is_regular_file(status) ? std::filesystem::file_size(input.file, error) : input.bytes;
  if (error) return input.file.string() + " is missing: " + error.message();
  if (!input.sha256.empty() &&
      (bytes != input.bytes || describe_input(input.file, false, progress).sha256 != input.sha256))
    return input.file.string() + " has changed since the session was saved (checksum differs)";
  return {};
}

std::vector<std::string> changed_inputs(const Session& session, const Progress* progress) {
  std::vector<std::string> sentences;
  for (const SessionInput& input : session.inputs) {
    if (std::string change = change_of(input, progress); !change.empty())
      sentences.push_back(std::move(change));
  }
  return sentences;
}

}  // namespace palpate
