#include "common/scene/tensor/tensor_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/field/tensor/gradient_table.h"
#include "common/field/tensor/tensor_measure.h"
#include "common/math/symmetric3.h"
#include "common/scene/tensor/fit_image.h"
#include "common/scene/tensor/stored_tensors.h"

namespace palpate {
namespace {

/// D becomes T D T^T at every point.
void turn_tensors(const Mat3& turn, std::vector<float>& tensors) {
  for (std::size_t at = 0; at + 6 <= tensors.size(); at += 6) {
    float* const d = tensors.data() + at;
    const Mat3 turned = turn * Mat3{Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}} *
                        glm::transpose(turn);
    const std::array<double, 6> six{turned[0][0], turned[1][0], turned[2][0],
                                    turned[1][1], turned[2][1], turned[2][2]};
    std::transform(six.begin(), six.end(), d, [](double value) { return static_cast<float>(value); });
  }
}

/// The block that has all arrays of the source.
DataSet block_of(std::vector<DataSet> blocks, const TensorInput& input) {
  for (DataSet& block : blocks) {
    const auto& names = input.source.arrays;
    if (std::all_of(names.begin(), names.end(), [&block](const std::string& name) {
          return block.find(name, Association::kPoint) != nullptr;
        })) {
      return std::move(block);
    }
  }
  throw input_error({input.file, "", "no block has the arrays of '" + input.source.label + "'", "", ""});
}

const UniformTopology& uniform(const DataSet& block, const TensorInput& input) {
  const auto* topology = std::get_if<UniformTopology>(&block.topology);
  if (topology == nullptr) {
    throw input_error(
        {input.file, "", "'" + input.source.label + "' does not lie on a uniform grid", "an image", ""});
  }
  return *topology;
}

std::string turn_text(const AxisTurn& turn) {
  return turn.text() + ": tensors turned along the image's axes, as asked for";
}

/// Turns that an image does not tell apart, a few of them by name.
std::string named_turns(const std::vector<std::string>& turns) {
  constexpr std::size_t kMostNamed = 3;
  std::string text;
  for (std::size_t t = 0; t < std::min(turns.size(), kMostNamed); ++t)
    text += (t == 0 ? "" : ", ") + (turns[t].empty() ? "the axes as they are" : turns[t]);
  if (turns.size() > kMostNamed) text += " and " + std::to_string(turns.size() - kMostNamed) + " more";
  return text;
}

/// What the borders in an image say of its axes.
void say_borders(const OrientationVerdict& verdict, const AxisTurn& turn, std::vector<std::string>& notes) {
  const auto part = [](double across) { return short_number(std::round(1000.0 * across) / 1000.0); };
  const char* const alike =
      " cannot be told from it by this image, which has one bundle of fibres: look at a tract that is known";
  if (!verdict.suspicious) {
    if (!verdict.alike.empty())
      notes.push_back("main directions run along the borders of what they make up, as they should; " +
                      named_turns(verdict.alike) + alike);
    return;
  }
  std::string warning =
      "WARNING: main directions run across the borders of what they make up (square of the sine " +
      part(verdict.across) + ", " + part(verdict.across_best) +
      " in other axes): gradients, vectors or tensors may have a wrong axis; ";
  if (verdict.rotated) {
    warning +=
        "but even in the best ones (" + verdict.advice +
        ") they are turned from the borders by more than 10 degrees, which no option mends: was the image turned "
        "without its table?";
  } else {
    warning +=
        "try " + verdict.advice + (turn.is_identity() ? "" : " in addition to the turn that was asked for");
    if (!verdict.alike.empty()) warning += "; " + named_turns(verdict.alike) + alike;
  }
  notes.push_back(std::move(warning));
}

void warn_of_orientation(const OrientationVerdict& verdict, const AxisTurn& turn,
                         std::vector<std::string>& notes) {
  if (!verdict.judged) {
    notes.emplace_back(
        "whether gradients, vectors or tensors have the right axes cannot be told from this image: too few voxels have a "
        "main direction, or neighbours line up as well in other axes; look at a tract that is known");
  }
  if (verdict.by_borders) {
    say_borders(verdict, turn, notes);
    return;
  }
  if (!verdict.suspicious) return;
  std::string warning = "WARNING: neighbouring main directions line up " +
                        short_number(std::round(1000.0 * (verdict.gain - 1.0)) / 10.0) +
                        " % better in other axes: gradients, vectors or tensors may have a wrong axis; ";
  // What would leave a rotation behind is no advice: it would only hide what is wrong.
  if (verdict.rotated) {
    warning +=
        "but even in the best ones (" + verdict.advice +
        ") they line up better still rotated by 10 degrees, which no option mends: was the image turned "
        "without its table?";
  } else {
    warning +=
        "try " + verdict.advice + (turn.is_identity() ? "" : " in addition to the turn that was asked for");
  }
  notes.push_back(std::move(warning));
}

/// What was asked for and means nothing here: of a fit where tensors are stored, of their order where it is no question.
void say_unused(const TensorReading& reading, bool fits, bool order_open, std::vector<std::string>& notes) {
  std::string unused;
  const auto add = [&unused](bool asked, const char* option) {
    if (asked) unused += (unused.empty() ? "" : ", ") + std::string(option);
  };
  if (!fits) {
    const GradientChoice& gradients = reading.gradients;
    add(!reading.mask_file.empty(), "--mask");
    add(!gradients.left_out.empty(), "--leave-out");
    add(std::isfinite(gradients.max_weighting), "--max-b");
    add(!gradients.shells.empty(), "--shell");
    add(!gradients.scale_by_length, "--bvec-length");
    add(reading.fit.weights != FitOptions{}.weights, "--fit");
    add(reading.fit.negative != FitOptions{}.negative, "--negative");
  }
  if (!unused.empty())
    notes.push_back("WARNING: " + unused +
                    ": of fits; the tensors of this file are taken as they are stored");
  if (reading.order != StoredOrder::kAuto && !order_open)
    notes.emplace_back(
        "WARNING: --tensor-order: of six volumes in an order that the file leaves open; there are none here");
}

/// How many of the tensors have an eigenvalue below zero, of at most 20000 that are asked.
void count_negative(const std::vector<float>& tensors, std::vector<std::string>& notes) {
  constexpr std::size_t kMostAsked = 20'000;
  const std::size_t count = tensors.size() / 6, stride = std::max<std::size_t>(1, count / kMostAsked);
  std::size_t asked = 0, negative = 0;
  for (std::size_t p = 0; p < count; p += stride) {
    const float* const d = tensors.data() + 6 * p;
    if (!std::all_of(d, d + 6, [](float x) { return std::isfinite(x); })) continue;
    ++asked;
    const Vec3 values =
        symmetric_eigenvalues({Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}});
    // A zero of single precision may come out below zero.
    constexpr double kRounding = 1e-6;
    negative += values[2] < -kRounding * values[0] ? 1 : 0;
  }
  say_negative(negative, asked, notes);
}

}  // namespace

TensorImage make_tensor_image(std::vector<DataSet> blocks, const TensorInput& input,
                              const TensorReading& reading, int threads, Progress* progress) {
  if (progress != nullptr) progress->check();
  TensorImage result;
  result.image = block_of(std::move(blocks), input);
  const auto* const topology = std::get_if<UniformTopology>(&result.image.topology);
  const bool as_stored =
      input.source.kind == TensorSource::Kind::kArray && input.diffusion.layout == TensorLayout::kData;
  const bool turned = !reading.turn.is_identity() || reading.frame;
  say_unused(reading, input.source.kind == TensorSource::Kind::kSignals,
             input.source.kind == TensorSource::Kind::kArray && !as_stored, result.notes);
  // The file's own numbers, in their own precision.
  const auto keep_stored = [&] {
    const DataArray& array = *result.image.find(input.source.arrays.front(), Association::kPoint);
    result.choice = {array.name, order_of_size(array.components), reading.interpolation};
  };
  if (as_stored && !turned && (!topology || !input.measured)) {
    keep_stored();
    return result;
  }
  const UniformTopology& grid = uniform(result.image, input);
  std::vector<float> tensors, all_peaks;
  Orientation taken{.turn = reading.turn};
  bool doubtful = false;
  if (input.source.kind == TensorSource::Kind::kSignals) {
    const DataArray& signals = *result.image.find(kSignalArray, Association::kPoint);
    FittedImage fitted = fit_image(signals, grid, *input.diffusion.gradients, reading, input.file, threads,
                                   result.notes, progress);
    tensors = std::exchange(fitted.fit.tensors, {});
    result.fit = std::move(fitted.fit);
    doubtful = fitted.doubtful;
    result.gradients = std::move(fitted.gradients.table);
    const VectorFrame read = input.diffusion.gradient_frame;
    taken.frame = reading.frame.value_or(read);
    if (reading.frame) {
      turn_tensors(matrix_of(taken.frame, grid.axes) * glm::transpose(matrix_of(read, grid.axes)), tensors);
      result.notes.push_back("gradients taken along " + std::string(words_of(taken.frame)) +
                             ", as asked for (--vectors)");
    }
  } else {
    tensors = read_stored_tensors(result.image, grid, input.source, input.diffusion, reading, threads,
                                  taken.frame, result.notes, input.file, all_peaks);
    count_negative(tensors, result.notes);
  }
  if (!reading.turn.is_identity()) {
    const Mat3 image = image_axes(grid.axes);
    const Mat3 turn = image * reading.turn.matrix() * glm::transpose(image);
    turn_tensors(turn, tensors);
    turn_vectors(turn, all_peaks);
    result.notes.push_back(turn_text(reading.turn));
  }
  // Of directions that are noise nothing can be learnt.
  if (doubtful) {
    result.notes.emplace_back(
        "axes are not checked against the anatomy: the table does not determine directions");
  } else {
    result.orientation = check_orientation(DirectionMap(tensors, grid, threads), grid, taken, threads);
    warn_of_orientation(result.orientation, reading.turn, result.notes);
  }
  if (as_stored && !turned) {
    keep_stored();
    return result;
  }
  result.image.arrays = {make_array("tensors", Association::kPoint, 6, std::move(tensors))};
  if (result.fit && !result.fit->cones.empty()) {
    result.image.arrays.push_back(
        make_array(std::string(kConeArray), Association::kPoint, 1, std::exchange(result.fit->cones, {})));
    result.image.arrays.push_back(make_array(std::string(kBaselineArray), Association::kPoint, 1,
                                             std::exchange(result.fit->baselines, {})));
  }
  result.choice = {"tensors", TensorOrder::kRows, reading.interpolation};
  if (!all_peaks.empty()) {
    const int numbers = static_cast<int>(all_peaks.size() / result.image.point_count());
    result.image.arrays.push_back(make_array("peaks", Association::kPoint, numbers, std::move(all_peaks)));
    result.choice.peaks = "peaks";
  }
  return result;
}

}  // namespace palpate
