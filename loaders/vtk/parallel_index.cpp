#include "loaders/vtk/parallel_index.h"

#include <algorithm>
#include <cstdlib>
#include <set>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/text.h"

namespace palpate {
namespace {

constexpr std::size_t kMaxPieces = 1'000'000;

int components_of(const XmlTag& tag) {
  const std::string& text = tag.at("NumberOfComponents");
  return text.empty() ? 1 : std::atoi(text.c_str());
}

/// Whether `arrays` has one of that name, place and shape.
bool has(const std::vector<XmlArray>& arrays, const XmlArray& wanted) {
  return std::any_of(arrays.begin(), arrays.end(), [&wanted](const XmlArray& array) {
    return array.name == wanted.name && array.on_points == wanted.on_points &&
           array.components == wanted.components;
  });
}

}  // namespace

bool ParallelIndex::structured() const noexcept {
  return data_type == "PImageData" || data_type == "PRectilinearGrid" || data_type == "PStructuredGrid";
}

ParallelIndex read_parallel_index(const std::string& file) {
  const MappedFile mapped(file);
  ParallelIndex index;
  XmlTags tags(mapped.text());
  XmlTag tag;
  std::string section;
  bool complete = false;
  while (tags.next(tag)) {
    if (tag.name == "VTKFile") {
      if (tag.opens) index.data_type = tag.at("type");
      complete = complete || tag.closes;
    } else if (tag.name == "PPointData" || tag.name == "PCellData") {
      section = tag.opens && !tag.closes ? tag.name : "";
    } else if (!tag.opens) {
      continue;
    } else if (tag.name == index.data_type) {
      index.whole_extent = tag.at("WholeExtent");
    } else if ((tag.name == "PDataArray" || tag.name == "DataArray") && !section.empty()) {
      index.arrays.push_back({tag.at("Name"), tag.at("type"), components_of(tag), section == "PPointData"});
    } else if (tag.name == "Piece") {
      if (tag.at("Source").empty()) throw input_error({file, "", "has a Piece without a Source"});
      if (index.pieces.size() >= kMaxPieces) throw input_error({file, "", "names too many pieces"});
      index.pieces.push_back(
          {std::filesystem::path(file).parent_path() / tag.at("Source"), tag.at("Extent")});
    }
  }
  if (!complete)
    throw input_error({file, "", "its end is missing (no </VTKFile>)", "", "it may be truncated"});
  if (index.pieces.empty()) throw input_error({file, "", "names no piece", "a Piece with a Source"});
  return index;
}

XmlScan check_parallel(const std::string& file, const ParallelIndex& index) {
  const auto whole = extent_of(index.whole_extent);
  if (!whole) {
    throw input_error(
        {file, "", "WholeExtent=\"" + index.whole_extent.substr(0, 60) + "\"", "six increasing numbers"});
  }
  std::vector<std::size_t> with_letters;
  std::set<std::filesystem::path> seen;
  std::vector<Extent> extents;
  for (const ParallelPiece& piece : index.pieces) {
    const std::string name = piece.file.string();
    if (!seen.insert(piece.file.lexically_normal()).second)
      throw input_error({file, "", "names the piece " + name + " twice"});
    const MappedFile mapped(name);
    const XmlScan scan = scan_xml(mapped.text());
    if (!scan.problem.empty()) throw input_error({name, "", scan.problem, "", "the file may be damaged"});
    if ("P" + scan.data_type != index.data_type) {
      throw input_error({name, "", "is of type '" + scan.data_type.substr(0, 40) + "'",
                         "pieces of a " + index.data_type + " as in " + file});
    }
    const auto extent = extent_of(piece.extent);
    if (!extent || extent->cells() > scan.whole.cells()) {
      throw input_error({name, "", "holds " + std::to_string(scan.whole.cells()) + " cells",
                         "the extent \"" + piece.extent.substr(0, 60) + "\" of " + file});
    }
    for (const XmlArray& array : index.arrays) {
      if (!has(scan.arrays, array))
        throw input_error({name, "", "has no array '" + array.name + "'", "the arrays of " + file});
    }
    if (!scan.ends_in_letter.empty()) with_letters.push_back(extents.size());
    extents.push_back(*extent);
  }
  const auto left_out = cells_left_out(*whole, extents);
  if (!left_out || *left_out > 0) {
    throw input_error({file, "",
                       left_out ? "its pieces leave out " + counted(*left_out, "cell")
                                : "its pieces overlap so much that what they cover is not known",
                       std::to_string(whole->cells()) + " of its whole extent"});
  }
  return {.data_type = index.data_type,
          .arrays = index.arrays,
          .whole = *whole,
          .problem = {},
          .empty_pieces = {},
          .pieces_with_letters = std::move(with_letters)};
}

}  // namespace palpate
