#include "loaders/cfd/fluent_faces.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <unordered_map>
#include <utility>

#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

std::size_t end_of_text_section(std::string_view text, std::size_t at) {
  std::size_t depth = 0;
  for (std::size_t i = text.find_first_of("()", at); i != std::string_view::npos;
       i = text.find_first_of("()", i + 1)) {
    depth = text[i] == '(' ? depth + 1 : depth - 1;
    if (depth == 0) return i + 1;
  }
  return std::string_view::npos;
}

/// The whole numbers of a section's body, one after the other: hexadecimal words, or 32 bits each.
class Numbers {
 public:
  Numbers(std::string_view body, bool binary) : rest_(body), binary_(binary) {}

  /// False where there is none left.
  bool next(std::int64_t& number) {
    if (binary_) {
      std::int32_t four = 0;
      if (rest_.size() < sizeof(four)) return false;
      std::memcpy(&four, rest_.data(), sizeof(four));
      rest_.remove_prefix(sizeof(four));
      number = four;
      return true;
    }
    const std::size_t first = rest_.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return false;
    rest_.remove_prefix(first);
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), number, 16);
    if (error != std::errc()) return false;
    rest_.remove_prefix(as_size(end - rest_.data()));
    return true;
  }

 private:
  std::string_view rest_;
  bool binary_;
};

/// The faces of one section. @returns what is wrong, or empty.
std::string add_faces(const FluentSection& section, FluentFaces& out) {
  const std::size_t head = section.whole.find('(', 1);
  const std::size_t head_end = head == std::string_view::npos ? head : section.whole.find(')', head);
  if (head_end == std::string_view::npos) return "has a section of faces without counts";
  std::array<std::int64_t, 5> about{};  // zone, first, last, kind of border, kind of face
  Numbers of_head(section.whole.substr(head + 1, head_end - head - 1), false);
  std::size_t count = 0;
  while (count < about.size() && of_head.next(about[count])) ++count;
  if (about[0] == 0) return {};  // what all zones have together
  const std::size_t body = section.whole.find('(', head_end);
  if (count < 3 || body == std::string_view::npos || about[1] < 1 || about[2] < about[1] - 1)
    return "has a section of faces without them";
  // 0 mixed, 2 lines, 3 triangles, 4 quadrilaterals, 5 polygons
  const std::int64_t corners = about[4] == 0 || about[4] == 5 ? 0 : about[4];
  constexpr std::int64_t kMostCorners = 4096;
  Numbers numbers(section.whole.substr(body + 1), section.number.size() > 2);
  for (std::int64_t face = about[1]; face <= about[2]; ++face) {
    std::int64_t of_face = corners;
    if (corners == 0 && !numbers.next(of_face)) return "has fewer faces than it says";
    if (of_face < 2 || of_face > kMostCorners) return "has a face of " + std::to_string(of_face) + " points";
    for (std::int64_t corner = 0; corner < of_face; ++corner) {
      if (!numbers.next(out.points.emplace_back())) return "has fewer faces than it says";
    }
    std::array<std::int64_t, 2> cells{};
    if (!numbers.next(cells[0]) || !numbers.next(cells[1])) return "has fewer faces than it says";
    out.begin.push_back(out.points.size());
    out.cells.push_back(cells);
  }
  return {};
}

std::uint64_t key_of(const std::vector<std::int64_t>& points) {
  std::uint64_t key = 1469598103934665603U;  // FNV-1a
  for (const std::int64_t point : points) key = (key ^ static_cast<std::uint64_t>(point)) * 1099511628211U;
  return key;
}

std::vector<std::int64_t> set_of(std::vector<std::int64_t> points) {
  std::ranges::sort(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/// The faces of each cell.
class FacesOfCells {
 public:
  explicit FacesOfCells(const FluentFaces& faces) : faces_(faces) {
    std::int64_t last = 0;
    const auto most = static_cast<std::int64_t>(2 * faces.cells.size());
    for (const auto& two : faces.cells) {
      for (const std::int64_t cell : two) last = cell <= most ? std::max(last, cell) : last;
    }
    begin_.assign(as_size(last) + 2, 0);
    const auto each = [&](const auto& visit) {
      for (std::size_t f = 0; f < faces.cells.size(); ++f) {
        for (const std::int64_t cell : faces.cells[f])
          if (cell > 0 && cell <= last) visit(as_size(cell), f);
      }
    };
    each([&](std::size_t cell, std::size_t) { ++begin_[cell + 1]; });
    for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
    face_.resize(begin_.back());
    std::vector<std::size_t> at = begin_;
    each([&](std::size_t cell, std::size_t face) { face_[at[cell]++] = face; });
    for (std::size_t cell = 1; cell + 1 < begin_.size(); ++cell)
      by_points_.emplace(key_of(points_of(cell)), cell);
  }

  /// The cell that has these points alone, sorted and from 1; 0 where there is none.
  [[nodiscard]] std::size_t cell_with(const std::vector<std::int64_t>& points) const {
    const auto [first, last] = by_points_.equal_range(key_of(points));
    for (auto found = first; found != last; ++found)
      if (points_of(found->second) == points) return found->second;
    return 0;
  }

  /// Appends the stream of data_set.h, with points from 0, the faces as seen from outside: those of a file are seen so
  /// from their first cell's inside.
  void append(std::size_t cell, std::vector<std::int64_t>& stream) const {
    stream.push_back(static_cast<std::int64_t>(begin_[cell + 1] - begin_[cell]));
    for (std::size_t i = begin_[cell]; i < begin_[cell + 1]; ++i) {
      const std::size_t first = faces_.begin[face_[i]], end = faces_.begin[face_[i] + 1];
      const bool turn = faces_.cells[face_[i]][0] == static_cast<std::int64_t>(cell);
      stream.push_back(static_cast<std::int64_t>(end - first));
      for (std::size_t p = first; p < end; ++p)
        stream.push_back(faces_.points[turn ? first + end - 1 - p : p] - 1);
    }
  }

 private:
  [[nodiscard]] std::vector<std::int64_t> points_of(std::size_t cell) const {
    std::vector<std::int64_t> out;
    for (std::size_t i = begin_[cell]; i < begin_[cell + 1]; ++i) {
      const auto at = [&](std::size_t p) { return faces_.points.begin() + static_cast<std::ptrdiff_t>(p); };
      out.insert(out.end(), at(faces_.begin[face_[i]]), at(faces_.begin[face_[i] + 1]));
    }
    return set_of(std::move(out));
  }

  const FluentFaces& faces_;
  std::vector<std::size_t> begin_, face_;
  std::unordered_multimap<std::uint64_t, std::size_t> by_points_;
};

}  // namespace

std::optional<FluentSection> next_fluent_section(std::string_view text, std::size_t& at,
                                                 std::string& problem) {
  const std::size_t begin = text.find('(', at);
  if (begin == std::string_view::npos) return std::nullopt;
  const std::size_t digits = std::min(text.find_first_not_of("0123456789", begin + 1), text.size());
  std::string number(text.substr(begin + 1, digits - begin - 1));
  if (number.empty() || digits == text.size() || text[digits] != ' ') {
    problem =
        "has a section '" + printable(text.substr(begin, 24)) + "' without a number and a blank behind it";
    return std::nullopt;
  }
  const bool binary = number.size() > 3;
  const std::string words = "End of Binary Section   " + number + ")";
  const std::size_t end = binary ? text.find(words, digits) : end_of_text_section(text, begin);
  if (end == std::string_view::npos) {
    problem = "has a section " + number + " that does not end";
    return std::nullopt;
  }
  at = binary ? end + words.size() : end;
  return FluentSection{std::move(number), text.substr(begin, at - begin)};
}

FluentFaces read_fluent_faces(std::string_view text) {
  FluentFaces out;
  std::size_t at = 0;
  while (const auto section = next_fluent_section(text, at, out.problem)) {
    const std::string& number = section->number;
    if (number == "59" || number == "2059" || number == "3059")
      out.problem = "has faces that are parted into others (hanging nodes) beside polyhedra";
    if (number == "13" || number == "2013" || number == "3013") out.problem = add_faces(*section, out);
    if (!out.problem.empty()) break;
  }
  return out;
}

std::string restore_polyhedra(UnstructuredTopology& mesh, const FluentFaces& faces) {
  constexpr std::uint8_t kPointSet = 41, kPolyhedron = 42;
  if (std::ranges::find(mesh.types, kPointSet) == mesh.types.end()) return {};
  if (!faces.problem.empty()) return faces.problem;
  const FacesOfCells of_cells(faces);
  std::vector<std::int64_t> connectivity, offsets{0}, points;
  for (std::size_t c = 0; c < mesh.types.size(); ++c) {
    points.assign(mesh.connectivity.begin() + mesh.offsets[c],
                  mesh.connectivity.begin() + mesh.offsets[c + 1]);
    if (mesh.types[c] == kPointSet) {
      for (std::int64_t& point : points) ++point;
      const std::size_t cell = of_cells.cell_with(set_of(points));
      if (cell == 0) return "has no faces of the polyhedron " + std::to_string(c);
      of_cells.append(cell, connectivity);
      mesh.types[c] = kPolyhedron;
    } else {
      connectivity.insert(connectivity.end(), points.begin(), points.end());
    }
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  mesh.connectivity = std::move(connectivity);
  mesh.offsets = std::move(offsets);
  return {};
}

}  // namespace palpate
