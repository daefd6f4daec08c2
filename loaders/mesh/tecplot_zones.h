/// What a Tecplot file holds once its text is read, and the meshes that this makes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "loaders/mesh/mesh_file.h"

namespace palpate {

struct TecplotZone {
  std::string name;
  bool block = false, elements = false;
  std::int64_t i = 1, j = 1, k = 1, nodes = 0, cells = 0;
  std::uint8_t type = 0;  ///< of VTK's file format; 0: of lower dimension
  int corners = 0;
  std::optional<double> time;
  std::set<std::size_t> of_cells, passive;
  std::map<std::size_t, std::size_t> shared;  ///< variables, and from which zone
  std::optional<std::size_t> cells_of;        ///< the zone that has its connectivity
  std::vector<std::vector<double>> values;    ///< by variable
  std::vector<std::int64_t> connectivity;

  [[nodiscard]] std::size_t node_count() const {
    return static_cast<std::size_t>(elements ? nodes : i * j * k);
  }
  [[nodiscard]] std::size_t cell_count() const {
    if (elements) return static_cast<std::size_t>(cells);
    const auto along = [](std::int64_t n) { return std::max<std::int64_t>(1, n - 1); };
    return static_cast<std::size_t>(along(i) * along(j) * along(k));
  }
};

struct TecplotContent {
  std::vector<std::string> variables;
  std::vector<TecplotZone> zones;
  std::set<std::string> notes;
};

/// The volumes of all zones, by their times. @param budget numbers that may be repeated from step to step.
/// @throws Error (bad input) with `file`: no zones, no coordinates, no volume, or more than `budget`.
[[nodiscard]] MeshFile meshes_of(TecplotContent content, const std::string& file, std::size_t budget);

}  // namespace palpate
