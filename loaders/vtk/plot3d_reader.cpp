/// PLOT3D grid and solution through vtkMultiBlockPLOT3DReader, told the layout that was found
/// (plot3d_layout.h).
#include <algorithm>
#include <bit>
#include <filesystem>

#include <vtkMultiBlockDataSet.h>
#include <vtkMultiBlockPLOT3DReader.h>
#include <vtkSmartPointer.h>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/json.h"
#include "common/load/find_format.h"
#include "common/load/plot3d_layout.h"
#include "loaders/vtk/memory_text.h"
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
    throw input_error(
        {file, "",
         "its " + std::to_string(head.file_size) + " bytes fit no layout of a PLOT3D " +
             (kind == Plot3dFile::kGrid ? "grid" : "solution"),
         "dimensions that agree with the file's size",
         kind == Plot3dFile::kGrid
             ? "it may be truncated"
             : "it may be truncated, or a file of functions or of OVERFLOW, which are not read: write "
               "the five values of PLOT3D"});
  }
  return *layout;
}

/// A grid with its solution, which may be empty.
struct Pair {
  double time = 0.0;
  std::string grid, solution;
};

/// ParaView's list: {"filenames": [{"time": 0.0, "xyz": "a.xyz", "q": "a.q"}, …]}, names relative to its folder.
std::vector<Pair> read_index(const std::string& file) {
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
    if (!entry.is_object() || !has("xyz", true) || !has("q", false) ||
        (entry.contains("time") && !entry["time"].is_number()))
      throw wrong("has an entry without a grid, or of other types");
    Pair& pair = out.emplace_back();
    pair.time = entry.value("time", static_cast<double>(out.size() - 1));
    pair.grid = (folder / entry["xyz"].get<std::string>()).string();
    if (entry.contains("q")) pair.solution = (folder / entry["q"].get<std::string>()).string();
    if (out.size() > 1 &&
        (pair.solution.empty() != out.front().solution.empty() || !(pair.time > out[out.size() - 2].time)))
      throw wrong("has times that do not rise, or solutions at some of them alone");
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
      pairs_ = read_index(file);
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
                                                : "solution: " + describe(solution_, Plot3dFile::kSolution));
    if (converted())
      info.notes.emplace_back("grid and solution are of different layouts: converted in memory");
    if (pairs_.size() > 1) {
      for (const Pair& pair : pairs_) info.times.push_back(pair.time);
    }

    for (const VtkBlock& block : leaves_of(run(false))) {
      BlockInfo about = describe_block(block.data, block.name);
      std::erase_if(about.arrays, [](const ArrayInfo& array) { return array.name == "IBlank"; });
      if (!solution_file_.empty()) {
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
    vtkDataObject* data = run(!solution_file_.empty() && !names.empty());
    std::vector<DataSet> blocks;
    for (const VtkBlock& block : leaves_of(data)) {
      blocks.push_back(convert_block(block.data, block.name, wanted, grid_file_));
      if (grid_.blanking) apply_blanking(blocks.back());
    }
    check_blocks(blocks.size());
    return blocks;
  }

 private:
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
    if (solution_file_ != pair.solution && !pair.solution.empty())
      solution_ = layout_of(pair.solution, Plot3dFile::kSolution);
    grid_file_ = pair.grid;
    solution_file_ = pair.solution;
    if (!solution_file_.empty()) check_solution();
  }

  /// Whether both files are handed to VTK in another layout (plot3d_bytes()). One setting of its reader covers both, and
  /// of text it would read some in single precision and others not at all.
  [[nodiscard]] bool converted() const {
    return grid_.text ||
           (!solution_file_.empty() &&
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
};

}  // namespace

std::unique_ptr<Loader> make_plot3d_reader() { return std::make_unique<Plot3dReader>(); }

}  // namespace palpate
