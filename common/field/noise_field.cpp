#include "common/field/noise_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

#include "common/base/index.h"
#include "common/base/parallel.h"

namespace palpate {
namespace {

constexpr int kStep = 4;        // points from node to node
constexpr int kMostNodes = 64;  // along an axis
constexpr int kReach = 3;       // points about a node at which differences are taken
constexpr std::size_t kSide = 2 * (kReach + 1) + 1;
constexpr std::size_t kLeast = 27;  // places by which a window can be judged

/// Values about a node, and in their place what each difference leaves of them.
class Window {
 public:
  /// @param points of the grid.  @param at_point value by index.
  template <typename Values>
  Window(const Index3& points, const Index3& center, const Values& at_point) {
    std::array<int, 3> first{};
    for (int a = 0; a < 3; ++a) {
      const int n = points[a];
      const int reach = n >= 3 ? kReach + 1 : kReach;
      first[as_size(a)] = std::max(0, center[a] - reach);
      count_[as_size(a)] = std::min(n - 1, center[a] + reach) - first[as_size(a)] + 1;
    }
    const auto row = as_size(points.x), slice = row * as_size(points.y);
    std::size_t out = 0;
    for (int k = 0; k < count_[2]; ++k) {
      for (int j = 0; j < count_[1]; ++j) {
        const std::size_t from =
            as_size(first[0]) + row * as_size(first[1] + j) + slice * as_size(first[2] + k);
        for (int i = 0; i < count_[0]; ++i) value_[out++] = at_point(from + as_size(i));
      }
    }
  }

  /// Takes second differences along `axis`: two places fewer along it.
  void difference(std::size_t axis) noexcept {
    std::array<std::size_t, 3> n{}, step{};
    for (std::size_t a = 0; a < 3; ++a) {
      n[a] = as_size(count_[a]);
      step[a] = a == 0 ? 1 : step[a - 1] * n[a - 1];
    }
    const std::size_t along = step[axis];
    n[axis] -= 2;
    std::size_t out = 0;  // never ahead of what is still to be read
    for (std::size_t k = 0; k < n[2]; ++k) {
      for (std::size_t j = 0; j < n[1]; ++j) {
        for (std::size_t i = 0; i < n[0]; ++i) {
          const std::size_t at = i * step[0] + j * step[1] + k * step[2];
          value_[out++] = value_[at] - 2.0 * value_[at + along] + value_[at + 2 * along];
        }
      }
    }
    count_[axis] -= 2;
  }

  /// The lower quartile of their sizes; 0 where too few are finite.
  [[nodiscard]] double lower_quartile() noexcept {
    const std::size_t all = as_size(count_[0]) * as_size(count_[1]) * as_size(count_[2]);
    const auto first = value_.begin();
    auto end = first;
    for (std::size_t i = 0; i < all; ++i) {
      if (std::isfinite(value_[i])) *end++ = std::abs(value_[i]);
    }
    if (end - first < static_cast<std::ptrdiff_t>(kLeast)) return 0.0;
    const auto quartile = first + (end - first) / 4;
    std::nth_element(first, quartile, end);
    return *quartile;
  }

 private:
  std::array<int, 3> count_{};
  std::array<double, kSide * kSide * kSide> value_{};
};

/// Where nodes lie on an axis of a grid.
struct Nodes {
  int step = 1;
  int count = 2;
};

Nodes nodes_along(int points) {
  const int step = std::max(kStep, (points - 1 + kMostNodes - 2) / (kMostNodes - 1));
  return {step, std::max(2, (points - 1 + step - 1) / step + 1)};
}

/// The nodes as a data set without arrays, data coordinates.
DataSet lattice(const BoxGrid& grid, const LocalFrame& frame, const std::array<Nodes, 3>& nodes) {
  DataSet data;
  if (!grid.uniform()) {  // such grids are not turned
    RectilinearTopology topology;
    for (int a = 0; a < 3; ++a) {
      const Nodes& along = nodes[as_size(a)];
      for (int i = 0; i < along.count; ++i) {
        topology.coordinates[as_size(a)].push_back(
            grid.coordinate(a, std::min(i * along.step, grid.points()[a] - 1)) * frame.length_scale());
      }
    }
    data.topology = std::move(topology);
    return data;
  }
  UniformTopology topology;
  Vec3 origin;
  for (int a = 0; a < 3; ++a) {
    const Nodes& along = nodes[as_size(a)];
    origin[a] = grid.coordinate(a, 0);
    Vec3 step{0.0};
    step[a] = along.step * (grid.coordinate(a, 1) - grid.coordinate(a, 0));
    topology.points[a] = along.count;
    topology.axes[a] = frame.data_from_local(grid.in_frame(step));
  }
  topology.origin = frame.data_from_local(grid.in_frame(origin));
  data.topology = topology;
  return data;
}

}  // namespace

std::shared_ptr<const ScalarField> make_noise_field(const ScalarField& field, int threads) {
  constexpr const char* kName = "noise";
  const BoxGrid* grid = field.box_grid();
  if (grid == nullptr) return nullptr;
  const Index3& points = grid->points();
  std::array<Nodes, 3> nodes{};
  double response = 0.31863936396437515;  // the lower quartile of |N(0, 1)|
  for (int a = 0; a < 3; ++a) {
    nodes[as_size(a)] = nodes_along(points[a]);
    if (points[a] >= 3) response *= std::sqrt(6.0);
  }
  const double range = field.local_range(), scale = field.values().scale;
  const auto row = as_size(nodes[0].count);
  const auto slice = row * as_size(nodes[1].count);
  std::vector<float> sigma(slice * as_size(nodes[2].count), 0.0F);
  if (range > 0.0) {
    std::visit(
        [&](const auto& values) {
          const auto at_point = [&values, scale](std::size_t i) {
            return static_cast<double>(values[i]) * scale;
          };
          parallel_for(sigma.size(), threads, [&](std::size_t first, std::size_t last) {
            for (std::size_t n = first; n < last; ++n) {
              const std::array<std::size_t, 3> at{n % row, n / row % as_size(nodes[1].count), n / slice};
              Index3 center;
              for (std::size_t a = 0; a < 3; ++a) {
                const int axis = static_cast<int>(a);
                center[axis] = std::min(static_cast<int>(at[a]) * nodes[a].step, points[axis] - 1);
              }
              Window window(points, center, at_point);
              for (std::size_t a = 0; a < 3; ++a) {
                if (points[static_cast<int>(a)] >= 3) window.difference(a);
              }
              sigma[n] = static_cast<float>(window.lower_quartile() / (response * range));
            }
          });
        },
        field.values().values);
  }
  DataSet data = lattice(*grid, field.frame(), nodes);
  data.arrays.push_back(make_array(kName, Association::kPoint, 1, std::span<const float>(sigma)));
  return make_scalar_field({data}, ScalarChoice{.array = kName}, kName, threads);
}

}  // namespace palpate
