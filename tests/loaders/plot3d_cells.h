/// One hexahedron as a grid of PLOT3D, with its values as a solution, as one of OVERFLOW and as functions.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/loaders/cell_kinds.h"

namespace palpate::test {

/// What holds the values of the grid.
enum class Plot3dKind : std::uint8_t { kSolution, kOverflow, kFunctions };

/// A record in the byte order of the file, with its byte count before and behind; in text the numbers alone.
class Plot3dRecord {
 public:
  Plot3dRecord(bool wide, bool big, bool text) : wide_(wide), big_(big), text_(text) {}
  void whole(std::int32_t value) { bytes_ += text_ ? std::to_string(value) + " " : raw(value, big_); }
  void number(double value) {
    bytes_ += text_   ? exact_number(value) + "\n"
              : wide_ ? raw(value, big_)
                      : raw(static_cast<float>(value), big_);
  }
  [[nodiscard]] std::string ended() {
    const std::string mark = text_ ? "" : raw(static_cast<std::int32_t>(bytes_.size()), big_);
    std::string out = mark + bytes_ + mark;
    bytes_.clear();
    return out;
  }

 private:
  bool wide_, big_, text_;
  std::string bytes_;
};

/// The nodes in the order of a grid: along rows, not around.
inline std::vector<Vec3> plot3d_nodes(const CellKind& kind) {
  const std::vector<Vec3> around = places(kind, {});
  std::vector<Vec3> out;
  for (const std::size_t i : {0, 1, 3, 2, 4, 5, 7, 6}) out.push_back(around[i]);
  return out;
}

/// The grid; empty for cells that are no hexahedra of eight nodes.
inline std::string plot3d_grid(const CellKind& kind, bool wide, bool big, bool text) {
  constexpr int kHexahedron = 12;
  if (kind.vtk != kHexahedron) return {};
  Plot3dRecord record(wide, big, text);
  for (int axis = 0; axis < 3; ++axis) record.whole(2);
  std::string out = record.ended();
  for (int axis = 0; axis < 3; ++axis) {
    for (const Vec3& x : plot3d_nodes(kind)) record.number(x[axis]);
  }
  return out + record.ended();
}

/// Its values: of a solution density 1, the flow as momentum, and energy 2; functions are the flow.
inline std::string plot3d_values(const CellKind& kind, Plot3dKind values, bool wide, bool big, bool text) {
  Plot3dRecord record(wide, big, text);
  for (int axis = 0; axis < 3; ++axis) record.whole(2);
  if (values == Plot3dKind::kFunctions) record.whole(3);
  constexpr int kOverflowValues = 6, kConditions = 4, kBeforeIgam = 7, kBehindIgam = 8;
  if (values == Plot3dKind::kOverflow) {
    record.whole(kOverflowValues);
    record.whole(0);
  }
  std::string out = record.ended();
  if (values == Plot3dKind::kOverflow) {
    for (int i = 0; i < kBeforeIgam; ++i) record.number(0.5);
    record.whole(1);
    for (int i = 0; i < kBehindIgam; ++i) record.number(1.0);
    out += record.ended();
  }
  if (values == Plot3dKind::kSolution) {
    for (int i = 0; i < kConditions; ++i) record.number(0.5);
    out += record.ended();
  }
  const std::vector<Vec3> nodes = plot3d_nodes(kind);
  const auto all = [&](double value) {
    for (std::size_t i = 0; i < nodes.size(); ++i) record.number(value);
  };
  if (values != Plot3dKind::kFunctions) all(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    for (const Vec3& x : nodes) record.number(flow_at(x)[axis]);
  }
  if (values != Plot3dKind::kFunctions) all(2.0);
  if (values == Plot3dKind::kOverflow) all(1.4);
  return out + record.ended();
}

/// ParaView's list of the two, a.xyz and a.q, with names for functions.
inline std::string plot3d_list(const CellKind& kind, Plot3dKind values) {
  if (plot3d_grid(kind, true, false, false).empty()) return {};
  return std::string(R"({"filenames": [{"time": 0, "xyz": "a.xyz", ")") +
         (values == Plot3dKind::kFunctions ? "function" : "q") +
         R"(": "a.q"}], "function-names": ["U", "V", "W"]})";
}

/// The Fluent case `text` in binary, of sections as fluent_file() writes them.
inline std::string fluent_in_binary(const CellKind& kind, bool wide) {
  std::string text = fluent_file(kind);
  if (text.empty()) return {};
  const auto in_binary = [&text](const std::string& head, const std::string& number,
                                 const std::string& bytes) {
    const std::size_t at = text.find("(" + head), open = text.find(")(", at) + 2, end = text.find("))", open);
    const std::string about = text.substr(at + 1 + head.size() - 2, open - at - 1 - head.size() + 2);
    text.replace(at, end + 2 - at,
                 "(" + number + " " + about + bytes + "\nEnd of Binary Section   " + number + ")");
  };
  std::string nodes, faces;
  for (const Vec3& x : places(kind, {})) {
    for (int axis = 0; axis < 3; ++axis)
      nodes += wide ? raw(x[axis], false) : raw(static_cast<float>(x[axis]), false);
  }
  for (const std::vector<int>& face : faces_of(kind)) {
    faces += raw(static_cast<std::int32_t>(face.size()), false);
    for (auto corner = face.rbegin(); corner != face.rend(); ++corner)
      faces += raw(static_cast<std::int32_t>(*corner + 1), false);
    faces += raw(std::int32_t{1}, false) + raw(std::int32_t{0}, false);
  }
  in_binary("10 (1", wide ? "3010" : "2010", nodes);
  in_binary("13 (3", "2013", faces);
  return text;
}

}  // namespace palpate::test
