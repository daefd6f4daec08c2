/// What metal does to a magnetic tracker, from its principle of operation (Ikits 2006, ch. 9: analytical error models).
///
/// The transmitter's three coils at the origin make dipole fields. With the matrix of their fields at p
///   M(p) = (3 r r^T - 1) / |p|^3,   r = p / |p|                                                          (1)
/// and metal, which answers them, the field is
///   F(p) = M(p) + sum_c a_c M(p - c) M(c)                     small pieces at c, of polarizability a       (2)
///               + sum_s k_s M(p - 2 s) (1 - 2 n n^T)          wide sheets through s across n = s / |s|     (3)
/// A piece is magnetized by the field where it is. A sheet in which eddy currents keep the field from passing
/// mirrors the coils, with the moments along n turned over; k = 1 for a perfect one, and less, or negative for iron.
/// The tracker reads the field as if it were M (Raab et al. 1979): the direction t / |t| is the major eigenvector of
/// F^T F, |t|^6 = 4 / its eigenvalue, and the turn is what remains of F M(t)^-1, a rotation but for what metal does.
///
/// Places, strengths and how many there are follow from measurements: the source that explains most is added, all are
/// fitted again, and so on for as long as measurements that were kept apart are explained better by it.
#pragma once

#include <string>
#include <vector>

#include "common/calibration/least_squares.h"
#include "common/calibration/measurements.h"

namespace palpate {

struct MetalSource {
  enum class Kind { kPiece, kSheet };

  Kind kind = Kind::kPiece;
  Vec3 place{0.0};        ///< c, or s [m]
  double strength = 0.0;  ///< a [m^3], or k
};

struct MetalModel {
  std::vector<MetalSource> sources;
  double turn_factor = 1.0;  ///< by which errors of orientation are those of the rest of F M(t)^-1

  /// F(p), but for a scale; coils along its columns.
  [[nodiscard]] Mat3 field_at(const Vec3& p) const noexcept;
  /// p - t and the turn's vector part for a sensor that is at `actual`: what the reading lacks. @rt Safe.
  [[nodiscard]] PoseError error_of(const Vec3& actual) const noexcept;
  /// The same at a place that was read, by iteration. NaN where none of the places near it is read so.
  [[nodiscard]] PoseError error_at(const Vec3& reported) const noexcept;
};

inline constexpr int kMostSources = 8;

/// @throws Error (bad input) where there are fewer than twenty measurements.
[[nodiscard]] MetalModel fit_metal(const std::vector<TrackerMeasurement>& rows, Loss loss,
                                   const std::string& source);

}  // namespace palpate
