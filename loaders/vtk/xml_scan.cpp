#include "loaders/vtk/xml_scan.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "common/base/text.h"
#include "loaders/vtk/saturated.h"
#include "loaders/vtk/xml_values.h"

namespace palpate {
namespace {

/// No compressor of VTK's (zlib, lz4, lzma) makes more of a byte.
constexpr std::uint64_t kMaxCompression = 8192;
constexpr int kMaxComponents = 4096;

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

std::string resolve_entities(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
      {{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto entity = std::find_if(kEntities.begin(), kEntities.end(), [&](const auto& e) {
      return text.substr(i, e.first.size()) == e.first;
    });
    if (entity == kEntities.end()) {
      result += text[i];
    } else {
      result += entity->second;
      i += entity->first.size() - 1;
    }
  }
  return result;
}

/// A count as XML's and Fortran's writers put it: blanks around it, a plus sign before it.
std::optional<std::uint64_t> count_of(const std::string& text) {
  std::string_view digits = trimmed(text);
  if (digits.size() > 1 && digits.front() == '+') digits.remove_prefix(1);
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) return kHuge;
  if (error != std::errc()) return std::nullopt;
  return value;
}

struct Broken {
  std::string what;
};

/// An array in the appended data: where, and how many bytes its values take, where the tags say so.
struct Appended {
  std::string name;
  std::uint64_t offset = 0;
  std::optional<std::uint64_t> bytes;
  std::uint64_t number_bytes = 1;
};

/// A list and the list of where its parts end, as far as both stand in text.
struct Lists {
  std::optional<std::uint64_t> count;  ///< values of the list
  std::optional<std::uint64_t> end;    ///< largest offset
};

/// What the tags before a DataArray said about it.
struct Context {
  BinaryHeader header;
  std::uint64_t file_size = 0;
  bool structured = false;
  Extent whole;
  std::vector<Extent> extents;  ///< of the pieces so far
  int pieces = 0;
  std::uint64_t points = 0;  ///< of this piece
  std::uint64_t cells = 0;
  std::size_t piece_start = 0;                 ///< in the text
  bool listed = false;                         ///< an earlier piece had points: its arrays are those of all
  std::vector<XmlArray> of_piece;              ///< of this piece
  std::map<std::string, std::uint64_t> lists;  ///< cells by the section that lists them: "Cells", "Polys"
  std::string section;                         ///< "PointData"
  std::size_t axis = 0;                        ///< of the next array of "Coordinates"
  Lists corners;
  Lists faces;
  std::vector<Appended> appended;
};

void begin_piece(const XmlTag& tag, Context& context) {
  ++context.pieces;
  const auto count = [&tag](const char* attribute) {
    const std::string& text = tag.at(attribute);
    if (text.empty()) return std::uint64_t{0};
    const auto value = count_of(text);
    if (!value)
      throw Broken{std::string("a Piece has ") + attribute + "=\"" + text.substr(0, 40) +
                   "\", expected a count"};
    return *value;
  };
  if (context.structured) {
    const auto extent = extent_of(tag.at("Extent"));
    if (!extent)
      throw Broken{"a Piece has Extent=\"" + tag.at("Extent").substr(0, 60) +
                   "\", expected six increasing numbers"};
    context.extents.push_back(*extent);
    context.points = extent->points();
    context.cells = extent->cells();
  } else {
    context.points = count("NumberOfPoints");
    context.cells = 0;
    // Polygonal data counts its kinds of cells apart.
    for (const auto& [section, attribute] : {std::pair{"Cells", "NumberOfCells"},
                                             {"Verts", "NumberOfVerts"},
                                             {"Lines", "NumberOfLines"},
                                             {"Strips", "NumberOfStrips"},
                                             {"Polys", "NumberOfPolys"}}) {
      context.lists[section] = count(attribute);
      if (__builtin_add_overflow(context.cells, context.lists[section], &context.cells))
        context.cells = kHuge;
    }
  }
}

/// Tuples that an array must have by what the tags before it say; nothing where they do not.
std::optional<std::uint64_t> tuples_of(const std::string& name, Context& context) {
  if (context.pieces == 0) return std::nullopt;
  if (context.section == "PointData" || context.section == "Points") return context.points;
  if (context.section == "CellData") return context.cells;
  if (context.section == "Coordinates")
    return context.axis < 3 && !context.extents.empty()
               ? std::optional(context.extents.back().points(context.axis++))
               : std::nullopt;
  const auto cells = context.lists.find(context.section);
  if (cells == context.lists.end()) return std::nullopt;
  if (name == "offsets" || name == "types") return cells->second;
  return std::nullopt;
}

[[noreturn]] void refuse_count(const std::string& name, std::uint64_t found, std::uint64_t expected) {
  throw Broken{"array '" + name + "' has " + std::to_string(found) + " values, expected " +
               std::to_string(expected)};
}

/// Lists that have another length than their offsets say.
void check_lists(const Context& context) {
  for (const auto& [name, lists] :
       {std::pair{"connectivity", context.corners}, std::pair{"faces", context.faces}}) {
    if (lists.count && lists.end && *lists.count != *lists.end) refuse_count(name, *lists.count, *lists.end);
  }
}

/// Counts the values that stand as text behind the tag.
void check_text(std::string_view text, const XmlTag& tag, const std::string& name,
                std::optional<std::uint64_t> expected, Context& context) {
  if (!is_xml_number(tag.at("type"))) return;
  const TextValues values = text_values(text.substr(0, text.find('<')), tag.at("type"));
  if (!values.wrong.empty()) {
    throw Broken{"array '" + name + "', value " + std::to_string(values.count + 1) + ": found '" +
                 values.wrong + "', expected a number of type " + tag.at("type")};
  }
  if (expected && values.count != *expected) refuse_count(name, values.count, *expected);
  const auto cells = context.lists.find(context.section);
  if (cells == context.lists.end()) return;
  // Meshes without polyhedra may have an empty list.
  if (name == "faceoffsets" && values.count != 0 && values.count != cells->second)
    refuse_count(name, values.count, cells->second);
  if (name == "connectivity") context.corners.count = values.count;
  if (name == "offsets") context.corners.end = values.largest;
  if (name == "faces") context.faces.count = values.count;
  if (name == "faceoffsets") context.faces.end = values.largest;
}

/// @param bytes  of the values by the tags; nothing where they do not say. @param number_bytes of each.
void check_binary(const BinaryArray& array, const std::string& name, std::optional<std::uint64_t> bytes,
                  std::uint64_t number_bytes, const BinaryHeader& header) {
  // A size is said once it can be read.
  if (bytes && array.values != kHuge && array.values != *bytes) {
    throw Broken{name + " does not have its " + std::to_string(*bytes) + " bytes, but says " +
                 std::to_string(array.values)};
  }
  if (!array.whole) throw Broken{name + " is cut off: its data ends before the end that its header states"};
  // VTK turns the numbers of each part around by itself, and what is left of one that a border cuts is lost.
  constexpr bool kBig = std::endian::native == std::endian::big;
  if (header.big_endian != kBig && array.block % number_bytes != 0) {
    throw Broken{name + " is compressed in parts of " + std::to_string(array.block) +
                 " bytes, which cut numbers of " + std::to_string(number_bytes) +
                 ": VTK reads such wrong in another byte order than this machine's"};
  }
}

/// @param text what follows the tag.
void check_array(const XmlTag& tag, std::string_view text, Context& context) {
  const std::string& name = tag.at("Name").empty() ? context.section : tag.at("Name");
  const std::optional<std::uint64_t> tuples = tuples_of(name, context);
  std::uint64_t components = context.section == "Points" ? 3 : 1;
  if (!tag.at("NumberOfComponents").empty()) {
    const auto given = count_of(tag.at("NumberOfComponents"));
    if (!given || *given < 1 || *given > kMaxComponents) {
      throw Broken{"array '" + name + "' has NumberOfComponents=\"" +
                   tag.at("NumberOfComponents").substr(0, 40) + "\""};
    }
    components = *given;
  }
  const std::string& format = tag.at("format");
  const bool number = is_xml_number(tag.at("type"));
  const std::uint64_t values = times(tuples.value_or(0), components);
  std::uint64_t possible = context.file_size;
  std::uint64_t needed = 0;
  if (format == "ascii") {
    needed = 2 * (values / 2);  // a digit and a separator
  } else {
    needed = times(values, bytes_of_xml_type(tag.at("type")));
    if (context.header.compressed) possible = times(possible, kMaxCompression);
  }
  if (needed > possible) {
    throw Broken{"array '" + name + "' claims " + (values == kHuge ? "over 2^63" : std::to_string(values)) +
                 " values, but the file has " + std::to_string(context.file_size) + " bytes"};
  }
  if (format == "appended") {
    const auto offset = count_of(tag.at("offset"));
    if (!offset || *offset > context.file_size) {
      throw Broken{"array '" + name + "' lies at offset \"" + tag.at("offset").substr(0, 40) +
                   "\", past the end of the file"};
    }
    context.appended.push_back({name, *offset,
                                tuples && number ? std::optional(needed) : std::optional<std::uint64_t>(),
                                bytes_of_xml_type(tag.at("type"))});
  } else if (format == "ascii") {
    check_text(text, tag, name, tuples ? std::optional(values) : tuples, context);
  } else {
    // Arrays of nothing may have nothing, not even a header.
    const std::string_view inline_data = trimmed(text.substr(0, text.find('<')));
    const bool sized = tuples && number;
    if (sized ? values == 0 : inline_data.empty()) return;
    BinaryHeader header = context.header;
    header.base64 = true;
    check_binary(binary_array(inline_data, header), "array '" + name + "'",
                 sized ? std::optional(needed) : std::nullopt, bytes_of_xml_type(tag.at("type")), header);
  }
}

/// Checks that the arrays of the appended data lie inside it, one behind the other, and have the sizes that the
/// tags say. VTK would read a short array as far as it goes, and what follows for the rest.
void check_appended(std::string_view data, bool base64, Context& context) {
  context.header.base64 = base64;
  std::stable_sort(context.appended.begin(), context.appended.end(),
                   [](const Appended& a, const Appended& b) { return a.offset < b.offset; });
  const auto words = [](const Appended& array) {
    return "array '" + array.name + "' at offset " + std::to_string(array.offset);
  };
  const Appended* before = nullptr;
  BinaryArray there;
  for (const Appended& array : context.appended) {
    if (array.bytes == std::uint64_t{0}) continue;
    // An array of several pieces or times may be one in the file; two of other names are a slip of who wrote it.
    if (before != nullptr && array.offset == before->offset && array.name != before->name)
      throw Broken{words(*before) + " and array '" + array.name + "' are the same bytes"};
    if (before == nullptr || array.offset != before->offset) {
      if (before != nullptr && there.size > array.offset - before->offset)
        throw Broken{words(*before) + " reaches into " + words(array)};
      there = binary_array(data.substr(std::min<std::uint64_t>(array.offset, data.size())), context.header);
    }
    before = &array;
    check_binary(there, words(array), array.bytes, array.number_bytes, context.header);
  }
}

/// Appended data, from `first` to the tag that ends it. Blanks that indent the tag as it is indented where it
/// opens are none of it.
std::string_view appended_data(std::string_view text, std::size_t opens, std::size_t first) {
  std::size_t end = text.rfind("</AppendedData");
  if (end == std::string_view::npos) end = text.rfind("</VTKFile");
  if (end == std::string_view::npos || end < first) end = text.size();
  std::size_t indent = opens;
  while (indent > 0 && (text[indent - 1] == ' ' || text[indent - 1] == '\t')) --indent;
  // Without blanks the line break alone might as well be the last byte.
  if (indent < opens && indent > 0 && text[indent - 1] == '\n') {
    const std::string_view blanks = text.substr(indent - 1, opens - indent + 1);
    if (end - first >= blanks.size() && text.substr(first, end - first).ends_with(blanks))
      end -= blanks.size();
  }
  return text.substr(first, end - first);
}

/// At the end of a piece, which ends at `end` of the text. VTK takes it that all pieces have the arrays of the
/// first: one that a piece lacks would be whatever stood in memory.
void end_piece(std::size_t end, Context& context, XmlScan& result) {
  std::vector<XmlArray> arrays;
  arrays.swap(context.of_piece);
  for (auto one = arrays.begin(); one != arrays.end(); ++one) {
    const bool again = std::any_of(arrays.begin(), one, [one](const XmlArray& other) {
      return other.name == one->name && other.on_points == one->on_points;
    });
    // VTK's reader takes one of them.
    if (again)
      throw Broken{"two arrays of " + std::string(one->on_points ? "points" : "cells") + " are called '" +
                   one->name + "'"};
  }
  if (context.points == 0 && !context.structured) {
    if (!context.listed || !result.empty_pieces.empty())
      result.empty_pieces.emplace_back(context.piece_start, end);
    return;
  }
  if (context.points == 0) return;
  if (!context.listed) {
    context.listed = true;
    result.arrays = std::move(arrays);
    return;
  }
  const auto lacks = [&context](const std::vector<XmlArray>& some, const std::vector<XmlArray>& all) {
    for (const XmlArray& wanted : all) {
      if (!wanted.on_points && context.cells == 0) continue;
      const bool there = std::any_of(some.begin(), some.end(), [&wanted](const XmlArray& array) {
        return array.name == wanted.name && array.on_points == wanted.on_points &&
               array.components == wanted.components;
      });
      if (!there) return wanted.name;
    }
    return std::string();
  };
  const std::string piece = "piece " + std::to_string(context.pieces);
  if (const std::string name = lacks(arrays, result.arrays); !name.empty())
    throw Broken{piece + " has no array '" + name + "' of that shape, which the pieces before it have"};
  if (const std::string name = lacks(result.arrays, arrays); !name.empty())
    throw Broken{piece + " has an array '" + name + "' that the pieces before it do not have in that shape"};
}

/// Pieces may overlap, and yet leave a part of the whole out, which would be whatever stood in memory.
void check_cover(const Context& context) {
  const auto left_out = cells_left_out(context.whole, context.extents);
  if (!left_out) throw Broken{"its pieces overlap so much that what they cover is not known"};
  if (*left_out > 0) {
    throw Broken{"its pieces leave out " + std::to_string(*left_out) + " cells of " +
                 std::to_string(context.whole.cells())};
  }
}

/// Whether the file closes its root element; what follows it may be white space only.
bool has_end(std::string_view text) {
  constexpr std::size_t kLook = 256;
  const std::string_view tail = text.substr(text.size() - std::min(text.size(), kLook));
  return tail.rfind("</VTKFile>") != std::string_view::npos;
}

/// VTK's reader takes what it cannot read for 0 and 1.
void check_numbers(const XmlTag& tag, const std::string& attribute, std::size_t count) {
  const std::string& text = tag.at(attribute);
  if (text.empty()) return;
  const std::vector<std::string_view> parts = words(text);
  const bool good =
      parts.size() == count && std::all_of(parts.begin(), parts.end(), [](std::string_view word) {
        return std::isfinite(number(word).value_or(std::nan("")));
      });
  if (!good)
    throw Broken{attribute + "=\"" + text.substr(0, 60) + "\", expected " + std::to_string(count) +
                 " finite numbers"};
}

void scan(std::string_view text, XmlScan& result) {
  Context context;
  context.file_size = text.size();
  XmlTags tags(text);
  XmlTag tag;
  std::string encoding;
  std::optional<std::size_t> appended;  // where the tag opens
  for (std::size_t before = 0; tags.next(tag); before = tags.position()) {
    if (tag.closes && !tag.opens) {
      if (tag.name == context.section) {
        check_lists(context);
        context.section.clear();
      }
      if (tag.name == "Piece") end_piece(tags.position(), context, result);
      continue;
    }
    if (tag.name == "VTKFile") {
      result.data_type = tag.at("type");
      context.header.compressed = !tag.at("compressor").empty();
      context.header.big_endian = tag.at("byte_order") == "BigEndian";
      context.header.number_bytes = tag.at("header_type") == "UInt64" ? 8 : 4;
      context.structured = result.data_type == "ImageData" || result.data_type == "RectilinearGrid" ||
                           result.data_type == "StructuredGrid";
    } else if (context.structured && tag.name == result.data_type) {
      const auto whole = extent_of(tag.at("WholeExtent"));
      if (!whole)
        throw Broken{"WholeExtent=\"" + tag.at("WholeExtent").substr(0, 60) +
                     "\", expected six increasing numbers"};
      context.whole = *whole;
      result.whole = *whole;
      check_numbers(tag, "Origin", 3);
      check_numbers(tag, "Spacing", 3);
      check_numbers(tag, "Direction", 9);
    } else if (tag.name == "Piece") {
      context.piece_start = before;
      begin_piece(tag, context);
      if (tag.closes) end_piece(tags.position(), context, result);
    } else if (tag.name == "PointData" || tag.name == "CellData" || tag.name == "Points" ||
               tag.name == "Coordinates" || tag.name == "FieldData" || context.lists.count(tag.name) > 0) {
      context.axis = 0;
      context.corners = {};
      context.faces = {};
      if (!tag.closes) context.section = tag.name;
    } else if (tag.name == "DataArray") {
      result.new_polyhedra = result.new_polyhedra || tag.at("Name") == "polyhedron_to_faces";
      if (const std::size_t end = text.find('<', tags.position());
          !tag.closes && tag.at("format") == "ascii" && is_xml_number(tag.at("type")) &&
          end != std::string_view::npos && std::isalpha(static_cast<unsigned char>(text[end - 1])) != 0) {
        result.ends_in_letter.push_back(end);
      }
      check_array(tag, tag.closes ? std::string_view() : text.substr(tags.position()), context);
      const bool on_points = context.section == "PointData";
      if (context.structured && tag.at("Name").empty() && (on_points || context.section == "CellData"))
        throw Broken{"an array of " + context.section + " has no Name"};
      if (context.pieces > 0 && (on_points || context.section == "CellData")) {
        const auto components = count_of(tag.at("NumberOfComponents"));
        context.of_piece.push_back(
            {tag.at("Name"), tag.at("type"), static_cast<int>(components.value_or(1)), on_points});
      }
    } else if (tag.name == "AppendedData") {
      appended = text.find('<', before);
      encoding = tag.at("encoding");
      break;
    }
  }
  if (!context.listed) result.empty_pieces.clear();
  if (!has_end(text)) throw Broken{"its end is missing (no </VTKFile>)"};
  if (appended) {
    const std::size_t underscore = text.find('_', tags.position());
    if (underscore == std::string_view::npos) throw Broken{"its appended data does not begin"};
    check_appended(appended_data(text, *appended, underscore + 1), encoding != "raw", context);
  } else if (!context.appended.empty()) {
    throw Broken{"its appended data is missing"};
  }
  if (context.structured) check_cover(context);
  if (context.pieces == 0) throw Broken{"holds no Piece"};
}

}  // namespace

const std::string& XmlTag::at(const std::string& attribute) const {
  static const std::string kNone;
  const auto found = attributes.find(attribute);
  return found == attributes.end() ? kNone : found->second;
}

bool XmlTags::next(XmlTag& tag) {
  while (true) {
    at_ = text_.find('<', at_);
    if (at_ == std::string_view::npos) {
      at_ = text_.size();
      return false;
    }
    const std::string_view rest = text_.substr(at_);
    if (rest.substr(0, 4) == "<!--") {
      const std::size_t end = rest.find("-->");
      if (end == std::string_view::npos) return false;
      at_ += end + 3;
    } else if (rest.substr(0, 2) == "<?" || rest.substr(0, 2) == "<!") {
      ++at_;
    } else {
      break;
    }
  }
  const std::string_view rest = text_.substr(at_);
  // A '>' inside quotes does not end the tag.
  std::size_t end = 1;
  char quote = '\0';
  for (; end < rest.size() && (quote != '\0' || rest[end] != '>'); ++end) {
    if (quote != '\0') {
      if (rest[end] == quote) quote = '\0';
    } else if (rest[end] == '"' || rest[end] == '\'') {
      quote = rest[end];
    }
  }
  if (end >= rest.size()) {
    at_ = text_.size();
    return false;
  }
  at_ += end + 1;
  std::string_view inner = rest.substr(1, end - 1);
  tag = {};
  tag.opens = inner.empty() || inner.front() != '/';
  tag.closes = !tag.opens || inner.back() == '/';
  if (!tag.opens) inner.remove_prefix(1);

  std::size_t i = 0;
  while (i < inner.size() && !is_space(inner[i]) && inner[i] != '/') ++i;
  tag.name = std::string(inner.substr(0, i));
  while (i < inner.size()) {
    while (i < inner.size() && (is_space(inner[i]) || inner[i] == '/')) ++i;
    const std::size_t name_start = i;
    while (i < inner.size() && !is_space(inner[i]) && inner[i] != '=') ++i;
    const std::string name(inner.substr(name_start, i - name_start));
    while (i < inner.size() && is_space(inner[i])) ++i;
    if (i >= inner.size() || inner[i] != '=') continue;
    ++i;
    while (i < inner.size() && is_space(inner[i])) ++i;
    if (i >= inner.size() || (inner[i] != '"' && inner[i] != '\'')) continue;
    const std::size_t close = inner.find(inner[i], i + 1);
    if (close == std::string_view::npos) break;
    tag.attributes[name] = resolve_entities(inner.substr(i + 1, close - i - 1));
    i = close + 1;
  }
  return true;
}

XmlScan scan_xml(std::string_view text) {
  XmlScan result;
  try {
    scan(text, result);
  } catch (const Broken& broken) {
    result.problem = broken.what;
  }
  return result;
}

}  // namespace palpate
