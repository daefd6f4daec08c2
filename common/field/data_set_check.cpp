#include "common/field/data_set_check.h"

#include <limits>

#include "common/base/index.h"

namespace palpate {
namespace {

class BlockCheck {
 public:
  BlockCheck(const DataSet& block, std::size_t index, std::size_t count, const std::string& file)
      : block_(block), index_(index), count_(count), file_(file) {}

  void run() const {
    check_counts();
    for (const DataArray& array : block_.arrays) {
      const bool point = array.association == Association::kPoint;
      const std::size_t wanted = point ? block_.point_count() : block_.cell_count();
      check_array(array);
      check_sparse(array);
      if (array.tuples != wanted) {
        refuse("array '" + array.name + "' has " + std::to_string(array.tuples) + " tuples",
               std::to_string(wanted) + ", one a " + (point ? "point" : "cell"));
      }
    }
    if (!block_.visible.empty() && block_.visible.size() != block_.point_count()) {
      refuse("blanking of " + std::to_string(block_.visible.size()) + " points",
             "one value for each of " + std::to_string(block_.point_count()) + " points");
    }
    if (!block_.hidden_cells.empty() && block_.hidden_cells.size() != block_.cell_count()) {
      refuse("marks of " + std::to_string(block_.hidden_cells.size()) + " hidden cells",
             "one for each of " + std::to_string(block_.cell_count()) + " cells");
    }
    if (const auto* grid = std::get_if<StructuredTopology>(&block_.topology)) {
      check_positions(grid->positions, block_.point_count());
    } else if (const auto* cells = std::get_if<UnstructuredTopology>(&block_.topology)) {
      check_positions(cells->positions, cells->positions.tuples);
      check_offsets(*cells);
    } else if (block_.arrays.empty() && block_.visible.empty() && block_.point_count() > 0) {
      refuse("no arrays", "values at the points or cells");
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    throw block_error(block_, index_, count_, file_, found, expected);
  }

  /// The product of the point counts must exist; a product that wraps round would pass every later check.
  void check_counts() const {
    const Index3 n = structured_points(block_);
    if (n.x < 0 || n.y < 0 || n.z < 0)
      refuse("a negative number of points along an axis", "positive numbers");
    constexpr std::uint64_t kMost = std::uint64_t{1} << 40U;
    const std::uint64_t slice = static_cast<std::uint64_t>(n.x) * static_cast<std::uint64_t>(n.y);
    if (slice > kMost || (n.z > 0 && slice > kMost / static_cast<std::uint64_t>(n.z))) {
      refuse(std::to_string(n.x) + " x " + std::to_string(n.y) + " x " + std::to_string(n.z) + " points",
             "at most 2^40 in all");
    }
  }

  void check_array(const DataArray& array) const {
    if (array.components < 1 || byte_size(array.type) == 0) {
      refuse("array '" + array.name + "' has " + std::to_string(array.components) + " components of type " +
                 name_of(array.type),
             "at least one component of a known type");
    }
    if (array.sparse) return;
    const std::size_t tuple = as_size(array.components) * byte_size(array.type);
    if (array.tuples > array.bytes.size() / tuple || array.tuples * tuple != array.bytes.size()) {
      refuse("array '" + array.name + "' has " + std::to_string(array.bytes.size()) + " bytes",
             std::to_string(array.tuples) + " tuples of " + std::to_string(tuple) + " bytes");
    }
  }

  void check_sparse(const DataArray& array) const {
    if (!array.sparse) return;
    const bool fits = std::holds_alternative<UniformTopology>(block_.topology) &&
                      array.association == Association::kPoint && array.components == 1 &&
                      array.type == ScalarType::kFloat32 && array.tuples == array.sparse->size() &&
                      array.sparse->points() == structured_points(block_);
    if (!fits) refuse("sparse array '" + array.name + "'", "one number a point of a uniform block");
  }

  void check_positions(const DataArray& positions, std::size_t points) const {
    check_array(positions);
    if (positions.components != 3 || positions.sparse) {
      refuse("points of " + std::to_string(positions.components) + " components", "3");
    }
    if (positions.tuples != points) {
      refuse(std::to_string(positions.tuples) + " positions", std::to_string(points));
    }
  }

  void check_offsets(const UnstructuredTopology& cells) const {
    if (cells.types.empty() && cells.offsets.empty()) return;
    if (cells.offsets.size() != cells.types.size() + 1) {
      refuse(std::to_string(cells.offsets.size()) + " cell offsets", std::to_string(cells.types.size() + 1));
    }
    const auto size = static_cast<std::int64_t>(cells.connectivity.size());
    std::int64_t last = 0;
    for (std::size_t c = 0; c < cells.offsets.size(); ++c) {
      if (cells.offsets[c] < last || cells.offsets[c] > size) {
        refuse("offset " + std::to_string(cells.offsets[c]) + " of cell " + std::to_string(c),
               "a number between " + std::to_string(last) + " and " + std::to_string(size));
      }
      last = cells.offsets[c];
    }
  }

  const DataSet& block_;
  std::size_t index_;
  std::size_t count_;
  const std::string& file_;
};

}  // namespace

Index3 structured_points(const DataSet& block) noexcept {
  if (const auto* grid = std::get_if<UniformTopology>(&block.topology)) return grid->points;
  if (const auto* grid = std::get_if<StructuredTopology>(&block.topology)) return grid->points;
  if (const auto* grid = std::get_if<RectilinearTopology>(&block.topology)) {
    constexpr std::size_t kMost = std::numeric_limits<int>::max();
    const auto lines = [&](std::size_t axis) {
      return static_cast<int>(std::min(kMost, grid->coordinates[axis].size()));
    };
    return {lines(0), lines(1), lines(2)};
  }
  return Index3{0};
}

Error block_error(const DataSet& block, std::size_t index, std::size_t count, const std::string& file,
                  const std::string& found, const std::string& expected) {
  std::string place = count > 1 ? "block " + std::to_string(index + 1) : std::string();
  if (!block.name.empty()) place += (place.empty() ? "block '" : " '") + block.name + "'";
  return input_error({.file = file, .place = place, .found = found, .expected = expected, .remedy = {}});
}

void refuse_data(const std::string& file, const std::string& found, const std::string& expected) {
  throw input_error({.file = file, .place = {}, .found = found, .expected = expected, .remedy = {}});
}

void check_block(const DataSet& block, std::size_t index, std::size_t count, const std::string& file) {
  BlockCheck(block, index, count, file).run();
}

}  // namespace palpate
