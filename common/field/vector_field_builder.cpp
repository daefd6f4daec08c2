#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/analytic/analytic_field.h"
#include "common/field/cells/boundary_values.h"
#include "common/field/cells/cell_values.h"
#include "common/field/cells/coincident_points.h"
#include "common/field/cells/hexahedron_difference.h"
#include "common/field/data_set_check.h"
#include "common/field/field_grid.h"
#include "common/field/field_on_grid.h"
#include "common/field/rest_speed.h"
#include "common/field/value_rounding.h"
#include "common/field/vector_field.h"

namespace palpate {
namespace {

/// Components that each array of a choice must have.
std::vector<int> wanted_components(const VectorChoice& choice) {
  switch (choice.kind) {
    case VectorChoice::Kind::kArray:
      return {3};
    case VectorChoice::Kind::kComponents:
      return {1, 1, 1};
    case VectorChoice::Kind::kMomentumOverDensity:
      return choice.arrays.size() == 2 ? std::vector<int>{3, 1} : std::vector<int>{1, 1, 1, 1};
  }
  return {};
}

/// The choice's arrays of one block, found anew for each block.
struct ChosenArrays {
  std::vector<const DataArray*> arrays;  ///< empty where one is missing
  std::string missing;
};

ChosenArrays find_arrays(const DataSet& block, const VectorChoice& choice) {
  ChosenArrays out;
  for (const std::string& name : choice.arrays) {
    const DataArray* array = block.find(name, choice.association);
    if (array == nullptr) return {{}, name};
    out.arrays.push_back(array);
  }
  return out;
}

/// The arrays that say what those of cells are at the boundary; empty where one is missing.
std::vector<const DataArray*> find_boundary(const DataSet& block, const VectorChoice& choice,
                                            const std::vector<const DataArray*>& cells) {
  std::vector<const DataArray*> out;
  for (std::size_t a = 0; a < choice.arrays.size(); ++a) {
    const DataArray* array = block.find(boundary_array_of(choice.arrays[a]), Association::kPoint);
    if (array == nullptr || array->components != cells[a]->components) return {};
    out.push_back(array);
  }
  return out;
}

/// The vector of a tuple, in the data frame.
Vec3 vector_of(const VectorChoice& choice, const std::vector<const DataArray*>& arrays, std::size_t tuple) {
  const auto read = [&](std::size_t first) {
    if (arrays[first]->components == 3) {
      return Vec3{arrays[first]->at(tuple, 0), arrays[first]->at(tuple, 1), arrays[first]->at(tuple, 2)};
    }
    return Vec3{arrays[first]->at(tuple), arrays[first + 1]->at(tuple), arrays[first + 2]->at(tuple)};
  };
  if (choice.kind != VectorChoice::Kind::kMomentumOverDensity) return read(0);
  return read(0) / arrays.back()->at(tuple);
}

/// The exponent of `speed`; of denormal ones the least whose reciprocal is a number.
int unit_exponent(double speed) {
  constexpr int kLeast = -1000;
  return std::max(kLeast, binary_exponent(speed));
}

struct SpeedRange {
  double max_speed = 0.0;
  std::size_t bad = 0;  ///< points whose value is not finite
};

template <typename T>
SpeedRange speed_range(std::span<const T> values) {
  SpeedRange out;
  // The largest component first: its power of two keeps the squares from overflow and underflow.
  double largest = 0.0;
  for (std::size_t p = 0; p + 2 < values.size(); p += 3) {
    const Vec3 v{static_cast<double>(values[p]), static_cast<double>(values[p + 1]),
                 static_cast<double>(values[p + 2])};
    if (!is_finite(v)) {
      ++out.bad;
      continue;
    }
    largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  }
  const int exponent = unit_exponent(largest);
  const double unit = power_of_two(-exponent);
  double square = 0.0;
  for (std::size_t p = 0; p + 2 < values.size(); p += 3) {
    const Vec3 v{static_cast<double>(values[p]) * unit, static_cast<double>(values[p + 1]) * unit,
                 static_cast<double>(values[p + 2]) * unit};
    if (is_finite(v)) square = std::max(square, glm::dot(v, v));
  }
  out.max_speed = std::sqrt(square) * power_of_two(exponent);
  return out;
}

/// Points that move, but slower than what counts as at rest.
template <typename T>
std::size_t count_resting(std::span<const T> values, double rest_speed) {
  std::size_t count = 0;
  for (std::size_t p = 0; p + 2 < values.size(); p += 3) {
    const auto at = [&](std::size_t i) { return std::abs(static_cast<double>(values[p + i])); };
    const double largest = std::max({at(0), at(1), at(2)});
    if (largest > 0.0 && largest <= rest_speed) ++count;
  }
  return count;
}

template <typename T>
bool aligned(const DataArray& array) {
  return reinterpret_cast<std::uintptr_t>(array.bytes.data()) % alignof(T) == 0;
}

}  // namespace

/// Puts a VectorField together.
class VectorFieldBuilder {
 public:
  static std::shared_ptr<const VectorField> from_data(const std::vector<DataSet>& blocks,
                                                      const VectorChoice& choice, const std::string& file,
                                                      int threads,
                                                      std::shared_ptr<const FieldGrid> made = nullptr) {
    auto field = std::make_shared<VectorField>();
    field->name_ = choice.label;
    const std::vector<DataSet> used = usable_blocks(blocks, choice, file, *field);
    field->grid_ = made ? std::move(made)
                        : make_field_grid(used, file, threads, {choice.association, value_of(used, choice)});
    const FieldGrid& grid = *field->grid_;
    field->frame_ = grid.frame;
    field->bounds_ = grid.bounds;
    field->box_ = grid.box;
    field->tets_ = grid.tets;
    field->notes_.zero_volume_cells = grid.notes.zero_volume_cells;
    field->notes_.inverted_cells = grid.notes.inverted_cells;
    field->notes_.lines.insert(field->notes_.lines.end(), grid.notes.lines.begin(), grid.notes.lines.end());

    if (!share_values(used, choice, grid, field->values_)) {
      gather(used, choice, grid, threads, *field);
    }
    note_values(choice, *field);
    note_difference(used, *field);
    return field;
  }

  static std::shared_ptr<const VectorField> from_formula(std::shared_ptr<const AnalyticField> formula,
                                                         int length_exponent, int speed_exponent) {
    auto field = std::make_shared<VectorField>();
    field->name_ = formula->name();
    field->frame_.length_exponent = length_exponent;
    field->frame_.speed_exponent = speed_exponent;
    const Box box = formula->bounds();
    field->bounds_ = {field->frame_.data_from_local(box.lower), field->frame_.data_from_local(box.upper)};
    // A formula's largest speed is taken from a lattice: it sets units and colours, no result.
    constexpr int kSteps = 32;
    double square = 0.0;
    for (int k = 0; k <= kSteps; ++k) {
      for (int j = 0; j <= kSteps; ++j) {
        for (int i = 0; i <= kSteps; ++i) {
          const Vec3 v = formula->velocity(box.lower + box.size() * (Vec3(i, j, k) / double{kSteps}));
          if (is_finite(v)) square = std::max(square, glm::dot(v, v));
        }
      }
    }
    field->max_speed_ = std::sqrt(square) * field->frame_.speed_scale();
    field->notes_.lines.push_back(formula->description());
    field->analytic_ = std::move(formula);
    return field;
  }

 private:
  static std::vector<DataSet> usable_blocks(const std::vector<DataSet>& blocks, const VectorChoice& choice,
                                            const std::string& file, VectorField& field) {
    const std::vector<int> wanted = wanted_components(choice);
    if (wanted.size() != choice.arrays.size()) {
      throw usage_error("the vector field '" + choice.label + "' names " +
                        std::to_string(choice.arrays.size()) + " arrays");
    }
    std::vector<DataSet> used;
    std::string missing;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const DataSet& block = blocks[b];
      if (block.cell_count() == 0) continue;
      const ChosenArrays chosen = find_arrays(block, choice);
      if (chosen.arrays.empty()) {
        missing = chosen.missing;
        field.notes_.lines.push_back("block " +
                                     (block.name.empty() ? std::to_string(b + 1) : "'" + block.name + "'") +
                                     " left out: it has no array '" + chosen.missing + "'");
        continue;
      }
      check_block(block, b, blocks.size(), file);
      for (std::size_t a = 0; a < wanted.size(); ++a) {
        if (chosen.arrays[a]->components == wanted[a]) continue;
        throw block_error(block, b, blocks.size(), file,
                          "array '" + choice.arrays[a] + "' has " +
                              std::to_string(chosen.arrays[a]->components) + " components",
                          std::to_string(wanted[a]));
      }
      used.push_back(block);
      field.blocks_.push_back(b);
    }
    if (used.empty()) {
      const char* where = choice.association == Association::kPoint ? "point" : "cell";
      throw input_error(
          {.file = file,
           .place = {},
           .found = missing.empty() ? "no cells" : "no " + std::string(where) + " array '" + missing + "'",
           .expected = missing.empty() ? "a volume grid" : "",
           .remedy = {}});
    }
    return used;
  }

  static PointValue value_of(const std::vector<DataSet>& blocks, const VectorChoice& choice) {
    std::vector<std::vector<const DataArray*>> arrays;
    for (const DataSet& block : blocks) arrays.push_back(find_arrays(block, choice).arrays);
    return [&blocks, &choice, arrays = std::move(arrays)](const DataSet& block, std::size_t point) {
      return vector_of(choice, arrays[as_size(&block - blocks.data())], point);
    };
  }

  /// Takes the data's own memory where its points are the grid's points.
  static bool share_values(const std::vector<DataSet>& blocks, const VectorChoice& choice,
                           const FieldGrid& grid, PointVectors& values) {
    if (blocks.size() != 1 || choice.kind != VectorChoice::Kind::kArray ||
        choice.association != Association::kPoint || grid.frame.rotated || !grid.same_points()) {
      return false;
    }
    const DataArray& array = *blocks.front().find(choice.arrays.front(), Association::kPoint);
    const std::size_t count = 3 * array.tuples;
    if (array.type == ScalarType::kFloat32 && aligned<float>(array)) {
      values.values = std::span(reinterpret_cast<const float*>(array.bytes.data()), count);
    } else if (array.type == ScalarType::kFloat64 && aligned<double>(array)) {
      values.values = std::span(reinterpret_cast<const double*>(array.bytes.data()), count);
    } else {
      return false;
    }
    values.owner = array.owner;
    return true;
  }

  static void gather(const std::vector<DataSet>& blocks, const VectorChoice& choice, const FieldGrid& grid,
                     int threads, VectorField& field) {
    PointVectors& values = field.values_;
    bool use_double = false;
    std::vector<std::vector<const DataArray*>> arrays, at_boundary;
    for (const DataSet& block : blocks) {
      arrays.push_back(find_arrays(block, choice).arrays);
      at_boundary.push_back(find_boundary(block, choice, arrays.back()));
      for (const DataArray* array : arrays.back()) use_double = use_double || needs_double(array->type);
    }
    const Mat3 rotation = grid.frame.rotation;
    const bool rotated = grid.frame.rotated;
    const auto read_from = [&](const std::vector<std::vector<const DataArray*>>& from, const DataSet& block,
                               std::size_t tuple, double* out) {
      const auto& of_block = from[as_size(&block - blocks.data())];
      Vec3 v(std::numeric_limits<double>::quiet_NaN());
      if (!of_block.empty()) v = vector_of(choice, of_block, tuple);
      if (rotated) v = v * rotation;  // R^T v
      for (int i = 0; i < 3; ++i) out[i] = v[i];
    };
    const TupleReader read = [&](const DataSet& block, std::size_t tuple, double* out) {
      read_from(arrays, block, tuple, out);
    };
    TupleReader read_boundary;
    if (choice.association == Association::kCell &&
        std::ranges::any_of(at_boundary, [](const auto& of_block) { return !of_block.empty(); })) {
      read_boundary = [&](const DataSet& block, std::size_t tuple, double* out) {
        read_from(at_boundary, block, tuple, out);
      };
    }
    TupleReader sliding;
    const bool of_cells =
        choice.association == Association::kCell && choice.kind == VectorChoice::Kind::kArray;
    const auto walls_of = [&](const DataSet& block) {
      return block.find(sliding_array_of(choice.arrays.front()), Association::kPoint);
    };
    if (of_cells &&
        std::ranges::any_of(blocks, [&](const DataSet& block) { return walls_of(block) != nullptr; })) {
      sliding = [&](const DataSet& block, std::size_t point, double* out) {
        const DataArray* const walls = walls_of(block);
        for (int c = 0; c < 6; ++c)
          out[c] = walls != nullptr && walls->components == 6 ? walls->at(point, c) : 0.0;
      };
    }
    const GivenValues given(grid, blocks, 3, read_boundary, sliding);
    auto stored = std::make_shared<const GatheredValues>(gather_values(
        grid, blocks, choice.association, 3, use_double, read, CellRule::kLeastSquares, threads, given));
    if (use_double) {
      values.values = std::span<const double>(stored->doubles);
    } else {
      values.values = std::span<const float>(stored->floats);
    }
    if (choice.association == Association::kCell)
      field.notes_.lines.push_back(cell_values_note(stored->cells));
    if (const std::string note = given.note(); !note.empty()) field.notes_.lines.push_back(note);
    values.owner = std::move(stored);
  }

  /// What the user of another program would see otherwise.
  static void note_difference(const std::vector<DataSet>& blocks, VectorField& field) {
    const HexahedronDifference difference = hexahedron_difference(field, blocks);
    if (difference.cells == 0) return;
    std::array<char, 160> text{};
    std::snprintf(
        text.data(), text.size(),
        "linear tetrahedra differ from trilinear hexahedra by %.3g %% of the largest speed at most, "
        "%.3g %% rms (%zu cells sampled)",
        100.0 * difference.max, 100.0 * difference.rms, difference.cells);
    field.notes_.lines.emplace_back(text.data());
  }

  static void note_values(const VectorChoice& choice, VectorField& field) {
    const SpeedRange range =
        std::visit([](const auto& values) { return speed_range(values); }, field.values_.values);
    field.max_speed_ = range.max_speed;
    field.frame_.speed_exponent = unit_exponent(range.max_speed);
    field.values_.scale = power_of_two(-field.frame_.speed_exponent);
    field.notes_.bad_values = range.bad;
    if (choice.kind == VectorChoice::Kind::kMomentumOverDensity) {
      field.notes_.lines.emplace_back("velocity computed as momentum divided by density");
    }
    field.value_rounding_ =
        std::visit([](const auto& values) { return value_rounding(values); }, field.values_.values);
    if (const double rounding = field.value_rounding_; rounding > 0.0) {
      std::array<char, 160> text{};
      std::snprintf(
          text.data(), text.size(),
          "values are of single precision: off by up to %.2g of themselves (counted into the errors of lines)",
          rounding);
      field.notes_.lines.emplace_back(text.data());
    }
    if (const double rounding = field.grid_->point_rounding; rounding > 0.0) {
      field.notes_.lines.push_back("points are of single precision: off by up to " + short_number(rounding) +
                                   " (counted into the errors of lines)");
    }
    if (range.bad > 0) {
      field.notes_.lines.push_back(std::to_string(range.bad) + (range.bad == 1 ? " point" : " points") +
                                   " with a value that is not finite: cells around them are bad data");
    }
    const double rest = std::visit(
        [](const auto& values) {
          return rest_speed(values.size() / 3, [&](std::size_t p) {
            return std::hypot(static_cast<double>(values[3 * p]), static_cast<double>(values[3 * p + 1]),
                              static_cast<double>(values[3 * p + 2]));
          });
        },
        field.values_.values);
    const std::size_t resting =
        std::visit([&](const auto& values) { return count_resting(values, rest); }, field.values_.values);
    if (resting > 0) {
      std::array<char, 160> text{};
      std::snprintf(text.data(), text.size(),
                    "%zu %s slower than %.2g: taken as at rest, lines end there (stagnation)", resting,
                    resting == 1 ? "point moves" : "points move", rest);
      field.notes_.lines.emplace_back(text.data());
    }
    const std::size_t points =
        std::visit([](const auto& values) { return values.size() / 3; }, field.values_.values);
    if (range.max_speed == 0.0)
      field.notes_.lines.emplace_back(range.bad == points ? "no value of the field is a number"
                                                          : "the field is zero everywhere");
  }
};

std::shared_ptr<const VectorField> make_vector_field(const std::vector<DataSet>& blocks,
                                                     const VectorChoice& choice, const std::string& file,
                                                     int threads) {
  return VectorFieldBuilder::from_data(blocks, choice, file, threads);
}

std::shared_ptr<const VectorField> make_vector_field(std::shared_ptr<const FieldGrid> grid,
                                                     const std::vector<DataSet>& blocks,
                                                     const VectorChoice& choice, const std::string& file,
                                                     int threads) {
  return VectorFieldBuilder::from_data(blocks, choice, file, threads, std::move(grid));
}

std::shared_ptr<const VectorField> make_vector_field(std::shared_ptr<const AnalyticField> formula,
                                                     int length_exponent, int speed_exponent) {
  return VectorFieldBuilder::from_formula(std::move(formula), length_exponent, speed_exponent);
}

}  // namespace palpate
