#include "common/field/cells/curved_split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include "common/base/index.h"
#include "common/field/grid/block_join.h"
#include "common/field/grid/cell_faces.h"
#include "common/field/grid/curved_cell.h"

namespace palpate {
namespace {

constexpr std::size_t kMostSampled = 64;

using Lattice = std::array<int, 3>;

bool in_reference(std::uint8_t linear, const Lattice& p, int n) {
  if (p[0] < 0 || p[1] < 0 || p[2] < 0 || p[0] > n || p[1] > n || p[2] > n) return false;
  if (linear == kTetrahedron) return p[0] + p[1] + p[2] <= n;
  return linear != kWedge || p[0] + p[1] <= n;
}

/// The parameters of a lattice point. A pyramid's lattice is that of the cube, its slices shrunk to the apex.
Vec3 parameters(std::uint8_t linear, const Vec3& p, int n) {
  const Vec3 xi = p / static_cast<double>(n);
  if (linear != kPyramid) return xi;
  return {0.5 + (xi.x - 0.5) * (1.0 - xi.z), 0.5 + (xi.y - 0.5) * (1.0 - xi.z), xi.z};
}

/// The parts of a reference cell: their type and the lattice points at their corners.
struct Part {
  std::uint8_t type;
  std::vector<Lattice> corners;
};

std::vector<Part> parts_of(std::uint8_t linear, int n) {
  std::vector<Part> out;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const auto at = [&](int a, int b, int c) { return Lattice{i + a, j + b, k + c}; };
        if (linear == kHexahedron || linear == kPyramid) {
          // In the topmost layer of a pyramid four corners are the apex: what is left is a pyramid.
          if (linear == kPyramid && k + 1 == n) {
            out.push_back({kPyramid, {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1)}});
          } else {
            out.push_back({kHexahedron,
                           {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1),
                            at(1, 1, 1), at(0, 1, 1)}});
          }
        } else if (linear == kWedge) {
          if (i + j < n)
            out.push_back(
                {kWedge, {at(0, 0, 0), at(1, 0, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1), at(0, 1, 1)}});
          if (i + j + 1 < n)
            out.push_back(
                {kWedge, {at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)}});
        } else {
          // Kuhn's six tetrahedra of a cube, for the simplex n >= x >= y >= z, whose barycentric coordinates are
          // n - x, x - y, y - z and z.
          static constexpr std::array<std::array<std::size_t, 3>, 6> kOrders{
              {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
          for (std::size_t o = 0; o < kOrders.size(); ++o) {
            Lattice p{i, j, k};
            std::array<Lattice, 4> path{p, p, p, p};
            for (std::size_t s = 0; s < 3; ++s) {
              ++p[kOrders[o][s]];
              path[s + 1] = p;
            }
            const bool within = std::ranges::all_of(
                path, [n](const Lattice& x) { return n >= x[0] && x[0] >= x[1] && x[1] >= x[2]; });
            if (!within) continue;
            Part part{kTetrahedron, {}};
            for (const Lattice& x : path) part.corners.push_back({x[0] - x[1], x[1] - x[2], x[2]});
            if (o >= 3) std::swap(part.corners[2], part.corners[3]);
            out.push_back(std::move(part));
          }
        }
      }
    }
  }
  return out;
}

/// Whether parts may have an edge along this step between neighbours of the lattice, as tetrahedra split them.
bool is_edge(std::uint8_t linear, const Lattice& step) {
  const auto sum_is_small = [](int sum) { return sum >= -1 && sum <= 1; };
  if (linear == kTetrahedron) {
    // Of Kuhn's tetrahedra, in barycentric coordinates: one of the four gives to another, or two to two in one way.
    const bool one = sum_is_small(step[0] + step[1]) && sum_is_small(step[1] + step[2]) &&
                     sum_is_small(step[0] + step[2]) && sum_is_small(step[0] + step[1] + step[2]);
    return one || step == Lattice{1, -1, 1};
  }
  return linear != kWedge || sum_is_small(step[0] + step[1]);
}

/// A cell's lattice, once for all cells of a type and number of nodes.
struct Template {
  std::unique_ptr<CurvedCell> cell;  ///< null where none is known
  std::vector<Lattice> points;
  /// For each lattice point the nodes of which it is a sum; a node alone is one with the weight 1.
  std::vector<std::vector<std::pair<std::uint32_t, double>>> sums;
  std::vector<std::uint8_t> shared;  ///< on the cell's border
  std::vector<Part> parts;
  std::vector<std::vector<std::uint32_t>> corners;  ///< of each part, as lattice points
};

std::vector<std::pair<std::uint32_t, double>> sum_of(const std::vector<double>& weights) {
  constexpr double kNothing = 1e-11;
  std::vector<std::pair<std::uint32_t, double>> out;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (std::abs(weights[i]) > kNothing) out.emplace_back(static_cast<std::uint32_t>(i), weights[i]);
  }
  if (out.size() == 1) out.front().second = 1.0;
  return out;
}

void fill(Template& shape, int n) {
  const std::uint8_t linear = shape.cell->linear_type();
  shape.parts = parts_of(linear, n);
  std::map<Lattice, std::uint32_t> number;
  std::vector<double> weights;
  for (const Part& part : shape.parts) {
    auto& corners = shape.corners.emplace_back();
    for (Lattice p : part.corners) {
      if (linear == kPyramid && p[2] == n) p = {0, 0, n};  // the apex
      const auto [found, fresh] = number.try_emplace(p, static_cast<std::uint32_t>(shape.points.size()));
      if (fresh) {
        shape.points.push_back(p);
        shape.cell->weights(parameters(linear, Vec3(p[0], p[1], p[2]), n), weights);
        shape.sums.push_back(sum_of(weights));
        const bool cube = p[0] == 0 || p[1] == 0 || p[2] == 0 || p[0] == n || p[1] == n || p[2] == n;
        const bool slanted =
            (linear == kTetrahedron && p[0] + p[1] + p[2] == n) || (linear == kWedge && p[0] + p[1] == n);
        shape.shared.push_back(cube || slanted ? 1 : 0);
      }
      corners.push_back(found->second);
    }
  }
}

class CurvedSplitter {
 public:
  CurvedSplitter(std::span<const DataSet> blocks, const PointValue& value) : blocks_(blocks), value_(value) {}

  std::optional<CurvedSplit> run() {
    count();
    if (out_.cells == 0) return std::nullopt;
    choose_parts();
    for (std::size_t b = 0; b < blocks_.size(); ++b) split_block(b);
    return std::move(out_);
  }

 private:
  struct Cell {
    std::span<const std::int64_t> nodes;
    Template* shape = nullptr;            ///< null: stays as it is
    const DataArray* rational = nullptr;  ///< weights of the points; null: all are 1
  };
  using Sum = std::vector<std::pair<std::uint32_t, double>>;

  /// What makes the sum of polynomials the rational one.
  static Sum rational(const Cell& cell, Sum sum) {
    if (cell.rational == nullptr) return sum;
    double all = 0.0;
    for (auto& [node, weight] : sum) {
      weight *= cell.rational->at(as_size(cell.nodes[node]));
      all += weight;
    }
    for (auto& term : sum) term.second /= all;
    return sum;
  }

  Cell cell_of(const DataSet& block, const UnstructuredTopology& cells, std::size_t c) {
    const auto begin = as_size(cells.offsets[c]), end = as_size(cells.offsets[c + 1]);
    Cell out{.nodes = {cells.connectivity.data() + begin, end - begin}};
    const std::uint8_t type = cells.types[c];
    if (!is_volume(type) || linear_type_of(type) == type) return out;
    CurvedCell::Orders orders{};
    const DataArray* const degrees = block.find(kHigherOrderDegrees, Association::kCell);
    for (std::size_t i = 0; degrees != nullptr && degrees->components == 3 && i < 3; ++i) {
      constexpr double kMost = 1000.0;  // that CurvedCell knows none of
      const double order = degrees->at(c, static_cast<int>(i));
      const bool whole = order >= 0.0 && order < kMost && order == std::floor(order);  // NaN is not
      orders[i] = static_cast<int>(whole ? order : kMost);
    }
    auto [found, fresh] = shapes_.try_emplace({type, out.nodes.size(), orders});
    if (fresh) found->second.cell = CurvedCell::make(type, out.nodes.size(), orders);
    const bool there = std::ranges::all_of(out.nodes, [&](std::int64_t p) {
      return p >= 0 && as_size(p) < cells.positions.tuples;  // refused when the cell is split
    });
    if (!found->second.cell || !there) return out;
    out.shape = &found->second;
    const DataArray* const weights =
        is_bezier(type) ? block.find(kRationalWeights, Association::kPoint) : nullptr;
    const bool positive = weights != nullptr && std::ranges::all_of(out.nodes, [weights](std::int64_t p) {
                            const double weight = weights->at(as_size(p));
                            return weight > 0.0 && std::isfinite(weight);
                          });
    if (positive) out.rational = weights;
    return out;
  }

  void count() {
    for (const DataSet& block : blocks_) {
      const auto* cells = std::get_if<UnstructuredTopology>(&block.topology);
      for (std::size_t c = 0; cells != nullptr && c < cells->types.size(); ++c) {
        const Cell cell = cell_of(block, *cells, c);
        if (cell.shape == nullptr) continue;
        ++out_.cells;
        if (is_bezier(cells->types[c]) && cell.rational == nullptr) {
          const bool none = block.find(kRationalWeights, Association::kPoint) == nullptr;
          ++(none ? out_.unweighted : out_.odd_weights);
        }
        order_ = std::max(order_, cell.shape->cell->order());
      }
    }
  }

  /// The most at the places of the nodes. Control points of Bezier cells have more than the cell itself.
  double largest_in(const DataSet& block, const Cell& cell) {
    std::vector<double> weights;
    double largest = 0.0;
    for (const Vec3& xi : cell.shape->cell->nodes()) {
      cell.shape->cell->weights(xi, weights);
      Vec3 sum{0.0};
      for (const auto& [node, weight] : rational(cell, sum_of(weights)))
        sum += weight * value_(block, as_size(cell.nodes[node]));
      const double size = glm::length(sum);
      if (size > largest && std::isfinite(size)) largest = size;
    }
    return largest;
  }

  struct Place {
    Vec3 at{0.0}, value{0.0};
  };
  /// At lattice coordinates of n intervals.
  Place place_at(const DataSet& block, const Cell& cell, const Vec3& p, int n) {
    const auto& positions = std::get<UnstructuredTopology>(block.topology).positions;
    cell.shape->cell->weights(parameters(cell.shape->cell->linear_type(), p, n), weights_);
    Place out;
    for (const auto& [node, weight] : rational(cell, sum_of(weights_))) {
      const std::size_t point = as_size(cell.nodes[node]);
      out.at += weight * Vec3(positions.at(point, 0), positions.at(point, 1), positions.at(point, 2));
      out.value += weight * value_(block, point);
    }
    return out;
  }

  /// By how much the value at lattice coordinates p changes over `step` in space, to first order.
  Vec3 change_over(const DataSet& block, const Cell& cell, const Vec3& p, int n, const Vec3& step) {
    constexpr double kNear = 0.25;
    Mat3 at{0.0}, value{0.0};
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 h{0.0};
      h[axis] = kNear;
      const Place before = place_at(block, cell, p - h, n), behind = place_at(block, cell, p + h, n);
      at[axis] = behind.at - before.at;
      value[axis] = behind.value - before.value;
    }
    const Vec3 along = glm::inverse(at) * step;
    const Vec3 out = value * along;
    return is_finite(out) && glm::length(along) < 2.0 ? out : Vec3{0.0};  // at a pyramid's apex
  }

  /// 3/2 of the most that linear interpolation along edges of the lattice is off in their middles.
  double bound(const DataSet& block, const Cell& cell, int n) {
    const std::uint8_t linear = cell.shape->cell->linear_type();
    double most = 0.0;
    // Of a fine lattice a few points will do.
    const int stride = std::max(1, n / 3);
    for (int k = 0; k <= n; k += stride) {
      for (int j = 0; j <= n; j += stride) {
        for (int i = 0; i <= n; i += stride) {
          const Lattice a{i, j, k};
          if (!in_reference(linear, a, n)) continue;
          const Place from = place_at(block, cell, Vec3(i, j, k), n);
          for (int d = 14; d < 27; ++d) {  // one of each pair of opposite neighbours
            const Lattice step{d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1};
            if (!is_edge(linear, step)) continue;
            const Lattice b{i + step[0], j + step[1], k + step[2]};
            if (!in_reference(linear, b, n)) continue;
            const Vec3 middle = 0.5 * Vec3(i + b[0], j + b[1], k + b[2]);
            const Place to = place_at(block, cell, Vec3(b[0], b[1], b[2]), n);
            const Place true_one = place_at(block, cell, middle, n);
            const Vec3 bend = 0.5 * (from.at + to.at) - true_one.at;
            Vec3 off = 0.5 * (from.value + to.value) - true_one.value;
            constexpr double kStraight = 1e-12;
            if (glm::length(bend) > kStraight * glm::distance(from.at, to.at))
              off -= change_over(block, cell, middle, n, bend);
            most = std::max(most, glm::length(off));
          }
        }
      }
    }
    return 1.5 * most;
  }

  void choose_parts() {
    double most = 0.0, largest = 0.0;
    const std::size_t stride = (out_.cells + kMostSampled - 1) / kMostSampled;
    struct Sampled {
      const DataSet* block;
      Cell cell;
    };
    std::vector<Sampled> sampled;
    std::size_t next = 0;
    for (const DataSet& block : blocks_) {
      const auto* cells = std::get_if<UnstructuredTopology>(&block.topology);
      for (std::size_t c = 0; cells != nullptr && c < cells->types.size(); ++c) {
        const Cell cell = cell_of(block, *cells, c);
        if (cell.shape == nullptr || next++ % stride != 0) continue;
        sampled.push_back({&block, cell});
        largest = std::max(largest, largest_in(block, cell));
      }
    }
    for (const Sampled& s : sampled) most = std::max(most, bound(*s.block, s.cell, order_));
    int times = 1;
    while (largest > 0.0 && most / (times * times) > kCurvedError * largest) {
      const auto n = as_size(order_ * (times + 1));
      if (n * n * n * out_.cells > kMostParts) break;
      ++times;
    }
    out_.parts = order_ * times;
    // One cell of a high order among many others is no reason to run out of memory.
    constexpr std::size_t kAtOnce = 64 * kMostParts;
    const auto too_many = [&] {
      const auto n = as_size(out_.parts);
      return n * n * n * out_.cells > kAtOnce;
    };
    while (times == 1 && out_.parts > 2 && too_many()) --out_.parts;
    if (out_.parts != order_) {
      most = 0.0;
      for (const Sampled& s : sampled) most = std::max(most, bound(*s.block, s.cell, out_.parts));
    }
    out_.made.error = largest > 0.0 ? most / largest : 0.0;
    for (auto& [key, shape] : shapes_) {
      if (shape.cell) fill(shape, out_.parts);
    }
  }

  void split_block(std::size_t b) {
    const DataSet& block = blocks_[b];
    const auto* cells = std::get_if<UnstructuredTopology>(&block.topology);
    const std::size_t points = block.point_count();
    for (std::size_t p = 0; p < points; ++p)
      out_.input_of.push_back(static_cast<std::uint32_t>(first_input_ + p));
    if (cells == nullptr) {
      for (std::size_t c = 0; c < block.cell_count(); ++c)
        out_.cell_of.push_back(static_cast<std::uint32_t>(first_cell_ + c));
      out_.blocks.push_back(block);  // with its arrays, whose memory it shares
      close_block(block);
      return;
    }
    std::vector<double> position;
    position.reserve(3 * points);
    for (std::size_t p = 0; p < points; ++p) {
      for (int i = 0; i < 3; ++i) position.push_back(cells->positions.at(p, i));
    }
    visible_ = block.visible;
    UnstructuredTopology linear;
    linear.offsets.push_back(0);
    made_.clear();
    std::vector<std::int64_t> place;
    for (std::size_t c = 0; c < cells->types.size(); ++c) {
      const Cell cell = cell_of(block, *cells, c);
      const auto add = [&](std::uint8_t type) {
        linear.types.push_back(type);
        linear.offsets.push_back(static_cast<std::int64_t>(linear.connectivity.size()));
        out_.cell_of.push_back(static_cast<std::uint32_t>(first_cell_ + c));
      };
      if (cell.shape == nullptr) {
        linear.connectivity.insert(linear.connectivity.end(), cell.nodes.begin(), cell.nodes.end());
        add(cells->types[c]);
        continue;
      }
      const Template& shape = *cell.shape;
      place.clear();
      for (std::size_t p = 0; p < shape.points.size(); ++p)
        place.push_back(point_of(cell, shape.sums[p], shape.shared[p] != 0, position));
      for (std::size_t part = 0; part < shape.parts.size(); ++part) {
        for (const std::uint32_t corner : shape.corners[part]) linear.connectivity.push_back(place[corner]);
        add(shape.parts[part].type);
      }
    }
    linear.positions =
        make_array(cells->positions.name, Association::kPoint, 3, std::span<const double>(position));
    DataSet& split = out_.blocks.emplace_back();
    split.name = block.name;
    split.topology = std::move(linear);
    split.visible = std::move(visible_);
    close_block(block);
  }

  void close_block(const DataSet& block) {
    first_input_ += block.point_count();
    first_cell_ += block.cell_count();
  }

  /// The number in the block of the point that is this sum of nodes. Cells that share the nodes share the point.
  std::int64_t point_of(const Cell& cell, const Sum& sum, bool shared, std::vector<double>& position) {
    const std::span<const std::int64_t> nodes = cell.nodes;
    if (sum.size() == 1) return nodes[sum.front().first];
    const auto number = static_cast<std::int64_t>(position.size() / 3);
    if (shared) {
      std::vector<std::pair<std::int64_t, std::int64_t>> key;
      // Weights are fractions of small denominators, rounded. In parts of 2^-20 none lies half way between two.
      constexpr double kParts = 0x1p20;
      for (const auto& [node, weight] : sum) {
        const std::int64_t parts = std::llround(kParts * weight);
        if (parts != 0) key.emplace_back(nodes[node], parts);
      }
      std::ranges::sort(key);
      const auto [found, fresh] = made_.try_emplace(std::move(key), number);
      if (!fresh) return found->second;
    }
    Vec3 x{0.0};
    bool seen = true;
    for (const auto& [node, weight] : rational(cell, sum)) {
      const auto p = as_size(nodes[node]);
      x += weight * Vec3(position[3 * p], position[3 * p + 1], position[3 * p + 2]);
      out_.made.input.push_back(static_cast<std::uint32_t>(first_input_ + p));
      out_.made.weight.push_back(weight);
      seen = seen && (visible_.empty() || visible_[p] != 0);
    }
    out_.made.begin.push_back(out_.made.input.size());
    out_.input_of.push_back(kNoPoint);
    position.insert(position.end(), {x.x, x.y, x.z});
    if (!visible_.empty()) visible_.push_back(seen ? 1 : 0);
    return number;
  }

  std::span<const DataSet> blocks_;
  const PointValue& value_;
  CurvedSplit out_;
  int order_ = 1;
  std::map<std::tuple<std::uint8_t, std::size_t, CurvedCell::Orders>, Template> shapes_;
  std::vector<double> weights_;  ///< of the place that is looked at
  std::map<std::vector<std::pair<std::int64_t, std::int64_t>>, std::int64_t> made_;  ///< of the block
  std::vector<std::uint8_t> visible_;
  std::size_t first_input_ = 0, first_cell_ = 0;  ///< of the block
};

}  // namespace

std::optional<CurvedSplit> split_curved(std::span<const DataSet> blocks, const PointValue& value) {
  return CurvedSplitter(blocks, value).run();
}

}  // namespace palpate
