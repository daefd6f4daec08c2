#include "common/load/read_surface.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <variant>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/data_set.h"
#include "common/load/load.h"

namespace palpate {
namespace {

constexpr std::size_t kMostCorners = 4096;  // of one polygon

class SurfaceText {
 public:
  SurfaceText(const std::filesystem::path& file, std::string_view text) : file_(file), rest_(text) {}

  /// The next line without its end; nothing at the end of the text.
  std::optional<std::string_view> line() {
    if (rest_.empty()) return std::nullopt;
    ++number_;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view one = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return trimmed(one);
  }
  [[nodiscard]] std::string_view rest() const noexcept { return rest_; }
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    throw input_error({file_.string(), number_ > 0 ? "line " + std::to_string(number_) : "", found, expected,
                       "the file may be damaged"});
  }
  /// Three numbers from words[first] on.
  [[nodiscard]] Vec3 place(const std::vector<std::string_view>& words, std::size_t first) const {
    Vec3 x{0.0};
    for (int c = 0; c < 3; ++c) {
      const std::size_t at = first + as_size(c);
      const auto value = at < words.size() ? number(words[at]) : std::nullopt;
      if (!value) refuse("holds no place", "three numbers");
      x[c] = *value;
    }
    return x;
  }

 private:
  const std::filesystem::path& file_;
  std::string_view rest_;
  std::size_t number_ = 0;
};

void add_polygon(const std::vector<std::uint32_t>& corners, SurfaceTriangles& surface) {
  for (std::size_t c = 2; c < corners.size(); ++c)
    surface.triangles.push_back({corners[0], corners[c - 1], corners[c]});
}

template <typename T>
T read_bytes(const char* from, bool swapped) noexcept {
  std::array<char, sizeof(T)> bytes{};
  std::memcpy(bytes.data(), from, sizeof(T));
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

constexpr bool kBigMachine = std::endian::native == std::endian::big;

constexpr std::size_t kStlHead = 84, kStlRecord = 50;

/// Whether its length is that of a binary file of as many triangles as it states: a text may begin with any words.
bool is_binary_stl(std::string_view text) {
  if (text.size() < kStlHead) return false;
  const auto count = read_bytes<std::uint32_t>(text.data() + kStlHead - 4, kBigMachine);
  return text.size() == kStlHead + kStlRecord * std::size_t{count};
}

SurfaceTriangles read_stl(SurfaceText& text) {
  SurfaceTriangles surface;
  const auto add = [&surface](const Vec3& x) { surface.points.push_back(x); };
  if (const std::string_view bytes = text.rest(); is_binary_stl(bytes)) {
    constexpr std::size_t kNormal = 12, kPlace = 12, kNumber = 4;
    for (std::size_t at = kStlHead; at < bytes.size(); at += kStlRecord) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        Vec3 x{0.0};
        for (int c = 0; c < 3; ++c) {
          const char* const from = bytes.data() + at + kNormal + kPlace * corner + kNumber * as_size(c);
          x[c] = double{read_bytes<float>(from, kBigMachine)};
        }
        add(x);
      }
    }
  } else {
    if (!lowered(bytes.substr(0, std::min(bytes.size(), std::size_t{5}))).starts_with("solid"))
      text.refuse("is no STL file: neither of the length that its count states nor text",
                  "a surface in STL, binary or text");
    bool ended = false;
    while (const auto line = text.line()) {
      const std::vector<std::string_view> all = words(*line);
      if (!all.empty() && lowered(all[0]) == "vertex") add(text.place(all, 1));
      ended = !all.empty() && lowered(all[0]) == "endsolid";
    }
    if (!ended || surface.points.size() % 3 != 0) text.refuse("ends within a solid", "endsolid");
  }
  for (std::uint32_t p = 0; p + 2 < surface.points.size(); p += 3)
    surface.triangles.push_back({p, p + 1, p + 2});
  return surface;
}

SurfaceTriangles read_obj(SurfaceText& text) {
  SurfaceTriangles surface;
  std::vector<std::uint32_t> corners;
  while (const auto line = text.line()) {
    const std::vector<std::string_view> all = words(*line);
    if (all.empty()) continue;
    if (all[0] == "v") surface.points.push_back(text.place(all, 1));
    if (all[0] != "f") continue;
    corners.clear();
    for (std::size_t w = 1; w < all.size(); ++w) {
      const auto index = parsed<std::int64_t>(all[w].substr(0, all[w].find('/')));
      const auto count = static_cast<std::int64_t>(surface.points.size());
      const std::int64_t place = !index ? -1 : *index > 0 ? *index - 1 : count + *index;
      if (place < 0 || place >= count || corners.size() == kMostCorners)
        text.refuse("names a vertex that is not there", "numbers of vertices above");
      corners.push_back(static_cast<std::uint32_t>(place));
    }
    add_polygon(corners, surface);
  }
  return surface;
}

/// A number of a PLY file in text or in bytes.
struct PlyType {
  std::size_t size = 0;
  double (*read)(const char*, bool) = nullptr;
};

template <typename T>
double ply_number(const char* from, bool swapped) {
  return static_cast<double>(read_bytes<T>(from, swapped));
}

std::optional<PlyType> ply_type(std::string_view word) {
  if (word == "char" || word == "int8") return PlyType{1, ply_number<std::int8_t>};
  if (word == "uchar" || word == "uint8") return PlyType{1, ply_number<std::uint8_t>};
  if (word == "short" || word == "int16") return PlyType{2, ply_number<std::int16_t>};
  if (word == "ushort" || word == "uint16") return PlyType{2, ply_number<std::uint16_t>};
  if (word == "int" || word == "int32") return PlyType{4, ply_number<std::int32_t>};
  if (word == "uint" || word == "uint32") return PlyType{4, ply_number<std::uint32_t>};
  if (word == "float" || word == "float32") return PlyType{4, ply_number<float>};
  if (word == "double" || word == "float64") return PlyType{8, ply_number<double>};
  return std::nullopt;
}

struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> count;  ///< of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

/// Reads number after number, of text or bytes.
class PlyNumbers {
 public:
  PlyNumbers(SurfaceText& text, bool binary, bool swapped)
      : text_(text), rest_(text.rest()), binary_(binary), swapped_(swapped) {}

  double next(const PlyType& type) {
    if (!binary_) {
      rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
      const std::size_t end = std::min(rest_.find_first_of(" \t\r\n"), rest_.size());
      const auto value = number(rest_.substr(0, end));
      if (!value) text_.refuse("ends, or holds no number, where its header has one", "a number");
      rest_.remove_prefix(end);
      return *value;
    }
    if (rest_.size() < type.size) text_.refuse("ends before what its header states", "more bytes");
    const double value = type.read(rest_.data(), swapped_);
    rest_.remove_prefix(type.size);
    return value;
  }

 private:
  SurfaceText& text_;
  std::string_view rest_;
  bool binary_, swapped_;
};

std::vector<PlyElement> ply_head(SurfaceText& text, std::string& format) {
  std::vector<PlyElement> elements;
  if (text.line() != std::optional<std::string_view>("ply")) text.refuse("is no PLY file", "ply");
  while (const auto line = text.line()) {
    const std::vector<std::string_view> all = words(*line);
    if (all.empty() || all[0] == "comment" || all[0] == "obj_info") continue;
    if (all[0] == "end_header") return elements;
    if (all[0] == "format" && all.size() > 1) {
      format = all[1];
    } else if (all[0] == "element" && all.size() == 3) {
      const auto count = parsed<std::uint64_t>(all[2]);
      // A file that states more than it has bytes is damaged.
      if (!count || *count > text.rest().size()) text.refuse("states a count that it cannot have", "a count");
      elements.push_back({std::string(all[1]), *count, {}});
    } else if (all[0] == "property" && all.size() >= 3 && !elements.empty()) {
      const bool list = all[1] == "list" && all.size() == 5;
      const auto type = ply_type(all[list ? 3 : 1]);
      const auto count = list ? ply_type(all[2]) : std::nullopt;
      if (!type || (list && !count)) text.refuse("has a property of an unknown type", "int, float, …");
      elements.back().properties.push_back({std::string(all.back()), *type, count});
    } else {
      text.refuse("has a line in its header that is not known", "element, property or end_header");
    }
  }
  text.refuse("ends in its header", "end_header");
}

SurfaceTriangles read_ply(SurfaceText& text) {
  std::string format;
  const std::vector<PlyElement> elements = ply_head(text, format);
  if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian")
    text.refuse("is of the format '" + format + "'", "ascii, binary_little_endian or binary_big_endian");
  const bool big = format == "binary_big_endian";
  PlyNumbers numbers(text, format != "ascii", big != kBigMachine);
  SurfaceTriangles surface;
  std::vector<std::uint32_t> corners;
  for (const PlyElement& element : elements) {
    const bool vertices = element.name == "vertex", faces = element.name == "face";
    for (const char* const axis : {"x", "y", "z"}) {
      const bool there = std::ranges::any_of(
          element.properties, [&](const PlyProperty& p) { return p.name == axis && !p.count; });
      if (vertices && !there) text.refuse(std::string("has vertices without ") + axis, "x, y and z");
    }
    for (std::uint64_t n = 0; n < element.count; ++n) {
      Vec3 x{0.0};
      for (const PlyProperty& property : element.properties) {
        const double count = property.count ? numbers.next(*property.count) : 1.0;
        if (!(count >= 0.0 && count <= static_cast<double>(kMostCorners)))
          text.refuse("has a list of " + short_number(count), "a polygon");
        const bool outline =
            faces && property.count && (property.name == "vertex_indices" || property.name == "vertex_index");
        corners.clear();
        for (std::size_t i = 0; i < floor_size(count); ++i) {
          const double value = numbers.next(property.type);
          if (vertices && !property.count && property.name.size() == 1 && property.name[0] >= 'x' &&
              property.name[0] <= 'z')
            x[property.name[0] - 'x'] = value;
          if (!outline) continue;
          if (!(value >= 0.0 && value < static_cast<double>(surface.points.size()) &&
                std::trunc(value) == value))
            text.refuse("names a vertex that is not there", "faces after their vertices");
          corners.push_back(static_cast<std::uint32_t>(value));
        }
        if (outline) add_polygon(corners, surface);
      }
      if (vertices) surface.points.push_back(x);
    }
  }
  return surface;
}

/// Cell types of the VTK file format that make triangles.
constexpr std::uint8_t kVtkTriangle = 5, kVtkStrip = 6, kVtkPolygon = 7, kVtkQuad = 9;

SurfaceTriangles read_polygons(const std::filesystem::path& file, Progress* progress) {
  Source source = Source::open({.files = {file}, .solution = {}}, {}, progress);
  SurfaceTriangles surface;
  std::vector<std::uint32_t> corners;
  for (const DataSet& block : source.read({}, 0, progress)) {
    const auto* const cells = std::get_if<UnstructuredTopology>(&block.topology);
    if (cells == nullptr) continue;
    const auto before = static_cast<std::uint32_t>(surface.points.size());
    const DataArray& places = cells->positions;
    for (std::size_t p = 0; p < places.tuples; ++p)
      surface.points.emplace_back(places.at(p, 0), places.at(p, 1), places.at(p, 2));
    for (std::size_t cell = 0; cell < cells->types.size(); ++cell) {
      const std::uint8_t type = cells->types[cell];
      corners.clear();
      for (std::int64_t c = cells->offsets[cell]; c < cells->offsets[cell + 1]; ++c)
        corners.push_back(before + static_cast<std::uint32_t>(cells->connectivity[as_size(c)]));
      if (type == kVtkTriangle || type == kVtkPolygon || type == kVtkQuad) add_polygon(corners, surface);
      for (std::size_t c = 2; type == kVtkStrip && c < corners.size(); ++c) {
        const bool odd = c % 2 != 0;
        surface.triangles.push_back({corners[odd ? c - 1 : c - 2], corners[odd ? c - 2 : c - 1], corners[c]});
      }
    }
  }
  return surface;
}

}  // namespace

bool names_surface(const std::filesystem::path& file) {
  const std::string ending = lowered(file.extension().string());
  return ending == ".stl" || ending == ".ply" || ending == ".obj";
}

SurfaceTriangles read_surface(const std::filesystem::path& file, Progress* progress) {
  if (progress != nullptr) progress->begin("reading " + file.filename().string(), 0);
  SurfaceTriangles surface;
  if (names_surface(file)) {
    const MappedFile mapped(file.string());
    SurfaceText text(file, mapped.text());
    const std::string ending = lowered(file.extension().string());
    surface = ending == ".stl" ? read_stl(text) : ending == ".ply" ? read_ply(text) : read_obj(text);
  } else {
    surface = read_polygons(file, progress);
  }
  if (surface.triangles.empty())
    throw input_error({file.string(), "", "holds no triangle", "a surface (.stl, .ply, .obj or .vtp)", ""});
  const auto lost = std::ranges::find_if_not(surface.points, [](const Vec3& x) { return is_finite(x); });
  if (lost != surface.points.end())
    throw input_error({file.string(), "point " + std::to_string(lost - surface.points.begin()),
                       "is nowhere (NaN or infinite)", "finite coordinates", "the file may be damaged"});
  return surface;
}

}  // namespace palpate
