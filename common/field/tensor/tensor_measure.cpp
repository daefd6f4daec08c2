#include "common/field/tensor/tensor_measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/tensor/diffusion_measures.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

constexpr std::array<std::string_view, kTensorMeasureCount> kNames{"fa",   "md", "cl",    "cp",     "cs",
                                                                   "mode", "v1", "color", "v1-cone"};

double number_of(TensorMeasure measure, const Vec3& eigenvalues, WestinScale westin) {
  switch (measure) {
    case TensorMeasure::kMd:
      return mean_diffusivity(eigenvalues);
    case TensorMeasure::kLinear:
      return anisotropy(eigenvalues, westin).linear;
    case TensorMeasure::kPlanar:
      return anisotropy(eigenvalues, westin).planar;
    case TensorMeasure::kSpherical:
      return anisotropy(eigenvalues, westin).spherical;
    case TensorMeasure::kMode:
      return mode_of_anisotropy(eigenvalues);
    default:
      return fractional_anisotropy(eigenvalues);
  }
}

/// Three numbers of a direction or a colour.
Vec3 triple_of(TensorMeasure measure, const SymmetricEigen& eigen) {
  const Vec3 direction = eigen.vectors[0];
  const Vec3 size = glm::abs(direction);
  if (measure == TensorMeasure::kColor) return fractional_anisotropy(eigen.values) * size;
  int largest = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (size[axis] > size[largest]) largest = axis;
  }
  return direction[largest] < 0.0 ? -direction : direction;
}

}  // namespace

TensorMeasures measures_at(const TensorField& field, const Vec3& x, CellHint& hint) noexcept {
  const TensorSample sample = field.sample(x, hint);
  if (sample.status != SampleStatus::kOk) return {};
  const Vec3 eigenvalues = symmetric_eigenvalues(sample.value);
  return {anisotropy(eigenvalues), fractional_anisotropy(eigenvalues)};
}

std::string_view name_of(TensorMeasure measure) noexcept { return kNames[as_size(measure)]; }

TensorMeasure measure_from_name(std::string_view name) {
  std::string known;
  for (std::size_t m = 0; m < kNames.size(); ++m) {
    if (name == kNames[m]) return static_cast<TensorMeasure>(m);
    known += (m == 0 ? "" : ", ") + std::string(kNames[m]);
  }
  throw usage_error("--measure " + std::string(name) + ": " + known + " are known");
}

int component_count(TensorMeasure measure) noexcept {
  return measure == TensorMeasure::kMainDirection || measure == TensorMeasure::kColor ? 3 : 1;
}

std::vector<float> measure_tensors(const DataSet& image, const TensorChoice& choice, TensorMeasure measure,
                                   int threads, WestinScale westin) {
  if (measure == TensorMeasure::kCone) {
    const DataArray* const cones = image.find(std::string(kConeArray), Association::kPoint);
    if (cones == nullptr)
      throw usage_error(
          "v1-cone: how sure a direction is follows from a fit: it needs the diffusion-weighted volumes, not tensors");
    std::vector<float> degrees(cones->tuples);
    for (std::size_t p = 0; p < degrees.size(); ++p) degrees[p] = static_cast<float>(cones->at(p));
    return degrees;
  }
  const DataArray& array = *image.find(choice.array, choice.association);
  const auto components = as_size(component_count(measure));
  std::vector<float> values(components * array.tuples, std::numeric_limits<float>::quiet_NaN());
  parallel_for(array.tuples, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      const auto d = read_tensor(array, p, choice.order);
      if (!std::all_of(d.begin(), d.end(), [](double x) { return std::isfinite(x); })) continue;
      const SymmetricEigen eigen =
          symmetric_eigen({Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}});
      if (components == 1) {
        values[p] = static_cast<float>(number_of(measure, eigen.values, westin));
        continue;
      }
      const Vec3 triple = triple_of(measure, eigen);
      for (std::size_t c = 0; c < 3; ++c) values[3 * p + c] = static_cast<float>(triple[static_cast<int>(c)]);
    }
  });
  return values;
}

}  // namespace palpate
