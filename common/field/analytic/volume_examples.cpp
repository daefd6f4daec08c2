#include "common/field/analytic/volume_examples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/grid/sparse/sparse_builder.h"
#include "common/math/counter_random.h"

namespace palpate {
namespace {

using std::cos;
using std::sin;
using std::sqrt;

struct Sphere {
  static constexpr const char* kName = "sphere";
  static constexpr const char* kDescription = "sphere: squared distance from the origin";
  static constexpr Box kBounds{{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}};

  template <typename T>
  static T value(const T& x, const T& y, const T& z) noexcept {
    return x * x + y * y + z * z;
  }
};

struct MarschnerLobb {
  static constexpr const char* kName = "marschner-lobb";
  static constexpr const char* kDescription =
      "Marschner-Lobb signal (Marschner and Lobb 1994): rings at the limit of what a 41^3 grid can hold";
  static constexpr Box kBounds{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};
  static constexpr double kFrequency = 6.0;
  static constexpr double kAlpha = 0.25;

  template <typename T>
  static T value(const T& x, const T& y, const T& z) noexcept {
    const T half_pi(0.5 * std::numbers::pi);
    const T r = sqrt(x * x + y * y + T(0x1p-100));  // its derivatives are finite on the axis, too
    const T rho = cos(T(2.0 * std::numbers::pi * kFrequency) * cos(half_pi * r));
    return (T(1.0) - sin(half_pi * z) + T(kAlpha) * (T(1.0) + rho)) / T(2.0 * (1.0 + kAlpha));
  }
};

template <typename T>
constexpr ScalarType kTypeOf = ScalarType::kFloat32;
template <>
constexpr ScalarType kTypeOf<std::uint8_t> = ScalarType::kUint8;
template <>
constexpr ScalarType kTypeOf<std::uint16_t> = ScalarType::kUint16;

/// A cube of n^3 points over `bounds`; value_at(x, index of the point).
template <typename T>
DataSet cube(int n, const Box& bounds, const std::function<T(const Vec3&, std::uint64_t)>& value_at) {
  UniformTopology topology;
  topology.points = Index3{n};
  topology.origin = bounds.lower;
  for (int axis = 0; axis < 3; ++axis) {
    topology.axes[axis] = Vec3{0.0};
    topology.axes[axis][axis] = bounds.size()[axis] / (n - 1);
  }
  const auto values = std::make_shared<std::vector<T>>();
  values->reserve(as_size(n) * as_size(n) * as_size(n));
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i)
        values->push_back(value_at(topology.origin + topology.axes * Vec3{i, j, k}, values->size()));
    }
  }
  DataArray array;
  array.name = kVolumeArray;
  array.type = kTypeOf<T>;
  array.tuples = values->size();
  array.bytes = std::as_bytes(std::span(std::as_const(*values)));
  array.owner = values;
  DataSet block;
  block.topology = topology;
  block.arrays.push_back(std::move(array));
  return block;
}

constexpr Box kUnitCube{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};

/// `part` of full scale as an integer.
template <typename T>
T quantised(double part) {
  constexpr auto kMost = static_cast<double>(static_cast<T>(~T{0}));
  return static_cast<T>(std::lround(std::clamp(part, 0.0, 1.0) * kMost));
}

/// On 41 points an axis, as Marschner and Lobb had it.
DataSet marschner_lobb() {
  constexpr int kPoints = 41;
  const auto formula = marschner_lobb_scalar();
  return cube<float>(kPoints, formula->bounds(), [&formula](const Vec3& x, std::uint64_t) {
    return static_cast<float>(formula->value(x));
  });
}

/// Shells with the value A_i around the origin, Gaussian across: s = sum_i A_i exp(-((|x| - R_i) / w)^2).
DataSet shells() {
  constexpr int kPoints = 96;
  constexpr double kWidth = 0.05;  // w
  struct Shell {
    double radius, value;
  };
  constexpr std::array<Shell, 4> kShells{{{0.2, 1.0}, {0.42, 0.75}, {0.64, 0.5}, {0.86, 0.25}}};
  return cube<std::uint8_t>(kPoints, kUnitCube, [&](const Vec3& x, std::uint64_t) {
    double sum = 0.0;
    for (const Shell& shell : kShells) {
      const double away = (glm::length(x) - shell.radius) / kWidth;
      sum += shell.value * std::exp(-away * away);
    }
    return quantised<std::uint8_t>(sum);
  });
}

/// Three overlapping Gaussian blobs under white noise of a tenth of full scale.
DataSet blob() {
  constexpr int kPoints = 64;
  constexpr double kNoise = 0.1;
  struct Part {
    Vec3 center;
    double radius, value;
  };
  const std::array<Part, 3> parts{
      {{{0.0, 0.0, 0.0}, 0.45, 0.6}, {{0.4, 0.2, 0.1}, 0.25, 0.35}, {{-0.3, 0.35, -0.25}, 0.2, 0.4}}};
  return cube<std::uint16_t>(kPoints, kUnitCube, [&](const Vec3& x, std::uint64_t index) {
    double sum = kNoise * uniform_at(index);
    for (const Part& part : parts) {
      const Vec3 away = (x - part.center) / part.radius;
      sum += part.value * std::exp(-glm::dot(away, away));
    }
    return quantised<std::uint16_t>(sum);
  });
}

/// Nothing but one voxel in the middle.
DataSet voxel() {
  constexpr int kPoints = 33;
  constexpr std::uint64_t kMiddle = std::uint64_t{kPoints} * kPoints * kPoints / 2;
  return cube<std::uint8_t>(kPoints, kUnitCube, [](const Vec3&, std::uint64_t index) {
    return static_cast<std::uint8_t>(index == kMiddle ? 255 : 0);
  });
}

/// The part in [0, 1] that a thin shell with holes has in the direction `d` of number `i`.
double part_of_shell(const Vec3& d, double i) {
  constexpr double kWaves = 5.0, kEdge = 4.0;  // of the pattern over a half turn; steepness of holes' edges
  const Vec3 a = kWaves * d;
  const double pattern = std::sin(a.x + i) * std::cos(a.y) + std::sin(a.y + i) * std::cos(a.z) +
                         std::sin(a.z + i) * std::cos(a.x);
  return std::clamp(0.5 + kEdge * pattern, 0.0, 1.0);
}

/// Six nested shells with holes, thin as a few voxels of 1024^3, nothing elsewhere:
/// s = A_i max(0, 1 - ||x| - R_i| / w) where shell i is no hole. Only blocks that a shell meets are made.
DataSet sparse_shells() {
  constexpr int kPoints = 1024, kShells = 6;
  constexpr double kStep = 2.0 / (kPoints - 1), kWidth = 2.0 * kStep;  // w
  const auto radius_of = [](int shell) { return 0.96 * (shell + 1) / kShells; };
  const auto value_at = [&](const Vec3& x) {
    const double r = glm::length(x);
    for (int shell = 0; shell < kShells; ++shell) {
      const double across = 1.0 - std::abs(r - radius_of(shell)) / kWidth;
      if (across <= 0.0) continue;
      const double height = 1.0 - 0.12 * shell;
      return static_cast<float>(height * across * part_of_shell(x / r, shell));
    }
    return 0.0F;
  };
  UniformTopology topology;
  topology.points = Index3{kPoints};
  topology.origin = kUnitCube.lower;
  topology.axes = kStep * Mat3{1.0};

  SparseBuilder builder(Index3{0}, topology.points, 0.0F);
  const Index3 n = builder.blocks();
  struct Made {
    bool any = false;
    std::array<float, kBlockVoxels> numbers{};
  };
  const auto make = [&](const Index3& block, Made& made) {
    const Vec3 middle = topology.origin + kStep * (Vec3{kBlockSide * block} + 0.5 * (kBlockSide - 1));
    const double reach = 0.5 * kBlockSide * kStep * std::sqrt(3.0) + kWidth, r = glm::length(middle);
    made.any = false;
    for (int shell = 0; shell < kShells; ++shell)
      made.any = made.any || std::abs(r - radius_of(shell)) <= reach;
    if (!made.any) return;
    for (int x = 0; x < kBlockSide; ++x) {
      for (int y = 0; y < kBlockSide; ++y) {
        for (int z = 0; z < kBlockSide; ++z) {
          const Index3 p = kBlockSide * block + Index3(x, y, z);
          made.numbers[block_offset(p)] = value_at(topology.origin + kStep * Vec3{p});
        }
      }
    }
  };
  std::vector<Made> layer(as_size(n.x) * as_size(n.y));
  const auto block_of = [&](std::size_t i, int z) {
    const auto row = as_size(n.x);
    return Index3(static_cast<int>(i % row), static_cast<int>(i / row), z);
  };
  for (int z = 0; z < n.z; ++z) {
    parallel_for(layer.size(), 0, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) make(block_of(i, z), layer[i]);
    });
    for (std::size_t i = 0; i < layer.size(); ++i) {
      if (layer[i].any) builder.put(block_of(i, z), layer[i].numbers);
    }
  }
  DataArray array;
  array.name = kVolumeArray;
  array.sparse = builder.finish();
  array.tuples = array.sparse->size();
  DataSet block;
  block.topology = topology;
  block.arrays.push_back(std::move(array));
  return block;
}

struct Example {
  const char* name;
  const char* summary;
  DataSet (*make)();
};
constexpr std::array<Example, 5> kExamples{
    {{"shells", "four nested shells of falling value (96^3, 8 bits)", shells},
     {"marschner-lobb",
      "Marschner-Lobb signal (Marschner and Lobb 1994): rings at the limit of its grid (41^3, float)",
      marschner_lobb},
     {"blob", "three joined blobs under white noise (64^3, 16 bits)", blob},
     {"voxel", "an empty volume with one voxel in the middle (33^3, 8 bits)", voxel},
     {"sparse-shells", "six thin shells with holes in an empty volume (1024^3, float, sparse)",
      sparse_shells}}};

}  // namespace

std::shared_ptr<const AnalyticScalar> sphere_scalar() { return std::make_shared<FormulaScalar<Sphere>>(); }
std::shared_ptr<const AnalyticScalar> marschner_lobb_scalar() {
  return std::make_shared<FormulaScalar<MarschnerLobb>>();
}

std::vector<ExampleInfo> volume_examples() {
  std::vector<ExampleInfo> list;
  list.reserve(kExamples.size());
  for (const Example& example : kExamples) list.push_back({example.name, example.summary});
  return list;
}

DataSet volume_example(std::string_view name) {
  std::string known;
  for (const Example& example : kExamples) {
    if (name == example.name) return example.make();
    known += (known.empty() ? "" : ", ") + std::string(example.name);
  }
  throw usage_error("no example '" + std::string(name) + "'; the known ones are: " + known);
}

}  // namespace palpate
