#include "common/field/tensor/orientation_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/tensor/diffusion_measures.h"
#include "common/field/tensor/gradient_table.h"
#include "common/math/lattice.h"
#include "common/math/symmetric3.h"
#include "common/math/units.h"

namespace palpate {
namespace {

constexpr const char* kAxisNames = "ijk";
/// Below it a main direction is mostly noise.
constexpr double kLeastAnisotropy = 0.2;

/// The half of a voxel's 26 neighbours that makes each pair count once.
std::vector<Index3> half_neighbourhood() {
  std::vector<Index3> offsets;
  for (int k = 0; k <= 1; ++k) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        if (k > 0 || j > 0 || (j == 0 && i > 0)) offsets.emplace_back(i, j, k);
      }
    }
  }
  return offsets;
}

}  // namespace

Mat3 AxisTurn::matrix() const noexcept {
  Mat3 m{0.0};
  for (std::size_t row = 0; row < 3; ++row) m[from[row]][static_cast<int>(row)] = flipped[row] ? -1.0 : 1.0;
  return m;
}

bool AxisTurn::is_identity() const noexcept { return matrix() == Mat3{1.0}; }

std::string AxisTurn::text() const {
  std::string permute, flip;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    permute += kAxisNames[from[axis]];
    if (flipped[axis]) flip += kAxisNames[axis];
  }
  std::string text;
  if (permute != kAxisNames) text = "--permute " + permute;
  if (!flip.empty()) text += (text.empty() ? "--flip " : " --flip ") + flip;
  return text;
}

std::vector<AxisTurn> axis_turns() {
  std::vector<AxisTurn> turns;
  std::array<int, 3> from{0, 1, 2};
  do {
    for (int flip = -1; flip < 3; ++flip) {
      AxisTurn turn{from, {}};
      if (flip >= 0) turn.flipped[as_size(flip)] = true;
      turns.push_back(turn);
    }
  } while (std::next_permutation(from.begin(), from.end()));
  return turns;
}

DirectionMap::DirectionMap(std::span<const float> tensors, const UniformTopology& topology, int threads)
    : points_(topology.points),
      axes_(topology.axes),
      directions_(tensors.size() / 6),
      shape_(directions_.size()) {
  parallel_for(directions_.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v) {
      const float* const d = tensors.data() + 6 * v;
      directions_[v] = {};
      shape_[v].fill(std::numeric_limits<float>::quiet_NaN());
      if (!std::all_of(d, d + 6, [](float x) { return std::isfinite(x); })) continue;
      const SymmetricEigen eigen =
          symmetric_eigen({Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}});
      const double fa = fractional_anisotropy(eigen.values);
      shape_[v] = {static_cast<float>(fa), static_cast<float>((d[0] + d[3] + d[5]) / 3.0F)};
      // An anisotropy near one is the mark of a negative eigenvalue: noise.
      if (!(fa > kLeastAnisotropy) || has_negative(eigen.values)) continue;
      for (std::size_t axis = 0; axis < 3; ++axis)
        directions_[v][axis] = static_cast<float>(eigen.vectors[0][static_cast<int>(axis)]);
      directions_[v][3] = static_cast<float>(fa);
    }
  });
  count_ = as_size(
      std::count_if(directions_.begin(), directions_.end(), [](const auto& d) { return d[3] > 0.0F; }));
}

double DirectionMap::median_turn(const Mat3& turn, const Mat3& others) const {
  constexpr int kEdge = 5;
  struct Block {
    Mat3 sum{0.0};
    std::size_t voxels = 0;
  };
  const Index3 blocks = (points_ + (kEdge - 1)) / kEdge;
  std::vector<Block> means(count_of(blocks));
  std::size_t v = 0;
  for (int k = 0; k < points_.z; ++k) {
    for (int j = 0; j < points_.y; ++j) {
      for (int i = 0; i < points_.x; ++i) {
        const auto& d = directions_[v++];
        if (!(d[3] > 0.0F)) continue;
        const Vec3 e{d[0], d[1], d[2]};
        Block& block = means[index_in(blocks, Index3{i, j, k} / kEdge)];
        block.sum += static_cast<double>(d[3]) * glm::outerProduct(e, e);
        ++block.voxels;
      }
    }
  }
  const std::size_t fullest = std::ranges::max(means, {}, &Block::voxels).voxels;
  std::vector<double> turns;
  for (const Block& block : means) {
    if (block.voxels == 0 || 2 * block.voxels < fullest) continue;
    const Vec3 e = symmetric_eigen(block.sum).vectors[0];
    turns.push_back(kDegreesARadian * axis_angle(turn * e, others * e));
  }
  if (turns.empty()) return 0.0;
  const auto middle = turns.begin() + static_cast<std::ptrdiff_t>(turns.size() / 2);
  std::ranges::nth_element(turns, middle);
  return *middle;
}

namespace {

/// Lines through the origin, each once.
class LineSet {
 public:
  std::size_t index_of(const Vec3& line) {
    constexpr double kSame = 1e-9;  // of 1 - cos
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      if (1.0 - std::abs(glm::dot(lines_[l], line)) < kSame) return l;
    }
    lines_.push_back(line);
    return lines_.size() - 1;
  }
  [[nodiscard]] const std::vector<Vec3>& lines() const noexcept { return lines_; }

 private:
  std::vector<Vec3> lines_;
};

/// FA (d . line)^4 of the voxels of a slice, a row of all lines for each that counts.
class SliceParts {
 public:
  SliceParts(std::span<const std::array<float, 4>> slice, const std::vector<Vec3>& lines)
      : rows_(slice.size(), kNone) {
    for (std::size_t v = 0; v < slice.size(); ++v) {
      const auto& d = slice[v];
      if (!(d[3] > 0.0F)) continue;
      rows_[v] = parts_.size();
      for (const Vec3& line : lines) {
        const double a = glm::dot(Vec3{d[0], d[1], d[2]}, line);
        parts_.push_back(static_cast<float>(static_cast<double>(d[3]) * a * a * a * a));
      }
    }
  }
  /// Null where the voxel does not count.
  [[nodiscard]] const float* row(std::size_t voxel) const noexcept {
    return rows_[voxel] == kNone ? nullptr : parts_.data() + rows_[voxel];
  }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};
  std::vector<std::size_t> rows_;
  std::vector<float> parts_;
};

/// (2) of P, whose column o stands in column `line_of[o]` of `sums`.
double excess(std::span<const double> sums, std::size_t width, std::span<const std::size_t> line_of) {
  const std::size_t n = line_of.size();
  std::vector<double> rows(n, 0.0), columns(n, 0.0);
  double along = 0.0, total = 0.0;
  for (std::size_t step = 0; step < n; ++step) {
    for (std::size_t o = 0; o < n; ++o) {
      const double part = sums[step * width + line_of[o]];
      rows[step] += part;
      columns[o] += part;
      total += part;
      if (o == step) along += part;
    }
  }
  double expected = 0.0;
  for (std::size_t o = 0; o < n; ++o) expected += rows[o] * columns[o];
  return expected > 0.0 ? along * total / expected - 1.0 : 0.0;
}

}  // namespace

namespace {

constexpr double kLeastErrors = 1.5;

/// Standard errors that the best of all turns has to be better by: more where few voxels count, since their octants
/// are few fibres each, and one of many turns is that much better by chance.
double errors_for(std::size_t voxels) {
  constexpr double kMostErrors = 4.0, kMany = 5000.0, kFew = 500.0;
  const double few = std::log(kMany / std::max(1.0, static_cast<double>(voxels))) / std::log(kMany / kFew);
  return kLeastErrors + (kMostErrors - kLeastErrors) * std::clamp(few, 0.0, 1.0);
}

bool better_by(const Coherence& a, const Coherence& b, double by, double errors) {
  constexpr double kClear = 0.02;
  const double better = a.score - b.score;
  if (!(a.score > kClear && better > by)) return false;
  constexpr auto kCount = static_cast<double>(Coherence::kBlocks);
  double mean = 0.0, squares = 0.0;
  for (std::size_t block = 0; block < Coherence::kBlocks; ++block)
    mean += (a.without[block] - b.without[block]) / kCount;
  for (std::size_t block = 0; block < Coherence::kBlocks; ++block) {
    const double apart = a.without[block] - b.without[block] - mean;
    squares += apart * apart;
  }
  return better > errors * std::sqrt((kCount - 1.0) / kCount * squares);
}

}  // namespace

bool clearly_better(const Coherence& a, const Coherence& b, double by) noexcept {
  return better_by(a, b, by, kLeastErrors);
}

std::vector<Coherence> DirectionMap::coherence(std::span<const Mat3> turns, int threads) const {
  const std::vector<Index3> offsets = half_neighbourhood();
  LineSet set;
  std::vector<std::size_t> line_of;  // a row a turn: (T d) . o = d . (T^T o)
  for (const Mat3& turn : turns) {
    for (const Index3& offset : offsets)
      line_of.push_back(set.index_of(glm::transpose(turn) * glm::normalize(axes_ * Vec3(offset))));
  }
  const std::size_t width = set.lines().size();
  const auto slices = as_size(points_.z);
  const std::size_t in_slice = as_size(points_.x) * as_size(points_.y);
  // By slab of slices and quarter of it: the order of sums is fixed, and their number has a bound.
  constexpr std::size_t kQuarters = 4, kMostSlabs = 64;
  const std::size_t slabs = std::min(slices, kMostSlabs);
  const std::size_t size = offsets.size() * width;
  std::vector<double> sums(slabs * kQuarters * size, 0.0);
  parallel_for(slabs, threads, [&](std::size_t first, std::size_t last) {
    std::size_t slab = first;
    const auto parts_of = [&](std::size_t slice) {
      return SliceParts(std::span(directions_).subspan(slice * in_slice, in_slice), set.lines());
    };
    for (std::size_t slice = first * slices / slabs; slice < last * slices / slabs; ++slice) {
      while ((slab + 1) * slices / slabs <= slice) ++slab;
      const SliceParts here = parts_of(slice);
      const SliceParts above = parts_of(std::min(slice + 1, slices - 1));
      for (int j = 0; j < points_.y; ++j) {
        for (int i = 0; i < points_.x; ++i) {
          const float* const u = here.row(index_in(points_, {i, j, 0}));
          if (u == nullptr) continue;
          const std::size_t quarter = (2 * i >= points_.x ? 1U : 0U) + (2 * j >= points_.y ? 2U : 0U);
          double* const sum = sums.data() + (slab * kQuarters + quarter) * size;
          for (std::size_t n = 0; n < offsets.size(); ++n) {
            const Index3 there{i + offsets[n].x, j + offsets[n].y, 0};
            if (there.x < 0 || there.y < 0 || there.x >= points_.x || there.y >= points_.y ||
                (offsets[n].z > 0 && slice + 1 == slices)) {
              continue;
            }
            const float* const v = (offsets[n].z > 0 ? above : here).row(index_in(points_, there));
            if (v == nullptr) continue;
            double* const row = sum + n * width;
            for (std::size_t l = 0; l < width; ++l) row[l] += static_cast<double>(u[l] * v[l]);
          }
        }
      }
    }
  });
  std::vector<double> all(size, 0.0);
  std::array<std::vector<double>, Coherence::kBlocks> without;
  without.fill(all);
  for (std::size_t part = 0; part < slabs * kQuarters; ++part) {
    const std::size_t block =
        part % kQuarters + (2 * (part / kQuarters) >= slabs ? kQuarters : std::size_t{0});
    for (std::size_t i = 0; i < size; ++i) {
      const double sum = sums[part * size + i];
      all[i] += sum;
      for (std::size_t b = 0; b < without.size(); ++b) without[b][i] += b == block ? 0.0 : sum;
    }
  }
  std::vector<Coherence> scores;
  for (std::size_t t = 0; t < turns.size(); ++t) {
    const auto lines = std::span(line_of).subspan(t * offsets.size(), offsets.size());
    Coherence& score = scores.emplace_back();
    score.score = excess(all, width, lines);
    for (std::size_t b = 0; b < without.size(); ++b) score.without[b] = excess(without[b], width, lines);
  }
  return scores;
}

Mat3 Orientation::matrix(const Mat3& axes) const noexcept {
  const Mat3 image = image_axes(axes);
  return image * turn.matrix() * glm::transpose(image) * matrix_of(frame, axes);
}

namespace {

/// Ten degrees about each axis, either way.
std::vector<Mat3> slight_rotations() {
  constexpr double kSine = 0.1736481776669303;
  const double cosine = std::sqrt(1.0 - kSine * kSine);
  std::vector<Mat3> rotations;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sine : {-kSine, kSine}) {
      Mat3 rotation{1.0};
      const int next = (axis + 1) % 3, last = (axis + 2) % 3;
      rotation[next][next] = rotation[last][last] = cosine;
      rotation[next][last] = sine;
      rotation[last][next] = -sine;
      rotations.push_back(rotation);
    }
  }
  return rotations;
}

/// Answers to a wrong orientation, the simplest first: what was taken, turned, in another frame, both. Turns come
/// behind the one that was taken.
std::vector<Orientation> answers_to(VectorFrame taken) {
  std::vector<Orientation> answers;
  const auto add_turns = [&answers](VectorFrame frame) {
    for (const AxisTurn& turn : axis_turns()) answers.push_back({frame, turn});  // the identity first
  };
  add_turns(taken);
  for (int f = 0; f < kVectorFrameCount; ++f) answers.push_back({static_cast<VectorFrame>(f), {}});
  for (int f = 0; f < kVectorFrameCount; ++f) add_turns(static_cast<VectorFrame>(f));
  return answers;
}

/// "--vectors scanner --flip k"; the frame is left out where it is the one that was taken.
std::string words_of(const Orientation& answer, VectorFrame taken) {
  std::string text = answer.frame == taken ? "" : "--vectors " + std::string(name_of(answer.frame));
  const std::string turned = answer.turn.text();
  if (!text.empty() && !turned.empty()) text += ' ';
  return text + turned;
}

/// Whether the borders decide, where neighbours do not or are suspicious. Fills `verdict` then. @param best of the neighbours.
bool judged_by_borders(const DirectionMap& directions, const std::vector<Orientation>& answers,
                       const std::vector<Mat3>& matrices, std::size_t best, OrientationVerdict& verdict) {
  constexpr double kLower =
      0.02;  // of B, that the neighbours' best has to be lower by where the borders exclude nothing
  const std::size_t turns =
      axis_turns().size();  // other frames turn by few degrees, which borders may be bent by
  const BorderVerdict borders = directions.borders().judge(matrices, turns);
  if (!borders.clear) return false;
  if (verdict.suspicious && !borders.excluded[best] &&
      (borders.excluded.front() || borders.across[best] + kLower < borders.across.front())) {
    return false;
  }
  verdict.by_borders = verdict.judged = true;
  verdict.suspicious = borders.excluded.front();
  const std::size_t right = verdict.suspicious ? borders.best : 0;
  verdict.best = answers[right];
  verdict.advice = verdict.best.turn.text();
  verdict.rotated = verdict.suspicious && borders.rotated;
  verdict.gain = 1.0;
  verdict.across = borders.across.front();
  verdict.across_best = borders.across[right];
  for (std::size_t t = 0; t < turns; ++t) {
    if (t != right && !borders.excluded[t]) verdict.alike.push_back(answers[t].turn.text());
  }
  return true;
}

}  // namespace

OrientationVerdict check_orientation(const DirectionMap& directions, const UniformTopology& topology,
                                     const Orientation& taken, int threads) {
  OrientationVerdict verdict{.best = {taken.frame, {}}, .advice = {}};
  if (directions.size() < kLeastCoherent) return verdict;
  const Mat3 turned = Orientation{VectorFrame::kScanner, taken.turn}.matrix(topology.axes);
  const Mat3 undone = glm::transpose(taken.matrix(topology.axes));
  const std::vector<Orientation> answers = answers_to(taken.frame);
  std::vector<Mat3> matrices;
  for (const Orientation& answer : answers) {
    const Mat3 behind = Orientation{VectorFrame::kScanner, answer.turn}.matrix(topology.axes);
    matrices.push_back(behind * turned * matrix_of(answer.frame, topology.axes) * undone);
  }
  const std::vector<Coherence> scores = directions.coherence(matrices, threads);
  constexpr double kBetter = 0.005;  // what a later, less simple answer has to be better by
  std::size_t best = 0;
  for (std::size_t a = 1; a < scores.size(); ++a) {
    if (scores[a].score > scores[best].score + kBetter) best = a;
  }
  constexpr double kByTurn = 0.02;
  const double errors = errors_for(directions.size());
  const bool suspicious = better_by(scores[best], scores.front(), kByTurn, errors);
  constexpr double kLeastSum = 1e-3;  // 1 + s is none below zero
  verdict.gain = (1.0 + scores[best].score) / std::max(1.0 + scores.front().score, kLeastSum);
  verdict.suspicious = suspicious;
  std::vector<Coherence> others(scores.begin() + 1, scores.end());
  const auto middle = others.begin() + static_cast<std::ptrdiff_t>(others.size() / 2);
  std::ranges::nth_element(others, middle, {}, &Coherence::score);
  verdict.judged = suspicious || better_by(scores.front(), *middle, kByTurn, errors);
  if ((suspicious || !verdict.judged) && judged_by_borders(directions, answers, matrices, best, verdict))
    return verdict;
  if (!suspicious) return verdict;
  verdict.best = answers[best];
  verdict.advice = words_of(verdict.best, taken.frame);
  std::vector<Mat3> rotated{matrices[best]};
  for (const Mat3& rotation : slight_rotations()) rotated.push_back(rotation * matrices[best]);
  const std::vector<Coherence> after = directions.coherence(rotated, threads);
  constexpr double kByRotation = 0.01;  // ten degrees change less than another axis does
  verdict.rotated = std::any_of(after.begin() + 1, after.end(), [&](const Coherence& one) {
    return better_by(one, after.front(), kByRotation, kLeastErrors);
  });
  return verdict;
}

}  // namespace palpate
