#include "common/hand/probe_readout.h"

#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"

namespace palpate {
namespace {

/// The cell of the grid that `x` lies in: a number, or i j k. @param hint of a sample there.
template <class Field>
std::string cell_text(const Field& field, const Vec3& x, const CellHint& hint) {
  if (const BoxGrid* grid = field.box_grid()) {
    Index3 cell{0};
    if (!grid->locate(grid->along_axes(field.frame().local_from_data(x)), cell)) return {};
    return std::to_string(cell.x) + "  " + std::to_string(cell.y) + "  " + std::to_string(cell.z);
  }
  return field.tet_mesh() != nullptr ? std::to_string(hint.cell) : std::string();
}

}  // namespace

void read_data(const NamedField& open, const ScalarField* noise, ReadoutHints& hints, ProbeReadout& readout) {
  readout.sampled = false;
  readout.tensor.reset();
  readout.scalar.reset();
  readout.scalar_name.clear();
  readout.cell.clear();
  if (open.scalar) {
    const ScalarSample sample = open.scalar->sample(readout.proxy, hints.scalar);
    if (sample.status == SampleStatus::kOk) readout.scalar = sample.value;
    readout.scalar_name = open.scalar->name();
  }
  readout.noise.reset();
  if (noise != nullptr) {
    const ScalarSample sample = noise->sample(readout.proxy, hints.noise);
    if (sample.status == SampleStatus::kOk) readout.noise = sample.value;
  }
  if (open.tensor) {
    const TensorSample sample = open.tensor->sample(readout.proxy, hints.field);
    if (sample.status == SampleStatus::kOk) readout.tensor = sample.value;
  } else if (open.field) {
    const VectorSample sample = open.field->sample(readout.proxy, hints.field);
    readout.sampled = sample.status == SampleStatus::kOk;
    readout.velocity = sample.value;
    if (readout.sampled) readout.cell = cell_text(*open.field, readout.proxy, hints.field);
  } else if (readout.scalar) {
    readout.cell = cell_text(*open.scalar, readout.proxy, hints.scalar);
  }
}

}  // namespace palpate
