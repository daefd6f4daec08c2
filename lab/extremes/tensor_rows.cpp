#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/field/tensor/tensor_fit.h"
#include "common/math/symmetric3.h"
#include "common/trace/tract/main_direction.h"
#include "lab/data/fit_errors.h"
#include "lab/extremes/extreme.h"

namespace palpate {
namespace {

constexpr double kRounding = 0x1p-53;

/// A rotation that is aligned with nothing.
Mat3 turned_axes() {
  const Vec3 a = glm::normalize(Vec3{2.0, 1.0, -1.5});
  const Vec3 b = glm::normalize(glm::cross(a, Vec3{0.3, -1.0, 0.7}));
  return {a, b, glm::cross(a, b)};
}

Mat3 turned(const Vec3& values) {
  const Mat3 r = turned_axes();
  Mat3 a{0.0};
  for (int i = 0; i < 3; ++i) {
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 3; ++k) a[c][i] += r[k][i] * values[k] * r[k][c];
    }
  }
  return a;
}

double largest(const Mat3& a) {
  double most = 0.0;
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < 3; ++i) most = a[c][i] == a[c][i] ? std::max(most, std::abs(a[c][i])) : HUGE_VAL;
  }
  return most;
}

/// Of V diag(w) V^T - A, of the largest value of A, and of V^T V - 1, in roundings.
double eigen_error(const Vec3& values) {
  const Mat3 a = turned(values);
  const SymmetricEigen found = symmetric_eigen(a);
  const double scale = std::max(largest(a), std::numeric_limits<double>::denorm_min());
  double worst = largest(glm::transpose(found.vectors) * found.vectors - Mat3(1.0));
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) {
      double sum = -found.values[k] / scale * found.vectors[k][i];
      for (int c = 0; c < 3; ++c) sum += a[c][i] / scale * found.vectors[k][c];
      worst = sum == sum ? std::max(worst, std::abs(sum)) : HUGE_VAL;
    }
  }
  if (found.values[0] < found.values[1] || found.values[1] < found.values[2]) return HUGE_VAL;
  return worst / kRounding;
}

void add_eigen_rows(std::vector<Extreme>& rows) {
  const std::pair<const char*, Vec3> kinds[] = {{"isotropic", {1, 1, 1}},
                                                {"planar", {1, 1, 0}},
                                                {"linear", {1, 0, 0}},
                                                {"zero", {0, 0, 0}},
                                                {"negative", {-1, -2, -3}},
                                                {"of both signs", {1, 0.5, -1}},
                                                {"two values 1e-12 apart", {1, 1.0 - 1e-12, 0.5}},
                                                {"two values a rounding apart", {1, 1.0 - 0x1p-52, 0.5}},
                                                {"values 1e16 apart", {1, 1e-8, 1e-16}},
                                                {"1e38", {3e38, 2e38, 1e38}},
                                                {"1e-38", {3e-38, 2e-38, 1e-38}},
                                                {"1e300", {3e300, 2e300, 1e300}},
                                                {"1e-300", {3e-300, 2e-300, 1e-300}}};
  for (const auto& [name, values] : kinds) {
    rows.push_back({ExtremeKind::kTensor, std::string("eigenvectors, ") + name,
                    "R diag(w) R^T, R aligned with nothing", "residual of A v = w v and of V^T V = 1", 24.0,
                    "roundings", [values = values] { return eigen_error(values); }});
  }
  // Of a diagonal tensor, where arithmetic would not carry it to the other values.
  rows.push_back({ExtremeKind::kTensor, "eigenvectors, NaN",
                  "a NaN among the three numbers of a diagonal tensor",
                  "values that are numbers all the same", 0.0, "values", [] {
                    Mat3 a(1.0);
                    a[1][1] = kNaN;
                    const SymmetricEigen found = symmetric_eigen(a);
                    double numbers = 0.0;
                    for (int k = 0; k < 3; ++k) numbers += std::isnan(found.values[k]) ? 0.0 : 1.0;
                    return numbers;
                  }});
  // The main direction along a line, from one that is up to sixty degrees away.
  for (const double gap : {1e-1, 1e-4, 1e-8, 1e-12, 0.0}) {
    rows.push_back(
        {ExtremeKind::kTensor,
         "main direction, two values " +
             (gap > 0.0 ? std::to_string(static_cast<int>(std::round(-std::log10(gap)))) + " digits apart"
                        : std::string("equal")),
         "R diag(1, 1 - gap, 0.2) R^T, from a direction 60 degrees away", "residual of D v = v", 1e-9,
         "of the largest value", [gap] {
           const Mat3 a = turned({1.0, 1.0 - gap, 0.2});
           const auto d = six_numbers(a);
           const Tensor6 tensor{d[0], d[1], d[2], d[3], d[4], d[5]};
           const Mat3 r = turned_axes();
           double worst = 0.0;
           for (int i = 0; i < 16; ++i) {
             const double angle = 0.39 * i;
             const Vec3 toward = glm::normalize(
                 0.5 * r[0] + 0.8660254037844386 * (std::cos(angle) * r[1] + std::sin(angle) * r[2]));
             const Vec3 v = main_direction(tensor, toward);
             if (!(glm::dot(v, toward) >= 0.0)) return HUGE_VAL;
             worst = std::max(worst, glm::length(a * v - v));
           }
           return worst;
         }});
  }
}

struct FitCase {
  GradientTable table = spread_gradients(30);
  double scale = 1.0;                   ///< of the signals
  Vec3 values{1.7e-3, 0.3e-3, 0.2e-3};  ///< of the tensor [mm^2/s]
};

/// In single precision but for their scale.
std::vector<double> signals_of(const FitCase& of) {
  const Mat3 d = turned(of.values);
  std::vector<double> signals;
  for (std::size_t i = 0; i < of.table.weightings.size(); ++i) {
    const Vec3& g = of.table.directions[i];
    signals.push_back(of.scale * static_cast<float>(std::exp(-of.table.weightings[i] * glm::dot(g, d * g))));
  }
  return signals;
}

TensorFit fitted(const FitCase& of, const std::vector<double>& signals) {
  const DataArray image = make_array("signals", Association::kPoint, static_cast<int>(signals.size()),
                                     std::span<const double>(signals));
  return fit_tensors(image, of.table, {}, {.threads = 1});
}

/// Largest error of the six numbers, of the largest value.
double fit_error(const FitCase& of) {
  const TensorFit fit = fitted(of, signals_of(of));
  if (fit.fitted != 1) return HUGE_VAL;
  const auto d = six_numbers(turned(of.values));
  double worst = 0.0;
  for (std::size_t i = 0; i < 6; ++i) {
    const double off = std::abs(static_cast<double>(fit.tensors[i]) - d[i]);
    worst = off == off ? std::max(worst, off) : HUGE_VAL;
  }
  return worst / std::abs(of.values[0]);
}

void add_fit_rows(std::vector<Extreme>& rows) {
  const auto row = [&](const std::string& name, const std::string& builder, double limit, const FitCase& of) {
    rows.push_back({ExtremeKind::kTensor, "fit, " + name, builder, "largest error of the six numbers", limit,
                    "of the largest eigenvalue", [of] { return fit_error(of); }});
  };
  constexpr double kFloats = 1e-5;
  row("30 directions", "signals of a tensor in single precision", kFloats, {});
  row("6 directions", "as few as determine a tensor", kFloats, {.table = spread_gradients(6)});
  row("signals of 1e200", "a scale of the signals, whose squares are no numbers", kFloats, {.scale = 1e200});
  row("signals of 1e-30", "a scale of the signals", kFloats, {.scale = 1e-30});
  row("isotropic", "three equal values", kFloats, {.values = Vec3(1e-3)});
  row("negative", "a value below zero", kFloats, {.values = {1.7e-3, 0.3e-3, -0.1e-3}});
  GradientTable near = spread_gradients(30);
  // All directions within a tenth of a degree of a cone that leaves one unknown open.
  for (std::size_t i = 1; i < near.directions.size(); ++i) {
    const double phi = 0.7 * static_cast<double>(i), z = 0.5 + 2e-3 * std::sin(2.3 * static_cast<double>(i));
    const double r = std::sqrt(1.0 - z * z);
    near.directions[i] = {r * std::cos(phi), r * std::sin(phi), z};
  }
  row("near-singular table", "directions within a tenth of a degree of one cone", 1e-2, {.table = near});
  rows.push_back({ExtremeKind::kTensor, "fit, singular table", "directions in one plane",
                  "tables that are not refused", 0.0, "tables", [] {
                    GradientTable flat = spread_gradients(30);
                    for (Vec3& g : flat.directions) {
                      g.z = 0.0;
                      if (glm::length(g) > 0.0) g = glm::normalize(g);
                    }
                    return gradient_problem(flat).empty() ? 1.0 : 0.0;
                  }});
  const auto spoiled = [&](const std::string& name, double value, bool usable) {
    rows.push_back({ExtremeKind::kTensor, "fit, " + name, "one signal of thirty is that",
                    usable ? "voxels whose tensor is not finite, or not counted as lifted"
                           : "voxels that are not counted as unusable",
                    0.0, "voxels", [value, usable] {
                      const FitCase of;
                      std::vector<double> signals = signals_of(of);
                      signals[7] = value;
                      const TensorFit fit = fitted(of, signals);
                      if (!usable) return fit.unusable == 1 && std::isnan(fit.tensors[0]) ? 0.0 : 1.0;
                      for (const float number : fit.tensors) {
                        if (!std::isfinite(number)) return 1.0;
                      }
                      return fit.lifted == 1 ? 0.0 : 1.0;
                    }});
  };
  spoiled("a signal of zero", 0.0, true);
  spoiled("a negative signal", -1.0, true);
  spoiled("a signal of NaN", kNaN, false);
  spoiled("an infinite signal", std::numeric_limits<double>::infinity(), false);
}

}  // namespace

void add_tensor_rows(std::vector<Extreme>& rows) {
  add_eigen_rows(rows);
  add_fit_rows(rows);
}

}  // namespace palpate
