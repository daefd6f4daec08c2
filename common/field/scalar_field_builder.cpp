#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <type_traits>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/analytic/analytic_field.h"
#include "common/field/cells/boundary_values.h"
#include "common/field/cells/cell_values.h"
#include "common/field/cells/coincident_points.h"
#include "common/field/data_set_check.h"
#include "common/field/field_grid.h"
#include "common/field/field_on_grid.h"
#include "common/field/grid/sparse/sparse_statistics.h"
#include "common/field/scalar_choice.h"
#include "common/field/scalar_field.h"

namespace palpate {
namespace {

[[noreturn]] void refuse_missing(const ScalarChoice& choice, const std::string& file) {
  refuse_data(file,
              "no " + std::string(choice.association == Association::kPoint ? "point" : "cell") + " array '" +
                  choice.array + "'",
              {});
}

void check_component(const DataArray& array, const ScalarChoice& choice) {
  if (choice.component < array.components && choice.component >= ScalarChoice::kMagnitude) return;
  throw usage_error("array '" + choice.array + "' has " + std::to_string(array.components) +
                    " components: no component " + std::to_string(choice.component));
}

template <typename T>
bool share(const DataArray& array, PointScalars& values) {
  if (reinterpret_cast<std::uintptr_t>(array.bytes.data()) % alignof(T) != 0) return false;
  values.values = std::span(reinterpret_cast<const T*>(array.bytes.data()), array.tuples);
  values.owner = array.owner;
  return true;
}

/// Uses a plain array over the grid's own points where it lies.
bool share_values(const FieldGrid& grid, const std::vector<DataSet>& used, const ScalarChoice& choice,
                  PointScalars& values) {
  if (used.size() != 1 || choice.association != Association::kPoint || choice.component != 0 ||
      !grid.same_points()) {
    return false;
  }
  const DataArray& array = *used.front().find(choice.array, Association::kPoint);
  if (array.components != 1) return false;
  if (array.sparse) {
    values.values = SparseSpan{array.sparse.get()};
    values.owner = array.sparse;
    return true;
  }
  switch (array.type) {
    case ScalarType::kFloat32:
      return share<float>(array, values);
    case ScalarType::kFloat64:
      return share<double>(array, values);
    case ScalarType::kUint8:
      return share<std::uint8_t>(array, values);
    case ScalarType::kInt16:
      return share<std::int16_t>(array, values);
    case ScalarType::kUint16:
      return share<std::uint16_t>(array, values);
    default:
      return false;
  }
}

/// The grid, or one whose points are joined only where the scalar agrees, if the grid joins others.
std::shared_ptr<const FieldGrid> keep_values(std::shared_ptr<const FieldGrid> grid,
                                             const std::vector<DataSet>& used, const ScalarChoice& choice,
                                             const std::string& file, int threads, FieldNotes& notes) {
  if (choice.association != Association::kPoint) return grid;
  const PointValue value = [&choice](const DataSet& block, std::size_t point) {
    const DataArray* array = block.find(choice.array, Association::kPoint);
    return Vec3(array == nullptr ? std::numeric_limits<double>::quiet_NaN()
                                 : number_of(*array, point, choice.component),
                0.0, 0.0);
  };
  const LostValues lost = find_lost_values(*grid, used, value);
  if (lost.points == 0) return grid;
  std::array<char, 200> text{};
  std::snprintf(
      text.data(), text.size(),
      "%zu %s a value of '%.60s' of its own at a place of several, different by up to %.3g: each side "
      "keeps its own",
      lost.points, lost.points == 1 ? "point has" : "points have", choice.array.c_str(), lost.most);
  notes.lines.emplace_back(text.data());
  return make_field_grid(used, file, threads, {Association::kPoint, value, false});
}

/// The speed of a formula. Its Hessian, on which convergence rests but no result, is a central difference of
/// its gradient, which is exact.
class SpeedFormula final : public AnalyticScalar {
 public:
  explicit SpeedFormula(std::shared_ptr<const VectorField> field) : field_(std::move(field)) {}

  [[nodiscard]] double value(const Vec3& x) const noexcept override {
    return glm::length(field_->analytic()->velocity(x));
  }
  [[nodiscard]] Jet3 jet(const Vec3& x) const noexcept override {
    const double step = 0x1p-16 * bounds().diagonal();
    Jet3 out(value(x), gradient(x));
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 ahead = x, behind = x;
      ahead[axis] += step;
      behind[axis] -= step;
      out.hessian[axis] = (gradient(ahead) - gradient(behind)) / (ahead[axis] - behind[axis]);
    }
    out.hessian = 0.5 * (out.hessian + glm::transpose(out.hessian));
    return out;
  }
  [[nodiscard]] Box bounds() const noexcept override { return field_->analytic()->bounds(); }
  [[nodiscard]] std::string name() const override { return "speed"; }
  [[nodiscard]] std::string description() const override {
    return "speed of " + field_->analytic()->description();
  }

 private:
  /// J^T v / |v|; zero where the flow rests.
  [[nodiscard]] Vec3 gradient(const Vec3& x) const noexcept {
    const Vec3 v = field_->analytic()->velocity(x);
    const double speed = glm::length(v);
    return speed > 0.0 ? (v / speed) * field_->analytic()->jacobian(x) : Vec3{0.0};
  }

  std::shared_ptr<const VectorField> field_;
};

}  // namespace

/// Puts a ScalarField together.
class ScalarFieldBuilder {
 public:
  static std::shared_ptr<const ScalarField> from_data(std::shared_ptr<const FieldGrid> grid,
                                                      const std::vector<DataSet>& used,
                                                      const ScalarChoice& choice, FieldNotes notes,
                                                      int threads) {
    auto field = on_grid(std::move(grid), choice.array);
    field->notes_ = std::move(notes);
    if (!share_values(*field->grid_, used, choice, field->values_)) gather(used, choice, threads, *field);
    take_range(*field, threads);
    return field;
  }

  static std::shared_ptr<const ScalarField> from_formula(std::shared_ptr<const AnalyticScalar> formula,
                                                         int length_exponent, int value_exponent) {
    auto field = std::make_shared<ScalarField>();
    field->name_ = formula->name();
    field->frame_.length_exponent = length_exponent;
    field->values_.scale = power_of_two(-value_exponent);
    const Box box = formula->bounds();
    field->bounds_ = {field->frame_.data_from_local(box.lower), field->frame_.data_from_local(box.upper)};
    // A formula's range is taken from a lattice: it sets units and colours, no result.
    constexpr int kSteps = 32;
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (int k = 0; k <= kSteps; ++k) {
      for (int j = 0; j <= kSteps; ++j) {
        for (int i = 0; i <= kSteps; ++i) {
          const double s = formula->value(box.lower + box.size() * (Vec3(i, j, k) / double{kSteps}));
          if (!std::isfinite(s)) continue;
          lowest = std::min(lowest, s);
          highest = std::max(highest, s);
        }
      }
    }
    field->lowest_ = lowest / field->values_.scale;
    field->highest_ = highest / field->values_.scale;
    field->notes_.lines.push_back(formula->description());
    field->analytic_ = std::move(formula);
    return field;
  }

  static std::shared_ptr<const ScalarField> speed_of(const std::shared_ptr<const VectorField>& like) {
    if (like->analytic() != nullptr) {
      return from_formula(std::make_shared<SpeedFormula>(like), like->frame().length_exponent,
                          like->frame().speed_exponent);
    }
    auto field = on_grid(like->grid(), "speed");
    const PointVectors& vectors = like->values();
    std::visit(
        [&](const auto& v) {
          using T = std::remove_const_t<typename std::remove_reference_t<decltype(v)>::element_type>;
          auto stored = std::make_shared<std::vector<T>>(v.size() / 3);
          for (std::size_t p = 0; p < stored->size(); ++p) {
            // Local units: no square overflows.
            const Vec3 at = Vec3{static_cast<double>(v[3 * p]), static_cast<double>(v[3 * p + 1]),
                                 static_cast<double>(v[3 * p + 2])} *
                            vectors.scale;
            (*stored)[p] = static_cast<T>(glm::length(at) / vectors.scale);
          }
          field->values_.values = std::span<const T>(*stored);
          field->values_.owner = std::move(stored);
        },
        vectors.values);
    take_range(*field, 0);
    return field;
  }

 private:
  static std::shared_ptr<ScalarField> on_grid(std::shared_ptr<const FieldGrid> grid,
                                              const std::string& name) {
    auto field = std::make_shared<ScalarField>();
    field->name_ = name;
    field->frame_ = grid->frame;
    field->bounds_ = grid->bounds;
    field->box_ = grid->box;
    field->tets_ = grid->tets;
    field->grid_ = std::move(grid);
    return field;
  }

  static void gather(const std::vector<DataSet>& used, const ScalarChoice& choice, int threads,
                     ScalarField& field) {
    bool use_double = false;
    for (const DataSet& block : used) {
      const DataArray* array = block.find(choice.array, choice.association);
      use_double = use_double || (array != nullptr && needs_double(array->type));
    }
    const auto reader_of = [&](const std::string& name, Association association) -> TupleReader {
      const bool any = std::ranges::any_of(
          used, [&](const DataSet& block) { return block.find(name, association) != nullptr; });
      if (!any) return {};
      return [&choice, name, association](const DataSet& block, std::size_t tuple, double* out) {
        const DataArray* array = block.find(name, association);
        const bool has = array != nullptr && choice.component < array->components;
        *out = has ? number_of(*array, tuple, choice.component) : std::numeric_limits<double>::quiet_NaN();
      };
    };
    TupleReader at_boundary;
    if (choice.association == Association::kCell)
      at_boundary = reader_of(boundary_array_of(choice.array), Association::kPoint);
    const GivenValues given(*field.grid_, used, 1, at_boundary);
    auto stored = std::make_shared<const GatheredValues>(
        gather_values(*field.grid_, used, choice.association, 1, use_double,
                      reader_of(choice.array, choice.association), CellRule::kLeastSquares, threads, given));
    if (use_double) {
      field.values_.values = std::span<const double>(stored->doubles);
    } else {
      field.values_.values = std::span<const float>(stored->floats);
    }
    if (choice.association == Association::kCell)
      field.notes_.lines.push_back(cell_values_note(stored->cells));
    if (const std::string note = given.note(); !note.empty()) field.notes_.lines.push_back(note);
    field.values_.owner = std::move(stored);
  }

  static void take_range(ScalarField& field, int threads) {
    field.lowest_ = std::numeric_limits<double>::infinity();
    field.highest_ = -std::numeric_limits<double>::infinity();
    std::size_t bad = 0;
    std::mutex joining;
    const auto include_whole = [&]<typename T>(std::span<const T> values) {
      parallel_for(values.size(), threads, [&](std::size_t first, std::size_t last) {
        const auto [least, most] = std::minmax_element(values.begin() + static_cast<std::ptrdiff_t>(first),
                                                       values.begin() + static_cast<std::ptrdiff_t>(last));
        const double lowest = *least, highest = *most;
        const std::lock_guard lock(joining);
        field.lowest_ = std::min(field.lowest_, lowest);
        field.highest_ = std::max(field.highest_, highest);
      });
    };
    const auto include = [&](const auto& values) {
      for (const auto stored : values) {
        const auto value = static_cast<double>(stored);
        if (!std::isfinite(value)) {
          ++bad;
          continue;
        }
        field.lowest_ = std::min(field.lowest_, value);
        field.highest_ = std::max(field.highest_, value);
      }
    };
    std::visit(
        [&](const auto& values) {
          if constexpr (std::is_same_v<std::decay_t<decltype(values)>, SparseSpan>) {
            const SparseRange range = range_of(*values.numbers, threads);
            field.lowest_ = range.lowest;
            field.highest_ = range.highest;
            bad = range.not_finite;
          } else if constexpr (std::is_integral_v<typename std::decay_t<decltype(values)>::value_type>) {
            include_whole(values);
          } else {
            include(values);
          }
        },
        field.values_.values);
    field.notes_.bad_values = bad;
    if (bad > 0) {
      field.notes_.lines.push_back(std::to_string(bad) + (bad == 1 ? " point" : " points") +
                                   " with a value that is not finite: cells around them are bad data");
    }
    if (bad == field.grid_->point_count()) return;
    // Halves, since the range itself may overflow.
    const double half_range = 0.5 * field.highest_ - 0.5 * field.lowest_;
    if (half_range > 0.0) field.values_.scale = power_of_two(-binary_exponent(half_range) - 1);
    if (half_range == 0.0) field.notes_.lines.emplace_back("the field is the same everywhere");
  }
};

std::shared_ptr<const ScalarField> make_scalar_field(const std::vector<DataSet>& blocks,
                                                     const ScalarChoice& choice, const std::string& file,
                                                     int threads) {
  FieldNotes notes;
  std::vector<DataSet> used;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const DataSet& block = blocks[b];
    if (block.cell_count() == 0) continue;
    const DataArray* array = block.find(choice.array, choice.association);
    if (array == nullptr) {
      notes.lines.push_back("block " + (block.name.empty() ? std::to_string(b + 1) : "'" + block.name + "'") +
                            " left out: it has no array '" + choice.array + "'");
      continue;
    }
    check_block(block, b, blocks.size(), file);
    check_component(*array, choice);
    used.push_back(block);
  }
  if (used.empty()) refuse_missing(choice, file);
  auto grid = keep_values(make_field_grid(used, file, threads, FallingAxes::kMirrored), used, choice, file,
                          threads, notes);
  notes.zero_volume_cells = grid->notes.zero_volume_cells;
  notes.inverted_cells = grid->notes.inverted_cells;
  notes.lines.insert(notes.lines.end(), grid->notes.lines.begin(), grid->notes.lines.end());
  return ScalarFieldBuilder::from_data(std::move(grid), used, choice, std::move(notes), threads);
}

std::shared_ptr<const ScalarField> make_scalar_field(const VectorField& like,
                                                     const std::vector<DataSet>& blocks,
                                                     const ScalarChoice& choice, const std::string& file,
                                                     int threads) {
  if (!like.grid()) throw usage_error("a formula has no array '" + choice.array + "'");
  std::vector<DataSet> used;
  bool found = false;
  for (const std::size_t b : like.blocks()) {
    if (b >= blocks.size()) {
      refuse_data(file, std::to_string(blocks.size()) + " blocks",
                  "at least " + std::to_string(b + 1) + ", as in the vector field");
    }
    used.push_back(blocks[b]);
    check_block(used.back(), b, blocks.size(), file);
    const DataArray* array = used.back().find(choice.array, choice.association);
    if (array == nullptr) continue;
    found = true;
    check_component(*array, choice);
  }
  if (!found) refuse_missing(choice, file);
  std::size_t points = 0;
  std::size_t cells = 0;
  for (const DataSet& block : used) {
    points += block.point_count();
    cells += block.cell_count();
  }
  if (points != like.grid()->input_points || cells != like.grid()->input_cells) {
    refuse_data(file, std::to_string(points) + " points and " + std::to_string(cells) + " cells",
                std::to_string(like.grid()->input_points) + " and " +
                    std::to_string(like.grid()->input_cells) + ", as in the vector field");
  }
  FieldNotes notes;
  auto grid = keep_values(like.grid(), used, choice, file, threads, notes);
  return ScalarFieldBuilder::from_data(std::move(grid), used, choice, std::move(notes), threads);
}

std::shared_ptr<const ScalarField> make_scalar_field(std::shared_ptr<const FieldGrid> grid,
                                                     const DataSet& block, const ScalarChoice& choice,
                                                     const std::string& file, int threads) {
  check_block(block, 0, 1, file);
  if (block.point_count() != grid->input_points || block.cell_count() != grid->input_cells)
    refuse_data(
        file,
        std::to_string(block.point_count()) + " points and " + std::to_string(block.cell_count()) + " cells",
        std::to_string(grid->input_points) + " and " + std::to_string(grid->input_cells) +
            ", as at the time step that was opened");
  const DataArray* array = block.find(choice.array, choice.association);
  if (array == nullptr) refuse_missing(choice, file);
  check_component(*array, choice);
  return ScalarFieldBuilder::from_data(std::move(grid), {block}, choice, {}, threads);
}

std::shared_ptr<const ScalarField> make_scalar_field(std::shared_ptr<const AnalyticScalar> formula,
                                                     int length_exponent, int value_exponent) {
  return ScalarFieldBuilder::from_formula(std::move(formula), length_exponent, value_exponent);
}

std::shared_ptr<const ScalarField> make_speed_field(const std::shared_ptr<const VectorField>& field) {
  return ScalarFieldBuilder::speed_of(field);
}

}  // namespace palpate
