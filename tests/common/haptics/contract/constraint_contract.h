/// What every constraint promises, as one suite of tests that runs over all of them.
///
/// To register a constraint, write a file beside this one that says how it is made and where its feature is,
///
///   INSTANTIATE_TEST_SUITE_P(Sphere, ConstraintContract, ::testing::Values(sphere()), subject_name);
///
/// Its name ends in _subjects.cpp, and so it is built. tests/layout fails where a constraint has no subject. The promises stand in constraint_contract_test.cpp, a test each.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/haptics/constraint.h"

namespace palpate::test {

/// Where and how large the data of a subject lies. x_moved = rotation x + shift, in the workspace; the data
/// is 2^exponent as large and the workspace shows it at 2^-exponent, so that this alone changes nothing
/// there.
struct Placement {
  Mat3 rotation{1.0};
  Vec3 shift{0.0};  ///< [m]
  int exponent = 0;
  double turn = 0.0;  ///< [rad] by which a frame that the data leaves undefined is turned about its last axis

  [[nodiscard]] Vec3 point(const Vec3& x) const { return rotation * x + shift; }
  [[nodiscard]] Vec3 direction(const Vec3& d) const { return rotation * d; }
  [[nodiscard]] Mat3 turned_axes() const {
    const double c = std::cos(turn), s = std::sin(turn);
    return rotation * Mat3{Vec3{c, s, 0.0}, Vec3{-s, c, 0.0}, Vec3{0.0, 0.0, 1.0}};
  }
};

/// A constraint under test. Positions in the workspace [m], as placed by Placement{} unless stated.
struct ContractSubject {
  std::string name;

  /// Makes it with its settings applied; whatever it rests on lives as long.
  std::function<std::shared_ptr<Constraint>(const Placement&)> make;

  /// Where the probe goes, s from 0 to 1: a continuous way of some 0.1 to 10 m on which it is held.
  std::function<Vec3(double s)> path;
  /// Updates at path(0) after which the constraint has all that it needs there (a line grows).
  int settling = 1;

  /// How far the proxy lies from its feature [m], found without the constraint's own code.
  std::function<double(const Vec3& probe, const LinkUpdate& link)> off_feature;
  double feature_error = 1e-12;  ///< of the feature itself, on top of the reported residual [m]

  /// |df| <= slope |dx| of the spring's stretch f = K (p - x) / k along the path.
  double slope = 1.0;
  /// Largest leap of f where the rule itself leaps, from tooth to tooth [m].
  double leap = 0.0;

  bool movable = true;         ///< Placement's rotation and shift can be had (grids cannot be turned)
  double moved_error = 1e-12;  ///< by which the proxy may differ after a motion there and back [m]

  /// Places s on the path where the rule is smooth, for the Jacobian.
  std::vector<double> smooth_at;
  double jacobian_error = 1e-6;

  Vec3 wild{1.0};  ///< hostile probes lie within plus and minus this, many of them far outside what is held
};

inline void PrintTo(const ContractSubject& subject, std::ostream* out) { *out << subject.name; }

class ConstraintContract : public ::testing::TestWithParam<ContractSubject> {};

[[nodiscard]] inline std::string subject_name(const ::testing::TestParamInfo<ContractSubject>& info) {
  return info.param.name;
}

}  // namespace palpate::test
