/// PLOT3D grid and solution through vtkMultiBlockPLOT3DReader, told the layout that was found
/// (plot3d_layout.h).
#include <algorithm>
#include <bit>

#include <vtkMultiBlockDataSet.h>
#include <vtkMultiBlockPLOT3DReader.h>
#include <vtkSmartPointer.h>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
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
    throw input_error({file, "",
                       "its " + std::to_string(head.file_size) + " bytes fit no layout of a PLOT3D " +
                           (kind == Plot3dFile::kGrid ? "grid" : "solution"),
                       "dimensions that agree with the file's size", "it may be truncated"});
  }
  return *layout;
}

class Plot3dReader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format) override {
    if (request.files.size() > 1) {
      throw input_error({request.files[1].string(), "", "is a second PLOT3D grid", "one grid file",
                         "pass a solution with --solution"});
    }
    grid_file_ = request.files.front().string();
    grid_ = layout_of(grid_file_, Plot3dFile::kGrid);
    FileInfo info;
    info.notes.push_back("grid: " + describe(grid_, Plot3dFile::kGrid));
    if (request.solution) {
      solution_file_ = request.solution->string();
      solution_ = layout_of(solution_file_, Plot3dFile::kSolution);
      info.notes.push_back("solution: " + describe(solution_, Plot3dFile::kSolution));
      check_solution();
    } else {
      info.notes.emplace_back("no solution file was given: a grid without values");
    }

    for (const VtkBlock& block : leaves_of(run(false))) {
      BlockInfo about = describe_block(block.data, block.name);
      std::erase_if(about.arrays, [](const ArrayInfo& array) { return array.name == "IBlank"; });
      if (request.solution) {
        const ScalarType type = solution_.double_precision ? ScalarType::kFloat64 : ScalarType::kFloat32;
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

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t) override {
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
    // One setting of the reader covers both files.
    if (solution_.big_endian != grid_.big_endian || solution_.record_marks != grid_.record_marks ||
        solution_.multi_grid != grid_.multi_grid || solution_.text != grid_.text ||
        solution_.two_dimensional != grid_.two_dimensional ||
        solution_.double_precision != grid_.double_precision) {
      throw input_error({solution_file_, "", "is " + describe(solution_, Plot3dFile::kSolution),
                         "the layout of " + grid_file_ + " (" + describe(grid_, Plot3dFile::kGrid) + ")"});
    }
  }

  void check_blocks(std::size_t found) const {
    if (found == grid_.grids.size()) return;
    throw input_error({grid_file_, "", "VTK's reader returned " + std::to_string(found) + " grids",
                       std::to_string(grid_.grids.size())});
  }

  /// The file itself, or bytes in memory of what it holds as text, of which VTK would read some in single precision
  /// and others not at all.
  static std::string readable(const std::string& file, const Plot3dLayout& layout, Plot3dFile kind,
                              MemoryText& memory) {
    return layout.text ? memory.write(plot3d_bytes(MappedFile(file).text(), layout, kind)) : file;
  }

  vtkDataObject* run(bool with_solution) {
    reader_ = vtkSmartPointer<vtkMultiBlockPLOT3DReader>::New();
    reader_->SetXYZFileName(readable(grid_file_, grid_, Plot3dFile::kGrid, grid_text_).c_str());
    if (with_solution)
      reader_->SetQFileName(
          readable(solution_file_, solution_, Plot3dFile::kSolution, solution_text_).c_str());
    reader_->SetAutoDetectFormat(0);
    reader_->SetBinaryFile(1);
    reader_->SetByteOrder(grid_.big_endian || (grid_.text && std::endian::native == std::endian::big)
                              ? vtkMultiBlockPLOT3DReader::FILE_BIG_ENDIAN
                              : vtkMultiBlockPLOT3DReader::FILE_LITTLE_ENDIAN);
    reader_->SetHasByteCount(grid_.record_marks ? 1 : 0);
    reader_->SetMultiGrid(grid_.multi_grid ? 1 : 0);
    reader_->SetIBlanking(grid_.blanking ? 1 : 0);
    reader_->SetTwoDimensionalGeometry(grid_.two_dimensional ? 1 : 0);
    reader_->SetDoublePrecision(grid_.double_precision ? 1 : 0);
    // Stored values only; derived ones are made where they are asked for.
    reader_->SetScalarFunctionNumber(-1);
    reader_->SetVectorFunctionNumber(-1);
    reader_->Update();
    errors_.check(with_solution ? solution_file_ : grid_file_);
    return reader_->GetOutput();
  }

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
