#include "common/trace/tract/tract_orientation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/field/tensor/diffusion_measures.h"
#include "common/field/tensor/gradient_table.h"
#include "common/field/tensor/peak_field.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

constexpr std::string_view kImageAxes = "ijk", kWorldAxes = "xyz";
/// Below it a main direction is mostly noise.
constexpr double kLeastAnisotropy = 0.2;

/// A short straight part of a line.
struct Piece {
  Vec3 middle{0.0};
  Vec3 direction{0.0};  ///< of unit length
};

/// At most some 4000 pieces, spread evenly over all of them.
std::vector<Piece> sample_pieces(const Tractogram& lines) {
  constexpr std::size_t kMost = 4000;
  const std::size_t all =
      lines.points.size() > lines.line_count() ? lines.points.size() - lines.line_count() : 0;
  const std::size_t stride = std::max<std::size_t>(1, all / kMost);
  std::vector<Piece> pieces;
  std::size_t next = 0, seen = 0;
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    const auto line = lines.line(l);
    for (std::size_t p = 1; p < line.size(); ++p, ++seen) {
      if (seen < next) continue;
      const Vec3 a{line[p - 1]}, b{line[p]};
      const double length = glm::distance(a, b);
      if (!(length > 0.0)) continue;
      pieces.push_back({0.5 * (a + b), (b - a) / length});
      next = seen + stride;
    }
  }
  return pieces;
}

/// The voxels' main directions.
class Directions {
 public:
  explicit Directions(const TensorField& field)
      : field_(field), image_(*field.voxels()), voxel_from_world_(glm::inverse(image_.axes)) {}

  struct Answer {
    double fa = -1.0;  ///< below zero: no tensor
    bool outside = false;
    double cosine = 0.0;
  };
  [[nodiscard]] Answer ask(const Vec3& x, const Vec3& direction) const {
    const Vec3 v = glm::round(voxel_from_world_ * (x - image_.origin));
    for (int axis = 0; axis < 3; ++axis) {
      if (!(v[axis] >= 0.0 && v[axis] < image_.points[axis])) return {.outside = true};
    }
    const TensorSample sample = field_.voxel(Index3{v});
    if (sample.status != SampleStatus::kOk) return {};
    const SymmetricEigen eigen = symmetric_eigen(sample.value);
    const double fa = std::min(1.0, fractional_anisotropy(eigen.values));
    if (!std::isfinite(fa)) return {};
    Vec3 along = eigen.vectors[0];
    if (field_.peaks() != nullptr) {
      const Vec3 peak = field_.peaks()->nearest(x, direction);
      if (peak != Vec3{0.0}) along = glm::normalize(peak);
    }
    return {.fa = fa, .cosine = std::min(1.0, std::abs(glm::dot(direction, along)))};
  }

 private:
  const TensorField& field_;
  UniformTopology image_;
  Mat3 voxel_from_world_{1.0};
};

struct Sum {
  double score = 0.0;
  std::size_t inside = 0, outside = 0;
  double angles = 0.0;  ///< [rad]
  std::size_t with_angle = 0;
};

Sum score_of(const Directions& directions, const std::vector<Piece>& pieces, const AffineMap& map) {
  Sum sum;
  for (const Piece& piece : pieces) {
    const auto answer = directions.ask(map.matrix * piece.middle + map.shift, map.matrix * piece.direction);
    sum.outside += answer.outside ? 1 : 0;
    if (answer.fa < 0.0) continue;
    ++sum.inside;
    sum.score += answer.fa * answer.cosine * answer.cosine;
    if (!(answer.fa > kLeastAnisotropy)) continue;
    sum.angles += std::acos(answer.cosine);
    ++sum.with_angle;
  }
  return sum;
}

/// The identity first.
std::vector<TractTurn> all_turns() {
  std::vector<TractTurn> turns;
  std::array<int, 3> from{0, 1, 2};
  const auto add_flips = [&](bool of_image, unsigned first) {
    for (unsigned flips = first; flips < 8; ++flips)
      turns.push_back({of_image, from, {(flips & 1U) != 0, (flips & 2U) != 0, (flips & 4U) != 0}});
  };
  do {
    add_flips(true, 0);
  } while (std::next_permutation(from.begin(), from.end()));
  add_flips(false, 1);  // next_permutation() ends at the first order again
  return turns;
}

}  // namespace

bool TractTurn::is_identity() const noexcept {
  return from == std::array<int, 3>{0, 1, 2} && flipped == std::array<bool, 3>{};
}

std::string TractTurn::text() const {
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += ',';
    if (flipped[axis]) text += '-';
    text += (of_image ? kImageAxes : kWorldAxes)[as_size(from[axis])];
  }
  return text;
}

TractTurn parse_tract_turn(std::string_view text) {
  const auto refuse = [&text] {
    throw usage_error(
        "a turn of tracts is written i,-j,k (the image's axes, about its centre) or -x,-y,z (about "
        "the origin), each axis once; found '" +
        std::string(text) + "'");
  };
  TractTurn turn;
  std::string_view left = text;
  unsigned seen = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis > 0) {
      if (!left.starts_with(',')) refuse();
      left.remove_prefix(1);
    }
    turn.flipped[axis] = left.starts_with('-');
    if (turn.flipped[axis]) left.remove_prefix(1);
    if (left.empty()) refuse();
    const std::size_t image = kImageAxes.find(left.front()), world = kWorldAxes.find(left.front());
    const bool of_image = image != std::string_view::npos;
    if ((!of_image && world == std::string_view::npos) || (axis > 0 && of_image != turn.of_image)) refuse();
    turn.of_image = of_image;
    turn.from[axis] = static_cast<int>(of_image ? image : world);
    seen |= 1U << static_cast<unsigned>(turn.from[axis]);
    left.remove_prefix(1);
  }
  if (seen != 7U || !left.empty()) refuse();
  return turn;
}

AffineMap map_of(const TractTurn& turn, const UniformTopology& image) {
  Mat3 signs{0.0};
  for (std::size_t row = 0; row < 3; ++row)
    signs[turn.from[row]][static_cast<int>(row)] = turn.flipped[row] ? -1.0 : 1.0;
  if (!turn.of_image) return {signs, Vec3{0.0}};
  const Mat3 axes = image_axes(image.axes);
  const Mat3 matrix = axes * signs * glm::transpose(axes);
  const Vec3 centre = image.origin + image.axes * (0.5 * (Vec3{image.points} - 1.0));
  return {matrix, centre - matrix * centre};
}

void turn_tracts(const AffineMap& map, Tractogram& lines) {
  for (Vec3f& x : lines.points) x = Vec3f{map.matrix * Vec3{x} + map.shift};
}

TractFit fit_of_tracts(const TensorField& field, const Tractogram& lines, int threads) {
  if (!field.voxels()) throw usage_error("tracts are compared with tensors of an image with even steps only");
  const Directions directions(field);
  const std::vector<Piece> pieces = sample_pieces(lines);
  const std::vector<TractTurn> turns = all_turns();
  std::vector<Sum> sums(turns.size());
  parallel_for(turns.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t t = first; t < last; ++t)
      sums[t] = score_of(directions, pieces, map_of(turns[t], *field.voxels()));
  });

  TractFit fit;
  fit.pieces = pieces.size();
  if (pieces.empty()) return fit;
  const auto count = static_cast<double>(pieces.size());
  const Sum& as_is = sums.front();
  fit.inside = static_cast<double>(as_is.inside) / count;
  fit.outside = static_cast<double>(as_is.outside) / count;
  fit.score = as_is.score / count;
  fit.anisotropic = as_is.with_angle;
  if (as_is.with_angle > 0)
    fit.angle = as_is.angles / static_cast<double>(as_is.with_angle) * 180.0 / std::numbers::pi;
  const auto best = std::max_element(sums.begin(), sums.end(),
                                     [](const Sum& a, const Sum& b) { return a.score < b.score; });
  if (!(best->score > 0.0)) return fit;
  fit.best = turns[as_size(best - sums.begin())];
  fit.gain = as_is.score > 0.0 ? best->score / as_is.score : std::numeric_limits<double>::infinity();
  // Heads are nearly symmetric: of left and right exchanged, bundles fit nearly as well.
  constexpr double kClear = 1.1;
  constexpr std::size_t kLeastPieces = 100;
  fit.suspicious = fit.gain > kClear && best->inside >= kLeastPieces;
  return fit;
}

std::string fit_sentence(const TractFit& fit, const std::string& option) {
  std::string text = short_number(std::round(1000.0 * fit.inside) / 10.0) + " % of " +
                     counted(fit.pieces, "sampled piece") + " lie where there is a tensor, ";
  text += fit.anisotropic > 0 ? short_number(std::round(10.0 * fit.angle) / 10.0) +
                                    " degrees from the main direction on average"
                              : "none where FA is above 0.2";
  if (fit.strays())
    text += "; " + short_number(std::round(1000.0 * fit.outside) / 10.0) +
            " % lie beyond the image: are these the tracts of another one?";
  if (!fit.suspicious) return (fit.strays() ? "WARNING: " : "") + text;
  return "WARNING: " + text + "; turned they fit " +
         (std::isfinite(fit.gain) ? short_number(std::round(100.0 * (fit.gain - 1.0))) + " % better"
                                  : "at all") +
         ": the tracts may have other axes than the image; try " + option + "=" + fit.best.text();
}

}  // namespace palpate
