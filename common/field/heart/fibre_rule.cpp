#include "common/field/heart/fibre_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "common/field/layer/laplace.h"
#include "common/field/layer/wall_coordinates.h"
#include "common/field/layer/way_lengths.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

/// Length of a mean of unit directions below which they do not agree on one.
constexpr double kAgree = 0.3;
/// Sine of the angle between the ways along and through the wall below which there is no way round it.
constexpr double kApart = 0.1;

/// The solutions of Laplace's equation; all but two are empty where there is one ventricle, `through` (phi_t) and
/// `between` (b, before it is scaled) where the rule is none of kDoste.
struct RulePotentials {
  std::vector<double> psi, epi, left, right, through, between;
  std::vector<std::uint32_t> apex;
};

RulePotentials rule_potentials(const FieldGrid& grid, const WallSurfaces& surfaces, FibreRule rule,
                               const std::string& file, int threads) {
  RulePotentials made;
  WallAxis axis = find_wall_axis(grid, surfaces, file, threads);
  made.psi = std::move(axis.potential);
  made.apex = std::move(axis.apex);
  const auto solve = [&](double epi, double left, double right) {
    std::vector<double> given(grid.tets->points().size(), std::numeric_limits<double>::quiet_NaN());
    give_on(surfaces, BorderRole::kOuter, epi, given);
    give_on(surfaces, BorderRole::kSeptum, right, given);
    give_on(surfaces, BorderRole::kRight, right, given);
    give_on(surfaces, BorderRole::kInner, left, given);
    return solve_laplace(*grid.tets, given, file, threads).values;
  };
  if (surfaces.has(BorderRole::kRight) || surfaces.has(BorderRole::kSeptum)) {
    made.epi = solve(1.0, 0.0, 0.0);
    made.left = solve(0.0, 1.0, 0.0);
    made.right = solve(0.0, 0.0, 1.0);
    if (rule == FibreRule::kDoste) {
      made.through = solve(0.0, -2.0, 1.0);
      made.between = solve(std::numeric_limits<double>::quiet_NaN(), -2.0, 1.0);
    }
  } else {
    made.epi = solve_laplace(*grid.tets, depths_on(surfaces), file, threads).values;
  }
  return made;
}

/// What the rule asks for in a cell.
struct RuleCell {
  Vec3 psi{0.0}, epi{0.0}, left{0.0}, right{0.0};  ///< means of unit directions of gradients
  double d = 0.0, r = 0.0;
  double through = 0.0, between = 0.0;  ///< phi_t and b
};

/// What lies between -2 and 1, as -1 to 1.
double scaled(double potential) { return potential < 0.0 ? 0.5 * potential : potential; }

/// alpha and beta of (5).
std::pair<double, double> doste_angles(double d, double through, double b, const RuleAngles& angles) {
  const double s = std::abs(scaled(through)), w = 0.5 * (1.0 + b);
  return {
      (b < 0.0 ? angles.endo : angles.right_endo) * s + ((1.0 - w) * angles.epi + w * angles.right_epi) * d,
      angles.transverse_endo * s + angles.transverse_epi * d};
}

/// The part of `v` across `along`, unit; nothing where it has none, or `v` is no direction.
std::optional<Vec3> made_across(const Vec3& v, const Vec3& along) {
  const Vec3 across = v - glm::dot(v, along) * along;
  if (!(glm::length(v) > kAgree) || !(glm::length(across) > kApart * glm::length(v))) return std::nullopt;
  return glm::normalize(across);
}

/// A way through the wall, and the angle that belongs to it.
struct TurnedWay {
  Vec3 way{0.0};
  double alpha = 0.0, beta = 0.0;
};

/// From `from` to `to` by a part of the way, about `axis`, where directions have no sign: where `to` is turned
/// back its angles change their sign, too.
TurnedWay mixed(const TurnedWay& from, const TurnedWay& to, double part, const Vec3& axis) {
  constexpr double kPi = std::numbers::pi;
  const double turn = std::atan2(glm::dot(glm::cross(from.way, to.way), axis), glm::dot(from.way, to.way));
  const bool back = std::abs(turn) > 0.5 * kPi;
  const double angle = part * (back ? turn - std::copysign(kPi, turn) : turn);
  const double sign = back ? -1.0 : 1.0;
  return {.way = std::cos(angle) * from.way + std::sin(angle) * glm::cross(axis, from.way),
          .alpha = (1.0 - part) * from.alpha + part * sign * to.alpha,
          .beta = (1.0 - part) * from.beta + part * sign * to.beta};
}

/// (4)
Mat3 oriented(const Vec3& e_l, const TurnedWay& by) {
  const Vec3 e_c = glm::cross(e_l, by.way);
  const Vec3 f = std::cos(by.alpha) * e_c + std::sin(by.alpha) * e_l;
  const Vec3 l = -std::sin(by.alpha) * e_c + std::cos(by.alpha) * e_l;
  return {f, std::cos(by.beta) * l - std::sin(by.beta) * by.way,
          std::sin(by.beta) * l + std::cos(by.beta) * by.way};
}

/// (6)
Mat3 turned_out(const Vec3& e_l, const TurnedWay& by) {
  const Vec3 e_c = glm::cross(e_l, by.way);
  const Vec3 along = std::cos(by.alpha) * e_c + std::sin(by.alpha) * e_l;
  return {std::cos(by.beta) * along - std::sin(by.beta) * by.way,
          -std::sin(by.alpha) * e_c + std::cos(by.alpha) * e_l,
          std::sin(by.beta) * along + std::cos(by.beta) * by.way};
}

/// Of Bayer et al.: between frames whose axes have no sign.
Mat3 bislerp(const Mat3& from, const Mat3& to, double part) {
  using Turn = glm::dquat;
  const Turn a = glm::quat_cast(from), b = glm::quat_cast(to);
  Turn nearest = a;
  double most = -1.0;
  for (const Turn& half : {Turn(1.0, 0.0, 0.0, 0.0), Turn(0.0, 1.0, 0.0, 0.0), Turn(0.0, 0.0, 1.0, 0.0),
                           Turn(0.0, 0.0, 0.0, 1.0)}) {
    const Turn each = a * half;
    if (!(std::abs(glm::dot(each, b)) > most)) continue;
    most = std::abs(glm::dot(each, b));
    nearest = each;
  }
  return glm::mat3_cast(glm::slerp(nearest, b, part));  // the shorter way
}

/// The frame of (6); nothing where (1) is not defined.
std::optional<Mat3> doste_frame(const RuleCell& cell, const RuleAngles& angles) {
  const Vec3 e_l = glm::normalize(cell.psi);
  const auto inside = made_across(cell.between < 0.0 ? -cell.left : -cell.right, e_l),
             epi = made_across(cell.epi, e_l);
  if (cell.d < 0.5 ? !inside : !epi) return std::nullopt;
  const auto [alpha, beta] = doste_angles(cell.d, cell.through, cell.between, angles);
  const TurnedWay outwards{epi.value_or(Vec3{0.0}), alpha, beta};
  if (!inside) return turned_out(e_l, outwards);
  const TurnedWay from{*inside, alpha, beta};
  if (!epi) return turned_out(e_l, from);
  // Both lead out of the cavity. Where they do not agree, deep in a septum, the epicardium's weighs little.
  TurnedWay way = mixed(from, outwards, cell.d, e_l);
  way.alpha = alpha;
  way.beta = beta;
  return turned_out(e_l, way);
}

/// Fibre and sheet, columns 0 and 2; nothing where (1) is not defined.
std::optional<Mat3> frame_of(const RuleCell& cell, FibreRule rule, const RuleAngles& angles) {
  if (!(glm::length(cell.psi) > kAgree)) return std::nullopt;
  if (rule == FibreRule::kDoste) return doste_frame(cell, angles);
  const Vec3 e_l = glm::normalize(cell.psi);
  double d = cell.d, r = cell.r;
  const auto left = made_across(-cell.left, e_l), right = made_across(cell.right, e_l),
             epi = made_across(cell.epi, e_l);
  // What weighs less may be undefined, as the epicardium's gradient in the middle of a septum.
  const bool inside = r < 0.5 ? left.has_value() : right.has_value();
  if (d < 0.5 ? !inside : !epi) return std::nullopt;
  if (!inside) return oriented(e_l, {*epi, angles.epi, angles.sheet_epi});
  if (!left) r = 1.0;
  if (!right) r = 0.0;
  if (!epi) d = 0.0;
  const double alpha_s = angles.endo * (1.0 - 2.0 * r), beta_s = angles.sheet_endo * (1.0 - 2.0 * r);
  const TurnedWay of_left{left.value_or(Vec3{0.0}), alpha_s, beta_s},
      of_right{right.value_or(Vec3{0.0}), alpha_s, beta_s};
  TurnedWay of_epi{epi.value_or(Vec3{0.0}), angles.epi, angles.sheet_epi};
  if (rule == FibreRule::kBayer) {
    const TurnedWay endo = r <= 0.0 ? of_left : r >= 1.0 ? of_right : mixed(of_left, of_right, r, e_l);
    return oriented(e_l, d <= 0.0 ? endo : mixed(endo, of_epi, d, e_l));
  }
  const Mat3 endo = r <= 0.0   ? oriented(e_l, of_left)
                    : r >= 1.0 ? oriented(e_l, of_right)
                               : bislerp(oriented(e_l, of_left), oriented(e_l, of_right), r);
  if (d <= 0.0) return endo;
  of_epi.alpha = angles.endo * (1.0 - d) + angles.epi * d;
  of_epi.beta = angles.sheet_endo * (1.0 - d) + angles.sheet_epi * d;
  return bislerp(endo, oriented(e_l, of_epi), d);
}

/// alpha of (3), or of (5), at a point.
double alpha_at(std::uint32_t p, const RulePotentials& potentials, FibreRule rule, const RuleAngles& angles) {
  const double d = potentials.epi[p];
  if (rule == FibreRule::kDoste)
    return potentials.through.empty()
               ? doste_angles(d, 2.0 * (d - 1.0), -1.0, angles).first
               : doste_angles(d, potentials.through[p], scaled(potentials.between[p]), angles).first;
  double endo = angles.endo;
  if (!potentials.right.empty()) {
    const double both = potentials.right[p] + potentials.left[p];
    endo *= both > 0.0 ? 1.0 - 2.0 * potentials.right[p] / both : 0.0;
  }
  return endo * (1.0 - d) + angles.epi * d;
}

/// By how much it differs between the points of a cell; NaN where it is not known at one of them.
double turn_within(const TetMesh::Tet& tet, const RulePotentials& potentials, FibreRule rule,
                   const RuleAngles& angles) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const std::uint32_t p : tet) {
    const double alpha = alpha_at(p, potentials, rule, angles);
    if (!std::isfinite(alpha)) return std::numeric_limits<double>::quiet_NaN();
    low = std::min(low, alpha);
    high = std::max(high, alpha);
  }
  return high - low;
}

void state_turns(const TetMesh& mesh, const RulePotentials& potentials, FibreRule rule,
                 const RuleAngles& angles, RuleFibres& made) {
  std::vector<double> turns;
  for (const TetMesh::Tet& tet : mesh.cells()) {
    const double turn = turn_within(tet, potentials, rule, angles);
    if (std::isfinite(turn)) turns.push_back(turn);
  }
  if (turns.empty()) return;
  std::sort(turns.begin(), turns.end());
  made.median_turn = turns[turns.size() / 2];
  made.most_turn = turns[turns.size() * 95 / 100];
}

Vec3 mean_axis(const Mat3& products) { return symmetric_eigen(products).vectors[0]; }

/// Gives undefined cells the mean of their neighbours, ring by ring.
void fill(const TetMesh& mesh, std::vector<bool>& defined, RuleFibres& made) {
  for (bool more = true; more;) {
    more = false;
    const std::vector<bool> known = defined;
    for (std::size_t c = 0; c < known.size(); ++c) {
      if (known[c]) continue;
      Mat3 fibres{0.0}, sheets{0.0};
      bool some = false;
      for (const CellIndex beside : mesh.neighbors()[c]) {
        if (beside == kNoCell || !known[as_size(beside)]) continue;
        const Vec3 f = made.fibres[as_size(beside)], s = made.sheets[as_size(beside)];
        fibres += glm::outerProduct(f, f);
        sheets += glm::outerProduct(s, s);
        some = true;
      }
      if (!some) continue;
      const Vec3 f = mean_axis(fibres);
      const Mat3 across = Mat3{1.0} - glm::outerProduct(f, f);
      made.fibres[c] = f;
      made.sheets[c] = mean_axis(across * sheets * across);
      defined[c] = true;
      more = true;
    }
  }
}

}  // namespace

RuleFibres make_rule_fibres(const FieldGrid& grid, const WallSurfaces& surfaces, FibreRule rule,
                            const RuleAngles& angles, const std::string& file, int threads) {
  const TetMesh& mesh = *grid.tets;
  const RulePotentials potentials = rule_potentials(grid, surfaces, rule, file, threads);
  const bool two = !potentials.right.empty();
  const std::vector<Vec3> psi = gradient_directions(mesh, potentials.psi),
                          epi = gradient_directions(mesh, potentials.epi);
  std::vector<Vec3> left, right;
  if (two) {
    left = gradient_directions(mesh, potentials.left);
    right = gradient_directions(mesh, potentials.right);
  }

  RuleFibres made;
  made.fibres.assign(mesh.cells().size(), Vec3{0.0});
  made.sheets = made.fibres;
  std::vector<bool> defined(made.fibres.size());
  for (std::size_t c = 0; c < made.fibres.size(); ++c) {
    const TetMesh::Tet& tet = mesh.cells()[c];
    const auto mean = [&tet](const auto& of_points) {
      return 0.25 * (of_points[tet[0]] + of_points[tet[1]] + of_points[tet[2]] + of_points[tet[3]]);
    };
    RuleCell cell{.psi = mean(psi), .epi = mean(epi), .d = mean(potentials.epi)};
    cell.left = -cell.epi;
    cell.through = 2.0 * (cell.d - 1.0);
    cell.between = -1.0;
    if (two && rule == FibreRule::kDoste) {
      cell.through = mean(potentials.through);
      cell.between = scaled(mean(potentials.between));
    }
    if (two) {
      cell.left = mean(left);
      cell.right = mean(right);
      const double of_right = mean(potentials.right), of_both = of_right + mean(potentials.left);
      cell.r = of_both > 0.0 ? of_right / of_both : 0.0;
    }
    if (!std::isfinite(cell.d) || !std::isfinite(cell.r) || !std::isfinite(cell.through + cell.between))
      continue;
    const auto frame = frame_of(cell, rule, angles);
    if (!frame) continue;
    defined[c] = true;
    made.fibres[c] = (*frame)[0];
    made.sheets[c] = (*frame)[2];
  }

  for (std::size_t c = 0; c < defined.size(); ++c) {
    if (defined[c]) continue;
    ++made.undefined;
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t p : potentials.apex)
      nearest = std::min(
          nearest, glm::distance(mesh.points()[p], mesh.position(static_cast<CellIndex>(c), Vec4{0.25})));
    made.farthest = std::max(made.farthest, nearest * grid.frame.length_scale());
  }
  fill(mesh, defined, made);
  state_turns(mesh, potentials, rule, angles, made);
  made.without = as_size(std::count(defined.begin(), defined.end(), false));
  return made;
}

}  // namespace palpate
