#include "loaders/cardiac/ex/ex_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/grid/block_join.h"
#include "common/field/layer/wall_layer.h"
#include "loaders/cardiac/ex/ex_element.h"
#include "loaders/cardiac/ex/ex_fields.h"
#include "loaders/cardiac/ex/ex_groups.h"
#include "loaders/cardiac/ex/ex_places.h"
#include "loaders/cardiac/mesh_text.h"

namespace palpate::ex {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// Places closer than this times the shortest edge at them are one point.
constexpr double kSamePlace = 1e-6;
/// Angles that differ by more than this at one point are said to disagree [rad].
constexpr double kSameAngle = 1e-6;
/// Memory for each place of a sampling, here and as some five tetrahedra where it is used; measured on the
/// ventricles of a dog.
constexpr double kBytesPerPlace = 2400.0;

/// The shapes of all elements, with the field that says where they are and the one of their fibres.
std::vector<ElementShape> shapes_of(const Model& model, const std::string& file, bool& with_fibres) {
  if (model.elements.empty())
    throw input_error({file, "", "holds no element of three dimensions", "an .exelem file with them",
                       "name the .exnode and the .exelem file together"});
  std::vector<ElementShape> shapes;
  shapes.reserve(model.elements.size());
  with_fibres = false;
  for (const Element& element : model.elements) {
    const std::string place = "line " + std::to_string(element.line);
    const std::vector<ElementField>& header = model.element_headers[element.header];
    const ElementField* const coordinates = coordinates_of(header);
    const ElementField* fibres = nullptr;
    for (const ElementField& field : header) {
      if (field.name == "fibres" || field.name == "fibers") fibres = &field;
    }
    if (coordinates == nullptr || coordinates->components.size() != 3)
      throw input_error({file, place, "has no coordinates of three components", "a field \"coordinates\""});
    with_fibres = with_fibres || fibres != nullptr;
    shapes.emplace_back(model, element, *coordinates, fibres, file);
  }
  return shapes;
}

/// Places in elements without fibres that others share have the axes of these.
void borrow_axes(const std::vector<std::uint32_t>& first, std::vector<Place>& places) {
  for (std::size_t p = 0; p < first.size(); ++p) {
    Place& there = places[first[p]];
    if (!std::isnan(there.angles[0]) || std::isnan(places[p].angles[0])) continue;
    there.angles = places[p].angles;
    there.axes = places[p].axes;
    there.has_axes = places[p].has_axes;
  }
}

DataArray array_of(const char* name, int components, const std::vector<double>& values) {
  return make_array(name, Association::kPoint, components, std::span<const double>(values));
}

/// Numbers the places of a lattice of (n + 1)^3, first axis fastest.
struct Lattice {
  std::size_t side;
  [[nodiscard]] std::size_t at(std::size_t i, std::size_t j, std::size_t k) const {
    return i + side * (j + side * k);
  }
  [[nodiscard]] std::size_t count() const { return side * side * side; }
};

/// The places of all elements, one element behind the other.
struct Samples {
  std::map<Linked, ElementPlaces> shapes;
  std::vector<const ElementPlaces*> of_element;
  std::vector<std::size_t> first;  ///< place of each element, and their count

  Samples(const Model& model, int refine) {
    first.push_back(0);
    for (const Element& element : model.elements) {
      const auto [found, is_new] = shapes.try_emplace(element.linked);
      if (is_new) found->second = element_places(element.linked, refine);
      of_element.push_back(&found->second);
      first.push_back(first.back() + found->second.xi.size());
    }
  }
  [[nodiscard]] bool cubes() const { return shapes.size() == 1 && shapes.begin()->first == Linked{}; }
};

/// The shortest edge at each place that is not zero.
std::vector<double> spacings(const std::vector<Place>& places, const Samples& samples) {
  std::vector<double> shortest(places.size(), std::numeric_limits<double>::infinity());
  for (std::size_t e = 0; e < samples.of_element.size(); ++e) {
    for (const auto& [from, to] : samples.of_element[e]->edges) {
      const std::size_t a = samples.first[e] + from, b = samples.first[e] + to;
      const double length = glm::distance(places[a].x, places[b].x);
      if (!(length > 0.0)) continue;
      shortest[a] = std::min(shortest[a], length);
      shortest[b] = std::min(shortest[b], length);
    }
  }
  return shortest;
}

/// For each place the first one at the same point.
std::vector<std::uint32_t> joined(const std::vector<Place>& places, const Samples& samples,
                                  const std::string& file) {
  const std::vector<double> spacing = spacings(places, samples);
  double size = 0.0;
  for (const Place& place : places) size = std::max(size, glm::length(place.x - places.front().x));
  std::vector<Vec3> positions;
  std::vector<MergeCandidate> candidates;
  positions.reserve(places.size());
  candidates.reserve(places.size());
  for (std::size_t e = 0; e < samples.of_element.size(); ++e) {
    for (std::size_t p = samples.first[e]; p < samples.first[e + 1]; ++p) {
      const Vec3& x = places[p].x;
      if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2]))
        throw input_error({file, "", "leads to coordinates that are not finite"});
      positions.push_back(x);
      // What is inside an element is no other's.
      if (samples.of_element[e]->inside[p - samples.first[e]]) continue;
      // A collapsed edge is zero but for rounding: it must not count as a spacing.
      const bool real = std::isfinite(spacing[p]) && spacing[p] > 1e-9 * size;
      candidates.push_back({static_cast<std::uint32_t>(p), real ? spacing[p] : 1e-3 * size,
                            static_cast<std::uint32_t>(e), true});
    }
  }
  return merge_points(positions, candidates, kSamePlace);
}

/// 1 and 2 at the points of faces that no other element shares: those where the third axis, which runs
/// through the wall, begins (inner surface) and ends (outer surface). 0 elsewhere; rims count as surfaces.
std::vector<double> surfaces_of(const std::vector<std::int64_t>& point_of, const Lattice& lattice,
                                std::size_t elements, std::size_t points) {
  const std::size_t n = lattice.side;
  // A face between elements is known by the points at its corners, in whatever order.
  using Face = std::array<std::int64_t, 4>;
  const auto face_of = [&](std::size_t e, std::size_t k) {
    const std::size_t base = e * lattice.count();
    Face face{point_of[base + lattice.at(0, 0, k)], point_of[base + lattice.at(n - 1, 0, k)],
              point_of[base + lattice.at(0, n - 1, k)], point_of[base + lattice.at(n - 1, n - 1, k)]};
    std::sort(face.begin(), face.end());
    return face;
  };
  std::map<Face, int> sharing;
  for (std::size_t e = 0; e < elements; ++e) {
    ++sharing[face_of(e, 0)];
    ++sharing[face_of(e, n - 1)];
  }
  std::vector<double> tags(points, 0.0);
  for (std::size_t e = 0; e < elements; ++e) {
    for (const std::size_t k : {std::size_t{0}, n - 1}) {
      if (sharing[face_of(e, k)] != 1) continue;
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < n; ++i)
          tags[as_size(point_of[e * lattice.count() + lattice.at(i, j, k)])] = k == 0 ? 1.0 : 2.0;
    }
  }
  return tags;
}

/// The depth in the wall at each point, from the elements' own third axis; empty where elements do not stand
/// in layers, or a point would have two depths.
std::vector<double> depths_of(const std::vector<std::int64_t>& point_of, const Lattice& lattice,
                              std::size_t elements, const std::vector<double>& tags, int& deep) {
  const std::size_t n = lattice.side;
  std::vector<std::array<std::int64_t, 8>> corners(elements);
  for (std::size_t e = 0; e < elements; ++e)
    for (std::size_t c = 0; c < 8; ++c)
      corners[e][c] = point_of[e * lattice.count() +
                               lattice.at((c & 1U) * (n - 1), (c >> 1U & 1U) * (n - 1), (c >> 2U) * (n - 1))];
  const std::vector<int> levels = layer_levels(corners);
  if (levels.empty()) return {};
  deep = *std::max_element(levels.begin(), levels.end()) + 1;
  std::vector<double> depth(tags.size(), kNaN);
  constexpr double kRounding = 1e-12;
  for (std::size_t e = 0; e < elements; ++e) {
    for (std::size_t p = 0; p < lattice.count(); ++p) {
      const std::size_t level = p / (n * n);
      const double xi = static_cast<double>(level) / static_cast<double>(n - 1);
      const double here = (levels[e] + xi) / deep;
      double& there = depth[as_size(point_of[e * lattice.count() + p])];
      if (std::isnan(there)) there = here;
      if (std::abs(there - here) > kRounding) return {};
    }
  }
  for (std::size_t p = 0; p < tags.size(); ++p)
    if (tags[p] != 0.0 && std::abs(depth[p] - (tags[p] == 2.0 ? 1.0 : 0.0)) > kRounding) return {};
  return depth;
}

void check_memory(const Model& model, int refine, std::uint64_t memory, const std::string& file) {
  const double side = refine + 1.0;
  double places = 0.0;
  for (const Element& element : model.elements) {
    const auto axes = std::count(element.linked.begin(), element.linked.end(), true);
    places += axes == 3   ? side * (side + 1.0) * (side + 2.0) / 6.0
              : axes == 2 ? side * side * (side + 1.0) / 2.0
                          : side * side * side;
  }
  const double wanted = kBytesPerPlace * places;
  if (wanted <= static_cast<double>(memory)) return;
  throw input_error({file, "",
                     "makes " + short_number(places) + " points of its " +
                         counted(model.elements.size(), "element") + ", sampled as " +
                         cells_text(model.elements.front().linked, refine) + " each, which take some " +
                         short_number(std::round(1e-9 * wanted)) + " GB",
                     "no more than the " + short_number(std::round(1e-9 * static_cast<double>(memory))) +
                         " GB that this machine can give",
                     "a smaller --refine"});
}

/// Whether all fields are linear in tetrahedra: sampling these finer says nothing more.
bool linear_tetrahedra(const Model& model) {
  const auto is_linear = [](const ElementComponent& component) {
    return std::all_of(component.basis.begin(), component.basis.end(), [](Basis basis) {
      return basis == Basis::kLinearSimplex || basis == Basis::kConstant;
    });
  };
  std::set<std::uint32_t> headers;
  for (const Element& element : model.elements) headers.insert(element.header);
  return std::all_of(headers.begin(), headers.end(), [&](std::uint32_t header) {
    const auto& fields = model.element_headers[header];
    return std::all_of(fields.begin(), fields.end(), [&](const ElementField& field) {
      return field.system == System::kCartesian &&
             std::all_of(field.components.begin(), field.components.end(), is_linear);
    });
  });
}

bool disagree(const Place& a, const Place& b) {
  for (int c = 0; c < 3; ++c)
    if (std::abs(std::remainder(a.angles[c] - b.angles[c], std::numbers::pi)) > kSameAngle) return true;
  return false;
}

/// Nodes and weights of Gauss-Legendre quadrature on [0, 1], by Newton's method on the recurrence.
std::vector<std::pair<double, double>> gauss_legendre(int order) {
  std::vector<std::pair<double, double>> rule;
  for (int i = 0; i < order; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (order + 0.5));
    double slope = 1.0;
    for (int step = 0; step < 50; ++step) {
      double before = 1.0, value = x;
      for (int k = 2; k <= order; ++k)
        before = std::exchange(value, ((2 * k - 1) * x * value - (k - 1) * before) / k);
      slope = order * (x * value - before) / (x * x - 1.0);
      const double change = value / slope;
      x -= change;
      if (std::abs(change) < 1e-15) break;
    }
    rule.emplace_back(0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

}  // namespace

std::vector<int> layer_levels(const std::vector<std::array<std::int64_t, 8>>& corners) {
  struct Side {
    std::size_t element, axis, end;
  };
  std::map<std::array<std::int64_t, 4>, std::vector<Side>> sides;
  for (std::size_t e = 0; e < corners.size(); ++e) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t end = 0; end < 2; ++end) {
        std::array<std::int64_t, 4> face{};
        std::size_t count = 0;
        for (std::size_t c = 0; c < 8; ++c)
          if ((c >> axis & 1U) == end) face[count++] = corners[e][c];
        std::sort(face.begin(), face.end());
        // A face that is collapsed to an edge joins nothing.
        if (std::unique(face.begin(), face.end()) - face.begin() < 3) continue;
        sides[face].push_back({e, axis, end});
      }
    }
  }
  std::vector<std::vector<std::pair<std::size_t, int>>> joined_to(corners.size());
  for (const auto& [face, of] : sides) {
    if (of.size() == 1) continue;
    if (of.size() > 2) return {};
    const Side &a = of[0], &b = of[1];
    const bool through = a.axis == 2, other = b.axis == 2;
    if (through != other || (through && a.end == b.end)) return {};
    const int up = !through ? 0 : a.end == 1 ? 1 : -1;
    joined_to[a.element].emplace_back(b.element, up);
    joined_to[b.element].emplace_back(a.element, -up);
  }
  constexpr int kUnset = std::numeric_limits<int>::min();
  std::vector<int> level(corners.size(), kUnset);
  for (std::size_t start = 0; start < level.size(); ++start) {
    if (level[start] != kUnset) continue;
    std::vector<std::size_t> part{start};
    level[start] = 0;
    int lowest = 0;
    for (std::size_t i = 0; i < part.size(); ++i) {
      for (const auto& [next, up] : joined_to[part[i]]) {
        const int wanted = level[part[i]] + up;
        if (level[next] == kUnset) {
          level[next] = wanted;
          lowest = std::min(lowest, wanted);
          part.push_back(next);
        } else if (level[next] != wanted) {
          return {};
        }
      }
    }
    for (const std::size_t e : part) level[e] -= lowest;
  }
  return level;
}

std::optional<Vec3> long_axis(const Model& model) {
  for (const Element& element : model.elements) {
    const auto& fields = model.element_headers[element.header];
    const bool prolate = std::any_of(fields.begin(), fields.end(), [](const ElementField& field) {
      return field.name == "coordinates" && field.system == System::kProlate;
    });
    if (!prolate) return std::nullopt;
  }
  return model.elements.empty() ? std::nullopt : std::optional(Vec3{-1.0, 0.0, 0.0});
}

SampledModel sample(const Model& model, int refine, const std::string& file, std::uint64_t memory) {
  bool with_fibres = false;
  const std::vector<ElementShape> shapes = shapes_of(model, file, with_fibres);
  const bool linear = linear_tetrahedra(model);
  if (linear) refine = 1;
  check_memory(model, refine, memory, file);
  const Samples samples(model, refine);

  std::vector<Place> places;
  places.reserve(samples.first.back());
  for (std::size_t e = 0; e < shapes.size(); ++e)
    for (const Vec3& xi : samples.of_element[e]->xi) places.push_back(shapes[e].at(xi));

  const std::vector<std::uint32_t> first = joined(places, samples, file);
  borrow_axes(first, places);
  SampledModel sampled;
  std::vector<OtherField> others = other_fields(model, refine, file, sampled.notes);
  std::vector<std::int64_t> point_of(places.size(), -1);
  std::vector<double> positions, fibre, sheet, normal;
  std::array<std::vector<double>, 3> angles;
  std::size_t points = 0, undefined = 0;
  std::set<std::uint32_t> disagreeing;
  const auto append = [](std::vector<double>& to, const Vec3& v) { to.insert(to.end(), {v[0], v[1], v[2]}); };
  for (std::size_t e = 0; e < shapes.size(); ++e) {
    for (std::size_t p = samples.first[e]; p < samples.first[e + 1]; ++p) {
      const Vec3& xi = samples.of_element[e]->xi[p - samples.first[e]];
      if (first[p] != p) {
        // A collapsed edge has many directions at one place: which of them does not matter, there is none.
        if (with_fibres && places[p].has_axes && disagree(places[p], places[first[p]]))
          disagreeing.insert(first[p]);
        point_of[p] = point_of[first[p]];
        for (OtherField& other : others) other.join(as_size(point_of[p]), e, xi);
        continue;
      }
      const Place& place = places[p];
      point_of[p] = static_cast<std::int64_t>(points++);
      append(positions, place.x);
      for (OtherField& other : others) other.append(e, xi);
      if (!with_fibres) continue;
      if (!place.has_axes && !std::isnan(place.angles[0])) ++undefined;
      append(fibre, place.has_axes ? place.axes[0] : Vec3{kNaN});
      append(sheet, place.has_axes ? place.axes[1] : Vec3{kNaN});
      append(normal, place.has_axes ? place.axes[2] : Vec3{kNaN});
      for (int c = 0; c < 3; ++c) angles[as_size(c)].push_back(place.angles[c] * 180.0 / std::numbers::pi);
    }
  }

  UnstructuredTopology topology;
  topology.positions = array_of("points", 3, positions);
  topology.offsets.push_back(0);
  std::vector<double> names;
  std::vector<std::size_t> element_of;  // of each cell
  for (std::size_t e = 0; e < shapes.size(); ++e) {
    const ElementPlaces& cells = *samples.of_element[e];
    for (std::size_t c = 0; c < cells.corners.size(); ++c) {
      topology.connectivity.push_back(point_of[samples.first[e] + cells.corners[c]]);
      if ((c + 1) % cells.corner_count != 0) continue;
      topology.types.push_back(cells.type);
      topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
      names.push_back(static_cast<double>(model.elements[e].name));
      element_of.push_back(e);
    }
  }
  sampled.mesh.topology = std::move(topology);
  if (with_fibres) {
    sampled.mesh.arrays.push_back(array_of("fibre", 3, fibre));
    sampled.mesh.arrays.push_back(array_of("sheet", 3, sheet));
    sampled.mesh.arrays.push_back(array_of("normal", 3, normal));
    sampled.mesh.arrays.push_back(array_of("fibre angle", 1, angles[0]));
    sampled.mesh.arrays.push_back(array_of("imbrication angle", 1, angles[1]));
    sampled.mesh.arrays.push_back(array_of("sheet angle", 1, angles[2]));
  }
  if (samples.cubes()) {
    const Lattice lattice{as_size(refine) + 1};
    std::vector<double> tags =
        group_surfaces(model, {samples.of_element, samples.first, point_of, points}, sampled.notes);
    if (tags.empty()) tags = surfaces_of(point_of, lattice, shapes.size(), points);
    sampled.mesh.arrays.push_back(array_of("surface", 1, tags));
    int deep = 0;
    const std::vector<double> depth = depths_of(point_of, lattice, shapes.size(), tags, deep);
    if (!depth.empty()) {
      sampled.mesh.arrays.push_back(array_of(kLayerArray, 1, depth));
      sampled.notes.push_back("layers by the elements' third axis, " +
                              counted(static_cast<std::uint64_t>(deep), "element") + " deep");
    }
  }
  sampled.mesh.arrays.push_back(make_array("element", Association::kCell, 1, std::span<const double>(names)));

  add_arrays(others, element_of, sampled.mesh, sampled.notes);
  for (const std::string& field : model.left_out)
    sampled.notes.push_back("field " + field + " left out: its values are no numbers");
  if (model.data_points > 0)
    sampled.notes.push_back(counted(model.data_points, "data point") + " left out: they are no nodes");
  for (const auto& [dimension, count] : model.flat_elements)
    sampled.notes.push_back(counted(count, "element") + " of " + counted(as_size(dimension), "dimension") +
                            " left out, with the fields on them");

  for (const auto& [linked, cells] : samples.shapes) {
    const auto is_one = [&shape = linked](const Element& element) { return element.linked == shape; };
    const auto count =
        static_cast<std::uint64_t>(std::count_if(model.elements.begin(), model.elements.end(), is_one));
    sampled.notes.push_back(linear ? counted(count, "element") + ", linear tetrahedra, as they stand"
                                   : counted(count, "curved element") + " sampled as " +
                                         cells_text(linked, refine) + " each");
  }
  const auto bare =
      std::ranges::count_if(shapes, [](const ElementShape& shape) { return !shape.has_fibres(); });
  if (with_fibres && bare > 0)
    sampled.notes.push_back("fibres: no data in " + std::to_string(bare) + " of " +
                            counted(shapes.size(), "element"));
  if (undefined > 0)
    sampled.notes.push_back(counted(undefined, "point") +
                            " on collapsed edges without a fibre direction: no data there");
  if (!disagreeing.empty())
    sampled.notes.push_back(counted(disagreeing.size(), "point") +
                            " where elements disagree on an angle: that of the first one is kept");
  return sampled;
}

double exact_volume(const Model& model, int order, const std::string& file) {
  bool with_fibres = false;
  const std::vector<ElementShape> shapes = shapes_of(model, file, with_fibres);
  const auto rule = gauss_legendre(order);
  double volume = 0.0;
  for (std::size_t e = 0; e < shapes.size(); ++e) {
    double part = 0.0;
    for (const auto& [z, wz] : rule) {
      for (const auto& [y, wy] : rule) {
        for (const auto& [x, wx] : rule) {
          const auto at = from_cube(model.elements[e].linked, {x, y, z});
          part += wx * wy * wz * at.second * glm::determinant(shapes[e].at(at.first).tangents);
        }
      }
    }
    volume += std::abs(part);
  }
  return volume;
}

}  // namespace palpate::ex
