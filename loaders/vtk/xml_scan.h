/// A cheap pass over the tags of a VTK XML file before VTK's reader sees it: what arrays there are, and that
/// every count in it can be true of a file of this size. VTK would allocate what a count claims.
///
/// File format: "VTK File Formats for VTK Version 4.2", "XML File Formats".
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "loaders/vtk/extents.h"

namespace palpate {

/// One tag. Attribute values have their entities (&lt; …) resolved.
struct XmlTag {
  std::string name;     ///< "DataArray"
  bool opens = false;   ///< <name …> or <name …/>
  bool closes = false;  ///< </name> or <name …/>
  std::map<std::string, std::string> attributes;

  /// The attribute, or an empty string.
  [[nodiscard]] const std::string& at(const std::string& attribute) const;
};

/// Walks from tag to tag; text, comments, declarations and anything malformed in between are passed over.
class XmlTags {
 public:
  explicit XmlTags(std::string_view text) : text_(text) {}
  /// False at the end of the text, also in the middle of a tag.
  bool next(XmlTag& tag);
  [[nodiscard]] std::size_t position() const noexcept { return at_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

struct XmlArray {
  std::string name;
  std::string type;  ///< "Float32"
  int components = 1;
  bool on_points = true;
};

struct XmlScan {
  std::string data_type;         ///< "UnstructuredGrid"
  std::vector<XmlArray> arrays;  ///< of PointData and CellData, of the first piece that has points
  Extent whole;                  ///< of structured kinds
  std::string problem;           ///< what is wrong, or empty
  bool new_polyhedra = false;    ///< cells have faces in the arrays that VTK 9.4 began to write
  /// Where text of numbers ends with a letter ("nan") before a tag: VTK's reader wants a blank there.
  std::vector<std::size_t> ends_in_letter;
  /// Meshes: where pieces without points stand in the text, if the first is one. VTK takes the arrays of the
  /// first piece for those of all.
  std::vector<std::pair<std::size_t, std::size_t>> empty_pieces;
  /// Of an index of pieces that make one grid: the numbers of those that have such text.
  std::vector<std::size_t> pieces_with_letters = {};
};

/// Scans `text`, the whole file (of binary data only the sizes).
[[nodiscard]] XmlScan scan_xml(std::string_view text);

}  // namespace palpate
