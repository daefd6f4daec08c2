#include "common/field/tensor/tensor_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <type_traits>
#include <utility>
#include <variant>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/data_set_check.h"
#include "common/field/field_grid.h"
#include "common/field/field_on_grid.h"
#include "common/field/grid/block_join.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/tensor/eigenframe.h"
#include "common/field/tensor/peak_field.h"
#include "common/math/lattice.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

using Six = std::array<double, 6>;

/// Where xx, xy, xz, yy, yz and zz stand in a tuple.
std::array<int, 6> places(TensorOrder order) noexcept {
  switch (order) {
    case TensorOrder::kMask:
      return {1, 2, 3, 4, 5, 6};
    case TensorOrder::kDiagonal:
      return {0, 3, 4, 1, 5, 2};
    case TensorOrder::kLower:
      return {0, 1, 3, 2, 4, 5};
    default:
      return {0, 1, 2, 3, 4, 5};
  }
}

bool is_there(const Six& d) noexcept {
  return std::all_of(d.begin(), d.end(), [](double x) { return std::isfinite(x); });
}

/// Tuples without a tensor.
std::size_t missing_of(const DataArray& array, TensorOrder order) {
  std::size_t missing = 0;
  for (std::size_t tuple = 0; tuple < array.tuples; ++tuple)
    missing += is_there(read_tensor(array, tuple, order)) ? 0 : 1;
  return missing;
}

/// Of each seven numbers, six over the seventh stay: NaN where that is zero.
template <typename Real>
void divide_by_weight(std::vector<Real>& values) {
  const std::size_t points = values.size() / 7;
  for (std::size_t point = 0; point < points; ++point) {
    const Real weight = values[7 * point + 6];
    for (std::size_t i = 0; i < 6; ++i)
      values[6 * point + i] =
          weight > Real{0} ? values[7 * point + i] / weight : std::numeric_limits<Real>::quiet_NaN();
  }
  values.resize(6 * points);
}

/// v v^T / |v|^2; NaN where v is zero or not finite. Signs leave no trace in it.
Six outer_product(const DataArray& array, std::size_t tuple) {
  Vec3 v(array.at(tuple, 0), array.at(tuple, 1), array.at(tuple, 2));
  // Scaled first, so that neither tiny nor huge numbers are lost in squares.
  v /= std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  const double square = glm::dot(v, v);
  return {v[0] * v[0] / square, v[0] * v[1] / square, v[0] * v[2] / square,
          v[1] * v[1] / square, v[1] * v[2] / square, v[2] * v[2] / square};
}

/// The weighted mean of corners, of which some may have no tensor.
class CornerMean {
 public:
  void add(double weight, const Six& tensor) noexcept {
    if (!is_there(tensor)) {
      missing_ += weight;
      return;
    }
    for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += weight * tensor[i];
  }
  /// NaN where those with a tensor do not weigh more than half.
  [[nodiscard]] Six result() const noexcept {
    Six mean = sum_;
    if (missing_ > 0.0) {
      const double scale = missing_ < 0.5 ? 1.0 / (1.0 - missing_) : std::numeric_limits<double>::quiet_NaN();
      for (double& d : mean) d *= scale;
    }
    return mean;
  }

 private:
  Six sum_{};
  double missing_ = 0.0;
};

}  // namespace

int component_count(TensorOrder order) noexcept {
  switch (order) {
    case TensorOrder::kFull:
      return 9;
    case TensorOrder::kMask:
      return 7;
    case TensorOrder::kAxis:
      return 3;
    default:
      return 6;
  }
}

std::array<double, 6> read_tensor(const DataArray& array, std::size_t tuple, TensorOrder order) noexcept {
  Six d{};
  if (order == TensorOrder::kFull) {
    const auto at = [&](int row, int column) { return array.at(tuple, 3 * row + column); };
    const auto mean = [&](int row, int column) { return 0.5 * at(row, column) + 0.5 * at(column, row); };
    return {at(0, 0), mean(0, 1), mean(0, 2), at(1, 1), mean(1, 2), at(2, 2)};
  }
  if (order == TensorOrder::kAxis) return outer_product(array, tuple);
  if (order == TensorOrder::kMask && !(array.at(tuple, 0) >= 0.5)) {
    d.fill(std::numeric_limits<double>::quiet_NaN());
    return d;
  }
  const auto from = places(order);
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = array.at(tuple, from[i]);
  return d;
}

const Box& TensorField::bounds() const noexcept { return grid_->bounds; }
const LocalFrame& TensorField::frame() const noexcept { return grid_->frame; }

std::variant<std::span<const float>, std::span<const double>> TensorField::values() const noexcept {
  using Either = std::variant<std::span<const float>, std::span<const double>>;
  return std::visit([](const auto& values) -> Either { return std::span(values); }, values_);
}

TensorField::Six TensorField::stored(std::size_t point) const noexcept {
  Six d{};
  std::visit(
      [&](const auto& values) {
        for (std::size_t i = 0; i < d.size(); ++i) d[i] = static_cast<double>(values[6 * point + i]);
      },
      values_);
  return d;
}

TensorSample TensorField::sample(const Vec3& x_data, CellHint& hint) const noexcept {
  const Vec3 x = frame().local_from_data(x_data);
  CornerMean mean;
  if (const BoxGrid* const box = grid_->box.get()) {
    const Vec3 y = box->along_axes(x);
    Index3 cell;
    if (!box->locate(y, cell)) return {};
    const Index3 n = box->points();
    std::array<std::array<double, 2>, 3> weight{};
    for (int axis = 0; axis < 3; ++axis) {
      const double lower = box->coordinate(axis, cell[axis]), upper = box->coordinate(axis, cell[axis] + 1);
      const double u = (y[axis] - lower) / (upper - lower);
      weight[as_size(axis)] = {1.0 - u, u};
    }
    for (unsigned corner = 0; corner < 8; ++corner) {
      const unsigned i = corner & 1U, j = (corner >> 1U) & 1U, k = corner >> 2U;
      const auto point =
          as_size(cell.x) + i + as_size(n.x) * (as_size(cell.y) + j + as_size(n.y) * (as_size(cell.z) + k));
      mean.add(weight[0][i] * weight[1][j] * weight[2][k], stored(point));
    }
  } else {
    const TetMesh& mesh = *grid_->tets;
    const auto start = hint.cell >= 0 && hint.cell <= INT32_MAX ? static_cast<CellIndex>(hint.cell) : kNoCell;
    TetPoint at;
    if (!mesh.locate(x, start, at)) return {};
    hint.cell = at.cell;
    if (constant_in_cells()) return sample_of(cells_[grid_->source_cell[as_size(at.cell)]]);
    const TetMesh::Tet& tet = mesh.cells()[as_size(at.cell)];
    for (int i = 0; i < 4; ++i) mean.add(at.b[i], stored(tet[as_size(i)]));
  }
  return sample_of(mean.result());
}

TensorSample TensorField::sample_of(const Six& numbers) const noexcept {
  if (!is_there(numbers)) return {.status = SampleStatus::kBadData};
  Mat3 value = symmetric_matrix(numbers);
  if (interpolation_ == TensorInterpolation::kLogEuclidean) value = symmetric_exp(value);
  return {.value = value, .status = SampleStatus::kOk};
}

TensorSample TensorField::voxel(const Index3& at) const noexcept {
  const Index3 n = voxels_ ? voxels_->points : Index3{0};
  Index3 place = at;
  for (int axis = 0; axis < 3; ++axis) {
    if (at[axis] < 0 || at[axis] >= n[axis]) return {};
    if (grid_->box && grid_->reversed[as_size(axis)]) place[axis] = n[axis] - 1 - at[axis];
  }
  auto point = index_in(n, place);
  if (!grid_->point_of_input.empty()) {
    if (grid_->point_of_input[point] == kNoPoint) return {.status = SampleStatus::kBadData};
    point = grid_->point_of_input[point];
  }
  return sample_of(stored(point));
}

/// Puts a TensorField together.
class TensorFieldBuilder {
 public:
  static std::shared_ptr<const TensorField> make(std::shared_ptr<const FieldGrid> grid, const DataSet& image,
                                                 const DataArray& array, const TensorChoice& choice,
                                                 int threads, const std::vector<std::string>& notes) {
    auto field = std::make_shared<TensorField>();
    field->name_ = choice.array;
    field->grid_ = std::move(grid);
    field->notes_ = field->grid_->notes;
    field->notes_.lines.insert(field->notes_.lines.begin(), notes.begin(), notes.end());
    field->interpolation_ = choice.interpolation;
    if (const auto* uniform = std::get_if<UniformTopology>(&image.topology)) {
      field->voxels_ = *uniform;
      if (const DataArray* const peaks = image.find(choice.peaks, Association::kPoint))
        field->peaks_ = std::make_shared<const PeakField>(*uniform, *peaks);
    }

    const bool logarithms = choice.interpolation == TensorInterpolation::kLogEuclidean;
    const bool use_double =
        logarithms || array.type != ScalarType::kFloat32 || choice.order == TensorOrder::kAxis;
    const std::size_t missing =
        choice.association == Association::kCell ? missing_of(array, choice.order) : 0;
    // The seventh number is the weight of the cells that have a tensor: the others have no say in the mean.
    const int numbers = missing > 0 ? 7 : 6;
    const TupleReader read = [&](const DataSet& /*block*/, std::size_t tuple, double* out) {
      const Six d = read_tensor(array, tuple, choice.order);
      const bool there = numbers == 6 || is_there(d);
      for (std::size_t i = 0; i < d.size(); ++i) out[i] = there ? d[i] : 0.0;
      if (numbers == 7) out[6] = there ? 1.0 : 0.0;
    };
    GatheredValues gathered = gather_values(*field->grid_, std::span(&image, 1), choice.association, numbers,
                                            use_double, read, CellRule::kMean, threads);
    if (missing > 0) {
      divide_by_weight(gathered.doubles);
      divide_by_weight(gathered.floats);
      field->notes_.lines.push_back(
          counted(missing, "cell") + " of " + std::to_string(array.tuples) +
          (choice.order == TensorOrder::kAxis ? " without a direction" : " without a tensor") +
          ": left out of the mean of those around a point that have one");
    }
    if (use_double) {
      field->values_ = std::move(gathered.doubles);
    } else {
      field->values_ = std::move(gathered.floats);
    }
    const bool directions = choice.order == TensorOrder::kAxis;
    if (directions && choice.association == Association::kPoint && field->grid_->tets) fill_points(*field);
    survey(*field, directions);
    if (logarithms) take_logarithms(*field);
    if (choice.constant_cells && choice.association == Association::kCell && field->grid_->tets) {
      PALPATE_CHECK(!logarithms);
      field->cells_.reserve(array.tuples);
      for (std::size_t cell = 0; cell < array.tuples; ++cell)
        field->cells_.push_back(read_tensor(array, cell, choice.order));
    }
    return field;
  }

 private:
  /// Gives points without a direction, in most of whose cells at least two points have one, the mean of these
  /// where they agree on one: a hole in the fibres is none in the wall. By volume, as cells are brought to points.
  static void fill_points(TensorField& field) {
    const TetMesh& mesh = *field.grid_->tets;
    struct Around {
      Six sum{};
      double volume = 0.0, unknown = 0.0;  ///< of cells whose other points have a direction, and of others
    };
    std::map<std::uint32_t, Around> missing;
    for (std::uint32_t p = 0; p < mesh.points().size(); ++p)
      if (!is_there(field.stored(p))) missing.try_emplace(p);
    if (missing.empty()) return;
    std::size_t filled = 0;
    for (const TetMesh::Tet& tet : mesh.cells()) {
      const Vec3 a = mesh.points()[tet[0]];
      const double volume = std::abs(glm::dot(
          mesh.points()[tet[1]] - a, glm::cross(mesh.points()[tet[2]] - a, mesh.points()[tet[3]] - a)));
      Six sum{};
      int known = 0;
      for (const std::uint32_t p : tet) {
        const Six d = field.stored(p);
        if (!is_there(d)) continue;
        ++known;
        for (std::size_t i = 0; i < d.size(); ++i) sum[i] += d[i];
      }
      if (known == 4) continue;
      for (const std::uint32_t p : tet) {
        const auto found = missing.find(p);
        if (found == missing.end()) continue;
        Around& around = found->second;
        // An axis of such points has cells with two of them.
        (known >= 2 ? around.volume : around.unknown) += volume;
        for (std::size_t i = 0; known >= 2 && i < sum.size(); ++i) around.sum[i] += volume * sum[i] / known;
      }
    }
    for (const auto& entry : missing) {
      const Around& around = entry.second;
      if (!(around.volume > around.unknown)) continue;
      Six mean = around.sum;
      for (double& d : mean) d /= around.volume;
      // At an apex all directions meet: their mean is none.
      constexpr double kAgree = 0.5;
      if (!(eigen_gaps(symmetric_eigenvalues(symmetric_matrix(mean))).major >= kAgree)) continue;
      const std::size_t at = std::size_t{6} * entry.first;
      std::visit(
          [&](auto& values) {
            using Number = typename std::decay_t<decltype(values)>::value_type;
            for (std::size_t i = 0; i < mean.size(); ++i) values[at + i] = static_cast<Number>(mean[i]);
          },
          field.values_);
      ++filled;
    }
    if (filled > 0)
      field.notes_.lines.push_back(counted(filled, "point") + " without a direction " +
                                   (filled == 1 ? "has" : "have") + " the mean of the points around");
  }

  /// Counts tensors that are not there or not positive.
  /// @param directions outer products: their smaller eigenvalues are zero, but for rounding.
  static void survey(TensorField& field, bool directions) {
    const std::size_t points = field.grid_->point_count();
    std::vector<double> traces;
    for (std::size_t point = 0; point < points; ++point) {
      const Six d = field.stored(point);
      if (!is_there(d)) {
        ++field.notes_.bad_values;
        continue;
      }
      const double trace = d[0] + d[3] + d[5];
      field.largest_trace_ = std::max(field.largest_trace_, trace);
      if (trace > 0.0) traces.push_back(trace);
      if (!directions && symmetric_eigenvalues(symmetric_matrix(d))[2] < 0.0) ++field.negative_tensors_;
    }
    if (!traces.empty()) {
      const auto middle = traces.begin() + static_cast<std::ptrdiff_t>(traces.size() / 2);
      std::nth_element(traces.begin(), middle, traces.end());
      field.typical_trace_ = *middle;
    }
    if (field.notes_.bad_values > 0) {
      field.notes_.lines.push_back(std::to_string(field.notes_.bad_values) +
                                   (directions ? " points without a direction (zero, or not finite)"
                                               : " points without a tensor (masked, or not finite)"));
    }
    if (field.negative_tensors_ > 0) {
      field.notes_.lines.push_back(std::to_string(field.negative_tensors_) +
                                   " tensors with an eigenvalue below zero: measures take it as zero");
    }
  }

  static void take_logarithms(TensorField& field) {
    auto& values = std::get<std::vector<double>>(field.values_);
    const double floor = kFloor * field.largest_trace_;
    for (std::size_t point = 0; point < values.size() / 6; ++point) {
      const Six d = field.stored(point);
      Six log = d;  // NaN stays NaN
      if (!std::isnan(d[0])) {
        // Where no tensor is above zero there is no scale, and no logarithm.
        if (floor > 0.0) {
          log = six_numbers(symmetric_log(symmetric_matrix(d), floor));
        } else {
          log.fill(std::numeric_limits<double>::quiet_NaN());
        }
      }
      std::copy(log.begin(), log.end(), values.begin() + static_cast<std::ptrdiff_t>(6 * point));
    }
  }

  static constexpr double kFloor = 1e-6;  ///< traces
};

namespace {

/// Checks the image and finds its array.
const DataArray& checked_array(const DataSet& image, const TensorChoice& choice, const std::string& file) {
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    throw input_error({.file = file, .place = {}, .found = found, .expected = expected, .remedy = {}});
  };
  check_block(image, 0, 1, file);
  const DataArray* const array = image.find(choice.array, choice.association);
  if (array == nullptr) {
    const bool points = choice.association == Association::kPoint;
    refuse(std::string("no ") + (points ? "point" : "cell") + " array '" + choice.array + "'",
           "an array of tensors");
  }
  const int components = component_count(choice.order);
  if (array->components != components) {
    refuse("array '" + choice.array + "' with " + std::to_string(array->components) + " components",
           std::to_string(components) + " components");
  }
  return *array;
}

}  // namespace

std::shared_ptr<const TensorField> make_tensor_field(const DataSet& image, const TensorChoice& choice,
                                                     const std::string& file, int threads,
                                                     const std::vector<std::string>& notes) {
  const DataArray& array = checked_array(image, choice, file);
  auto grid = make_field_grid(std::span(&image, 1), file, threads);
  return TensorFieldBuilder::make(std::move(grid), image, array, choice, threads, notes);
}

std::shared_ptr<const TensorField> make_tensor_field(std::shared_ptr<const FieldGrid> grid,
                                                     const DataSet& image, const TensorChoice& choice,
                                                     const std::string& file, int threads,
                                                     const std::vector<std::string>& notes) {
  const DataArray& array = checked_array(image, choice, file);
  return TensorFieldBuilder::make(std::move(grid), image, array, choice, threads, notes);
}

}  // namespace palpate
