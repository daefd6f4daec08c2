#include "loaders/vtk/vtk_files.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <utility>

#include <vtkAbstractArray.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkVariant.h>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/find_format.h"
#include "common/load/voxel_bytes.h"
#include "loaders/vtk/file_index.h"
#include "loaders/vtk/file_names.h"
#include "loaders/vtk/ghost_cells.h"
#include "loaders/vtk/legacy_check.h"
#include "loaders/vtk/legacy_file.h"
#include "loaders/vtk/parallel_index.h"
#include "loaders/vtk/refined_levels.h"
#include "loaders/vtk/vtk_convert.h"
#include "loaders/vtk/xml_file.h"

namespace palpate {
namespace {

ScalarType type_of_xml(const std::string& name) {
  static const std::map<std::string, ScalarType> kTypes{
      {"Int8", ScalarType::kInt8},      {"UInt8", ScalarType::kUint8},   {"Int16", ScalarType::kInt16},
      {"UInt16", ScalarType::kUint16},  {"Int32", ScalarType::kInt32},   {"UInt32", ScalarType::kUint32},
      {"Int64", ScalarType::kInt64},    {"UInt64", ScalarType::kUint64}, {"Float32", ScalarType::kFloat32},
      {"Float64", ScalarType::kFloat64}};
  const auto found = kTypes.find(name);
  return found == kTypes.end() ? ScalarType::kFloat32 : found->second;
}

/// One open file: XML files with their reader, legacy files as a whole.
struct OpenFile {
  std::unique_ptr<XmlFile> xml;
  vtkSmartPointer<vtkDataObject> legacy;
};

constexpr int kSymmetric = 6;  ///< numbers of a symmetric tensor

/// VTK's order of a symmetric tensor, xx yy zz xy yz xz, becomes that of TensorLayout::kData, xx xy xz yy yz
/// zz.
DataArray in_rows(const DataArray& array) {
  static constexpr std::array<std::size_t, kSymmetric> kFrom{0, 3, 5, 1, 4, 2};
  const std::size_t size = byte_size(array.type);
  const auto bytes = std::make_shared<std::vector<std::byte>>(array.bytes.size());
  for (std::size_t t = 0; t < array.tuples; ++t) {
    for (std::size_t c = 0; c < kFrom.size(); ++c) {
      const auto from = array.bytes.subspan((kSymmetric * t + kFrom[c]) * size, size);
      std::copy(from.begin(), from.end(),
                bytes->begin() + static_cast<std::ptrdiff_t>((kSymmetric * t + c) * size));
    }
  }
  DataArray ordered = array;
  ordered.bytes = std::as_const(*bytes);
  ordered.owner = bytes;
  return ordered;
}

/// Words of strings, or of the codes of their letters, as one.
std::string text_of(vtkAbstractArray* stated) {
  std::string text;
  for (vtkIdType i = 0; i < stated->GetNumberOfValues(); ++i) {
    auto* const codes = vtkDataArray::SafeDownCast(stated);
    if (codes == nullptr) {
      text += stated->GetVariantValue(i).ToString();
      continue;
    }
    const double code = codes->GetComponent(i / codes->GetNumberOfComponents(),
                                            static_cast<int>(i % codes->GetNumberOfComponents()));
    if (code >= 1.0 && code < 128.0) text += static_cast<char>(code);
  }
  return text;
}

/// "LPS" and "RAS" by any of their names, else the word itself.
std::string space_named(std::string_view word) {
  const std::string name = lowered(trimmed(word));
  if (name == "lps" || name == "left-posterior-superior" || name == "lps+") return "LPS";
  if (name == "ras" || name == "right-anterior-superior" || name == "ras+") return "RAS";
  return std::string(trimmed(word));
}

/// What the file says of its space, "LPS": 3D Slicer states it in the title of legacy files, and in the field
/// data SPACE. Of lines and surfaces alone; empty where there is no word.
std::string space_of(const std::string& file, bool legacy, vtkDataSet* data) {
  if (vtkPolyData::SafeDownCast(data) == nullptr) return {};
  constexpr std::string_view kKey = "space";
  vtkFieldData* const fields = data->GetFieldData();
  for (int f = 0; f < fields->GetNumberOfArrays(); ++f) {
    vtkAbstractArray* const stated = fields->GetAbstractArray(f);
    const char* const name = stated->GetName();
    constexpr vtkIdType kLongest = 64;
    if (name == nullptr || lowered(trimmed(name)) != kKey || stated->GetNumberOfValues() > kLongest) continue;
    if (std::string space = space_named(text_of(stated)); !space.empty()) return space;
  }
  if (!legacy) return {};
  constexpr std::size_t kTwoLines = 384;
  const HeadOfFile head = read_head(file, kTwoLines);
  const std::vector<std::string_view> lines = split(head.bytes, '\n');
  const std::string_view title = lines.size() > 1 ? lines[1] : std::string_view();
  const std::string small = lowered(title);
  for (std::size_t at = small.find(kKey); at != std::string::npos; at = small.find(kKey, at + 1)) {
    std::string_view rest = title.substr(at + kKey.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    if (!rest.starts_with('=') && !rest.starts_with(':')) continue;
    rest.remove_prefix(1);
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t\""), rest.size()));
    return space_named(rest.substr(0, rest.find_first_of(" \t\r\",;")));
  }
  return {};
}

/// Positions with x and y turned around: from LPS to RAS.
DataArray from_lps(const DataArray& positions) {
  std::vector<double> turned;
  turned.reserve(3 * positions.tuples);
  for (std::size_t p = 0; p < positions.tuples; ++p) {
    for (int c = 0; c < 3; ++c) turned.push_back((c < 2 ? -1.0 : 1.0) * positions.at(p, c));
  }
  return make_array(positions.name, positions.association, 3, turned);
}

class VtkFiles : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format format) override {
    FileInfo info;
    arrange(request, format, info.notes);
    tensors_ = request.diffusion.has_value();
    std::string why = "holds no data";
    while (!describe_first_step(info, why)) {
      info.notes.push_back("time " + short_number(steps_.front().time) + " left out with it");
      steps_.erase(steps_.begin());
    }
    if (steps_.size() > 1) {
      for (const FileStep& step : steps_) info.times.push_back(step.time);
    }
    for (const BlockInfo& block : info.blocks) {
      for (const ArrayInfo& array : block.arrays) {
        if (!tensors_ || array.components != kSymmetric) continue;
        info.notes.push_back("array '" + array.name +
                             "': six numbers taken as a tensor in VTK's order (xx yy zz xy yz xz)");
      }
    }
    if (ghost_cells_ > 0) info.notes.push_back(ghost_cells_note(ghost_cells_));
    const auto& first = steps_.front().pieces;
    if (std::ranges::any_of(first, [](const FilePiece& piece) { return piece.level > 0; }))
      info.notes.emplace_back("where levels of refinement lie over one another, the finest counts");
    if (info.blocks.empty()) throw input_error({request.files.front().string(), "", why, "a volume"});
    has_volume_ = std::any_of(info.blocks.begin(), info.blocks.end(),
                              [](const BlockInfo& block) { return block.not_volume.empty(); });
    if (has_volume_) {
      for (const BlockInfo& block : info.blocks) {
        if (!block.not_volume.empty())
          info.notes.push_back("block '" + block.name + "' " + block.not_volume + "; left out");
      }
      std::erase_if(info.blocks, [](const BlockInfo& block) { return !block.not_volume.empty(); });
    }
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    if (step != open_step_) {
      open_files_.clear();  // one step at a time is kept
      open_step_ = step;
    }
    const std::set<std::string> wanted(names.begin(), names.end());
    std::vector<DataSet> blocks;
    std::vector<int> levels;
    std::string why = "holds no data";
    const auto& pieces = steps_[step].pieces;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      const std::string file = pieces[p].file.string();
      OpenFile& opened = open_file(file);
      for (const VtkBlock& block : leaves_of(opened.xml ? opened.xml->read(wanted) : opened.legacy.Get())) {
        std::string reason = why_not_readable(block.data);
        if (reason.empty() && has_volume_) reason = why_not_volume(block.data);
        if (!reason.empty()) {
          why = reason;
          continue;
        }
        blocks.push_back(convert_block(block.data, name_of_block(pieces[p], block), wanted, file));
        levels.push_back(pieces[p].level);
        if (auto* const cells = std::get_if<UnstructuredTopology>(&blocks.back().topology);
            cells != nullptr && space_of(file, !opened.xml, block.data) == "LPS") {
          cells->positions = from_lps(cells->positions);
        }
        for (DataArray& array : blocks.back().arrays) {
          if (tensors_ && array.components == kSymmetric) array = in_rows(array);
        }
      }
      if (on_progress) on_progress(static_cast<double>(p + 1) / static_cast<double>(pieces.size()));
    }
    if (blocks.empty()) throw input_error({pieces.front().file.string(), "", why, "a volume"});
    (void)hide_refined_cells(blocks, levels);
    return blocks;
  }

 private:
  void arrange(const LoadRequest& request, Format format, std::vector<std::string>& notes) {
    const bool index = format == Format::kVtkMultiBlock || format == Format::kVtkParallel ||
                       format == Format::kParaviewSeries;
    if (request.files.size() > 1) {
      std::vector<std::optional<double>> stated;
      for (const auto& file : request.files) stated.push_back(stated_time(file, format));
      steps_ = arrange_files(request.files, stated, notes);
    } else if (index) {
      steps_ = read_index(request.files.front(), format, notes,
                          [this](const auto& a, const auto& b) { return same_grid(a, b); });
    } else {
      steps_ = {{0.0, {{request.files.front(), ""}}}};
    }
    if (format == Format::kParaviewSeries && request.files.size() > 1) {
      throw input_error({request.files[1].string(), "", "is a second time series", "one"});
    }
    if (index) leave_out_missing(steps_, notes);
    if (format == Format::kLegacyVtk || format == Format::kVtkXml) return;
    // An index of time steps may name indices of blocks, and so may the files of a series.
    for (FileStep& step : steps_) {
      std::vector<FilePiece> pieces;
      for (const FilePiece& piece : step.pieces) {
        const std::vector<FilePiece> parts = parts_of(piece, index, notes);
        pieces.insert(pieces.end(), parts.begin(), parts.end());
      }
      step.pieces.swap(pieces);
    }
    if (index) leave_out_missing(steps_, notes);
  }

  /// The files that `piece` stands for. @param tolerant one that cannot be told costs itself and a word.
  static std::vector<FilePiece> parts_of(const FilePiece& piece, bool tolerant,
                                         std::vector<std::string>& notes) {
    try {
      const Format inner = find_format(piece.file);
      if (inner == Format::kVtkXml || inner == Format::kLegacyVtk) return {piece};
      if (inner == Format::kVtkMultiBlock || inner == Format::kVtkParallel)
        return read_index(piece.file, inner, notes, {}).front().pieces;
      throw input_error({piece.file.string(), "", "is " + std::string(row_of(inner).name), "a VTK file"});
    } catch (const Error& error) {
      if (!tolerant) throw;
      notes.push_back(std::string(error.what()) + ": left out");
      return {};
    }
  }

  /// The time in the file's own field data; of an index without one, that of its first piece.
  std::optional<double> stated_time(const std::filesystem::path& file, Format format) {
    constexpr std::size_t kLook = std::size_t{4} << 20U;
    if (format == Format::kLegacyVtk) return legacy_time(MappedFile(file.string()).text().substr(0, kLook));
    if (const auto time = xml_time(file.string(), errors_)) return time;
    if (format != Format::kVtkMultiBlock && format != Format::kVtkParallel) return std::nullopt;
    try {
      std::vector<std::string> notes;
      if (format == Format::kVtkParallel && read_parallel_index(file.string()).structured())
        return std::nullopt;
      const auto pieces = read_index(file, format, notes, {}).front().pieces;
      return pieces.empty() ? std::nullopt
                            : stated_time(pieces.front().file, find_format(pieces.front().file));
    } catch (const Error&) {
      return std::nullopt;  // what is wrong shows when it is read
    }
  }

  /// Boxes are alike up to this part of their diagonal.
  static constexpr double kSameBox = 1e-6;

  bool same_grid(const std::filesystem::path& first, const std::filesystem::path& second) {
    const auto blocks_of = [this](const std::filesystem::path& file) {
      FileInfo info;
      std::string why;
      for (const FilePiece& piece : parts_of({file, ""}, false, info.notes)) describe(piece, info, why);
      return info.blocks;
    };
    try {
      const std::vector<BlockInfo> a = blocks_of(first), b = blocks_of(second);
      return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const BlockInfo& p, const BlockInfo& q) {
        const double near = kSameBox * glm::length(p.bounds.upper - p.bounds.lower);
        return p.point_count == q.point_count && p.cell_count == q.cell_count &&
               glm::length(p.bounds.lower - q.bounds.lower) <= near &&
               glm::length(p.bounds.upper - q.bounds.upper) <= near &&
               std::equal(p.arrays.begin(), p.arrays.end(), q.arrays.begin(), q.arrays.end(),
                          [](const ArrayInfo& x, const ArrayInfo& y) {
                            return x.name == y.name && x.association == y.association;
                          });
      });
    } catch (const Error&) {
      return false;
    }
  }

  OpenFile& open_file(const std::string& file) {
    OpenFile& opened = open_files_[file];
    if (opened.xml || opened.legacy != nullptr) return opened;
    if (find_format(file) == Format::kLegacyVtk) {
      opened.legacy = read_legacy(file, errors_);
    } else {
      opened.xml = std::make_unique<XmlFile>(file, errors_);
    }
    return opened;
  }

  /// Adds the blocks of the first step to `info`. A damaged piece costs itself and a word where others are
  /// left. False where none is, but another step.
  bool describe_first_step(FileInfo& info, std::string& why) {
    std::vector<FilePiece>& pieces = steps_.front().pieces;
    std::vector<FilePiece> good;
    for (const FilePiece& piece : pieces) {
      try {
        describe(piece, info, why);
        good.push_back(piece);
      } catch (const Error& error) {
        if (pieces.size() == 1 && steps_.size() == 1) throw;
        why = error.what();
        info.notes.push_back(why + ": left out");
      }
    }
    if (good.empty()) return steps_.size() == 1;
    pieces.swap(good);
    return true;
  }

  /// Adds the blocks of one file to `info`; notes what cannot be read, and why.
  void describe(const FilePiece& piece, FileInfo& info, std::string& why) {
    const std::string file = piece.file.string();
    OpenFile& opened = open_file(file);
    constexpr std::size_t kThreeLines = 512;
    if (!opened.xml && read_head(file, kThreeLines).bytes.find("\nASCII") != std::string::npos) {
      const std::string note = text_end_note(file);
      if (!note.empty()) info.notes.push_back(note);
    }
    for (const VtkBlock& block : leaves_of(opened.xml ? opened.xml->read({}) : opened.legacy.Get())) {
      const std::string name = name_of_block(piece, block);
      if (std::string reason = why_not_readable(block.data); !reason.empty()) {
        why = reason;
        info.notes.push_back(
            std::string("block '").append(name).append("' ").append(reason).append("; left out"));
        continue;
      }
      BlockInfo about = describe_block(block.data, name);
      ghost_cells_ += ghost_cell_count(block.data);
      if (opened.xml) {
        about.arrays.clear();
        for (const XmlArray& array : opened.xml->scan().arrays) {
          if (array.name == "vtkGhostType" || array.type == "String") continue;
          about.arrays.push_back({array.name, array.on_points ? Association::kPoint : Association::kCell,
                                  array.components, type_of_xml(array.type),
                                  as_size(array.on_points ? about.point_count : about.cell_count)});
        }
      }
      if (const std::string space = space_of(file, !opened.xml, block.data); !space.empty()) {
        const bool lps = space == "LPS";
        info.anatomical = lps || space == "RAS";
        info.notes.push_back(std::string(info.anatomical ? "" : "WARNING: ") + "states SPACE=" + space +
                             (lps              ? ": turned into RAS (x and y turned around); vectors and "
                                                 "tensors along it are left as they are"
                              : space == "RAS" ? ""
                                               : ", which is not known: coordinates as they are"));
        if (lps) {
          std::swap(about.bounds.lower.x, about.bounds.upper.x);
          std::swap(about.bounds.lower.y, about.bounds.upper.y);
          for (Vec3* const corner : {&about.bounds.lower, &about.bounds.upper})
            *corner *= Vec3{-1.0, -1.0, 1.0};
        }
      }
      if (!info.long_axis) info.long_axis = long_axis_of(block.data);
      info.blocks.push_back(std::move(about));
    }
  }

  static std::string name_of_block(const FilePiece& piece, const VtkBlock& block) {
    if (piece.name.empty()) return block.name;
    return block.name.empty() ? piece.name : piece.name + "/" + block.name;
  }

  VtkErrors errors_;
  std::vector<FileStep> steps_;
  bool tensors_ = false;    ///< asked for: arrays of six numbers are symmetric tensors
  bool has_volume_ = true;  ///< of the first step: then what is no volume is left out
  std::size_t open_step_ = 0;
  std::size_t ghost_cells_ = 0;  ///< of the first step
  std::map<std::string, OpenFile> open_files_;
};

}  // namespace

std::unique_ptr<Loader> make_vtk_loader() { return std::make_unique<VtkFiles>(); }

}  // namespace palpate
