#include "loaders/cardiac/ex/ex_element.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "common/base/error.h"
#include "common/base/index.h"

namespace palpate::ex {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
/// Tangents whose lengths' product is more than this many times their parallelogram span no plane.
constexpr double kNoPlane = 1e-9;

/// Lifts an angle by a turn where it passes the seam along the first axis, of which the ends are neighbours;
/// then the edges along that axis as wholes, so that no turn lies between them either.
void unwind(Winding winding, std::vector<double>& values) {
  for (std::size_t pair = 0; pair + 1 < values.size(); pair += 2) {
    double& first = values[pair];
    double& last = values[pair + 1];
    switch (winding) {
      case Winding::kIncreasing:
        if (last <= first) last += kTurn;
        break;
      case Winding::kNonDecreasing:
        if (last < first) last += kTurn;
        break;
      case Winding::kDecreasing:
        if (last >= first) first += kTurn;
        break;
      case Winding::kNonIncreasing:
        if (last > first) first += kTurn;
        break;
      case Winding::kNone:
        break;
    }
    const double apart = 0.5 * (values[0] + values[1]) - 0.5 * (first + last);
    const double turns = kTurn * std::round(apart / kTurn);
    first += turns;
    last += turns;
  }
}

const NodeComponent* find(const std::vector<NodeField>& header, const std::string& field,
                          const std::string& component) {
  for (const NodeField& candidate : header) {
    if (candidate.name != field) continue;
    for (const NodeComponent& c : candidate.components)
      if (c.name == component) return &c;
  }
  return nullptr;
}

/// Cartesian place and tangents of curvilinear coordinates and their derivatives (rows of `slopes`).
void to_cartesian(System system, double focus, const Vec3& q, const std::array<Vec3, 3>& slopes,
                  Place& place) {
  Mat3 jacobian{1.0};  // columns: dx/dq
  if (system == System::kCartesian) {
    place.x = q;
  } else if (system == System::kCylindrical) {
    const double c = std::cos(q[1]), s = std::sin(q[1]);
    place.x = {q[0] * c, q[0] * s, q[2]};
    jacobian = Mat3{Vec3{c, s, 0.0}, Vec3{-q[0] * s, q[0] * c, 0.0}, Vec3{0.0, 0.0, 1.0}};
  } else {
    const double ch = std::cosh(q[0]), sh = std::sinh(q[0]);
    const double cm = std::cos(q[1]), sm = std::sin(q[1]);
    const double ct = std::cos(q[2]), st = std::sin(q[2]);
    place.x = focus * Vec3{ch * cm, sh * sm * ct, sh * sm * st};
    jacobian = Mat3{focus * Vec3{sh * cm, ch * sm * ct, ch * sm * st},
                    focus * Vec3{-ch * sm, sh * cm * ct, sh * cm * st},
                    focus * Vec3{0.0, -sh * sm * st, sh * sm * ct}};
  }
  for (int axis = 0; axis < 3; ++axis) {
    place.tangents[axis] =
        jacobian[0] * slopes[0][axis] + jacobian[1] * slopes[1][axis] + jacobian[2] * slopes[2][axis];
  }
}

/// Turns two perpendicular axes in their plane, `from` towards `to`.
void turn(double angle, Vec3& from, Vec3& to) {
  const double c = std::cos(angle), s = std::sin(angle);
  const Vec3 first = c * from + s * to;
  to = c * to - s * from;
  from = first;
}

void set_axes(Place& place) {
  const Vec3 along = place.tangents[0];
  const Vec3 normal = glm::cross(along, place.tangents[1]);
  const double area = glm::length(normal);
  const double sides = glm::length(along) * glm::length(place.tangents[1]);
  // At a collapsed edge a tangent vanishes against the third one, or both are parallel.
  const double scale = glm::length(place.tangents[2]);
  place.has_axes = std::isfinite(area) && area > kNoPlane * sides && sides > kNoPlane * scale * scale;
  if (!place.has_axes) return;
  Vec3 fibre = along / glm::length(along);
  Vec3 out = normal / area;
  Vec3 across = glm::cross(out, fibre);
  turn(place.angles[0], fibre, across);
  turn(place.angles[1], out, fibre);
  turn(place.angles[2], across, out);
  place.axes = Mat3{fibre, across, out};
}

ElementFunction gather(const Model& model, const Element& element, const std::string& field,
                       const ElementComponent& component, const std::string& file) {
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    throw input_error({file, "element " + std::to_string(element.name), found, expected});
  };
  ElementFunction gathered{component.basis, {}, {}};
  if (component.grid) {
    const auto begin = element.values.begin() + static_cast<std::ptrdiff_t>(component.grid->first);
    gathered.parameters.assign(begin, begin + static_cast<std::ptrdiff_t>(component.grid->count()));
    gathered.intervals = component.grid->intervals;
    return gathered;
  }
  for (const Parameter& parameter : component.parameters) {
    if (parameter.node < 0) {
      gathered.parameters.push_back(0.0);
      continue;
    }
    if (parameter.node >= static_cast<int>(element.nodes.size()))
      refuse("names its node " + std::to_string(parameter.node + 1),
             "one of " + std::to_string(element.nodes.size()));
    const std::int64_t name = element.nodes[as_size(parameter.node)];
    const auto node = model.nodes.find(name);
    if (node == model.nodes.end()) refuse("names node " + std::to_string(name), "a node of the .exnode file");
    const NodeComponent* at = find(model.node_headers[node->second.header], field, component.name);
    if (at == nullptr)
      refuse("needs " + field + "." + component.name + " at node " + std::to_string(name), "that component");
    int value = parameter.value;
    if (parameter.label) {
      const auto labelled = std::find(at->labels.begin(), at->labels.end(), *parameter.label);
      if (labelled == at->labels.end())
        refuse("asks for version " + std::to_string(parameter.label->version + 1) +
                   " of a value or derivative of " + component.name + " that node " + std::to_string(name) +
                   " does not have",
               "one of its " + std::to_string(at->labels.size()) + " labels");
      value = static_cast<int>(labelled - at->labels.begin());
    }
    if (value >= at->count)
      refuse("asks for value " + std::to_string(value + 1) + " of " + component.name + " at node " +
                 std::to_string(name),
             "at most " + std::to_string(at->count));
    double factor = 1.0;
    if (parameter.scale >= 0) {
      if (parameter.scale >= static_cast<int>(element.scales.size()))
        refuse("asks for scale factor " + std::to_string(parameter.scale + 1),
               "at most " + std::to_string(element.scales.size()));
      factor = element.scales[as_size(parameter.scale)];
    }
    gathered.parameters.push_back(factor * node->second.values[as_size(at->first) + as_size(value)]);
  }
  if (component.winding != Winding::kNone) {
    if (component.basis[0] != Basis::kLinear || component.of_corner() != 1)
      refuse("winds " + component.name + " about the axis with a basis that is not linear",
             "linear Lagrange polynomials");
    unwind(component.winding, gathered.parameters);
  }
  return gathered;
}

}  // namespace

const ElementField* coordinates_of(const std::vector<ElementField>& header) {
  const ElementField* coordinates = nullptr;
  for (const ElementField& field : header)
    if (field.name == "coordinates" || (coordinates == nullptr && field.components.size() == 3))
      coordinates = &field;
  return coordinates;
}

Interpolated ElementFunction::at(const Vec3& xi) const {
  if (!intervals) return interpolate(basis, parameters.data(), xi);
  std::array<std::size_t, 3> low{}, high{};
  Vec3 within{0.0}, counts{0.0};
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a), count = (*intervals)[a];
    const double along = xi[axis] * count;
    low[a] = as_size(std::clamp(static_cast<int>(along), 0, std::max(count - 1, 0)));
    high[a] = std::min(low[a] + 1, as_size(count));
    within[axis] = along - static_cast<double>(low[a]);
    counts[axis] = count;
  }
  std::array<double, 8> corners{};
  for (std::size_t c = 0; c < 8; ++c) {
    const std::size_t i = (c & 1U) != 0 ? high[0] : low[0], j = (c & 2U) != 0 ? high[1] : low[1],
                      k = (c & 4U) != 0 ? high[2] : low[2];
    corners[c] = parameters[i + as_size((*intervals)[0] + 1) * (j + as_size((*intervals)[1] + 1) * k)];
  }
  Interpolated here = interpolate({Basis::kLinear, Basis::kLinear, Basis::kLinear}, corners.data(), within);
  here.slope *= counts;
  return here;
}

ElementValues::ElementValues(const Model& model, const Element& element, const ElementField& field,
                             const std::string& file) {
  for (const ElementComponent& component : field.components)
    components_.push_back(gather(model, element, field.name, component, file));
}

void ElementValues::append_at(const Vec3& xi, std::vector<double>& to) const {
  for (const ElementFunction& component : components_) to.push_back(component.at(xi).value);
}

bool ElementValues::constant() const {
  return std::ranges::all_of(components_, [](const ElementFunction& f) { return f.parameters.size() == 1; });
}

ElementShape::ElementShape(const Model& model, const Element& element, const ElementField& coordinates,
                           const ElementField* fibres, const std::string& file)
    : system_(coordinates.system), focus_(coordinates.focus) {
  for (std::size_t c = 0; c < 3; ++c)
    coordinates_[c] = gather(model, element, coordinates.name, coordinates.components[c], file);
  if (fibres == nullptr) return;
  const std::size_t count = std::min<std::size_t>(fibres->components.size(), 3);
  for (std::size_t c = 0; c < count; ++c)
    angles_.push_back(gather(model, element, fibres->name, fibres->components[c], file));
}

Place ElementShape::at(const Vec3& xi) const {
  Vec3 q{0.0};
  std::array<Vec3, 3> slopes{};
  for (std::size_t c = 0; c < 3; ++c) {
    const Interpolated here = coordinates_[c].at(xi);
    q[static_cast<int>(c)] = here.value;
    slopes[c] = here.slope;
  }
  Place place;
  to_cartesian(system_, focus_, q, slopes, place);
  for (std::size_t c = 0; c < angles_.size(); ++c)
    place.angles[static_cast<int>(c)] = angles_[c].at(xi).value;
  if (angles_.empty()) {
    place.angles = Vec3{std::numeric_limits<double>::quiet_NaN()};
  } else {
    set_axes(place);
  }
  return place;
}

}  // namespace palpate::ex
