/// How well tracts lie along the main directions of an image, and which turn of their coordinates would fit
/// better: tracts of a program with other axes, or of an image that was turned since, lie beside the anatomy
/// or across it.
///
/// For a turn M of the coordinates, over sampled pieces of the lines with midpoint x and unit direction t,
///
///   s(M) = 1/n sum FA(M x) (M t . e_1(M x))^2                                              (1)
///
/// with the tensor of the nearest voxel; 0 where there is none. So it counts both whether lines stay inside
/// and whether they run along. A shift of half a voxel is not seen.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/tensor/tensor_field.h"
#include "common/geometry/tractogram.h"

namespace palpate {

/// A turn of coordinates. About the centre of an image, in steps of its own axes i, j, k; or about the origin
/// of the coordinates x, y, z. Component a of a position becomes its component `from[a]`, with the other sign
/// where `flipped[a]`.
struct TractTurn {
  bool of_image = true;
  std::array<int, 3> from{0, 1, 2};
  std::array<bool, 3> flipped{};

  [[nodiscard]] bool is_identity() const noexcept;
  /// "i,-j,k", "-x,-y,z": what parse_tract_turn() reads.
  [[nodiscard]] std::string text() const;
};

/// @throws Error (usage).
[[nodiscard]] TractTurn parse_tract_turn(std::string_view text);

/// x -> matrix x + shift.
struct AffineMap {
  Mat3 matrix{1.0};
  Vec3 shift{0.0};
};
/// The turn along the axes of `image`, in mm: lengths are kept also where voxels are not cubes.
[[nodiscard]] AffineMap map_of(const TractTurn& turn, const UniformTopology& image);

/// Turns every point.
void turn_tracts(const AffineMap& map, Tractogram& lines);

struct TractFit {
  std::size_t pieces = 0;       ///< asked, spread evenly over the lines
  double inside = 0.0;          ///< part of them whose voxel has a tensor
  double outside = 0.0;         ///< part of them beyond the voxels of the image
  std::size_t anisotropic = 0;  ///< pieces in a voxel with FA > 0.2
  double angle = 0.0;           ///< mean of those with FA > 0.2, between line and main direction [degrees]
  double score = 0.0;           ///< s of the lines as they are
  TractTurn best;               ///< of 48 turns of the image and 7 of the world
  double gain = 1.0;            ///< s(best) / score; infinite where the lines as they are hit nothing
  bool suspicious = false;      ///< the best turn is not the identity, by so much that it is no chance

  /// Whether many pieces lie beyond the image.
  [[nodiscard]] bool strays() const noexcept { return outside > 0.1; }
};

/// Scores all turns. Nothing is suspicious where fewer than 100 pieces of the best turn meet a tensor.
/// @throws Error (usage) where the field was not made of an image.
[[nodiscard]] TractFit fit_of_tracts(const TensorField& field, const Tractogram& lines, int threads);

/// What the user should know, a line: how well they fit, and a warning with the turn where it is suspicious.
/// @param option how a turn is asked for ("--turn").
[[nodiscard]] std::string fit_sentence(const TractFit& fit, const std::string& option);

}  // namespace palpate
