#include "common/scene/stored_tensors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/field/tensor/gradient_table.h"
#include "common/field/tensor/orientation_check.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

using Six = std::array<double, 6>;

/// Stores a tensor turned by `axes`; NaN where it is zero or not finite.
void store(const Six& tensor, const Mat3& axes, float* out) {
  const bool zero = std::all_of(tensor.begin(), tensor.end(), [](double d) { return d == 0.0; });
  const bool finite = std::all_of(tensor.begin(), tensor.end(), [](double d) { return std::isfinite(d); });
  if (zero || !finite) {
    std::fill_n(out, 6, std::numeric_limits<float>::quiet_NaN());
    return;
  }
  const Six turned =
      axes == Mat3{1.0} ? tensor : six_numbers(axes * symmetric_matrix(tensor) * glm::transpose(axes));
  std::transform(turned.begin(), turned.end(), out, [](double value) { return static_cast<float>(value); });
}

/// All tensors of an array, turned by `axes`.
std::vector<float> read_array(const DataArray& array, TensorOrder order, const Mat3& axes) {
  std::vector<float> tensors(6 * array.tuples);
  for (std::size_t p = 0; p < array.tuples; ++p) store(read_tensor(array, p, order), axes, &tensors[6 * p]);
  return tensors;
}

/// An order that six numbers may have, and the axes that go with it.
struct Reading {
  StoredOrder order;
  TensorOrder places;
  const char* name;
};
constexpr std::array<Reading, 3> kReadings{
    {{StoredOrder::kFsl, TensorOrder::kRows, "FSL's order (xx xy xz yy yz zz)"},
     {StoredOrder::kMrtrix, TensorOrder::kDiagonal, "MRtrix's order (xx yy zz xy xz yz)"},
     {StoredOrder::kNifti, TensorOrder::kLower, "NIfTI's order (xx xy yy xz yz zz)"}}};

/// The part of the tensors that have no eigenvalue below zero, of those that are not zero.
double positive_part(const DataArray& array, TensorOrder order) {
  constexpr std::size_t kMostAsked = 20'000;
  const std::size_t stride = std::max<std::size_t>(1, array.tuples / kMostAsked);
  std::size_t asked = 0, positive = 0;
  for (std::size_t p = 0; p < array.tuples; p += stride) {
    const Six d = read_tensor(array, p, order);
    if (!std::all_of(d.begin(), d.end(), [](double x) { return std::isfinite(x); })) continue;
    if (std::all_of(d.begin(), d.end(), [](double x) { return x == 0.0; })) continue;
    ++asked;
    positive += symmetric_eigenvalues(symmetric_matrix(d))[2] >= 0.0 ? 1 : 0;
  }
  return asked > 0 ? static_cast<double>(positive) / static_cast<double>(asked) : 0.0;
}

struct Axes {
  Mat3 matrix;
  const char* name;
};

/// Axes that tensors of that order may be along, the likeliest first.
std::vector<Axes> axes_of(StoredOrder order, const UniformTopology& topology) {
  const Axes fsl{fsl_axes(topology.axes),
                 "FSL's image axes (the first turned around where the image is right-handed)"};
  const Axes world{Mat3{1.0}, "the axes of the coordinates"};
  const Axes image{image_axes(topology.axes), "the image's axes"};
  if (order == StoredOrder::kFsl) return {fsl};
  if (order == StoredOrder::kMrtrix) return {world};
  return {image, world, fsl};
}

/// How well main directions line up along the tensors' own reading.
double coherence(const std::vector<float>& tensors, const UniformTopology& topology, int threads) {
  const Mat3 identity{1.0};
  return DirectionMap(tensors, topology, threads).coherence(std::span(&identity, 1), threads).front();
}

/// Tensors of six numbers whose order or axes the file leaves open.
std::vector<float> read_unstated(const DataArray& array, const UniformTopology& topology, StoredOrder wanted,
                                 int threads, std::vector<std::string>& notes, const std::string& file) {
  std::array<double, 3> positive{};
  for (std::size_t r = 0; r < kReadings.size(); ++r) positive[r] = positive_part(array, kReadings[r].places);
  const double most = *std::max_element(positive.begin(), positive.end());
  constexpr double kTensors = 0.5;
  if (wanted == StoredOrder::kAuto && most < kTensors)
    throw input_error(
        {file, "", "has six volumes that are positive tensors in no known order", "tensors",
         "name the gradients of a diffusion-weighted series (--bval, --bvec), or --tensor-order"});
  constexpr double kAsGood = 0.02;
  constexpr double kClear = 1.01;
  std::vector<float> best;
  double best_coherence = -1.0;
  std::string chosen;
  for (std::size_t r = 0; r < kReadings.size(); ++r) {
    const Reading& reading = kReadings[r];
    const bool taken = wanted == StoredOrder::kAuto ? positive[r] >= most - kAsGood : wanted == reading.order;
    if (!taken) continue;
    for (const Axes& axes : axes_of(reading.order, topology)) {
      std::vector<float> tensors = read_array(array, reading.places, axes.matrix);
      const double score = coherence(tensors, topology, threads);
      if (score <= kClear * best_coherence) continue;
      best = std::move(tensors);
      best_coherence = score;
      chosen = std::string(reading.name) + " along " + axes.name;
    }
  }
  std::string parts;
  for (std::size_t r = 0; r < kReadings.size(); ++r) {
    parts += (r == 0 ? "" : ", ") + short_number(std::round(1000.0 * positive[r]) / 10.0) + " % in " +
             kReadings[r].name;
  }
  notes.push_back("tensors taken in " + chosen + (wanted == StoredOrder::kAuto ? "" : ", as asked for") +
                  "; without an eigenvalue below zero: " + parts + " (--tensor-order)");
  return best;
}

std::vector<float> from_eigen_set(const DataSet& image, const TensorSource& source, const Mat3& axes) {
  std::array<const DataArray*, 6> arrays{};  // V1 V2 V3 L1 L2 L3
  for (std::size_t a = 0; a < arrays.size(); ++a)
    arrays[a] = image.find(source.arrays[a], Association::kPoint);
  std::vector<float> tensors(6 * image.point_count());
  for (std::size_t p = 0; p < image.point_count(); ++p) {
    Mat3 sum{0.0};
    for (std::size_t e = 0; e < 3; ++e) {
      const Vec3 v{arrays[e]->at(p, 0), arrays[e]->at(p, 1), arrays[e]->at(p, 2)};
      sum += arrays[e + 3]->at(p) * glm::outerProduct(v, v);
    }
    store(six_numbers(sum), axes, &tensors[6 * p]);
  }
  return tensors;
}

/// A mean diffusivity that white and grey matter have [mm^2/s].
constexpr double kMeanDiffusivity = 0.7e-3;

/// With eigenvalues MD (1 + 2 t), MD (1 - t) twice, FA = sqrt(3 t^2 / (1 + 2 t^2)).
std::vector<float> from_directions(const DataSet& image, const TensorSource& source, const Mat3& axes) {
  const DataArray& directions = *image.find(source.arrays[0], Association::kPoint);
  const DataArray& anisotropies = *image.find(source.arrays[1], Association::kPoint);
  std::vector<float> tensors(6 * image.point_count());
  for (std::size_t p = 0; p < image.point_count(); ++p) {
    const Vec3 v{directions.at(p, 0), directions.at(p, 1), directions.at(p, 2)};
    const double length = glm::length(v);
    Mat3 tensor{0.0};
    if (length > 0.0 && std::isfinite(length)) {
      const double fa = std::clamp(anisotropies.at(p), 0.0, 1.0);
      const double t = fa / std::sqrt(3.0 - 2.0 * fa * fa);
      const Vec3 unit = v / length;
      tensor = kMeanDiffusivity * (Mat3{1.0 - t} + 3.0 * t * glm::outerProduct(unit, unit));
    }
    store(six_numbers(tensor), axes, &tensors[6 * p]);
  }
  return tensors;
}

}  // namespace

TensorOrder order_of_size(int components) noexcept {
  if (components == 9) return TensorOrder::kFull;
  return components == 7 ? TensorOrder::kMask : TensorOrder::kRows;
}

std::vector<float> read_stored_tensors(const DataSet& image, const UniformTopology& topology,
                                       const TensorSource& source, TensorLayout layout, StoredOrder order,
                                       int threads, std::vector<std::string>& notes,
                                       const std::string& file) {
  const std::string along =
      ", along FSL's image axes (the first turned around where the image is right-handed)";
  switch (source.kind) {
    case TensorSource::Kind::kEigenSet:
      notes.push_back("tensors put together from eigenvectors and eigenvalues" + along);
      return from_eigen_set(image, source, fsl_axes(topology.axes));
    case TensorSource::Kind::kDirections:
      notes.push_back(
          "V1 and FA alone do not determine tensors: taken as alike across V1, with a mean diffusivity "
          "of 0.0007 mm^2/s" +
          along);
      return from_directions(image, source, fsl_axes(topology.axes));
    default:
      break;
  }
  const DataArray& array = *image.find(source.arrays.front(), Association::kPoint);
  if (layout == TensorLayout::kData) return read_array(array, order_of_size(array.components), Mat3{1.0});
  if (order == StoredOrder::kAuto && layout == TensorLayout::kLower) order = StoredOrder::kNifti;
  return read_unstated(array, topology, order, threads, notes, file);
}

}  // namespace palpate
