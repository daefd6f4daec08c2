#include "common/scene/tensor_spec.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "common/base/error.h"

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

AxisTurn turn_of(const TensorSpec& words) {
  AxisTurn turn;
  if (!words.permute.empty()) {
    std::string sorted = words.permute;
    std::sort(sorted.begin(), sorted.end());
    if (sorted != kAxes)
      throw usage_error("--permute " + words.permute + ": the letters i, j, k in some order are expected");
    for (std::size_t axis = 0; axis < 3; ++axis)
      turn.from[axis] = static_cast<int>(kAxes.find(words.permute[axis]));
  }
  for (const char letter : words.flip) {
    const std::size_t axis = kAxes.find(letter);
    if (axis == std::string_view::npos)
      throw usage_error("--flip " + words.flip + ": letters of the image's axes i, j, k are expected");
    turn.flipped[axis] = true;
  }
  return turn;
}

}  // namespace

TensorReading parse_tensor_spec(const TensorSpec& words) {
  TensorReading reading;
  reading.order = one_of<StoredOrder, 4>("--tensor-order", words.order,
                                         {{{"auto", StoredOrder::kAuto},
                                           {"fsl", StoredOrder::kFsl},
                                           {"mrtrix", StoredOrder::kMrtrix},
                                           {"nifti", StoredOrder::kNifti}}});
  reading.fit.weights = one_of<FitWeights, 2>(
      "--fit", words.fit, {{{"weighted", FitWeights::kSignal}, {"ordinary", FitWeights::kOrdinary}}});
  reading.fit.negative = one_of<NegativeEigenvalues, 2>(
      "--negative", words.negative,
      {{{"keep", NegativeEigenvalues::kKept}, {"zero", NegativeEigenvalues::kZero}}});
  reading.masked = words.mask != "none";
  if (reading.masked && words.mask != "auto") reading.mask_file = words.mask;
  reading.turn = turn_of(words);
  reading.interpolation =
      one_of<TensorInterpolation, 2>("--interpolation", words.interpolation,
                                     {{{"components", TensorInterpolation::kComponents},
                                       {"log-euclidean", TensorInterpolation::kLogEuclidean}}});
  return reading;
}

}  // namespace palpate
