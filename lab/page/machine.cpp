#include "lab/page/machine.h"

#include <fstream>

#include <sys/utsname.h>

#include "common/base/memory.h"
#include "common/base/parallel.h"
#include "common/base/version.h"

namespace palpate {
namespace {

/// The rest of the first line of `file` that begins with `key`, after the separator and blanks.
std::string value_in(const char* file, const std::string& key, char separator) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(key)) continue;
    auto start = line.find(separator);
    if (start == std::string::npos) continue;
    start = line.find_first_not_of(" \t\"", start + 1);
    const auto end = line.find_last_not_of(" \t\"");
    if (start == std::string::npos || end < start) return {};
    return line.substr(start, end - start + 1);
  }
  return {};
}

}  // namespace

Machine this_machine() {
  Machine machine;
  machine.processor = value_in("/proc/cpuinfo", "model name", ':');
  if (machine.processor.empty()) machine.processor = "unknown processor";
  machine.cores = resolve_threads(0);
  machine.memory_bytes = machine_memory();
  machine.system = value_in("/etc/os-release", "PRETTY_NAME", '=');
  utsname names{};
  if (uname(&names) == 0) {
    machine.system += (machine.system.empty() ? "" : ", ") + std::string(names.sysname) + " " +
                      names.release + " " + names.machine;
  }
  machine.build = build_text();
  machine.version = version();
  return machine;
}

}  // namespace palpate
