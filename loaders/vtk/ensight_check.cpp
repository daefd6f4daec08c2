#include "loaders/vtk/ensight_check.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>

#include "common/base/error.h"
#include "common/load/find_format.h"

namespace palpate {
namespace {

constexpr std::size_t kCaseBytes = std::size_t{4} << 20;

/// Files of `folder` whose names fit `pattern`, by the number that stands for its asterisks.
std::map<unsigned long long, std::filesystem::path> matching_files(const std::filesystem::path& folder,
                                                                   const std::string& pattern) {
  const std::size_t first = pattern.find('*');
  const std::string before = pattern.substr(0, first);
  const std::string after = pattern.substr(pattern.find_last_of('*') + 1);
  std::map<unsigned long long, std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.size() <= before.size() + after.size() || name.compare(0, before.size(), before) != 0 ||
        name.compare(name.size() - after.size(), after.size(), after) != 0) {
      continue;
    }
    const std::string digits = name.substr(before.size(), name.size() - before.size() - after.size());
    const bool number = digits.size() < 19 && std::all_of(digits.begin(), digits.end(), [](unsigned char c) {
                          return std::isdigit(c) != 0;
                        });
    if (number) files[std::stoull(digits)] = it->path();
  }
  return files;
}

}  // namespace

std::vector<EnsightVariable> ensight_variables(std::string_view case_text) {
  std::vector<EnsightVariable> variables;
  std::istringstream lines{std::string(case_text)};
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::string kind = line.substr(0, colon);
    const bool on_points = kind.find(" per node") != std::string::npos;
    if (!on_points && kind.find(" per element") == std::string::npos) continue;
    // Optional numbers of the time set and file set, then the name and the file.
    std::istringstream rest(line.substr(colon + 1));
    std::vector<std::string> words;
    for (std::string word; rest >> word;) words.push_back(word);
    if (words.size() < 2) continue;
    variables.push_back(
        {words[words.size() - 2], on_points ? Association::kPoint : Association::kCell, words.back()});
  }
  return variables;
}

void check_ensight_values(const std::string& case_file, const std::string& variable, Association association,
                          std::size_t values, std::size_t step, std::size_t steps) {
  constexpr std::size_t kTextBytes = 12;
  constexpr std::size_t kBinaryBytes = 4;
  const std::filesystem::path folder = std::filesystem::path(case_file).parent_path();
  for (const EnsightVariable& known : ensight_variables(read_head(case_file, kCaseBytes).bytes)) {
    if (known.name != variable || known.association != association) continue;
    std::filesystem::path path = folder / known.pattern;
    if (known.pattern.find('*') != std::string::npos) {
      const auto files = matching_files(path.parent_path(), path.filename().string());
      if (files.size() != steps) return;  // not one file a step: which one was read is not known
      path = std::next(files.begin(), static_cast<std::ptrdiff_t>(step))->second;
    }
    // Binary numbers hold bytes that no text has.
    const HeadOfFile head = read_head(path, 4096);
    const bool text = std::all_of(head.bytes.begin(), head.bytes.end(),
                                  [](unsigned char c) { return c >= 0x20 || std::isspace(c) != 0; });
    if (head.file_size < values * (text ? kTextBytes : kBinaryBytes)) {
      throw input_error({path.string(), "", "has " + std::to_string(head.file_size) + " bytes",
                         "at least " + std::to_string(values * (text ? kTextBytes : kBinaryBytes)) + " for " +
                             std::to_string(values) + " values",
                         "it may be truncated"});
    }
    return;
  }
}

}  // namespace palpate
