/// Formula fields sampled onto grids, as a loader would hand them over.
#pragma once

#include <cstdint>
#include <functional>

#include "common/field/analytic/analytic_field.h"
#include "common/field/data_set.h"

namespace palpate::test {

/// Name of the vector array of sampled data sets.
inline constexpr const char* kSampledName = "velocity";

/// How the values of a sampled data set are stored.
enum class SampledType : std::uint8_t { kFloat32, kFloat64 };

/// Uniform grid of `points` over the field's bounds.
[[nodiscard]] DataSet sample_uniform(const AnalyticField& field, const Index3& points,
                                     SampledType type = SampledType::kFloat32);

/// Rectilinear grid over the bounds whose intervals grow along each axis, the last `growth` times the first.
[[nodiscard]] DataSet sample_rectilinear(const AnalyticField& field, const Index3& points,
                                         double growth = 4.0, SampledType type = SampledType::kFloat32);

/// Curvilinear block over the bounds: the inner points are moved by smooth waves, `warp` of a cell high.
/// Below 0.3 no cell turns inside out.
[[nodiscard]] DataSet sample_curvilinear(const AnalyticField& field, const Index3& points, double warp = 0.25,
                                         SampledType type = SampledType::kFloat32);

/// Tetrahedra: the same block with random (seeded) moves of the inner points, every hexahedron split.
[[nodiscard]] DataSet sample_tetrahedra(const AnalyticField& field, const Index3& points, double jitter = 0.2,
                                        std::uint64_t seed = 1, SampledType type = SampledType::kFloat32);

/// The block of sample_curvilinear() with any map of the unit cube: `position(u)` for u in [0, 1]^3.
[[nodiscard]] DataSet sample_mapped(const AnalyticField& field, const Index3& points,
                                    const std::function<Vec3(const Vec3& u)>& position,
                                    SampledType type = SampledType::kFloat32);

}  // namespace palpate::test
