/// Affine fields on meshes of every kind, and their lines in closed form: what the exact tracer is held against.
///
/// A field is v = A (x - c) with A = S J S^-1, J of one real rate and a block of two rows (or a Jordan block of three), so
/// that exp(tJ) is written down. Points, A and c are dyadic with few bits, so that every value at a vertex is the field's own
/// number, unrounded: the interpolant is the field, however stiff.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/vector_field.h"
#include "common/geometry/line.h"

namespace palpate {

using Long = long double;
using Long3 = std::array<Long, 3>;
using Long33 = std::array<Long3, 3>;  ///< rows first

/// J: `rate` beside the block [[a, b], [c, d]] of rows 1 and 2; with `chain`, a Jordan block of three of `rate`.
struct NormalForm {
  Long rate = 0, a = 0, b = 0, c = 0, d = 0;
  bool chain = false;

  [[nodiscard]] Long33 matrix() const;
  /// exp(tJ) z.
  [[nodiscard]] Long3 moved(const Long3& z, Long t) const;
};

struct AffineField {
  std::string name;
  Long33 a{};      ///< exact in doubles
  Long33 frame{};  ///< S
  NormalForm form;
  std::array<double, 3> center{};

  [[nodiscard]] Long3 velocity(const Long3& x) const;
  /// The line through `seed` at time `t`.
  [[nodiscard]] Long3 at(const Vec3& seed, Long t) const;
};

/// A mesh of tetrahedra over [-1, 1]^3, sheared by x += shear y.
struct AffineMesh {
  std::string name;
  std::vector<Vec3> points;
  std::vector<std::array<std::int64_t, 4>> cells;
  double shear = 0.0;

  [[nodiscard]] bool on_border(const Vec3& x, double tolerance) const;
};

/// The kinds of fields that are drawn.
inline constexpr std::array<const char*, 10> kAffineKinds{
    "one fast rate",   "three rates",    "slow pair", "fast pair",     "defective",
    "defective chain", "near defective", "singular",  "singular pair", "sheared fast rate"};

/// One of the fields, of rates up to 2^exponent, drawn at random. @param kind one of kAffineKinds; empty: any.
[[nodiscard]] AffineField draw_field(std::mt19937_64& random, int exponent, std::string_view kind = {});
/// One of the families of meshes: planes at equal distances, dyadic ones, slivers; split in five or in six; moved or not.
/// @param name of the mesh that is wanted, "slivers, five, jittered, sheared"; empty: any.
[[nodiscard]] AffineMesh draw_mesh(std::mt19937_64& random, std::string_view name = {});
/// A point within a cell, or on a face, an edge or a vertex.
[[nodiscard]] Vec3 draw_seed(std::mt19937_64& random, const AffineMesh& mesh);

/// The field at the points of the mesh. Null where a value is no double: such a field is not the interpolant.
[[nodiscard]] std::shared_ptr<const VectorField> sampled(const AffineField& field, const AffineMesh& mesh);

/// Vectors at the points of the mesh, three numbers each.
[[nodiscard]] std::shared_ptr<const VectorField> on_mesh(const AffineMesh& mesh,
                                                         const std::vector<float>& values);

/// What a traced line has to say for itself.
struct LineVerdict {
  std::size_t points = 0;
  std::size_t understated = 0;    ///< points farther from the curve than they say
  double worst_excess = 0.0;      ///< largest true error over the stated one
  double worst_error = 0.0;       ///< largest true error, in diagonals
  double worst_stated = 0.0;      ///< largest stated error, in diagonals
  std::vector<float> overstated;  ///< stated over true error, of every eighth point
  std::string wrong_end;          ///< what is wrong with the end; empty where nothing is
};
[[nodiscard]] LineVerdict judge(const Line& line, const AffineField& field, const AffineMesh& mesh,
                                const Vec3& seed, double diagonal);

}  // namespace palpate
