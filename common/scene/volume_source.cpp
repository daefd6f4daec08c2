#include "common/scene/volume_source.h"

#include <cmath>
#include <utility>

#include "common/base/error.h"

namespace palpate {
namespace {

/// The number that `choice` takes of every tuple, as an array of its own.
DataArray single_component(const DataArray& array, int component) {
  std::vector<float> values(array.tuples);
  for (std::size_t t = 0; t < array.tuples; ++t) {
    double value = 0.0;
    if (component == ScalarChoice::kMagnitude) {
      for (int c = 0; c < array.components; ++c) value = std::hypot(value, array.at(t, c));
    } else {
      value = array.at(t, component);
    }
    values[t] = static_cast<float>(value);
  }
  return make_array(array.name, array.association, 1, values);
}

}  // namespace

DataSet volume_source(const std::vector<DataSet>& blocks, const ScalarChoice& choice,
                      const std::string& file) {
  const auto* topology =
      blocks.size() == 1 ? std::get_if<UniformTopology>(&blocks.front().topology) : nullptr;
  if (topology == nullptr) {
    throw input_error({file, "", "is not one uniform grid", "one: images and structured points",
                       "make an image of it, by 'Resample To Image' in ParaView for one"});
  }
  const DataSet& block = blocks.front();
  const DataArray* array = block.find(choice.array, choice.association);
  if (array == nullptr) throw input_error({file, "", "has no array '" + choice.array + "'"});

  DataSet source;
  source.name = block.name;
  UniformTopology place = *topology;
  DataArray values = array->components == 1 ? *array : single_component(*array, choice.component);
  if (choice.association == Association::kCell) {
    for (int axis = 0; axis < 3; ++axis) {
      // A flat grid has its cells in its plane.
      if (place.points[axis] < 2) continue;
      place.origin += 0.5 * place.axes[axis];
      --place.points[axis];
    }
    values.association = Association::kPoint;
  } else {
    source.visible = block.visible;
    source.hidden_cells = block.hidden_cells;
  }
  source.topology = place;
  source.arrays.push_back(std::move(values));
  return source;
}

}  // namespace palpate
