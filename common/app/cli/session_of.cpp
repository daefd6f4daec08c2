#include "common/app/cli/session_of.h"

#include <filesystem>

#include <unistd.h>

namespace palpate {

Session begin_session(const InputSpec& spec, const std::string& program) {
  Session session{.program = program};
  for (const auto& file : spec.files) session.inputs.push_back(describe_input(file, false));
  if (spec.solution) session.inputs.push_back(describe_input(*spec.solution, true));
  return session;
}

std::string store_session(const Session& session, const InputSpec& spec) {
  const std::string name =
      (spec.files.empty() ? session.program + "-" + spec.example : spec.files.front().stem().string()) +
      ".palpate.toml";
  const auto beside = spec.files.empty() ? std::filesystem::path() : spec.files.front().parent_path();
  const bool writable = access(beside.empty() ? "." : beside.c_str(), W_OK) == 0;
  const std::filesystem::path path = writable ? beside / name : std::filesystem::path(name);
  save_session(path, session);
  return path.string();
}

}  // namespace palpate
