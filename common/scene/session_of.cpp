#include "common/scene/session_of.h"

#include <filesystem>

#include "common/base/keep_beside.h"

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
  std::filesystem::path path = beside / name;
  if (!may_keep_beside(path)) path = name;
  save_session(path, session);
  return path.string();
}

}  // namespace palpate
