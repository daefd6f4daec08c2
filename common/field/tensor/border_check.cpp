#include "common/field/tensor/border_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/index.h"
#include "common/math/lattice.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

constexpr std::size_t kParts = BorderMap::kParts;
constexpr auto kPartCount = static_cast<double>(kParts);
/// Fewer voxels have no border that can be trusted.
constexpr std::size_t kLeastVoxels = 300;

/// FA and the logarithm of MD over the usual one, within what tissue has: beyond it there is noise.
Vec2 shape_of(const std::array<float, 2>& shape, double usual) {
  constexpr double kLeast = 0.125, kMost = 5.0;
  return {std::clamp(static_cast<double>(shape[0]), 0.0, 1.0),
          std::log(std::clamp(static_cast<double>(shape[1]) / usual, kLeast, kMost))};
}

/// Both estimates of both gradients at a point, along the axes of the grid.
struct Gradients {
  std::array<Vec3, 2> near{}, far{};
};

/// The 26 steps to the neighbours of a point.
const std::vector<Index3>& neighbours() {
  static const std::vector<Index3> steps = [] {
    std::vector<Index3> all;
    for (int k = -1; k <= 1; ++k) {
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          if (i != 0 || j != 0 || k != 0) all.emplace_back(i, j, k);
        }
      }
    }
    return all;
  }();
  return steps;
}

/// False where a neighbour has no tensor. @param at no point of the image's rim.
bool gradients_at(std::span<const std::array<float, 2>> shape, const Index3& points, const Index3& at,
                  double usual, Gradients& out) {
  // Sums of the squares of steps along an axis: 2 of the six nearest, 16 of the twenty others.
  constexpr double kNear = 2.0, kFar = 16.0;
  out = {};
  for (const Index3& step : neighbours()) {
    const auto& there = shape[index_in(points, at + step)];
    if (!std::isfinite(there[0]) || !std::isfinite(there[1])) return false;
    const Vec2 value = shape_of(there, usual);
    const bool nearest = std::abs(step.x) + std::abs(step.y) + std::abs(step.z) == 1;
    for (int channel = 0; channel < 2; ++channel) {
      (nearest ? out.near : out.far)[as_size(channel)] +=
          value[channel] / (nearest ? kNear : kFar) * Vec3(step);
    }
  }
  return true;
}

/// 1 where all neighbours have the direction of the point, 0 where theirs are any: noise has a direction, too.
double agreement(std::span<const std::array<float, 4>> directions, const Index3& points, const Index3& at) {
  const auto direction_at = [&](const Index3& place) {
    const auto& d = directions[index_in(points, place)];
    return d[3] > 0.0F ? Vec3{d[0], d[1], d[2]} : Vec3{0.0};
  };
  constexpr double kAny = 1.0 / 3.0;  // mean square of the cosine of two directions, and of no direction
  const Vec3 here = direction_at(at);
  double sum = 0.0;
  for (const Index3& step : neighbours()) {
    const Vec3 there = direction_at(at + step);
    const double cosine = glm::dot(here, there);
    sum += there == Vec3{0.0} ? kAny : cosine * cosine;
  }
  const double mean = sum / static_cast<double>(neighbours().size());
  return std::max(0.0, (mean - kAny) / (1.0 - kAny));
}

/// The usual MD of the points that count: their median.
double usual_of(std::span<const std::array<float, 4>> directions,
                std::span<const std::array<float, 2>> shape) {
  std::vector<float> sizes;
  for (std::size_t v = 0; v < directions.size(); ++v) {
    if (directions[v][3] > 0.0F) sizes.push_back(shape[v][1]);
  }
  if (sizes.empty()) return 0.0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);
  return *middle;
}

/// A point that counts, and the part of the image that it is in.
struct Counted {
  Index3 at{0};
  std::size_t point = 0;
  double weight = 0.0;
};

/// Where along `axis` each part ends: as much weight in each.
std::vector<std::size_t> part_of_planes(const std::vector<Counted>& counted, int axis, int planes) {
  std::vector<double> weight(as_size(planes), 0.0);
  double total = 0.0;
  for (const Counted& one : counted) {
    weight[as_size(one.at[axis])] += one.weight;
    total += one.weight;
  }
  std::vector<std::size_t> part(as_size(planes), 0);
  double before = 0.0;
  for (std::size_t plane = 0; plane < part.size(); ++plane) {
    part[plane] =
        std::min(kParts - 1, static_cast<std::size_t>(kPartCount * (before + 0.5 * weight[plane]) / total));
    before += weight[plane];
  }
  return part;
}

/// The axis of the grid along which the points lie furthest apart.
int longest_axis(const std::vector<Counted>& counted, const Mat3& axes) {
  Vec3 sum{0.0}, squares{0.0};
  double total = 0.0;
  for (const Counted& one : counted) {
    const Vec3 at(one.at);
    sum += one.weight * at;
    squares += one.weight * at * at;
    total += one.weight;
  }
  int longest = 0;
  double most = -1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double mean = sum[axis] / total;
    const double spread = (squares[axis] / total - mean * mean) * glm::dot(axes[axis], axes[axis]);
    if (spread > most) {
      most = spread;
      longest = axis;
    }
  }
  return longest;
}

/// (1) over its denominator: numerator for a turn, and denominator.
double across_sum(const BorderSums& part, const Mat3& turn) {
  // The six numbers xx, xy, xz, yy, yz, zz; those beside the diagonal stand twice.
  constexpr std::array<std::array<int, 2>, 6> kPlaces{{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};
  double sum = 0.0;
  for (std::size_t n = 0; n < kPlaces.size(); ++n) {
    const auto [row, column] = kPlaces[n];
    const Mat3 turned = turn * part.products[n] * glm::transpose(turn);
    sum += (row == column ? 1.0 : 2.0) * turned[column][row];
  }
  return sum;
}

double trace(const Mat3& m) { return m[0][0] + m[1][1] + m[2][2]; }

/// A number of the whole, and of the whole without each part.
struct Jackknifed {
  double all = 0.0;
  std::array<double, kParts> without{};

  [[nodiscard]] double error() const {
    double mean = 0.0, squares = 0.0;
    for (const double value : without) mean += value / kPartCount;
    for (const double value : without) squares += (value - mean) * (value - mean);
    return std::sqrt((kPartCount - 1.0) / kPartCount * squares);
  }
  Jackknifed operator-(const Jackknifed& other) const {
    Jackknifed difference{all - other.all, {}};
    for (std::size_t p = 0; p < kParts; ++p) difference.without[p] = without[p] - other.without[p];
    return difference;
  }
};

/// The axis of the borders and the mean direction of a part; how far the borders have an axis.
struct PartAxes {
  Vec3 borders{0.0}, directions{0.0};
  double weight = 0.0;
};

std::vector<PartAxes> axes_of(const std::array<BorderSums, kParts>& parts) {
  std::vector<PartAxes> axes;
  for (const BorderSums& part : parts) {
    const SymmetricEigen borders = symmetric_eigen(part.borders);
    if (!(borders.values[0] > 0.0)) continue;
    axes.push_back({borders.vectors[2], symmetric_eigen(part.directions).vectors[0],
                    (borders.values[1] - borders.values[2]) / borders.values[0]});
  }
  return axes;
}

Vec3 towards(const Vec3& line, const Vec3& direction) {
  return glm::dot(line, direction) < 0.0 ? -line : line;
}

/// Whether (2) says that `right` is right where `taken` was taken.
bool leans_to(const std::vector<PartAxes>& parts, const Mat3& taken, const Mat3& right) {
  constexpr std::size_t kLeastParts = 4;
  constexpr double kNearBy = 0.5;  // cosine; turns further apart are for (1)
  constexpr double kLeastSlope = 0.6, kMostSlope = 1.5, kErrors = 3.5;
  // Slices that moved, sampled coarsely, lean a made cord by five degrees against its fibres; a flip has to do more.
  constexpr double kLeastSine = 0.13917310096007;  // of eight degrees
  double xx = 0.0, xy = 0.0, yy = 0.0, weights = 0.0;
  std::size_t count = 0;
  for (const PartAxes& part : parts) {
    const Vec3 e = taken * part.directions, other = towards(right * part.directions, e);
    if (glm::dot(e, other) < kNearBy) continue;
    const Vec3 a = towards(part.borders, e);
    const Vec3 x = other - glm::dot(e, other) * e, y = a - glm::dot(e, a) * e;
    xx += part.weight * glm::dot(x, x);
    xy += part.weight * glm::dot(x, y);
    yy += part.weight * glm::dot(y, y);
    weights += part.weight;
    ++count;
  }
  if (count < kLeastParts || !(xx > kLeastSine * kLeastSine * weights)) return false;
  const double slope = xy / xx;
  if (!(slope > kLeastSlope && slope < kMostSlope)) return false;
  const double rest = std::max(0.0, yy - slope * xy) / (static_cast<double>(count) - 1.0);
  return slope * std::sqrt(xx) > kErrors * std::sqrt(rest);
}

/// Whether directions are turned from the borders alike in all parts.
bool turned_alike(const std::vector<PartAxes>& parts, const Mat3& turn) {
  constexpr double kLeastSine = 0.17364817766693;  // of ten degrees
  constexpr double kErrors = 3.0;
  Vec3 mean{0.0};
  double weights = 0.0, squares = 0.0;
  for (const PartAxes& part : parts) {
    const Vec3 e = turn * part.directions;
    const Vec3 rotation = glm::cross(e, towards(part.borders, e));
    mean += part.weight * rotation;
    squares += part.weight * glm::dot(rotation, rotation);
    weights += part.weight;
  }
  if (parts.size() < 2 || !(weights > 0.0)) return false;
  mean /= weights;
  const double size = glm::length(mean);
  const double spread =
      std::max(0.0, squares / weights - size * size) / (static_cast<double>(parts.size()) - 1.0);
  return size > kLeastSine && size > kErrors * std::sqrt(spread);
}

}  // namespace

BorderMap::BorderMap(std::span<const std::array<float, 4>> directions,
                     std::span<const std::array<float, 2>> shape, const UniformTopology& topology) {
  const Index3 points = topology.points;
  const double usual = usual_of(directions, shape);
  if (!(usual > 0.0)) return;
  std::vector<Counted> counted;
  std::vector<Gradients> gradients;
  for (int k = 1; k + 1 < points.z; ++k) {
    for (int j = 1; j + 1 < points.y; ++j) {
      for (int i = 1; i + 1 < points.x; ++i) {
        const Index3 at{i, j, k};
        const std::size_t point = index_in(points, at);
        const double fa = directions[point][3];
        Gradients here;
        if (!(fa > 0.0) || !gradients_at(shape, points, at, usual, here)) continue;
        const double agreed = agreement(directions, points, at);
        if (!(agreed > 0.0)) continue;
        counted.push_back({at, point, fa * fa * agreed});
        gradients.push_back(here);
      }
    }
  }
  count_ = counted.size();
  if (counted.empty()) return;
  const int axis = longest_axis(counted, topology.axes);
  step_ = std::cbrt(std::abs(glm::determinant(topology.axes)));
  const std::vector<std::size_t> part_of = part_of_planes(counted, axis, points[axis]);
  const Mat3 to_data = glm::transpose(glm::inverse(topology.axes));
  for (std::size_t n = 0; n < counted.size(); ++n) {
    const Counted& one = counted[n];
    BorderSums& part = parts_[part_of[as_size(one.at[axis])]];
    Mat3 borders{0.0};
    for (std::size_t channel = 0; channel < 2; ++channel) {
      const Mat3 product =
          glm::outerProduct(to_data * gradients[n].near[channel], to_data * gradients[n].far[channel]);
      borders += 0.5 * (product + glm::transpose(product));
    }
    const auto& d = directions[one.point];
    const Vec3 e{d[0], d[1], d[2]};
    const Mat3 along = one.weight * glm::outerProduct(e, e);
    part.borders += one.weight * borders;
    part.directions += along;
    const std::array<double, 6> six = six_numbers(borders);
    for (std::size_t c = 0; c < six.size(); ++c) part.products[c] += six[c] * along;
  }
}

BorderVerdict BorderMap::judge(std::span<const Mat3> turns, std::size_t answers) const {
  constexpr double kLeastErrors = 5.0;   // that the borders have to be there by
  constexpr double kLeastBorder = 1e-6;  // their square, a voxel: less is rounding
  constexpr double kFollowed = 0.1;      // B of directions that follow them
  constexpr double kAcross = 0.15, kAcrossErrors = 4.0;
  constexpr double kAlike = 0.005;  // of B: a later turn has to be better by more
  BorderVerdict verdict;
  if (count_ < kLeastVoxels || answers == 0) return verdict;
  // Everything, then everything without each part.
  const auto jackknifed = [&](const auto& sum_of) {
    Jackknifed sums;
    std::array<double, kParts> each{};
    for (std::size_t p = 0; p < kParts; ++p) sums.all += each[p] = sum_of(parts_[p]);
    for (std::size_t p = 0; p < kParts; ++p) sums.without[p] = sums.all - each[p];
    return sums;
  };
  const Jackknifed borders = jackknifed([](const BorderSums& part) { return trace(part.borders); });
  const double weight = jackknifed([](const BorderSums& part) { return trace(part.directions); }).all;
  if (!(borders.all > kLeastErrors * borders.error() && borders.all * step_ * step_ > kLeastBorder * weight))
    return verdict;
  std::vector<Jackknifed> across;
  for (const Mat3& turn : turns) {
    Jackknifed sums = jackknifed([&](const BorderSums& part) { return across_sum(part, turn); });
    sums.all /= borders.all;
    for (std::size_t p = 0; p < kParts; ++p) sums.without[p] /= borders.without[p];
    verdict.across.push_back(sums.all);
    across.push_back(sums);
  }
  const auto least = as_size(std::ranges::min_element(std::span(verdict.across).first(answers)) -
                             std::span(verdict.across).begin());
  if (verdict.across[least] > kFollowed) return verdict;
  for (const Jackknifed& one : across) {
    const Jackknifed worse = one - across[least];
    verdict.excluded.push_back(worse.all > kAcross && worse.all > kAcrossErrors * worse.error());
  }
  const std::vector<PartAxes> axes = axes_of(parts_);
  const std::vector<bool> far = verdict.excluded;
  for (std::size_t taken = 0; taken < turns.size(); ++taken) {
    for (std::size_t right = 0; right < answers && !verdict.excluded[taken]; ++right) {
      if (far[right] || verdict.across[right] >= verdict.across[taken]) continue;
      verdict.excluded[taken] = leans_to(axes, turns[taken], turns[right]);
    }
  }
  double lowest = HUGE_VAL;
  for (std::size_t t = 0; t < answers; ++t) {
    if (!verdict.excluded[t]) lowest = std::min(lowest, verdict.across[t]);
  }
  verdict.clear = lowest < HUGE_VAL;
  while (verdict.clear && (verdict.excluded[verdict.best] || verdict.across[verdict.best] > lowest + kAlike))
    ++verdict.best;
  verdict.rotated = verdict.clear && turned_alike(axes, turns[verdict.best]);
  return verdict;
}

}  // namespace palpate
