#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/field/cells/boundary_values.h"
#include "common/field/cells/cell_values.h"
#include "common/field/cells/curved_split.h"
#include "common/field/field_grid.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

/// Fixed weights from tuples of the data to one point of the grid.
struct Store {
  GatheredValues& out;
  int components;
  bool use_double;

  void put(std::size_t point, const double* value) const {
    const std::size_t at = point * as_size(components);
    for (int c = 0; c < components; ++c) {
      const auto i = at + as_size(c);
      if (use_double) {
        out.doubles[i] = value[c];
      } else {
        out.floats[i] = static_cast<float>(value[c]);
      }
    }
  }
};

void gather_box(const FieldGrid& grid, const DataSet& block, const TupleReader& read, const Store& store,
                int threads) {
  const Index3 n = grid.box->points();
  const auto slice = as_size(n.x) * as_size(n.y);
  parallel_for(as_size(n.z), threads, [&](std::size_t first, std::size_t last) {
    std::vector<double> value(as_size(store.components));
    for (std::size_t point = first * slice; point < last * slice; ++point) {
      const Index3 at{static_cast<int>(point % as_size(n.x)),
                      static_cast<int>(point / as_size(n.x) % as_size(n.y)), static_cast<int>(point / slice)};
      const std::size_t input = grid.data_index(n, at);
      if (!block.visible.empty() && block.visible[input] == 0) continue;
      read(block, input, value.data());
      store.put(point, value.data());
    }
  });
}

/// Points inside curved cells, of which none stands for a point of the data.
void gather_made(const MadePoints& made, std::span<const DataSet> blocks, const TupleReader& read,
                 std::vector<std::uint8_t>& done, const Store& store) {
  std::vector<std::size_t> first_point{0};
  for (const DataSet& block : blocks) first_point.push_back(first_point.back() + block.point_count());
  std::vector<double> value(as_size(store.components)), sum(value.size());
  for (std::size_t m = 0; m < made.point.size(); ++m) {
    if (made.point[m] == kNoPoint || done[made.point[m]] != 0) continue;
    done[made.point[m]] = 1;
    std::ranges::fill(sum, 0.0);
    for (std::size_t i = made.begin[m]; i < made.begin[m + 1]; ++i) {
      const auto above = std::ranges::upper_bound(first_point, std::size_t{made.input[i]});
      const auto b = as_size(above - first_point.begin()) - 1;
      read(blocks[b], made.input[i] - first_point[b], value.data());
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += made.weight[i] * value[c];
    }
    store.put(made.point[m], sum.data());
  }
}

void gather_tets(const FieldGrid& grid, std::span<const DataSet> blocks, const TupleReader& read,
                 const Store& store) {
  std::vector<double> value(as_size(store.components));
  std::vector<std::uint8_t> done(grid.tets->points().size(), 0);
  std::size_t input = 0;
  for (const DataSet& block : blocks) {
    const std::size_t count = block.point_count();
    for (std::size_t i = 0; i < count; ++i, ++input) {
      const std::size_t point = grid.point_of_input.empty() ? input : as_size(grid.point_of_input[input]);
      if (point == kNoPoint || done[point] != 0) continue;
      if (!block.visible.empty() && block.visible[i] == 0) continue;
      done[point] = 1;
      read(block, i, value.data());
      store.put(point, value.data());
    }
  }
  if (grid.made) gather_made(*grid.made, blocks, read, done, store);
}

/// Cell values; blanked points of a box get none.
CellDifference gather_cells(const FieldGrid& grid, std::span<const DataSet> blocks, const TupleReader& read,
                            const GivenValues* given, const Store& store, CellRule rule, int threads) {
  const std::vector<std::uint8_t>& visible = blocks.front().visible;
  const bool blanked = grid.box && !visible.empty();
  const auto put = [&](std::size_t point, const double* value) {
    if (blanked) {
      const Index3 n = grid.box->points();
      const Index3 at{static_cast<int>(point % as_size(n.x)),
                      static_cast<int>(point / as_size(n.x) % as_size(n.y)),
                      static_cast<int>(point / (as_size(n.x) * as_size(n.y)))};
      if (visible[grid.data_index(n, at)] == 0) return;
    }
    const double* const here = given != nullptr ? given->at(point) : nullptr;
    if (here == nullptr && given != nullptr && store.components == 3) {
      std::array<double, 3> along{value[0], value[1], value[2]};
      given->slide(point, along.data());
      store.put(point, along.data());
      return;
    }
    store.put(point, here != nullptr ? here : value);
  };
  const auto value_at = [&](std::size_t point, int component) {
    const std::size_t i = point * as_size(store.components) + as_size(component);
    return store.use_double ? store.out.doubles[i] : static_cast<double>(store.out.floats[i]);
  };
  return bring_to_points(grid, blocks, store.components, read, put, value_at, rule, threads);
}

GatheredValues gather(const FieldGrid& grid, std::span<const DataSet> blocks, Association association,
                      int components, bool use_double, const TupleReader& read, CellRule rule, int threads,
                      const GivenValues* given) {
  GatheredValues out;
  const std::size_t count = grid.point_count() * as_size(components);
  if (use_double) {
    out.doubles.assign(count, std::numeric_limits<double>::quiet_NaN());
  } else {
    out.floats.assign(count, std::numeric_limits<float>::quiet_NaN());
  }
  const Store store{out, components, use_double};
  if (association == Association::kCell) {
    out.cells = gather_cells(grid, blocks, read, given, store, rule, threads);
  } else if (grid.box) {
    gather_box(grid, blocks.front(), read, store, threads);
  } else {
    gather_tets(grid, blocks, read, store);
  }
  return out;
}

}  // namespace

GatheredValues gather_values(const FieldGrid& grid, std::span<const DataSet> blocks, Association association,
                             int components, bool use_double, const TupleReader& read, CellRule rule,
                             int threads) {
  return gather(grid, blocks, association, components, use_double, read, rule, threads, nullptr);
}

GatheredValues gather_values(const FieldGrid& grid, std::span<const DataSet> blocks, Association association,
                             int components, bool use_double, const TupleReader& read, CellRule rule,
                             int threads, const GivenValues& given) {
  return gather(grid, blocks, association, components, use_double, read, rule, threads, &given);
}

std::string boundary_array_of(const std::string& name) { return name + " at the boundary"; }

std::string sliding_array_of(const std::string& name) { return name + " along the boundary"; }

namespace {

/// Takes from a vector its parts along the normals of which `sum` is. Faces about a point of a smooth wall have nearly
/// the same normal; an edge of it has two.
Mat3 along_walls(const std::array<double, 6>& sum) {
  constexpr double kEdge = 0.05;  // of the largest part: faces at 26 degrees to each other
  const SymmetricEigen normals = symmetric_eigen(symmetric_matrix(sum));
  Mat3 along{1.0};
  for (int i = 0; i < 3; ++i) {
    if (normals.values[i] > kEdge * normals.values[0])
      along -= glm::outerProduct(normals.vectors[i], normals.vectors[i]);
  }
  return along;
}

}  // namespace

GivenValues::GivenValues(const FieldGrid& grid, std::span<const DataSet> blocks, int components,
                         const TupleReader& read, const TupleReader& sliding)
    : components_(as_size(components)) {
  if (!grid.tets) return;
  if (sliding) {
    std::map<std::size_t, std::array<double, 6>> sums;
    std::size_t input = 0;
    for (const DataSet& block : blocks) {
      for (std::size_t i = 0; i < block.point_count(); ++i, ++input) {
        const std::size_t point = grid.point_of_input.empty() ? input : as_size(grid.point_of_input[input]);
        std::array<double, 6> six{};
        if (point != kNoPoint) sliding(block, i, six.data());
        const double trace = six[0] + six[3] + six[5];
        if (!(trace > 0.0) || !std::isfinite(trace)) continue;
        std::array<double, 6>& sum = sums[point];
        for (std::size_t c = 0; c < six.size(); ++c) sum[c] += six[c];
      }
    }
    if (!sums.empty()) {
      sliding_.assign(grid.point_count(), 0);
      along_.emplace_back(1.0);
    }
    for (const auto& [point, sum] : sums) {
      sliding_[point] = static_cast<std::uint32_t>(along_.size());
      along_.push_back(along_walls(sum));
    }
  }
  if (read) take_means(grid, blocks, read);
  for (std::size_t point = 0; point < sliding_.size(); ++point) {
    if (sliding_[point] == 0) continue;
    if (at(point) == nullptr) {
      ++slides_;
      continue;
    }
    double* const value = values_.data() + point * components_;
    const std::array<double, 3> before{value[0], value[1], value[2]};
    slide(point, value);
    constexpr double kRounding = 1e-12;
    const double change = std::hypot(value[0] - before[0], value[1] - before[1], value[2] - before[2]);
    if (change > kRounding * std::hypot(before[0], before[1], before[2])) ++edges_;
  }
}

void GivenValues::take_means(const FieldGrid& grid, std::span<const DataSet> blocks,
                             const TupleReader& read) {
  std::vector<double> value(components_);
  std::size_t input = 0;
  for (const DataSet& block : blocks) {
    for (std::size_t i = 0; i < block.point_count(); ++i, ++input) {
      const std::size_t point = grid.point_of_input.empty() ? input : as_size(grid.point_of_input[input]);
      if (point == kNoPoint) continue;
      read(block, i, value.data());
      if (!std::ranges::all_of(value, [](double v) { return std::isfinite(v); })) continue;
      if (counts_.empty()) {
        counts_.assign(grid.point_count(), 0);
        values_.assign(counts_.size() * components_, 0.0);
      }
      const double share = 1.0 / ++counts_[point];
      for (std::size_t c = 0; c < components_; ++c) {
        double& mean = values_[point * components_ + c];
        mean += share * (value[c] - mean);
      }
    }
  }
}

void GivenValues::slide(std::size_t point, double* value) const noexcept {
  if (sliding_.empty() || sliding_[point] == 0) return;
  const Vec3 along = along_[sliding_[point]] * Vec3{value[0], value[1], value[2]};
  for (int i = 0; i < 3; ++i) value[i] = along[i];
}

std::string GivenValues::note() const {
  const auto count = counts_.size() - as_size(std::ranges::count(counts_, std::uint32_t{0}));
  const std::string slides =
      slides_ == 0
          ? std::string()
          : std::to_string(slides_) + " at walls along which the flow slides: none of it goes through";
  const std::string edges =
      edges_ == 0 ? std::string() : ", less what would go through a wall at " + counted(edges_, "edge point");
  if (count == 0) return slides.empty() ? slides : "boundary points: " + slides;
  return std::to_string(count) +
         (count == 1 ? " boundary point has the value" : " boundary points have the values") +
         " that the data gives there" + edges + (slides.empty() ? "" : ", " + slides);
}

}  // namespace palpate
