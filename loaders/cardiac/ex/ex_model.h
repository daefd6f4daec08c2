/// A finite element model of EX files (CMISS, OpenCMISS-Zinc): parameters at nodes and how each component of
/// a field is interpolated in an element.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/base/index.h"

namespace palpate::ex {

/// Along one axis of an element. Axes of a simplex are linked: their coordinates add up to at most one.
enum class Basis : std::uint8_t {
  kLinear,
  kQuadratic,
  kCubic,
  kHermite,
  kLinearSimplex,
  kQuadraticSimplex,
  kConstant
};
[[nodiscard]] constexpr bool is_simplex(Basis basis) noexcept {
  return basis == Basis::kLinearSimplex || basis == Basis::kQuadraticSimplex;
}
/// Which axes are those of a simplex: none, two (a wedge) or all three (a tetrahedron).
using Linked = std::array<bool, 3>;
/// Nodes along that axis, and parameters (value, derivative) at each.
[[nodiscard]] int node_count(Basis basis) noexcept;
[[nodiscard]] int parameter_count(Basis basis) noexcept;
/// Nodes of an element. @pre linked axes have one basis.
[[nodiscard]] std::size_t node_count(const std::array<Basis, 3>& basis) noexcept;

/// How an angle that winds around the axis is taken where it passes from 2 pi to 0.
enum class Winding : std::uint8_t { kNone, kIncreasing, kDecreasing, kNonIncreasing, kNonDecreasing };

enum class System : std::uint8_t { kCartesian, kCylindrical, kProlate };

/// What a number of a node is: "value", "d/ds1" and so on to "d3/ds1ds2ds3", and of which version, from 0.
struct ValueLabel {
  int kind = 0;
  int version = 0;
  bool operator==(const ValueLabel&) const = default;
};

/// A component of a field as a node's header describes it.
struct NodeComponent {
  std::string name;
  int first = 0;                   ///< its first number among those of the node
  int count = 1;                   ///< its numbers; before version 2 all of a version, then those of the next
  std::vector<ValueLabel> labels;  ///< of its numbers; from version 2 of the format on
};

/// What the values of a field are. Those that are no numbers are passed over.
enum class ValueKind : std::uint8_t { kNumber, kString, kElementXi };

struct NodeField {
  std::string name;
  ValueKind kind = ValueKind::kNumber;
  int xi = 3;  ///< numbers of a place in an element, of kElementXi
  System system = System::kCartesian;
  double focus = 1.0;  ///< of a prolate spheroidal system
  std::vector<NodeComponent> components;
};

struct Node {
  std::uint32_t header = 0;    ///< of Model::node_headers
  std::vector<double> values;  ///< NaN where they are no numbers
};

/// What multiplies one function of a component's basis.
struct Parameter {
  int node = 0;                     ///< of the element's own list, from 0; -1: the parameter is zero
  int value = 0;                    ///< of the component at that node, from 0; where there is no label
  std::optional<ValueLabel> label;  ///< from version 2 of the format on
  int scale = -1;                   ///< of the element's scale factors, from 0; -1 for a factor of one
  bool operator==(const Parameter&) const = default;
};

/// Values of a component at equidistant places of the element, the first axis fastest: linear between them.
struct ElementGrid {
  std::array<int, 3> intervals{};  ///< along each axis; 0 where it is constant
  std::size_t first = 0;           ///< its first value among those of the element
  [[nodiscard]] std::size_t count() const noexcept {
    return as_size(intervals[0] + 1) * as_size(intervals[1] + 1) * as_size(intervals[2] + 1);
  }
};

struct ElementComponent {
  std::string name;
  std::array<Basis, 3> basis{};
  Winding winding = Winding::kNone;   ///< along the first axis
  std::vector<Parameter> parameters;  ///< corner after corner, first axis fastest
  std::optional<ElementGrid> grid;    ///< in place of parameters
  /// Parameters of each corner.
  [[nodiscard]] std::size_t of_corner() const noexcept {
    std::size_t each = 1;
    for (const Basis b : basis) each *= as_size(parameter_count(b));
    return each;
  }
};

struct ElementField {
  std::string name;
  System system = System::kCartesian;
  double focus = 1.0;
  std::vector<ElementComponent> components;
};

struct Element {
  std::int64_t name = 0;     ///< its number in the file
  std::uint32_t header = 0;  ///< of Model::element_headers
  std::size_t line = 0;      ///< where it begins
  Linked linked{};           ///< its shape
  std::vector<std::int64_t> nodes;
  std::vector<double> scales;
  std::vector<double> values;       ///< of its own, at the places of grids
  std::vector<std::int64_t> faces;  ///< their numbers: the first axis at 0 and 1, then the next; or none
};

/// What a group lists, of what a surface is made of.
struct Group {
  std::set<std::int64_t> nodes, faces;
};

struct Model {
  std::vector<std::vector<NodeField>> node_headers;
  std::map<std::int64_t, Node> nodes;
  std::vector<std::vector<ElementField>> element_headers;
  std::vector<Element> elements;  ///< of three dimensions
  std::map<std::int64_t, std::size_t> element_of_name;
  std::map<int, std::size_t> flat_elements;  ///< with fields of their own, passed over, by their dimension
  std::set<std::string> left_out;            ///< fields whose values are no numbers, with their type
  std::size_t data_points = 0;               ///< passed over
  std::map<std::string, Group> groups;       ///< by their names
  /// Of nodes that have the fields of two headers: the header of both.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> joined_headers;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> joined_element_headers;  ///< likewise
};

}  // namespace palpate::ex
