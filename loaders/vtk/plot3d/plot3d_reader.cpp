/// PLOT3D grid and solution through vtkMultiBlockPLOT3DReader, told the layout that was found
/// (plot3d_layout.h).
#include <algorithm>
#include <bit>
#include <filesystem>
#include <optional>

#include <vtkMultiBlockDataSet.h>
#include <vtkMultiBlockPLOT3DReader.h>
#include <vtkSmartPointer.h>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/files/memory_text.h"
#include "common/base/json.h"
#include "common/base/text.h"
#include "common/load/find_format.h"
#include "common/load/plot3d_layout.h"
#include "loaders/vtk/plot3d/plot3d_values.h"
#include "loaders/vtk/solver_readers.h"
#include "loaders/vtk/vtk_convert.h"
#include "loaders/vtk/vtk_errors.h"

namespace palpate {
namespace {

Plot3dLayout layout_of(const std::string& file, Plot3dFile kind) {
  const HeadOfFile head = read_head(file, kPlot3dHeadBytes, kPlot3dTailBytes);
  const Plot3dBytes bytes{std::as_bytes(std::span(head.bytes)), std::as_bytes(std::span(head.tail)),
                          head.file_size};
  auto layout = find_plot3d_layout(bytes, kind);
  if (!layout && may_be_plot3d_text(bytes, kind)) {
    layout = find_plot3d_text_layout(MappedFile(file).text(), kind);
    if (!layout) {
      throw input_error({file, "", "the count of its numbers does not fit its dimensions", "",
                         "it may be truncated, have words that are no numbers, or repeat over 2^24 of them"});
    }
  }
  if (!layout) {
    throw input_error({file, "",
                       "its " + std::to_string(head.file_size) + " bytes fit no layout of a PLOT3D " +
                           (kind == Plot3dFile::kGrid ? "grid" : "solution"),
                       "dimensions that agree with the file's size",
                       "it may be truncated, or the solution of another grid"});
  }
  return *layout;
}

/// A grid with its solution, which may be empty.
struct Pair {
  double time = 0.0;
  std::string grid, solution;
};

/// Names of functions, one a line: a file of the solution's name that ends with .nam, as FieldView has it.
std::vector<std::string> names_beside(const std::string& solution) {
  const std::filesystem::path file = std::filesystem::path(solution).replace_extension(".nam");
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return {};
  const std::string text = read_head(file, kPlot3dHeadBytes).bytes;
  std::vector<std::string> names;
  for (const std::string_view line : split(text, '\n')) {
    const std::string_view name = trimmed(line.substr(0, line.find(';')));
    if (!name.empty()) names.push_back(printable(name));
  }
  return names;
}

/// ParaView's list: {"filenames": [{"time": 0.0, "xyz": "a.xyz", "q": "a.q"}, …], "function-names": […]}, names relative
/// to its folder; "function" in place of "q" is a file of functions.
std::vector<Pair> read_index(const std::string& file, std::vector<std::string>& names) {
  const auto index = parse_json(MappedFile(file).text());
  const auto wrong = [&file](const std::string& found) {
    return input_error({file, "", found,
                        R"({"filenames": [{"time": 0.0, "xyz": "GRID", "q": "SOLUTION"}, …]})",
                        "it may be truncated"});
  };
  if (!index.is_object() || !index.contains("filenames") || !index["filenames"].is_array() ||
      index["filenames"].empty())
    throw wrong("is no list of PLOT3D files");
  std::vector<Pair> out;
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  for (const auto& entry : index["filenames"]) {
    const auto has = [&entry](const char* key, bool needed) {
      return entry.contains(key) ? entry[key].is_string() : !needed;
    };
    if (entry.is_object() && entry.contains("q") && entry.contains("function"))
      throw wrong("names a solution and functions of one grid");
    if (!entry.is_object() || !has("xyz", true) || !has("q", false) || !has("function", false) ||
        (entry.contains("time") && !entry["time"].is_number()))
      throw wrong("has an entry without a grid, or of other types");
    Pair& pair = out.emplace_back();
    pair.time = entry.value("time", static_cast<double>(out.size() - 1));
    pair.grid = (folder / entry["xyz"].get<std::string>()).string();
    for (const char* const key : {"q", "function"}) {
      if (entry.contains(key)) pair.solution = (folder / entry[key].get<std::string>()).string();
    }
    if (out.size() > 1 &&
        (pair.solution.empty() != out.front().solution.empty() || !(pair.time > out[out.size() - 2].time)))
      throw wrong("has times that do not rise, or solutions at some of them alone");
  }
  if (index.contains("function-names") && index["function-names"].is_array()) {
    for (const auto& name : index["function-names"]) {
      if (name.is_string()) names.push_back(printable(name.get<std::string>()));
    }
  }
  return out;
}

class Plot3dReader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format) override {
    if (request.files.size() > 1) {
      throw input_error({request.files[1].string(), "", "is a second PLOT3D grid", "one grid file",
                         "pass a solution with --solution"});
    }
    const std::string file = request.files.front().string();
    if (read_head(file, 1).bytes == "{") {
      pairs_ = read_index(file, names_);
      if (request.solution)
        throw input_error(
            {request.solution->string(), "", "is a second solution: " + file + " names its own"});
    } else {
      pairs_ = {{0.0, file, request.solution ? request.solution->string() : ""}};
    }
    FileInfo info;
    // Layouts may differ from time to time; all files are there before one is read.
    for (std::size_t step = pairs_.size(); step-- > 0;) choose(step);
    info.notes.push_back("grid: " + describe(grid_, Plot3dFile::kGrid));
    info.notes.push_back(solution_file_.empty() ? "no solution file was given: a grid without values"
                         : values_              ? "solution: " + describe(*values_)
                                                : "solution: " + describe(solution_, Plot3dFile::kSolution));
    if (values_ && !values_->overflow && names_.empty() && values_->parts.front().count != 3)
      info.notes.emplace_back(
          "WARNING: the file does not say which of its functions are a velocity: any three that follow one another are "
          "offered (--field); a file beside it that ends with .nam names them, one a line");
    if (converted())
      info.notes.emplace_back("grid and solution are of different layouts: converted in memory");
    if (pairs_.size() > 1) {
      for (const Pair& pair : pairs_) info.times.push_back(pair.time);
    }

    for (const VtkBlock& block : leaves_of(run(false))) {
      BlockInfo about = describe_block(block.data, block.name);
      std::erase_if(about.arrays, [](const ArrayInfo& array) { return array.name == "IBlank"; });
      if (values_) {
        for (const Plot3dArray& array : arrays_of(*values_, info.blocks.size(), axes(), names_)) {
          about.arrays.push_back({array.name, Association::kPoint,
                                  array.components == 2 ? 3 : array.components, ScalarType::kFloat64,
                                  about.point_count});
        }
      } else if (!solution_file_.empty()) {
        const ScalarType type =
            solution_.double_precision || converted() ? ScalarType::kFloat64 : ScalarType::kFloat32;
        for (const auto& [name, components] :
             {std::pair{"Density", 1}, {"Momentum", 3}, {"StagnationEnergy", 1}}) {
          about.arrays.push_back({name, Association::kPoint, components, type, about.point_count});
        }
      }
      info.blocks.push_back(std::move(about));
    }
    check_blocks(info.blocks.size());
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    choose(step);
    std::set<std::string> wanted(names.begin(), names.end());
    if (grid_.blanking) wanted.insert("IBlank");
    vtkDataObject* data = run(!solution_file_.empty() && !values_ && !names.empty());
    const std::optional<MappedFile> file = values_ ? std::optional<MappedFile>(solution_file_) : std::nullopt;
    std::vector<DataSet> blocks;
    for (const VtkBlock& block : leaves_of(data)) {
      blocks.push_back(convert_block(block.data, block.name, wanted, grid_file_));
      if (grid_.blanking) apply_blanking(blocks.back());
      if (!values_ || blocks.size() > values_->parts.size()) continue;
      for (const Plot3dArray& array : arrays_of(*values_, blocks.size() - 1, axes(), names_)) {
        if (wanted.count(array.name) > 0)
          blocks.back().arrays.push_back(read_values(file->text(), *values_, blocks.size() - 1, array));
      }
    }
    check_blocks(blocks.size());
    return blocks;
  }

 private:
  [[nodiscard]] int axes() const { return grid_.two_dimensional ? 2 : 3; }
  /// The blanked points are those where iblank is 0. VTK hides the cells around them, from which they could
  /// not be told apart from their neighbours.
  static void apply_blanking(DataSet& block) {
    const auto iblank = std::find_if(block.arrays.begin(), block.arrays.end(),
                                     [](const DataArray& array) { return array.name == "IBlank"; });
    if (iblank == block.arrays.end()) return;
    block.hidden_cells.clear();
    block.visible.resize(iblank->tuples);
    for (std::size_t p = 0; p < iblank->tuples; ++p) block.visible[p] = iblank->at(p) != 0.0 ? 1 : 0;
    block.arrays.erase(iblank);
  }

  /// Takes the files of a step.
  void choose(std::size_t step) {
    const Pair& pair = pairs_[step];
    if (grid_file_ != pair.grid) grid_ = layout_of(pair.grid, Plot3dFile::kGrid);
    if ((solution_file_ != pair.solution || grid_file_ != pair.grid) && !pair.solution.empty()) {
      values_ = find_plot3d_values(MappedFile(pair.solution).text(), grid_);
      if (!values_) solution_ = layout_of(pair.solution, Plot3dFile::kSolution);
      if (values_ && names_.empty()) names_ = names_beside(pair.solution);
    }
    grid_file_ = pair.grid;
    solution_file_ = pair.solution;
    if (!solution_file_.empty() && !values_) check_solution();
  }

  /// Whether both files are handed to VTK in another layout (plot3d_bytes()). One setting of its reader covers both, and
  /// of text it would read some in single precision and others not at all.
  [[nodiscard]] bool converted() const {
    return grid_.text ||
           (!solution_file_.empty() && !values_ &&
            (solution_.text || solution_.big_endian != grid_.big_endian ||
             solution_.record_marks != grid_.record_marks || solution_.multi_grid != grid_.multi_grid ||
             solution_.double_precision != grid_.double_precision));
  }

  void check_solution() const {
    if (solution_.grids != grid_.grids) {
      const Index3 n = grid_.grids.front();
      const Index3 m = solution_.grids.front();
      const auto text = [](const Plot3dLayout& layout, const Index3& d) {
        return std::to_string(layout.grids.size()) + " grids, the first of " + std::to_string(d.x) + " x " +
               std::to_string(d.y) + " x " + std::to_string(d.z) + " points";
      };
      throw input_error(
          {solution_file_, "", "has " + text(solution_, m), text(grid_, n) + " as in " + grid_file_});
    }
    if (solution_.two_dimensional != grid_.two_dimensional) {
      throw input_error(
          {solution_file_, "", "is " + describe(solution_, Plot3dFile::kSolution),
           "the dimensions of " + grid_file_ + " (" + describe(grid_, Plot3dFile::kGrid) + ")"});
    }
  }

  void check_blocks(std::size_t found) const {
    if (found == grid_.grids.size()) return;
    throw input_error({grid_file_, "", "VTK's reader returned " + std::to_string(found) + " grids",
                       std::to_string(grid_.grids.size())});
  }

  /// The file itself, or bytes in memory.
  [[nodiscard]] std::string readable(const std::string& file, const Plot3dLayout& layout, Plot3dFile kind,
                                     MemoryText& memory) const {
    return converted() ? memory.write(plot3d_bytes(MappedFile(file).text(), layout, kind)) : file;
  }

  vtkDataObject* run(bool with_solution) {
    reader_ = vtkSmartPointer<vtkMultiBlockPLOT3DReader>::New();
    reader_->SetXYZFileName(readable(grid_file_, grid_, Plot3dFile::kGrid, grid_text_).c_str());
    if (with_solution)
      reader_->SetQFileName(
          readable(solution_file_, solution_, Plot3dFile::kSolution, solution_text_).c_str());
    reader_->SetAutoDetectFormat(0);
    reader_->SetBinaryFile(1);
    const bool native = converted();
    if (native) reader_->ForceReadOn();  // what it guesses of the layout is another one at times
    reader_->SetByteOrder((native ? std::endian::native == std::endian::big : grid_.big_endian)
                              ? vtkMultiBlockPLOT3DReader::FILE_BIG_ENDIAN
                              : vtkMultiBlockPLOT3DReader::FILE_LITTLE_ENDIAN);
    reader_->SetHasByteCount(!native && grid_.record_marks ? 1 : 0);
    reader_->SetMultiGrid(native || grid_.multi_grid ? 1 : 0);
    reader_->SetIBlanking(grid_.blanking ? 1 : 0);
    reader_->SetTwoDimensionalGeometry(grid_.two_dimensional ? 1 : 0);
    reader_->SetDoublePrecision(native || grid_.double_precision ? 1 : 0);
    // Stored values only; derived ones are made where they are asked for.
    reader_->SetScalarFunctionNumber(-1);
    reader_->SetVectorFunctionNumber(-1);
    reader_->Update();
    errors_.check(with_solution ? solution_file_ : grid_file_);
    return reader_->GetOutput();
  }

  std::vector<Pair> pairs_;  ///< by time
  VtkErrors errors_;
  vtkSmartPointer<vtkMultiBlockPLOT3DReader> reader_;
  std::string grid_file_;
  std::string solution_file_;
  MemoryText grid_text_;
  MemoryText solution_text_;
  Plot3dLayout grid_;
  Plot3dLayout solution_;
  std::optional<Plot3dValues> values_;  ///< in place of `solution_`
  std::vector<std::string> names_;      ///< of functions
};

}  // namespace

std::unique_ptr<Loader> make_plot3d_reader() { return std::make_unique<Plot3dReader>(); }

}  // namespace palpate
