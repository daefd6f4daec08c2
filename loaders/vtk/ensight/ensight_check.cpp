#include "loaders/vtk/ensight/ensight_check.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/load/find_format.h"
#include "loaders/vtk/ensight/ensight_rows.h"

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

/// Whether a file fits `pattern`, which may hold asterisks in its folders, too.
bool exists_any(const std::filesystem::path& pattern) {
  std::filesystem::path known;
  for (const auto& part : pattern) {
    if (part.string().find('*') == std::string::npos) {
      known /= part;
      continue;
    }
    std::error_code error;
    const bool last = part == pattern.filename();
    if (!last) return std::filesystem::is_directory(known, error);
    return !matching_files(known, part.string()).empty();
  }
  std::error_code error;
  return std::filesystem::exists(known, error);
}

/// What VTK's readers take for something else, and say nothing: curved cells of EnSight 6, through their corners; of Gold the
/// words behind "block curvilinear", which is the kind of block that none states, too.
void refuse_misread_geometry(const std::filesystem::path& pattern, bool ensight6) {
  std::filesystem::path path = pattern;
  if (path.filename().string().find('*') != std::string::npos) {
    const auto files = matching_files(path.parent_path(), path.filename().string());
    if (files.empty()) return;
    path = files.begin()->second;
  }
  constexpr std::size_t kFirstLine = 80;
  const bool binary = read_head(path, kFirstLine).bytes.find("Binary") != std::string::npos;
  std::ifstream lines(path, std::ios::binary);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t block = ensight6 ? std::string::npos : line.find("block ");
    if (block != std::string::npos && (block == 0 || binary)) {
      constexpr std::size_t kLine = 80;
      const std::string_view words = std::string_view(line).substr(block, kLine);
      const bool curvilinear = words.starts_with("block curvilinear ");
      for (const char* const word : {"range", "iblanked", "with_ghost"}) {
        const bool is_range = std::string_view(word) == "range";
        if (words.find(word) == std::string_view::npos || (!curvilinear && !is_range)) continue;
        throw input_error(
            {path.string(), "",
             "has a 'block' with '" + std::string(word) + "', which VTK's reader does not know there", "",
             is_range ? "write the whole block" : "take out 'curvilinear', which says nothing"});
      }
    }
    for (const char* const shape : {"tetra10", "hexa20", "penta15", "pyramid13"}) {
      const std::size_t at = ensight6 ? line.find(shape) : std::string::npos;
      if (at == std::string::npos || (at > 0 && !binary)) continue;
      throw input_error({path.string(), "",
                         std::string("has cells ") + shape + ", of which only corners are read",
                         "cells of corners alone in EnSight 6", "write it as EnSight Gold"});
    }
  }
}

}  // namespace

bool is_ensight6(std::string_view case_text) {
  for (const EnsightRow& row : ensight_rows(case_text)) {
    if (row.kind == "type") return row.line.find("gold") == std::string_view::npos;
  }
  return false;
}

std::string ensight_case_for_vtk(std::string_view text, const std::string& case_file,
                                 const std::string& prefix, std::set<std::string>& lost,
                                 std::vector<std::string>& notes) {
  const std::filesystem::path folder = std::filesystem::absolute(case_file).parent_path();
  std::string out;
  std::size_t sets_of_geometry = 0;
  for (const EnsightRow& row : ensight_rows(text)) {
    const bool is_model = row.section == "GEOMETRY" && row.kind == "model" && !row.words.empty();
    const bool is_values = row.is_variable() && row.words.size() > 1;
    if (!is_model && !is_values) {
      // Of what is not read VTK's reader may make something else.
      if (row.kind.empty() || (row.section != "GEOMETRY" && row.section != "VARIABLE"))
        out.append(row.line).append("\n");
      continue;
    }
    std::vector<std::string> words = row.words;
    std::size_t word = words.size() - 1;
    if (is_model) {
      // "model: [time set] [file set] file [change_coords_only …]"
      word = sets_of_geometry = row.sets(1);
    }
    // VTK looks for steps in the file of the geometry then, without an end.
    if (is_values && row.sets(2) == 2 && sets_of_geometry < 2) {
      throw input_error(
          {case_file, "",
           "has all steps of '" + words[words.size() - 2] + "' in one file, but a geometry without steps",
           "the geometry in a file set, too", "write a file a step (" + words.back() + "****)"});
    }
    std::string& file = words[word];
    const std::filesystem::path path = folder / file;
    if (!exists_any(path)) {
      if (is_model) throw input_error({path.string(), "", "is missing, the geometry of " + case_file});
      lost.insert(words[words.size() - 2]);
      notes.push_back("variable '" + words[words.size() - 2] + "' left out: its file " + path.string() +
                      " is missing");
      continue;
    }
    if (path.string().find(' ') != std::string::npos) {
      throw input_error({case_file, "", "names the file '" + path.string() + "'",
                         "names without blanks: VTK's reader knows none", "rename or link it"});
    }
    if (is_model) refuse_misread_geometry(path, is_ensight6(text));
    file = prefix + path.string();
    out += row.kind + ":";
    for (const std::string& part : words) out += " " + part;
    out += "\n";
  }
  return out;
}

std::vector<EnsightVariable> ensight_variables(std::string_view case_text) {
  std::vector<EnsightVariable> variables;
  for (const EnsightRow& row : ensight_rows(case_text)) {
    // Optional numbers of the time set and file set, then the name and the file.
    if (!row.is_variable() || row.words.size() < 2) continue;
    const bool on_points = row.kind.ends_with(" per node");
    variables.push_back({row.words[row.words.size() - 2],
                         on_points ? Association::kPoint : Association::kCell, row.words.back()});
  }
  return variables;
}

void check_ensight_values(const std::string& case_file, const std::string& variable, const EnsightCounts& due,
                          std::size_t values, std::size_t missing, std::size_t step, std::size_t steps) {
  constexpr std::size_t kTextBytes = 12;
  constexpr std::size_t kBinaryBytes = 4;
  const std::filesystem::path folder = std::filesystem::path(case_file).parent_path();
  const std::string case_text = read_head(case_file, kCaseBytes).bytes;
  for (const EnsightVariable& known : ensight_variables(case_text)) {
    if (known.name != variable || known.association != due.association) continue;
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
    const std::size_t each = text ? kTextBytes : kBinaryBytes;
    // A block "partial" has the values of some places alone, and VTK's reader NaN for the others.
    if (head.file_size < values * each && head.file_size >= (values - missing) * each && missing > 0 &&
        read_head(path, head.file_size).bytes.find(" partial") != std::string::npos)
      return;
    if (head.file_size < values * each) {
      throw input_error(
          {path.string(), "", "has " + std::to_string(head.file_size) + " bytes",
           "at least " + std::to_string(values * each) + " for " + std::to_string(values) + " values",
           "it may be truncated"});
    }
    const MappedFile mapped(path);
    std::string problem;
    if (!is_ensight6(case_text)) {
      problem = gold_counts_problem(mapped.text(), text, due);
    } else if (text && due.association == Association::kPoint) {
      problem = ensight6_counts_problem(mapped.text(), values);
    }
    if (!problem.empty()) throw input_error({path.string(), "", problem, "", "the file may be damaged"});
    return;
  }
}

}  // namespace palpate
