#include "common/window/files/dropped_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/load/find_format.h"
#include "common/load/plot3d_layout.h"
#include "common/scene/session_of.h"

namespace palpate {
namespace {

bool is_solution(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return false;
  try {
    const HeadOfFile read = read_head(file, kSniffBytes, kPlot3dTailBytes);
    const std::string ending = file.extension().string();
    const Sniffed sniffed = sniff(
        {std::as_bytes(std::span(read.bytes)), std::as_bytes(std::span(read.tail)), read.file_size, ending});
    return !sniffed.format && sniffed.found == "a PLOT3D solution";
  } catch (const Error&) {
    return false;  // the model says what is wrong with it
  }
}

/// Whether the ending is of formats that hold tracts alone.
bool is_tractogram(const std::filesystem::path& file) {
  const bool packed = lowered(file.extension().string()) == ".gz";
  const std::string ending = (packed ? file.stem() : file).extension().string();
  return std::ranges::any_of(format_rows(), [&](const FormatRow& row) {
    return row.holds == "tracts" && names_ending(row, ending) && (row.gzip || !packed);
  });
}

bool is_gradient_table(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 6> kEndings{".bval",  ".bvals", ".bvec",
                                                     ".bvecs", ".b",     ".eddy_rotated_bvecs"};
  return std::ranges::find(kEndings, file.extension().string()) != kEndings.end();
}

/// Takes out gradient tables that an image of the set finds by itself, for they have its name and lie beside it.
/// @throws Error (usage) for others.
void take_gradients(std::vector<std::filesystem::path>& data) {
  const auto tables = std::stable_partition(
      data.begin(), data.end(), [](const std::filesystem::path& file) { return !is_gradient_table(file); });
  if (tables == data.begin()) return;  // alone they are none that could be opened, as the model says
  for (auto table = tables; table != data.end(); ++table) {
    const std::string name = table->stem().string() + ".";
    const bool found = std::any_of(data.begin(), tables, [&](const std::filesystem::path& image) {
      return image.parent_path() == table->parent_path() && image.filename().string().starts_with(name);
    });
    if (!found)
      throw usage_error(table->filename().string() +
                        " is no table of an image that came with it: the image would have its name, " + name +
                        "nii.gz; else start with --bval and --bvec");
  }
  data.erase(tables, data.end());
}

enum class Table : std::uint8_t { kNone, kSeeds, kTransfer };

/// By the first line: no data that can be opened are a table of comma-separated values.
Table table_of(const std::filesystem::path& file) {
  if (file.extension() != ".csv" && file.extension() != ".txt") return Table::kNone;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  if (line.find("opacity") != std::string::npos) return Table::kTransfer;
  std::erase_if(line, [](unsigned char c) { return std::isspace(c) != 0 || c == '"'; });
  line = "," + line + ",";
  const auto has = [&](const char* column) { return line.find(column) != std::string::npos; };
  return has(",x,") && has(",y,") && has(",z,") ? Table::kSeeds : Table::kNone;
}

/// Puts `file` where there may be one of its kind.
void put(const std::filesystem::path& file, const char* what, std::filesystem::path& place) {
  if (!place.empty()) {
    throw usage_error(place.filename().string() + " and " + file.filename().string() + " are two " + what +
                      ": open one at a time");
  }
  place = file;
}

}  // namespace

InputFiles sort_dropped(const std::vector<std::filesystem::path>& files, const InputFiles* open,
                        std::vector<InputFiles>& beside) {
  InputFiles sorted;
  for (const auto& file : files) {
    if (is_session(file)) {
      put(file, "sessions", sorted.session);
    } else if (const Table table = table_of(file); table != Table::kNone) {
      const bool seeds = table == Table::kSeeds;
      put(file, seeds ? "tables of seeds" : "transfer functions", seeds ? sorted.seeds : sorted.transfer);
    } else if (!sorted.solution && is_solution(file)) {
      sorted.solution = file;
    } else {
      sorted.files.push_back(file);
    }
  }
  std::vector<std::filesystem::path>& data = sorted.files;
  take_gradients(data);
  const auto tracts = std::stable_partition(
      data.begin(), data.end(), [](const std::filesystem::path& file) { return !is_tractogram(file); });
  // Alone they are what is opened, beside what is open or in place of it.
  if (tracts != data.begin() || !sorted.session.empty()) {
    for (auto file = tracts; file != data.end(); ++file) beside.emplace_back().files.push_back(*file);
    data.erase(tracts, data.end());
  }
  if (sorted.solution && sorted.files.empty() && open != nullptr) sorted.files = open->files;
  // Alone with nothing to go with, it is told by the model what it lacks.
  if (sorted.files.empty() && sorted.solution) sorted.files.push_back(*std::exchange(sorted.solution, {}));
  return sorted;
}

}  // namespace palpate
