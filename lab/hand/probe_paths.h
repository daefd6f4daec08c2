/// Probe paths of a hand on the field at hand, made up for measuring constraints: the hand goes along a
/// streamline, to and fro, and is pulled off it.
///
///   smooth  at up to 0.2 m/s along the line, at most 0.7 release distances beside it
///   tremor  the same with a physiological tremor (8 to 12 Hz, 0.5 to 1 mm in each axis: Elble and Koller
///           1990), noise, and steps of an encoder
///   rough   the same with jumps within reach and out of it, strokes at 5 m/s, places beside the data, and
///           jumps of a metre in a millisecond
///
/// All of them tick at 1 kHz. They are drawn from a seeded generator: the same arguments give the same path.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/device/probe_path.h"
#include "common/field/vector_field.h"
#include "common/haptics/workspace.h"

namespace palpate {

enum class PathKind : std::uint8_t { kSmooth, kTremor, kRough };
inline constexpr std::array<PathKind, 3> kPathKinds{PathKind::kSmooth, PathKind::kTremor, PathKind::kRough};
[[nodiscard]] std::string_view name_of(PathKind kind) noexcept;  ///< "smooth"

/// What paths are made for.
struct PathScene {
  const VectorField& field;
  const Workspace& workspace;
  double release_distance = 0.0;  ///< [m]
};

/// `steps` rows that begin at `seed` (data coordinates) at time 0; none where no line passes there.
[[nodiscard]] std::vector<PathRow> make_probe_path(const PathScene& scene, PathKind kind, const Vec3& seed,
                                                   std::size_t steps, std::uint64_t random_seed);

}  // namespace palpate
