#include "loaders/cardiac/ex/ex_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/layer/wall_layer.h"

namespace palpate::ex {
namespace {

bool is_own(const std::vector<ElementField>& header, const ElementField& field) {
  return &field == coordinates_of(header) || field.name == "coordinates" || field.name == "fibres" ||
         field.name == "fibers";
}

const ElementField* named(const std::vector<ElementField>& header, const std::string& name) {
  const auto field =
      std::find_if(header.begin(), header.end(), [&](const ElementField& f) { return f.name == name; });
  return field == header.end() ? nullptr : &*field;
}

/// A field as the elements have it that have it. @param why of the first one that has not.
OtherField field_of(const Model& model, const std::string& name, const std::string& file,
                    std::size_t& without, std::string& why) {
  std::vector<std::optional<ElementValues>> of_element;
  int components = 0;
  for (const Element& element : model.elements) {
    std::string lacks;
    std::optional<ElementValues>& values = of_element.emplace_back();
    const ElementField* const field = named(model.element_headers[element.header], name);
    if (field == nullptr) {
      lacks = "not defined there";
    } else if (field->system != System::kCartesian) {
      lacks = "its coordinates are not Cartesian";
    } else if (components > 0 && static_cast<int>(field->components.size()) != components) {
      lacks = "other components than elsewhere";
    } else {
      try {
        values.emplace(model, element, *field, file);
        components = static_cast<int>(field->components.size());
      } catch (const Error& error) {
        lacks = error.what();
      }
    }
    if (lacks.empty()) continue;
    if (why.empty()) why = lacks;
    ++without;
  }
  return {name, components, std::move(of_element)};
}

/// The most intervals of a grid that places of a sampling do not all meet; 0: they do.
int unseen_intervals(const Model& model, const std::string& name, int refine) {
  int most = 0;
  for (const Element& element : model.elements) {
    const ElementField* const field = named(model.element_headers[element.header], name);
    if (field == nullptr) continue;
    for (const ElementComponent& component : field->components) {
      if (!component.grid) continue;
      for (const int intervals : component.grid->intervals)
        if (intervals > 0 && refine % intervals != 0) most = std::max(most, intervals);
    }
  }
  return most;
}

/// Fields of nodes that no element has.
std::set<std::string> of_nodes_alone(const Model& model) {
  std::set<std::string> names;
  for (const auto& header : model.node_headers)
    for (const NodeField& field : header)
      if (field.kind == ValueKind::kNumber) names.insert(field.name);
  for (const auto& header : model.element_headers)
    for (const ElementField& field : header) names.erase(field.name);
  return names;
}

}  // namespace

bool OtherField::of_cells() const {
  return std::ranges::all_of(of_element_, [](const auto& values) { return !values || values->constant(); });
}

std::vector<double> OtherField::values_at(std::size_t element, const Vec3& xi) const {
  std::vector<double> values;
  if (of_element_[element]) of_element_[element]->append_at(xi, values);
  values.resize(as_size(components_), std::numeric_limits<double>::quiet_NaN());
  return values;
}

void OtherField::append(std::size_t element, const Vec3& xi) {
  const std::vector<double> values = values_at(element, xi);
  values_.insert(values_.end(), values.begin(), values.end());
}

void OtherField::join(std::size_t at, std::size_t element, const Vec3& xi) {
  const std::vector<double> values = values_at(element, xi);
  for (std::size_t c = 0; c < values.size(); ++c) {
    double& there = values_[at * values.size() + c];
    if (std::isnan(there)) there = values[c];
    const double apart = std::abs(values[c] - there);
    if (apart > 0.0) apart_[at] = std::max(apart_[at], apart);
  }
}

std::size_t OtherField::disagreeing() const {
  constexpr double kSame = 1e-6;  // of the largest value
  double most = 0.0;
  for (const double value : values_)
    if (std::isfinite(value)) most = std::max(most, std::abs(value));
  return as_size(
      std::ranges::count_if(apart_, [&](const auto& point) { return point.second > kSame * most; }));
}

std::vector<OtherField> other_fields(const Model& model, int refine, const std::string& file,
                                     std::vector<std::string>& notes) {
  std::set<std::string> names;
  for (const Element& element : model.elements) {
    const std::vector<ElementField>& header = model.element_headers[element.header];
    for (const ElementField& field : header)
      if (!is_own(header, field)) names.insert(field.name);
  }
  std::vector<OtherField> others;
  for (const std::string& name : names) {
    std::size_t without = 0;
    std::string why;
    OtherField other = field_of(model, name, file, without, why);
    const std::string start = "field \"" + name + "\"";
    if (without == model.elements.size()) {
      notes.push_back(start + " left out: " + why);
      continue;
    }
    if (without > 0)
      notes.push_back(start + ": no data in " + std::to_string(without) + " of " +
                      counted(model.elements.size(), "element") + " (" + why + ")");
    if (const int most = unseen_intervals(model, name, refine); most > 0)
      notes.push_back(start + " has values at " + std::to_string(most + 1) +
                      " places along an axis of an element, " + std::to_string(refine + 1) +
                      " are sampled: --refine " + std::to_string(most) + " takes them all");
    others.push_back(std::move(other));
  }
  for (const std::string& name : of_nodes_alone(model))
    notes.push_back("field \"" + name + "\" of nodes left out: no element says what it is between them");
  return others;
}

void add_arrays(const std::vector<OtherField>& others, const std::vector<std::size_t>& element_of,
                DataSet& mesh, std::vector<std::string>& notes) {
  for (const OtherField& other : others) {
    const auto is_taken = [&](const DataArray& array) { return array.name == other.name(); };
    const bool taken =
        std::ranges::any_of(mesh.arrays, is_taken) || other.name() == kLayerArray;  // would be the depth
    const std::string name = (taken ? "field " : "") + other.name();
    if (!other.of_cells()) {
      mesh.arrays.push_back(
          make_array(name, Association::kPoint, other.components(), std::span<const double>(other.values())));
      if (const std::size_t points = other.disagreeing(); points > 0)
        notes.push_back("field \"" + other.name() + "\": " + counted(points, "point") +
                        " where elements disagree: what the first one has is kept");
      continue;
    }
    std::vector<double> of_cell;
    for (const std::size_t element : element_of) {
      const std::vector<double> values = other.values_of(element);
      of_cell.insert(of_cell.end(), values.begin(), values.end());
    }
    mesh.arrays.push_back(
        make_array(name, Association::kCell, other.components(), std::span<const double>(of_cell)));
  }
}

}  // namespace palpate::ex
