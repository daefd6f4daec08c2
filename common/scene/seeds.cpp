#include "common/scene/seeds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <random>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/math/vec_text.h"
#include "common/scene/seed_file.h"

namespace palpate {
namespace {

constexpr const char* kGrammar =
    "seeds are file.csv, file.vtp (its points), point:x,y,z, line:x,y,z,x,y,z,n, "
    "plane:o(x,y,z),a(x,y,z),b(x,y,z),na,nb, "
    "grid:nx,ny,nz, random:n or speed:n";

// A line holds its seed's index in 32 bits, and a hundred million seeds take 2.4 GB: more is a slip.
constexpr std::size_t kMostSeeds = 100'000'000;

/// A count written as a number: whole, at least one, not absurd.
int count_from(double value, const std::string& text) {
  if (value < 1.0 || value > static_cast<double>(kMostSeeds) || value != std::floor(value)) {
    throw usage_error("--seeds " + text + ": counts are whole numbers from 1 to 100000000");
  }
  return static_cast<int>(value);
}

void check_total(double total, const std::string& text) {
  if (total > static_cast<double>(kMostSeeds))
    throw usage_error("--seeds " + text + ": more than 100000000 seeds");
}

/// i / (n - 1), the middle of the range for a single point.
double fraction_of(int i, int n) { return n == 1 ? 0.5 : static_cast<double>(i) / (n - 1); }

/// Uniform in [0, 1) from the upper 53 bits: std::uniform_real_distribution differs between libraries.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

double tet_volume(const TetMesh& mesh, std::size_t cell) {
  const auto& v = mesh.cells()[cell];
  const auto x = mesh.points();
  const Vec3 a = x[v[0]];
  return std::abs(glm::dot(glm::cross(x[v[1]] - a, x[v[2]] - a), x[v[3]] - a)) / 6.0;
}

/// Draws points of a mesh, uniform in volume.
class MeshSource {
 public:
  explicit MeshSource(const TetMesh& mesh) : mesh_(mesh) {
    volume_up_to_.reserve(mesh.cells().size());
    double sum = 0.0;
    for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
      if (!mesh.zero_volume(static_cast<CellIndex>(c))) sum += tet_volume(mesh, c);
      volume_up_to_.push_back(sum);
    }
  }

  /// False for a mesh without volume.
  [[nodiscard]] bool usable() const { return !volume_up_to_.empty() && volume_up_to_.back() > 0.0; }

  /// Frame L. @pre usable().
  [[nodiscard]] Vec3 draw(std::mt19937_64& random) const {
    const double wanted = uniform(random) * volume_up_to_.back();
    const auto place = std::upper_bound(volume_up_to_.begin(), volume_up_to_.end() - 1, wanted);
    // The spacings of three sorted uniform numbers are uniform on the simplex.
    std::array<double, 3> u{};
    for (double& part : u) part = uniform(random);
    std::sort(u.begin(), u.end());
    const Vec4 b{u[0], u[1] - u[0], u[2] - u[1], 1.0 - u[2]};
    return mesh_.position(static_cast<CellIndex>(place - volume_up_to_.begin()), b);
  }

 private:
  const TetMesh& mesh_;
  std::vector<double> volume_up_to_;  ///< of the cells up to each, frame L
};

/// Draws points of a field's domain, uniform in volume.
class PointSource {
 public:
  explicit PointSource(const VectorField& field) : field_(field) {
    if (field.tet_mesh() != nullptr) mesh_.emplace(*field.tet_mesh());
  }

  /// False for a mesh without volume.
  [[nodiscard]] bool usable() const { return !mesh_ || mesh_->usable(); }

  [[nodiscard]] Vec3 draw(std::mt19937_64& random) const {
    const LocalFrame& frame = field_.frame();
    if (mesh_) return frame.data_from_local(mesh_->draw(random));
    // The grid's own box, which may be turned against the data's axes, or sheared.
    if (const BoxGrid* grid = field_.box_grid())
      return frame.data_from_local(grid->in_frame(draw_in(grid->bounds(), random)));
    Vec3 x{0.0};
    CellHint hint;
    for (int attempt = 0; attempt < kMostTries; ++attempt) {
      x = draw_in(field_.bounds(), random);
      if (field_.sample(x, hint).status != SampleStatus::kOutside) break;
    }
    return x;
  }

  // A domain, or a flow, that fills less than a thousandth of its box gives up.
  static constexpr int kMostTries = 1000;

 private:
  static Vec3 draw_in(const Box& box, std::mt19937_64& random) {
    const double x = uniform(random);
    const double y = uniform(random);
    return box.lower + Vec3{x, y, uniform(random)} * box.size();
  }

  const VectorField& field_;
  std::optional<MeshSource> mesh_;
};

std::vector<Vec3> random_seeds(const VectorField& field, const SeedRandom& wanted,
                               std::uint64_t random_seed) {
  const PointSource source(field);
  if (!source.usable()) return {};
  std::mt19937_64 random{random_seed};
  const bool by_speed = wanted.by_speed && field.max_speed() > 0.0;
  std::vector<Vec3> seeds;
  seeds.reserve(wanted.count);
  CellHint hint;
  while (seeds.size() < wanted.count) {
    Vec3 x = source.draw(random);
    for (int attempt = 1; by_speed && attempt < PointSource::kMostTries; ++attempt) {
      const VectorSample v = field.sample(x, hint);
      const double speed = v.status == SampleStatus::kOk ? glm::length(v.value) : 0.0;
      if (uniform(random) * field.max_speed() < speed) break;
      x = source.draw(random);
    }
    seeds.push_back(x);
  }
  return seeds;
}

std::vector<Vec3> grid_seeds(const Box& bounds, const Index3& n) {
  std::vector<Vec3> seeds;
  seeds.reserve(as_size(n.x) * as_size(n.y) * as_size(n.z));
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i) {
        const Vec3 part{(i + 0.5) / n.x, (j + 0.5) / n.y, (k + 0.5) / n.z};
        seeds.push_back(bounds.lower + part * bounds.size());
      }
    }
  }
  return seeds;
}

}  // namespace

SeedSpec parse_seeds(const std::string& text, const std::string& grammar) {
  const std::string known = grammar.empty() ? kGrammar : grammar;
  const auto colon = text.find(':');
  const std::string kind = colon == std::string::npos ? std::string() : text.substr(0, colon);
  const auto numbers = [&](std::size_t count) {
    return parse_numbers(std::string_view(text).substr(colon + 1), count, known);
  };
  if (kind == "point") return SeedList{{vec_at(numbers(3), 0)}};
  if (kind == "line") {
    const auto v = numbers(7);
    const int n = count_from(v[6], text);
    SeedList seeds;
    for (int i = 0; i < n; ++i)
      seeds.points.push_back(glm::mix(vec_at(v, 0), vec_at(v, 3), fraction_of(i, n)));
    return seeds;
  }
  if (kind == "plane") {
    const auto v = numbers(11);
    const int na = count_from(v[9], text);
    const int nb = count_from(v[10], text);
    check_total(static_cast<double>(na) * nb, text);
    const Vec3 o = vec_at(v, 0);
    const Vec3 a = vec_at(v, 3) - o;
    const Vec3 b = vec_at(v, 6) - o;
    SeedList seeds;
    for (int j = 0; j < nb; ++j) {
      for (int i = 0; i < na; ++i)
        seeds.points.push_back(o + fraction_of(i, na) * a + fraction_of(j, nb) * b);
    }
    return seeds;
  }
  if (kind == "grid") {
    const auto v = numbers(3);
    check_total(std::max(v[0], 1.0) * std::max(v[1], 1.0) * std::max(v[2], 1.0), text);
    return SeedGrid{{count_from(v[0], text), count_from(v[1], text), count_from(v[2], text)}};
  }
  if (kind == "random" || kind == "speed") {
    return SeedRandom{as_size(count_from(numbers(1)[0], text)), kind == "speed"};
  }
  std::error_code ignored;
  if (text.ends_with(".csv") || text.ends_with(".vtp") || std::filesystem::exists(text, ignored))
    return SeedList{read_seed_file(text, kMostSeeds)};
  throw usage_error("--seeds " + text + ": not understood; " + known);
}

std::size_t seed_count(const SeedSpec& spec) noexcept {
  if (const auto* list = std::get_if<SeedList>(&spec)) return list->points.size();
  if (const auto* grid = std::get_if<SeedGrid>(&spec)) {
    return as_size(grid->n.x) * as_size(grid->n.y) * as_size(grid->n.z);
  }
  const auto* random = std::get_if<SeedRandom>(&spec);
  return random != nullptr ? random->count : 0;
}

std::vector<Vec3> make_seeds(const SeedSpec& spec, const VectorField& field, std::uint64_t random_seed) {
  if (const auto* list = std::get_if<SeedList>(&spec)) return list->points;
  if (const auto* grid = std::get_if<SeedGrid>(&spec)) return grid_seeds(field.bounds(), grid->n);
  return random_seeds(field, std::get<SeedRandom>(spec), random_seed);
}

std::vector<Vec3> make_seeds(const SeedSpec& spec, const TetMesh& mesh, const LocalFrame& frame,
                             const Box& bounds, std::uint64_t random_seed) {
  if (const auto* list = std::get_if<SeedList>(&spec)) return list->points;
  if (const auto* grid = std::get_if<SeedGrid>(&spec)) return grid_seeds(bounds, grid->n);
  const auto& wanted = std::get<SeedRandom>(spec);
  if (wanted.by_speed) throw usage_error("--seeds speed:n: fibres have no speed; try random:n");
  const MeshSource source(mesh);
  std::vector<Vec3> seeds;
  if (!source.usable()) return seeds;
  std::mt19937_64 random{random_seed};
  seeds.reserve(wanted.count);
  while (seeds.size() < wanted.count) seeds.push_back(frame.data_from_local(source.draw(random)));
  return seeds;
}

}  // namespace palpate
