/// A left ventricle made of formulas: half of an ellipsoidal shell whose fibres turn through the wall.
///
/// In prolate spheroidal coordinates of focus f about the z axis, apex below,
///
///   x = f sinh(lambda) sin(mu) cos(theta)
///   y = f sinh(lambda) sin(mu) sin(theta)                                                          (1)
///   z = -f cosh(lambda) cos(mu)
///
/// the wall is lambda_in <= lambda <= lambda_out, 0 <= mu <= mu_base. Its layers are the confocal ellipsoids
/// of constant lambda; the depth s = (lambda - lambda_in) / (lambda_out - lambda_in) is 0 on the inner and 1
/// on the outer surface. Fibres lie in the layers (but for an imbrication), at the helix angle
///
///   alpha(s) = (1 - s) alpha_in + s alpha_out                                                       (2)
///
/// from the circumferential direction (counter-clockwise as seen from the base), positive towards the base:
/// +60 to -60 degrees, linear through the wall (Streeter et al., Circ Res 24 (1969) 339, found about that).
/// At the apex they have no direction. With c = cos(mu), a = sinh(lambda) and A = cosh(lambda), a fibre runs
/// along
///
///   theta(mu) = theta_0 - cot(alpha) / a [ arcsin(c / A) + a artanh(a c / sqrt(A^2 - c^2)) ]        (3)
///
/// which follows from h_theta dtheta / (h_mu dmu) = cot(alpha) with the scale factors of (1),
/// h_mu = f sqrt(a^2 + sin^2 mu), h_theta = f a sin(mu).
#pragma once

#include "common/field/data_set.h"
#include "common/math/vec.h"

namespace palpate {

/// Prolate spheroidal coordinates.
struct Prolate {
  double lambda = 0.0, mu = 0.0, theta = 0.0;
};

struct Ventricle {
  double focus = 40.0;                       ///< f [mm]
  double lambda_inner = 0.5;                 ///< half axes 45.1 and 20.8 mm
  double lambda_outer = 0.8;                 ///< 53.5 and 35.5 mm
  double mu_base = 1.9;                      ///< [rad]: a little above the equator
  double alpha_inner = 1.0471975511965976;   ///< [rad]
  double alpha_outer = -1.0471975511965976;  ///< [rad]
  /// Angle by which fibres rise out of their layer, outwards; the sheet is turned with them [rad].
  double imbrication = 0.0;

  [[nodiscard]] Vec3 position(const Prolate& at) const noexcept;
  /// The inverse of position(); theta in (-pi, pi].
  [[nodiscard]] Prolate coordinates(const Vec3& x) const noexcept;
  [[nodiscard]] double depth(double lambda) const noexcept;        ///< s
  [[nodiscard]] double helix_angle(double lambda) const noexcept;  ///< (2) [rad]
  /// Unit directions: circumferential, longitudinal (towards the base), transmural (outwards); columns.
  /// @pre mu > 0.
  [[nodiscard]] Mat3 wall_axes(const Prolate& at) const noexcept;
  [[nodiscard]] Vec3 fibre(const Prolate& at) const noexcept;  ///< unit. @pre mu > 0.
  [[nodiscard]] Vec3 sheet(const Prolate& at) const noexcept;  ///< unit, across the fibre. @pre mu > 0.
  [[nodiscard]] double volume() const noexcept;                ///< of the wall [mm^3]
  /// The solution of Laplace's equation that is 0 on the inner and 1 on the outer surface, with no flux
  /// through the base: ln tanh(lambda / 2) up to two constants, since confocal ellipsoids are its
  /// equipotentials.
  [[nodiscard]] double potential(double lambda) const noexcept;
  /// (3) without theta_0: how far a fibre has turned by mu. @pre alpha and mu not zero.
  [[nodiscard]] double turn(double lambda, double mu) const noexcept;
};

/// Cells along each coordinate.
struct VentricleCells {
  int wall = 10, along = 48, around = 120;
};

/// The ventricle as a mesh of hexahedra, wedges at the apex, with the point arrays "fibre", "sheet" and
/// "normal" (unit; the sheet transmural but for an imbrication, NaN at the apex), "layer" (the depth) and
/// "surface" (layer/wall_surfaces.h).
[[nodiscard]] DataSet ventricle_mesh(const Ventricle& ventricle, const VentricleCells& cells);

}  // namespace palpate
