#include "common/scene/tensor/stored_tensors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/tensor/gradient_table.h"
#include "common/field/tensor/orientation_check.h"
#include "common/field/tensor/peak_field.h"
#include "common/field/tensor/vector_frame.h"
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

/// Axes that tensors of that order may be along, the likeliest first.
std::vector<VectorFrame> frames_of(StoredOrder order) {
  if (order == StoredOrder::kFsl) return {VectorFrame::kImage, VectorFrame::kScanner, VectorFrame::kLps};
  if (order == StoredOrder::kMrtrix) return {VectorFrame::kScanner, VectorFrame::kImage, VectorFrame::kLps};
  return {VectorFrame::kVoxel, VectorFrame::kScanner, VectorFrame::kImage, VectorFrame::kLps};
}

/// The frame of numbers as stored, and how well main directions line up in it.
struct FrameChoice {
  VectorFrame frame = VectorFrame::kScanner;
  Coherence coherence;
  std::string why;
  bool warns = false;  ///< a wrong guess would be far off
};

/// What `wanted` and the file leave open.
struct OpenFrame {
  std::optional<VectorFrame> asked;
  std::optional<VectorFrame> stated;
};

/// The one that is asked for, else that the file states, else of `likely`, the likeliest first, the one in which
/// directions line up best.
FrameChoice choose_frame(const std::vector<float>& stored, const UniformTopology& topology,
                         const std::vector<VectorFrame>& likely, const OpenFrame& open, int threads) {
  const DirectionMap map(stored, topology, threads);
  std::vector<VectorFrame> frames = likely;
  if (open.asked || open.stated) frames = {open.asked ? *open.asked : *open.stated};
  std::vector<Mat3> matrices;
  for (const VectorFrame frame : frames) matrices.push_back(matrix_of(frame, topology.axes));
  const std::vector<Coherence> scores = map.coherence(matrices, threads);
  FrameChoice choice{.frame = frames.front(),
                     .coherence = scores.front(),
                     .why = open.asked ? ", as asked for" : ", as the file states"};
  if (frames.size() == 1) return choice;
  const bool enough = map.size() >= kLeastCoherent;
  std::size_t best = 0;
  for (std::size_t f = 1; enough && f < frames.size(); ++f) {
    if (clearly_better(scores[f], scores[best])) best = f;
  }
  choice.frame = frames[best];
  choice.coherence = scores[best];
  // Of those that the image does not speak against, the one in which most is at stake.
  double most = 0.0;
  std::size_t farthest = best;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (f == best || (enough && clearly_better(scores[best], scores[f]))) continue;
    const double turn = map.median_turn(matrices[best], matrices[f]);
    if (turn > most) farthest = f;
    most = std::max(most, turn);
  }
  choice.why = std::string(": the file does not say, and ") +
               (!enough       ? "the image has too few fibres to tell"
                : most >= 1.0 ? "the image does not decide"
                              : "neighbouring directions line up best so");
  if (most < 1.0) return choice;
  constexpr double kMuch = 5.0;
  choice.warns = most > kMuch;
  choice.why += "; along " + std::string(words_of(frames[farthest])) + " main directions would be " +
                short_number(std::round(most)) + " degrees from these, in the median: name theirs, as in " +
                "--vectors " + std::string(name_of(frames[farthest])) + ", where you know it";
  return choice;
}

/// "tensors taken along LPS axes ...", a WARNING where a wrong guess would be far off.
std::string frame_note(const std::string& what, const FrameChoice& choice) {
  return (choice.warns ? "WARNING: " : "") + what + " along " + std::string(words_of(choice.frame)) +
         choice.why + (choice.warns ? "" : " (--vectors)");
}

void turn_stored(const Mat3& axes, std::vector<float>& tensors) {
  for (std::size_t at = 0; at + 6 <= tensors.size(); at += 6) {
    Six six{};
    std::copy_n(tensors.begin() + static_cast<std::ptrdiff_t>(at), 6, six.begin());
    store(six, axes, &tensors[at]);
  }
}

/// Tensors of six numbers whose order or axes the file leaves open.
std::vector<float> read_unstated(const DataArray& array, const UniformTopology& topology, StoredOrder wanted,
                                 const OpenFrame& open, int threads, VectorFrame& frame,
                                 std::vector<std::string>& notes, const std::string& file) {
  std::array<double, 3> positive{};
  for (std::size_t r = 0; r < kReadings.size(); ++r) positive[r] = positive_part(array, kReadings[r].places);
  const double most = *std::max_element(positive.begin(), positive.end());
  constexpr double kTensors = 0.5;
  if (wanted == StoredOrder::kAuto && most < kTensors)
    throw input_error(
        {file, "", "has six volumes that are positive tensors in no known order", "tensors",
         "name the gradients of a diffusion-weighted series (--bval, --bvec), or --tensor-order; --field peaks "
         "takes them for two directions"});
  constexpr double kAsGood = 0.02;
  std::vector<float> best;
  FrameChoice chosen;
  std::string name;
  for (std::size_t r = 0; r < kReadings.size(); ++r) {
    const Reading& way = kReadings[r];
    const bool taken = wanted == StoredOrder::kAuto ? positive[r] >= most - kAsGood : wanted == way.order;
    if (!taken) continue;
    std::vector<float> tensors = read_array(array, way.places, Mat3{1.0});
    FrameChoice choice = choose_frame(tensors, topology, frames_of(way.order), open, threads);
    if (!best.empty() && !clearly_better(choice.coherence, chosen.coherence)) continue;
    best = std::move(tensors);
    chosen = std::move(choice);
    name = way.name;
  }
  frame = chosen.frame;
  turn_stored(matrix_of(frame, topology.axes), best);
  std::string parts;
  for (std::size_t r = 0; r < kReadings.size(); ++r) {
    parts += (r == 0 ? "" : ", ") + short_number(std::round(1000.0 * positive[r]) / 10.0) + " % in " +
             kReadings[r].name;
  }
  notes.push_back("tensors taken in " + name + (wanted == StoredOrder::kAuto ? "" : ", as asked for") +
                  "; without an eigenvalue below zero: " + parts + " (--tensor-order)");
  notes.push_back(frame_note("tensors taken", chosen));
  return best;
}

std::vector<float> from_eigen_set(const DataSet& image, const TensorSource& source) {
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
    store(six_numbers(sum), Mat3{1.0}, &tensors[6 * p]);
  }
  return tensors;
}

std::vector<float> from_directions(const DataSet& image, const TensorSource& source) {
  const DataArray& directions = *image.find(source.arrays[0], Association::kPoint);
  const DataArray& anisotropies = *image.find(source.arrays[1], Association::kPoint);
  std::vector<float> tensors(6 * image.point_count());
  for (std::size_t p = 0; p < image.point_count(); ++p) {
    const Vec3 v{directions.at(p, 0), directions.at(p, 1), directions.at(p, 2)};
    const double length = glm::length(v);
    Mat3 tensor{0.0};
    if (length > 0.0 && std::isfinite(length)) {
      tensor = fibre_tensor(v / length, std::clamp(anisotropies.at(p), 0.0, 1.0));
    }
    store(six_numbers(tensor), Mat3{1.0}, &tensors[6 * p]);
  }
  return tensors;
}

/// Tensors along the longest of the peaks of each voxel. @param all become the peaks, as PeakField takes them.
/// @throws Error (bad input) where the numbers are no directions.
std::vector<float> from_peaks(const DataArray& peaks, const std::string& file, std::string& what,
                              std::vector<float>& all) {
  std::vector<Vec3> longest(peaks.tuples, Vec3{0.0});
  std::vector<double> lengths;
  std::size_t several = 0, numbers = 0, negative = 0;
  for (std::size_t p = 0; p < peaks.tuples; ++p) {
    int found = 0;
    for (int c = 0; c < peaks.components; c += 3) {
      const Vec3 v{peaks.at(p, c), peaks.at(p, c + 1), peaks.at(p, c + 2)};
      const double length = glm::length(v);
      if (!(length > 0.0) || !std::isfinite(length)) continue;
      ++found;
      for (int axis = 0; axis < 3; ++axis) {
        numbers += v[axis] != 0.0 ? 1 : 0;
        negative += v[axis] < 0.0 ? 1 : 0;
      }
      // Of those that are as long, but for rounding, the first: eigenvectors have one length often.
      constexpr double kLonger = 1.0 + 1e-4;
      if (length > kLonger * glm::length(longest[p])) longest[p] = v;
    }
    if (found > 0) lengths.push_back(glm::length(longest[p]));
    several += found > 1 ? 1 : 0;
  }
  // Signals are not below zero, directions are about as often as not: those of one hemisphere a third of the time.
  constexpr double kLeastNegative = 0.05;
  if (static_cast<double>(negative) < kLeastNegative * static_cast<double>(numbers) || lengths.empty()) {
    throw input_error({file, "",
                       "has " + std::to_string(peaks.components) +
                           " volumes that are no directions: hardly a number is below zero",
                       "peaks, tensors, or diffusion-weighted volumes with their gradients",
                       "name the gradients by --bval and --bvec"});
  }
  const auto usual = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() * 99 / 100);
  std::ranges::nth_element(lengths, usual);
  constexpr double kAnisotropy = 0.8;
  const auto anisotropy = [&](double length) { return kAnisotropy * std::min(1.0, length / *usual); };
  std::vector<float> tensors(6 * peaks.tuples);
  for (std::size_t p = 0; p < peaks.tuples; ++p) {
    const double length = glm::length(longest[p]);
    const Mat3 tensor = length > 0.0 ? fibre_tensor(longest[p] / length, anisotropy(length)) : Mat3{0.0};
    store(six_numbers(tensor), Mat3{1.0}, &tensors[6 * p]);
    for (int c = 0; c < peaks.components; c += 3) {
      Vec3 v{peaks.at(p, c), peaks.at(p, c + 1), peaks.at(p, c + 2)};
      const double own = glm::length(v);
      v = own > 0.0 && std::isfinite(own) ? v * (anisotropy(own) / own) : Vec3{0.0};
      for (int axis = 0; axis < 3; ++axis) all.push_back(static_cast<float>(v[axis]));
    }
  }
  const double share =
      std::round(1000.0 * static_cast<double>(several) / static_cast<double>(lengths.size())) / 10.0;
  what =
      "directions alone (peaks, " + std::to_string(peaks.components / 3) +
      " a voxel): tensors along the longest, with a mean diffusivity of 0.0007 mm^2/s and an FA of 0.8, less in "
      "proportion where it is shorter than in the upper hundredth";
  if (several > 0)
    what +=
        "; tracts and the hand follow the peak nearest to their way, within 45 degrees, from the longest on "
        "(--seeds peaks:… from each); " +
        short_number(share) + " % of the voxels have several";
  what += "; ";
  return tensors;
}

}  // namespace

void turn_vectors(const Mat3& turn, std::vector<float>& vectors) {
  for (std::size_t at = 0; at + 3 <= vectors.size(); at += 3) {
    const Vec3 v = turn * Vec3{vectors[at], vectors[at + 1], vectors[at + 2]};
    for (int axis = 0; axis < 3; ++axis) vectors[at + as_size(axis)] = static_cast<float>(v[axis]);
  }
}

TensorOrder order_of_size(int components) noexcept {
  if (components == 9) return TensorOrder::kFull;
  return components == 7 ? TensorOrder::kMask : TensorOrder::kRows;
}

std::vector<float> read_stored_tensors(const DataSet& image, const UniformTopology& topology,
                                       const TensorSource& source, const DiffusionInfo& diffusion,
                                       const TensorReading& reading, int threads, VectorFrame& frame,
                                       std::vector<std::string>& notes, const std::string& file,
                                       std::vector<float>& all_peaks) {
  const OpenFrame open{.asked = reading.frame, .stated = diffusion.frame};
  if (source.kind == TensorSource::Kind::kEigenSet || source.kind == TensorSource::Kind::kDirections) {
    const bool set = source.kind == TensorSource::Kind::kEigenSet;
    const bool peaks = !set && source.arrays.size() == 1;
    std::string what;
    std::vector<float> tensors =
        set     ? from_eigen_set(image, source)
        : peaks ? from_peaks(*image.find(source.arrays.front(), Association::kPoint), file, what, all_peaks)
                : from_directions(image, source);
    // Peaks are MRtrix's, which has them along the scanner's axes.
    std::vector<VectorFrame> likely{VectorFrame::kImage, VectorFrame::kScanner, VectorFrame::kLps};
    if (peaks) std::swap(likely[0], likely[1]);
    const FrameChoice choice = choose_frame(tensors, topology, likely, open, threads);
    frame = choice.frame;
    turn_stored(matrix_of(frame, topology.axes), tensors);
    if (peaks) {
      turn_vectors(matrix_of(frame, topology.axes), all_peaks);
      notes.push_back(frame_note(what + "taken", choice));
      return tensors;
    }
    notes.push_back(
        frame_note(set ? "tensors put together from eigenvectors and eigenvalues,"
                       : "V1 and FA alone do not determine tensors: taken as alike across V1, with a "
                         "mean diffusivity of 0.0007 mm^2/s,",
                   choice));
    return tensors;
  }
  const DataArray& array = *image.find(source.arrays.front(), Association::kPoint);
  if (diffusion.layout == TensorLayout::kData) {
    frame = reading.frame.value_or(VectorFrame::kScanner);
    if (reading.frame)
      notes.push_back("tensors taken along " + std::string(words_of(frame)) + ", as asked for (--vectors)");
    return read_array(array, order_of_size(array.components), matrix_of(frame, topology.axes));
  }
  StoredOrder order = reading.order;
  if (order == StoredOrder::kAuto && diffusion.layout == TensorLayout::kLower) order = StoredOrder::kNifti;
  return read_unstated(array, topology, order, open, threads, frame, notes, file);
}

}  // namespace palpate
