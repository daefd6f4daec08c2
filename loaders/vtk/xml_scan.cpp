#include "loaders/vtk/xml_scan.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "loaders/vtk/saturated.h"

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

std::optional<std::uint64_t> count_of(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) return kHuge;
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Points and cells of an extent "i0 i1 j0 j1 k0 k1".
struct Extent {
  std::uint64_t points = 0;
  std::uint64_t cells = 0;
};
std::optional<Extent> extent_of(const std::string& text) {
  std::istringstream stream(text);
  Extent extent{1, 1};
  for (int axis = 0; axis < 3; ++axis) {
    long long first = 0;
    long long last = 0;
    if (!(stream >> first >> last)) return std::nullopt;
    constexpr long long kLargest = 2'147'483'647;
    if (first < -kLargest || last > kLargest || last < first) return std::nullopt;
    const auto points = static_cast<std::uint64_t>(last - first) + 1;
    extent.points = times(extent.points, points);
    extent.cells = times(extent.cells, std::max<std::uint64_t>(1, points - 1));
  }
  return extent;
}

std::uint64_t bytes_of_type(const std::string& type) {
  if (type.find("64") != std::string::npos) return 8;
  if (type.find("32") != std::string::npos) return 4;
  if (type.find("16") != std::string::npos) return 2;
  return 1;
}

struct Broken {
  std::string what;
};

/// An array in the appended data: where, and how many bytes its values take (0: not known from the tags).
struct Appended {
  std::string name;
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
};

/// What the tags before a DataArray said about it.
struct Context {
  bool big_endian = false;
  std::uint64_t header_bytes = 4;  ///< of the numbers that precede binary data
  std::uint64_t file_size = 0;
  bool compressed = false;
  bool structured = false;
  Extent whole;
  std::uint64_t cells_in_pieces = 0;
  int pieces = 0;
  std::uint64_t points = 0;  ///< of the current piece
  std::uint64_t cells = 0;
  std::string section;  ///< "PointData"
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
    context.points = extent->points;
    context.cells = extent->cells;
    std::uint64_t sum = 0;
    context.cells_in_pieces =
        __builtin_add_overflow(context.cells_in_pieces, extent->cells, &sum) ? kHuge : sum;
  } else {
    context.points = count("NumberOfPoints");
    context.cells = 0;
    // Polygonal data counts its kinds of cells apart.
    for (const char* kind :
         {"NumberOfCells", "NumberOfVerts", "NumberOfLines", "NumberOfStrips", "NumberOfPolys"}) {
      if (__builtin_add_overflow(context.cells, count(kind), &context.cells)) context.cells = kHuge;
    }
  }
}

void check_array(const XmlTag& tag, Context& context) {
  const std::string& name = tag.at("Name");
  std::uint64_t tuples = 0;
  if (context.section == "PointData" || context.section == "Points") tuples = context.points;
  if (context.section == "CellData") tuples = context.cells;
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
  const std::uint64_t values = times(tuples, components);
  std::uint64_t possible = context.file_size;
  std::uint64_t needed = 0;
  if (format == "ascii") {
    needed = 2 * (values / 2);  // a digit and a separator
  } else {
    needed = times(values, bytes_of_type(tag.at("type")));
    if (context.compressed) possible = times(possible, kMaxCompression);
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
    const bool sized =
        context.section == "PointData" || context.section == "Points" || context.section == "CellData";
    const bool text = tag.at("type") == "String" || tag.at("type") == "Bit";
    context.appended.push_back({name, *offset, sized && !text ? needed : 0});
  }
}

/// Checks that the arrays of raw appended data lie inside it and have the sizes that the tags say. `data`
/// goes from behind the underscore to the end of the file. VTK would read a short array as far as it goes.
void check_raw(std::string_view data, const Context& context) {
  const auto number = [&](std::uint64_t offset) {
    std::uint64_t value = 0;
    if (offset > data.size() || data.size() - offset < context.header_bytes) return kHuge;
    for (std::uint64_t i = 0; i < context.header_bytes; ++i) {
      const std::uint64_t at = context.big_endian ? offset + i : offset + context.header_bytes - 1 - i;
      value = value << 8 | static_cast<unsigned char>(data[at]);
    }
    return value;
  };
  for (const Appended& array : context.appended) {
    const auto refuse = [&](const std::string& what) {
      throw Broken{"array '" + array.name + "' at offset " + std::to_string(array.offset) + " " + what};
    };
    const std::uint64_t first = number(array.offset);
    std::uint64_t stored = first;
    std::uint64_t header = context.header_bytes;
    if (context.compressed) {
      // Block count, block size, size of a last partial block, then the compressed size of every block.
      const std::uint64_t blocks = first;
      if (blocks > data.size()) refuse("reaches past the end of the file");
      header = (3 + blocks) * context.header_bytes;
      stored = 0;
      for (std::uint64_t block = 0; block < blocks; ++block) {
        const std::uint64_t size = number(array.offset + (3 + block) * context.header_bytes);
        if (size > data.size()) refuse("reaches past the end of the file");
        stored += size;
      }
      const std::uint64_t block_bytes = number(array.offset + context.header_bytes);
      const std::uint64_t partial = number(array.offset + 2 * context.header_bytes);
      const std::uint64_t full = blocks - (partial > 0 && blocks > 0 ? 1 : 0);
      const std::uint64_t bytes =
          times(full, block_bytes) == kHuge ? kHuge : times(full, block_bytes) + partial;
      if (array.bytes > 0 && bytes != array.bytes)
        refuse("does not have its " + std::to_string(array.bytes) + " bytes");
    } else if (array.bytes > 0 && stored != array.bytes) {
      refuse("does not have its " + std::to_string(array.bytes) + " bytes");
    }
    if (header > data.size() - array.offset || stored > data.size() - array.offset - header) {
      refuse("reaches past the end of the file");
    }
  }
}

/// The same for base64: four characters for three bytes, so a lower bound only.
void check_base64(std::string_view data, const Context& context) {
  for (const Appended& array : context.appended) {
    const std::uint64_t characters = context.compressed ? 0 : array.bytes / 3 * 4;
    if (array.offset > data.size() || characters > data.size() - array.offset) {
      throw Broken{"array '" + array.name + "' at offset " + std::to_string(array.offset) +
                   " reaches past the end of the file"};
    }
  }
}

/// Whether the file closes its root element; what follows it may be white space only.
bool has_end(std::string_view text) {
  constexpr std::size_t kLook = 256;
  const std::string_view tail = text.substr(text.size() - std::min(text.size(), kLook));
  return tail.rfind("</VTKFile>") != std::string_view::npos;
}

void scan(std::string_view text, XmlScan& result) {
  Context context;
  context.file_size = text.size();
  XmlTags tags(text);
  XmlTag tag;
  std::string encoding;
  bool appended = false;
  while (tags.next(tag)) {
    if (tag.closes && !tag.opens) {
      if (tag.name == context.section) context.section.clear();
      continue;
    }
    if (tag.name == "VTKFile") {
      result.data_type = tag.at("type");
      context.compressed = !tag.at("compressor").empty();
      context.big_endian = tag.at("byte_order") == "BigEndian";
      context.header_bytes = tag.at("header_type") == "UInt64" ? 8 : 4;
      context.structured = result.data_type == "ImageData" || result.data_type == "RectilinearGrid" ||
                           result.data_type == "StructuredGrid";
    } else if (context.structured && tag.name == result.data_type) {
      const auto whole = extent_of(tag.at("WholeExtent"));
      if (!whole)
        throw Broken{"WholeExtent=\"" + tag.at("WholeExtent").substr(0, 60) +
                     "\", expected six increasing numbers"};
      context.whole = *whole;
      result.whole_cells = whole->cells;
    } else if (tag.name == "Piece") {
      begin_piece(tag, context);
    } else if (tag.name == "PointData" || tag.name == "CellData" || tag.name == "Points" ||
               tag.name == "Cells" || tag.name == "Coordinates" || tag.name == "FieldData") {
      if (!tag.closes) context.section = tag.name;
    } else if (tag.name == "DataArray") {
      check_array(tag, context);
      const bool on_points = context.section == "PointData";
      if (context.pieces == 1 && (on_points || context.section == "CellData")) {
        const auto components = count_of(tag.at("NumberOfComponents"));
        result.arrays.push_back(
            {tag.at("Name"), tag.at("type"), static_cast<int>(components.value_or(1)), on_points});
      }
    } else if (tag.name == "AppendedData") {
      appended = true;
      encoding = tag.at("encoding");
      break;
    }
  }
  if (!has_end(text)) throw Broken{"its end is missing (no </VTKFile>)"};
  if (appended) {
    const std::size_t underscore = text.find('_', tags.position());
    if (underscore == std::string_view::npos) throw Broken{"its appended data does not begin"};
    const std::string_view data = text.substr(underscore + 1);
    if (encoding == "raw") {
      check_raw(data, context);
    } else {
      check_base64(data, context);
    }
  } else if (!context.appended.empty()) {
    throw Broken{"its appended data is missing"};
  }
  if (context.structured && context.cells_in_pieces < context.whole.cells) {
    throw Broken{"its pieces cover " + std::to_string(context.cells_in_pieces) + " cells of " +
                 std::to_string(context.whole.cells)};
  }
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

std::optional<std::uint64_t> cells_of_extent(const std::string& extent) {
  const auto found = extent_of(extent);
  if (!found) return std::nullopt;
  return found->cells;
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
