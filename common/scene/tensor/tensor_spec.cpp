#include "common/scene/tensor/tensor_spec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

template <typename T, std::size_t N>
T one_of(const char* option, const std::string& word,
         const std::array<std::pair<std::string_view, T>, N>& known) {
  std::string list;
  for (const auto& [name, value] : known) {
    if (word == name) return value;
    list += (list.empty() ? "" : ", ") + std::string(name);
  }
  throw usage_error(std::string(option) + " " + word + ": " + list + " are known");
}

constexpr std::string_view kAxes = "ijk";

AxisTurn turn_of(const TensorSpec& spec) {
  AxisTurn turn;
  if (!spec.permute.empty()) {
    std::string sorted = spec.permute;
    std::sort(sorted.begin(), sorted.end());
    if (sorted != kAxes)
      throw usage_error("--permute " + spec.permute + ": the letters i, j, k in some order are expected");
    for (std::size_t axis = 0; axis < 3; ++axis)
      turn.from[axis] = static_cast<int>(kAxes.find(spec.permute[axis]));
  }
  for (const char letter : spec.flip) {
    const std::size_t axis = kAxes.find(letter);
    if (axis == std::string_view::npos)
      throw usage_error("--flip " + spec.flip + ": letters of the image's axes i, j, k are expected");
    turn.flipped[axis] = true;
  }
  return turn;
}

/// "3,7,12-15"
std::vector<std::size_t> parse_volumes(const std::string& text) {
  std::vector<std::size_t> volumes;
  if (text.empty()) return volumes;
  std::vector<bool> named(kMostGradients, false);
  for (const std::string_view word : split(text, ',')) {
    const std::string_view part = trimmed(word);
    const std::size_t dash = part.find('-');
    const auto first = parsed<std::size_t>(part.substr(0, dash));
    const auto last = dash == std::string_view::npos ? first : parsed<std::size_t>(part.substr(dash + 1));
    if (!first || !last || *last < *first || *last >= kMostGradients) {
      throw usage_error("--leave-out " + text +
                        ": volumes counted from 0 are expected, with '-' between the first and the last of "
                        "several, such as 3,7,12-15");
    }
    std::fill(named.begin() + static_cast<std::ptrdiff_t>(*first),
              named.begin() + static_cast<std::ptrdiff_t>(*last) + 1, true);
  }
  for (std::size_t v = 0; v < named.size(); ++v)
    if (named[v]) volumes.push_back(v);
  return volumes;
}

GradientChoice gradients_of(const TensorSpec& spec) {
  GradientChoice choice;
  choice.scale_by_length =
      one_of<bool, 2>("--bvec-length", spec.bvec_length, {{{"scale", true}, {"ignore", false}}});
  choice.left_out = parse_volumes(spec.leave_out);
  if (spec.max_b) choice.max_weighting = *spec.max_b;
  if (spec.shell.empty()) return choice;
  for (const std::string_view word : split(spec.shell, ',')) {
    const std::optional<double> b = number(trimmed(word));
    if (!b || !(*b > 0.0) || !std::isfinite(*b))
      throw usage_error("--shell " + spec.shell + ": b-values above 0 are expected, such as 1000,2000");
    choice.shells.push_back(*b);
  }
  return choice;
}

std::optional<VectorFrame> frame_of(const std::string& word) {
  if (word == "auto") return std::nullopt;
  for (int f = 0; f < kVectorFrameCount; ++f) {
    const auto frame = static_cast<VectorFrame>(f);
    if (word == name_of(frame)) return frame;
  }
  throw usage_error("--vectors " + word + ": auto, image, voxel, scanner, lps are known");
}

}  // namespace

TensorReading parse_tensor_spec(const TensorSpec& spec) {
  TensorReading reading;
  reading.order = one_of<StoredOrder, 4>("--tensor-order", spec.order,
                                         {{{"auto", StoredOrder::kAuto},
                                           {"fsl", StoredOrder::kFsl},
                                           {"mrtrix", StoredOrder::kMrtrix},
                                           {"nifti", StoredOrder::kNifti}}});
  reading.fit.weights = one_of<FitWeights, 2>(
      "--fit", spec.fit, {{{"weighted", FitWeights::kSignal}, {"ordinary", FitWeights::kOrdinary}}});
  reading.fit.negative = one_of<NegativeEigenvalues, 2>(
      "--negative", spec.negative,
      {{{"keep", NegativeEigenvalues::kKept}, {"zero", NegativeEigenvalues::kZero}}});
  reading.frame = frame_of(spec.vectors);
  reading.left_handed =
      one_of<bool, 2>("--handedness", spec.handedness, {{{"right", false}, {"left", true}}});
  reading.gradients = gradients_of(spec);
  reading.masked = spec.mask != "none";
  if (reading.masked && spec.mask != "auto") reading.mask_file = spec.mask;
  reading.turn = turn_of(spec);
  reading.interpolation =
      one_of<TensorInterpolation, 2>("--interpolation", spec.interpolation,
                                     {{{"components", TensorInterpolation::kComponents},
                                       {"log-euclidean", TensorInterpolation::kLogEuclidean}}});
  return reading;
}

}  // namespace palpate
