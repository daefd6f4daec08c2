#include "tests/support/sample_meshes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace palpate::test {
namespace {

using Ids = std::vector<std::int64_t>;

DataArray vectors(const std::string& name, const std::vector<Vec3>& values) {
  std::vector<double> numbers;
  for (const Vec3& v : values) numbers.insert(numbers.end(), {v.x, v.y, v.z});
  return make_array(name, Association::kPoint, 3, std::span<const double>(numbers));
}

std::vector<Vec3> values_at(const std::vector<Vec3>& points, const std::function<Vec3(const Vec3&)>& value) {
  std::vector<Vec3> out;
  for (const Vec3& x : points) out.push_back(value(x));
  return out;
}

/// Uniform in [0, 1), from the engine's own bits.
double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

std::size_t below(std::mt19937_64& random, std::size_t n) { return random() % n; }

template <typename T>
void shuffle(std::vector<T>& items, std::mt19937_64& random) {
  for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(random, i)]);
}

constexpr std::array<std::array<int, 4>, 6> kFaces{
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};

/// One of the 24 ways to number a hexahedron without turning it inside out.
Ids turned_hexahedron(Ids v, std::mt19937_64& random) {
  for (std::size_t turn = 0; turn < 6; ++turn) {
    if (below(random, 2) == 0) v = {v[1], v[2], v[3], v[0], v[5], v[6], v[7], v[4]};  // about z
    if (below(random, 2) == 0) v = {v[3], v[2], v[6], v[7], v[0], v[1], v[5], v[4]};  // about x
  }
  return v;
}

std::vector<Ids> faces_of_cube(const Ids& v) {
  std::vector<Ids> out;
  for (const auto& face : kFaces) {
    Ids ids;
    for (const int i : face) ids.push_back(v[static_cast<std::size_t>(i)]);
    out.push_back(ids);
  }
  return out;
}

}  // namespace

void CellSoup::add_polyhedron(const std::vector<Ids>& faces, std::mt19937_64& random) {
  Ids stream{static_cast<std::int64_t>(faces.size())};
  for (Ids face : faces) {
    std::rotate(face.begin(), face.begin() + static_cast<std::ptrdiff_t>(below(random, face.size())),
                face.end());
    if (below(random, 2) == 0) std::ranges::reverse(face);
    stream.push_back(static_cast<std::int64_t>(face.size()));
    stream.insert(stream.end(), face.begin(), face.end());
  }
  cells_.push_back({42, stream});
}

DataSet CellSoup::take(std::mt19937_64& random, const std::function<Vec3(const Vec3&)>& value) const {
  std::vector<std::int64_t> number(points_.size());
  std::iota(number.begin(), number.end(), 0);
  shuffle(number, random);
  std::vector<Vec3> points(points_.size());
  for (std::size_t p = 0; p < points_.size(); ++p) points[static_cast<std::size_t>(number[p])] = points_[p];
  std::vector<Cell> cells = cells_;
  shuffle(cells, random);

  UnstructuredTopology topology;
  topology.offsets.push_back(0);
  for (const Cell& cell : cells) {
    topology.types.push_back(cell.type);
    if (cell.type == 42) {
      std::size_t at = 0;
      topology.connectivity.push_back(cell.stream[at++]);
      for (std::int64_t f = 0; f < cell.stream[0]; ++f) {
        const std::int64_t count = cell.stream[at++];
        topology.connectivity.push_back(count);
        for (std::int64_t i = 0; i < count; ++i) {
          topology.connectivity.push_back(number[static_cast<std::size_t>(cell.stream[at++])]);
        }
      }
    } else {
      for (const std::int64_t p : cell.stream)
        topology.connectivity.push_back(number[static_cast<std::size_t>(p)]);
    }
    topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
  }
  topology.positions = vectors("points", points);
  DataSet out;
  out.topology = std::move(topology);
  out.arrays.push_back(vectors("velocity", values_at(points, value)));
  return out;
}

DataSet mixed_cells(int n, double jitter, std::uint64_t seed, const std::function<Vec3(const Vec3&)>& value) {
  std::mt19937_64 random(seed);
  CellSoup soup;
  const double h = 1.0 / n;
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        Vec3 x = h * Vec3(i, j, k);
        const Index3 at{i, j, k};
        for (int a = 0; a < 3; ++a) {
          const double move = jitter * h * (2.0 * unit(random) - 1.0);
          if (at[a] > 0 && at[a] < n) x[a] += move;
        }
        soup.add_point(x);
      }
    }
  }
  const auto id = [n](int i, int j, int k) {
    return static_cast<std::int64_t>(i + (n + 1) * (j + (n + 1) * k));
  };
  const auto cube = [&](int i, int j, int k) {
    return Ids{id(i, j, k),     id(i + 1, j, k),     id(i + 1, j + 1, k),     id(i, j + 1, k),
               id(i, j, k + 1), id(i + 1, j, k + 1), id(i + 1, j + 1, k + 1), id(i, j + 1, k + 1)};
  };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const bool wedges = below(random, 4) == 0;
      const bool other_diagonal = below(random, 2) == 0;
      for (int k = 0; k < n; ++k) {
        const Ids v = cube(i, j, k);
        if (wedges) {
          // Two columns of wedges; their vertex order as VTK documents it.
          if (other_diagonal) {
            soup.add_cell(13, {v[0], v[1], v[3], v[4], v[5], v[7]});
            soup.add_cell(13, {v[1], v[2], v[3], v[5], v[6], v[7]});
          } else {
            soup.add_cell(13, {v[0], v[1], v[2], v[4], v[5], v[6]});
            soup.add_cell(13, {v[0], v[2], v[3], v[4], v[6], v[7]});
          }
          continue;
        }
        switch (below(random, 5)) {
          case 0: {
            Vec3 centre{0.0};
            for (const std::int64_t p : v) centre += 0.125 * soup.points()[static_cast<std::size_t>(p)];
            const auto apex = static_cast<std::int64_t>(soup.add_point(centre));
            for (Ids face : faces_of_cube(v)) {
              // Base seen from inside turns against the outward face.
              std::ranges::reverse(face);
              face.push_back(apex);
              soup.add_cell(14, face);
            }
            break;
          }
          case 1:
            soup.add_polyhedron(faces_of_cube(v), random);
            break;
          case 2:
            if (jitter == 0.0 && k + 1 < n) {
              // Two cubes as one: ten faces, the sides in two halves.
              const Ids w = cube(i, j, k + 1);
              std::vector<Ids> faces = faces_of_cube(v);
              std::vector<Ids> upper = faces_of_cube(w);
              faces.pop_back();
              upper.erase(upper.begin() + 4);
              faces.insert(faces.end(), upper.begin(), upper.end());
              soup.add_polyhedron(faces, random);
              ++k;
              break;
            }
            [[fallthrough]];
          default:
            soup.add_cell(12, turned_hexahedron(v, random));
        }
      }
    }
  }
  return soup.take(random, value);
}

DataSet honeycomb(int rings, int layers, std::uint64_t seed, const std::function<Vec3(const Vec3&)>& value) {
  std::mt19937_64 random(seed);
  CellSoup soup;
  std::map<std::array<long, 3>, std::int64_t> known;
  const auto point = [&](double x, double y, int k) {
    const std::array<long, 3> place{std::lround(x * 1e6), std::lround(y * 1e6), k};
    const auto [at, fresh] = known.try_emplace(place, 0);
    if (fresh) at->second = soup.add_point({x, y, 0.5 * k});
    return at->second;
  };
  for (int q = -rings; q <= rings; ++q) {
    for (int r = -rings; r <= rings; ++r) {
      if (std::abs(q + r) > rings) continue;
      const double cx = std::numbers::sqrt3 * (q + 0.5 * r);
      const double cy = 1.5 * r;
      for (int k = 0; k < layers; ++k) {
        Ids low;
        Ids high;
        for (int i = 0; i < 6; ++i) {
          const double angle = std::numbers::pi / 180.0 * (60.0 * i + 30.0);
          low.push_back(point(cx + std::cos(angle), cy + std::sin(angle), k));
          high.push_back(point(cx + std::cos(angle), cy + std::sin(angle), k + 1));
        }
        // Every third column is a pentagonal prism and a wedge in place of the hexagonal prism.
        const bool cut = (q - r + 99) % 3 == 0;
        Ids prism;
        const std::size_t corners = cut ? 5 : 6;
        prism.insert(prism.end(), low.begin(), low.begin() + static_cast<std::ptrdiff_t>(corners));
        prism.insert(prism.end(), high.begin(), high.begin() + static_cast<std::ptrdiff_t>(corners));
        soup.add_cell(cut ? 15 : 16, prism);
        if (cut) soup.add_cell(13, {low[4], low[5], low[0], high[4], high[5], high[0]});
      }
    }
  }
  return soup.take(random, value);
}

DataSet structured_block(const Index3& n, const std::vector<Vec3>& positions,
                         const std::function<Vec3(const Vec3&)>& value) {
  DataSet out;
  out.topology = StructuredTopology{n, vectors("points", positions)};
  out.arrays.push_back(vectors("velocity", values_at(positions, value)));
  return out;
}

std::vector<DataSet> turned_blocks(int n, double noise, std::uint64_t seed,
                                   const std::function<Vec3(const Vec3&)>& value) {
  std::mt19937_64 random(seed);
  std::vector<DataSet> out;
  for (int b = 0; b < 8; ++b) {
    const Vec3 corner = 0.5 * Vec3(b & 1, (b >> 1) & 1, b >> 2);
    std::array<int, 3> axis{0, 1, 2};
    for (std::size_t i = 3; i > 1; --i) std::swap(axis[i - 1], axis[below(random, i)]);
    const std::array<bool, 3> backwards{below(random, 2) == 0, below(random, 2) == 0, below(random, 2) == 0};
    std::vector<Vec3> positions;
    for (int k = 0; k <= n; ++k) {
      for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
          const std::array<int, 3> at{i, j, k};
          Vec3 x{0.0};
          for (std::size_t a = 0; a < 3; ++a) {
            const int step = backwards[a] ? n - at[a] : at[a];
            x[axis[a]] = 0.5 * step / n;
          }
          x += corner + noise * Vec3{unit(random), unit(random), unit(random)};
          positions.push_back(x);
        }
      }
    }
    out.push_back(structured_block({n + 1, n + 1, n + 1}, positions, value));
  }
  return out;
}

DataSet polar_block(int radial, int around, int high, const std::function<Vec3(const Vec3&)>& value) {
  std::vector<Vec3> positions;
  for (int k = 0; k <= high; ++k) {
    for (int j = 0; j <= around; ++j) {
      // The seam's two planes have the same bits.
      const double angle = 2.0 * std::numbers::pi * (j % around) / around;
      for (int i = 0; i <= radial; ++i) {
        const double r = static_cast<double>(i) / radial;
        positions.emplace_back(r * std::cos(angle), r * std::sin(angle), static_cast<double>(k) / high);
      }
    }
  }
  return structured_block({radial + 1, around + 1, high + 1}, positions, value);
}

DataSet quadratic_tetrahedra(const DataSet& linear, const std::function<Vec3(const Vec3&)>& value) {
  const auto& old = std::get<UnstructuredTopology>(linear.topology);
  std::vector<Vec3> points;
  for (std::size_t p = 0; p < old.positions.tuples; ++p) {
    points.emplace_back(old.positions.at(p, 0), old.positions.at(p, 1), old.positions.at(p, 2));
  }
  std::map<std::array<std::int64_t, 2>, std::int64_t> middles;
  const auto middle = [&](std::int64_t a, std::int64_t b) {
    const auto [at, fresh] =
        middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::int64_t>(points.size()));
    if (fresh)
      points.push_back(0.5 * (points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(b)]));
    return at->second;
  };
  UnstructuredTopology topology;
  topology.offsets.push_back(0);
  for (std::size_t c = 0; c < old.types.size(); ++c) {
    const std::int64_t* v = old.connectivity.data() + old.offsets[c];
    const Ids ids{v[0],
                  v[1],
                  v[2],
                  v[3],
                  middle(v[0], v[1]),
                  middle(v[1], v[2]),
                  middle(v[2], v[0]),
                  middle(v[0], v[3]),
                  middle(v[1], v[3]),
                  middle(v[2], v[3])};
    topology.types.push_back(24);
    topology.connectivity.insert(topology.connectivity.end(), ids.begin(), ids.end());
    topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
  }
  topology.positions = vectors("points", points);
  DataSet out;
  out.topology = std::move(topology);
  out.arrays.push_back(vectors("velocity", values_at(points, value)));
  return out;
}

}  // namespace palpate::test
