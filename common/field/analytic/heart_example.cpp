#include "common/field/analytic/heart_example.h"

#include <algorithm>
#include <span>

#include "common/base/error.h"
#include "common/field/analytic/excitation.h"
#include "common/field/grid/cell_split.h"

namespace palpate {
namespace {

constexpr const char* kVentricle = "ventricle";
constexpr const char* kWave = "wave";
constexpr const char* kPotential = "potential";
constexpr const char* kActivation = "activation";
/// Cells of about two millimetres; coarser than those of the ventricle, so that the wave is there in seconds.
constexpr VentricleCells kWaveCells{.wall = 6, .along = 40, .around = 80};
constexpr double kStep = 1.0;         // [ms]
constexpr int kStepsApart = 5;        // of two time steps that are kept
constexpr int kTimes = 81;            // to 400 ms: all of it was excited, and where it began rests again
constexpr double kRest = -80.0;       // [mV], u = 0
constexpr double kAmplitude = 100.0;  // [mV], u = 1

}  // namespace

std::vector<ExampleInfo> heart_examples() {
  return {{kVentricle, "left ventricle: half an ellipsoidal shell, fibres turn from +60 to -60 degrees"},
          {kWave, "the same, with a wave of excitation over 400 ms: potential and activation time"}};
}

HeartExample::HeartExample(std::string_view name) {
  const bool wave = name == kWave;
  if (!wave && name != kVentricle) {
    std::string known;
    for (const ExampleInfo& each : heart_examples()) known += (known.empty() ? "" : ", ") + each.name;
    throw usage_error("no example '" + std::string(name) + "'; there are " + known);
  }
  mesh_ = ventricle_mesh({}, wave ? kWaveCells : VentricleCells{});
  for (const DataArray& array : mesh_.arrays)
    arrays_.push_back({array.name, array.association, array.components, array.type, array.tuples});
  if (!wave) return;
  const std::size_t points = mesh_.point_count();
  arrays_.push_back({kPotential, Association::kPoint, 1, ScalarType::kFloat32, points});
  arrays_.push_back({kActivation, Association::kPoint, 1, ScalarType::kFloat64, points});
  for (int i = 0; i < kTimes; ++i) times_.push_back(kStep * kStepsApart * i);
}

HeartExample::Wave HeartExample::run(const DataSet& mesh, const std::vector<double>& times) {
  const SplitMesh split = split_into_tetrahedra(std::span(&mesh, 1), kWave);
  const Ventricle ventricle;
  std::vector<Vec3> fibres;
  fibres.reserve(split.tets.size());
  for (const TetMesh::Tet& tet : split.tets) {
    Vec3 centroid{0.0};
    for (const std::uint32_t p : tet) centroid += 0.25 * split.points[p];
    fibres.push_back(ventricle.fibre(ventricle.coordinates(centroid)));
  }
  const Vec3 begin = ventricle.position(kStimulus);
  std::vector<double> u;
  u.reserve(split.points.size());
  for (const Vec3& x : split.points) u.push_back(glm::distance(x, begin) < kStimulusRadius ? 1.0 : 0.0);
  ExcitationWave wave(split.points, split.tets, fibres, {}, std::move(u), kStep);
  const auto to_input = [&](std::span<const double> values, auto convert, auto& out) {
    for (const std::uint32_t p : split.point_of_input) out.push_back(convert(values[p]));
  };
  Wave kept;
  for (std::size_t t = 0; t < times.size(); ++t) {
    for (int i = 0; t > 0 && i < kStepsApart; ++i) wave.advance();
    to_input(
        wave.potential(), [](double v) { return static_cast<float>(kRest + kAmplitude * v); },
        kept.potentials.emplace_back());
  }
  to_input(
      wave.activation(), [](double at) { return at; }, kept.activation);
  return kept;
}

DataSet HeartExample::read(const std::vector<std::string>& names, std::size_t step) {
  const auto asked = [&names](std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  DataSet chosen;
  chosen.topology = mesh_.topology;
  for (const DataArray& array : mesh_.arrays)
    if (asked(array.name)) chosen.arrays.push_back(array);
  if (times_.empty() || (!asked(kPotential) && !asked(kActivation))) return chosen;
  if (!wave_) wave_ = run(mesh_, times_);
  if (asked(kPotential))
    chosen.arrays.push_back(
        make_array(kPotential, Association::kPoint, 1, std::span<const float>(wave_->potentials[step])));
  if (asked(kActivation))
    chosen.arrays.push_back(
        make_array(kActivation, Association::kPoint, 1, std::span<const double>(wave_->activation)));
  return chosen;
}

}  // namespace palpate
