#include "common/field/scalar_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "common/base/error.h"
#include "common/field/data_set_check.h"
#include "common/field/field_grid.h"

namespace palpate {
namespace {

/// Where a point lies: the grid points around it, their weights, and the weights' gradients in frame L.
struct Stencil {
  std::array<std::size_t, 8> point{};
  std::array<double, 8> weight{};
  std::array<Vec3, 8> gradient{};
  std::size_t count = 0;
};

bool make_stencil(const FieldGrid& grid, const Vec3& x, CellHint& hint, Stencil& out) noexcept {
  if (grid.tets) {
    const auto start = hint.cell >= 0 && hint.cell <= INT32_MAX ? static_cast<CellIndex>(hint.cell) : kNoCell;
    TetPoint at;
    if (!grid.tets->locate(x, start, at)) return false;
    hint.cell = at.cell;
    const TetMesh::Tet& v = grid.tets->cells()[static_cast<std::size_t>(at.cell)];
    const Mat3 gradients = grid.tets->barycentric_gradients(at.cell);
    out.count = 4;
    for (std::size_t i = 0; i < 4; ++i) {
      out.point[i] = v[i];
      out.weight[i] = at.b[static_cast<int>(i)];
    }
    for (int i = 0; i < 3; ++i) {
      out.gradient[static_cast<std::size_t>(i) + 1] = gradients[i];
      out.gradient[0] -= gradients[i];
    }
    return true;
  }
  Index3 cell;
  if (!grid.box->locate(x, cell)) return false;
  const Index3& n = grid.box->points();
  Vec3 u{0.0};
  Vec3 inverse{0.0};
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = grid.box->coordinate(axis, cell[axis]);
    inverse[axis] = 1.0 / (grid.box->coordinate(axis, cell[axis] + 1) - lower);
    u[axis] = (x[axis] - lower) * inverse[axis];
  }
  out.count = 8;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Index3 at = cell + Index3(corner & 1U, (corner >> 1U) & 1U, corner >> 2U);
    out.point[corner] =
        static_cast<std::size_t>(at.x) +
        static_cast<std::size_t>(n.x) *
            (static_cast<std::size_t>(at.y) + static_cast<std::size_t>(n.y) * static_cast<std::size_t>(at.z));
    Vec3 part{0.0};
    Vec3 slope{0.0};
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = at[axis] > cell[axis];
      part[axis] = upper ? u[axis] : 1.0 - u[axis];
      slope[axis] = upper ? inverse[axis] : -inverse[axis];
    }
    out.weight[corner] = part.x * part.y * part.z;
    out.gradient[corner] = {slope.x * part.y * part.z, part.x * slope.y * part.z, part.x * part.y * slope.z};
  }
  return true;
}

/// One number of a tuple.
double number_of(const DataArray& array, std::size_t tuple, int component) noexcept {
  if (component != ScalarChoice::kMagnitude) return array.at(tuple, component);
  double norm = 0.0;
  for (int c = 0; c < array.components; ++c) norm = std::hypot(norm, array.at(tuple, c));
  return norm;
}

}  // namespace

ScalarSample ScalarField::sample(const Vec3& x_data, CellHint& hint) const noexcept {
  Stencil stencil;
  if (!make_stencil(*grid_, grid_->frame.local_from_data(x_data), hint, stencil)) return {};
  double value = 0.0;
  bool finite = true;
  for (std::size_t i = 0; i < stencil.count; ++i) {
    const double at = std::visit(
        [&](const auto& values) { return static_cast<double>(values[stencil.point[i]]); }, values_);
    finite = finite && std::isfinite(at);
    value += stencil.weight[i] * at;
  }
  if (!finite) return {0.0, SampleStatus::kBadData};
  return {value, SampleStatus::kOk};
}

VectorSample ScalarField::gradient(const Vec3& x_data, CellHint& hint) const noexcept {
  Stencil stencil;
  if (!make_stencil(*grid_, grid_->frame.local_from_data(x_data), hint, stencil)) return {};
  Vec3 local{0.0};
  bool finite = true;
  for (std::size_t i = 0; i < stencil.count; ++i) {
    const double at = std::visit(
        [&](const auto& values) { return static_cast<double>(values[stencil.point[i]]); }, values_);
    finite = finite && std::isfinite(at);
    local += stencil.gradient[i] * at;
  }
  if (!finite) return {Vec3{0.0}, SampleStatus::kBadData};
  const LocalFrame& frame = grid_->frame;
  return {(frame.rotated ? frame.rotation * local : local) * power_of_two(-frame.length_exponent),
          SampleStatus::kOk};
}

std::shared_ptr<const ScalarField> make_scalar_field(const VectorField& like,
                                                     const std::vector<DataSet>& blocks,
                                                     const ScalarChoice& choice, const std::string& file,
                                                     int threads) {
  if (!like.grid()) throw usage_error("a formula has no array '" + choice.array + "'");
  std::vector<DataSet> used;
  bool use_double = false;
  bool found = false;
  for (const std::size_t b : like.blocks()) {
    if (b >= blocks.size()) {
      throw input_error({.file = file,
                         .place = {},
                         .found = std::to_string(blocks.size()) + " blocks",
                         .expected = "at least " + std::to_string(b + 1) + ", as in the vector field",
                         .remedy = {}});
    }
    used.push_back(blocks[b]);
    check_block(used.back(), b, blocks.size(), file);
    const DataArray* array = used.back().find(choice.array, choice.association);
    if (array == nullptr) continue;
    found = true;
    use_double = use_double || byte_size(array->type) == 8;
    if (choice.component >= array->components || choice.component < ScalarChoice::kMagnitude) {
      throw usage_error("array '" + choice.array + "' has " + std::to_string(array->components) +
                        " components: no component " + std::to_string(choice.component));
    }
  }
  if (!found) {
    throw input_error({.file = file,
                       .place = {},
                       .found = "no " +
                                std::string(choice.association == Association::kPoint ? "point" : "cell") +
                                " array '" + choice.array + "'",
                       .expected = {},
                       .remedy = {}});
  }
  std::size_t points = 0;
  std::size_t cells = 0;
  for (const DataSet& block : used) {
    points += block.point_count();
    cells += block.cell_count();
  }
  if (points != like.grid()->input_points || cells != like.grid()->input_cells) {
    throw input_error({.file = file,
                       .place = {},
                       .found = std::to_string(points) + " points and " + std::to_string(cells) + " cells",
                       .expected = std::to_string(like.grid()->input_points) + " and " +
                                   std::to_string(like.grid()->input_cells) + ", as in the vector field",
                       .remedy = {}});
  }

  const TupleReader read = [&choice](const DataSet& block, std::size_t tuple, double* out) {
    const DataArray* array = block.find(choice.array, choice.association);
    *out = array == nullptr ? std::numeric_limits<double>::quiet_NaN()
                            : number_of(*array, tuple, choice.component);
  };
  auto field = std::make_shared<ScalarField>();
  field->name_ = choice.array;
  field->grid_ = like.grid();
  // A plain array over the grid's own points is used where it lies.
  const DataArray* whole = used.size() == 1 ? used.front().find(choice.array, choice.association) : nullptr;
  const bool plain = whole != nullptr && choice.association == Association::kPoint &&
                     whole->components == 1 && choice.component == 0 && field->grid_->same_points();
  const auto address = whole == nullptr ? 0 : reinterpret_cast<std::uintptr_t>(whole->bytes.data());
  if (plain && whole->type == ScalarType::kFloat32 && address % alignof(float) == 0) {
    field->values_ = std::span(reinterpret_cast<const float*>(whole->bytes.data()), whole->tuples);
    field->owner_ = whole->owner;
  } else if (plain && whole->type == ScalarType::kFloat64 && address % alignof(double) == 0) {
    field->values_ = std::span(reinterpret_cast<const double*>(whole->bytes.data()), whole->tuples);
    field->owner_ = whole->owner;
  } else {
    auto stored = std::make_shared<const GatheredValues>(
        gather_values(*field->grid_, used, choice.association, 1, use_double, read, threads));
    if (use_double) {
      field->values_ = std::span<const double>(stored->doubles);
    } else {
      field->values_ = std::span<const float>(stored->floats);
    }
    field->owner_ = std::move(stored);
  }
  field->lowest_ = std::numeric_limits<double>::infinity();
  field->highest_ = -std::numeric_limits<double>::infinity();
  std::visit(
      [&field](const auto& values) {
        for (const auto value : values) {
          if (!std::isfinite(value)) continue;
          field->lowest_ = std::min(field->lowest_, static_cast<double>(value));
          field->highest_ = std::max(field->highest_, static_cast<double>(value));
        }
      },
      field->values_);
  return field;
}

}  // namespace palpate
