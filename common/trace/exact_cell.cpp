#include "common/trace/exact_cell.h"

#include <cmath>

namespace palpate {
namespace {

// The number of terms of (2) after which what is left is below 2^-52, by |h C|: theta^n / (n + 1)! plus the
// geometric tail.
constexpr int kMinTerms = 4;
constexpr int kMaxTerms = 26;

consteval std::array<double, kMaxTerms + 1> make_term_limits() {
  std::array<double, kMaxTerms + 1> limit{};
  for (int n = kMinTerms; n <= kMaxTerms; ++n) {
    // Largest theta with theta^n / (n + 1)! / (1 - theta / (n + 2)) <= 2^-52, by bisection.
    double low = 0.0, high = 4.0;
    for (int i = 0; i < 60; ++i) {
      const double theta = 0.5 * (low + high);
      double term = 1.0;
      for (int k = 1; k <= n; ++k) term *= theta / (k + 1);
      (term / (1.0 - theta / (n + 2)) <= 0x1p-52 ? low : high) = theta;
    }
    limit[static_cast<std::size_t>(n)] = low;
  }
  return limit;
}
constexpr auto kTermLimit = make_term_limits();

struct TermWeights {
  double inverse;                    // 1 / k
  double inverse_next;               // 1 / (k + 1)
  std::array<double, 3> node_power;  // c_m^k
};

// Five-point Lobatto rule on [0, 1]: nodes 0, c_1, 1/2, 1 - c_1, 1 with c_1 = (1 - sqrt(3/7)) / 2.
constexpr double kNode = 0.17267316464601142810;
constexpr double kEndWeight = 1.0 / 20, kOuterWeight = 49.0 / 180, kMiddleWeight = 16.0 / 45;

consteval std::array<TermWeights, kMaxTerms + 1> make_term_weights() {
  std::array<TermWeights, kMaxTerms + 1> weights{};
  std::array<double, 3> power{1.0, 1.0, 1.0};
  constexpr std::array<double, 3> node{kNode, 0.5, 1.0 - kNode};
  for (int k = 0; k <= kMaxTerms; ++k) {
    weights[static_cast<std::size_t>(k)] = {k > 0 ? 1.0 / k : 0.0, 1.0 / (k + 1), power};
    for (std::size_t m = 0; m < 3; ++m) power[m] *= node[m];
  }
  return weights;
}
constexpr auto kTerm = make_term_weights();

int term_count(double theta) noexcept {
  int n = kMinTerms;
  while (n < kMaxTerms && theta > kTermLimit[static_cast<std::size_t>(n)]) ++n;
  return n;
}

}  // namespace

bool AffineCell::load(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign) noexcept {
  const PackedVertex& p3 = vertices[tet[3]];
  corner_ = p3.x;
  std::array<Vec3, 3> du;
  for (std::size_t j = 0; j < 3; ++j) {
    const PackedVertex& p = vertices[tet[j]];
    edge_[j] = p.x - p3.x;
    du[j] = sign * (p.v - p3.v);
  }
  const Vec3 n0 = glm::cross(edge_[1], edge_[2]);
  const Vec3 n1 = glm::cross(edge_[2], edge_[0]);
  const Vec3 n2 = glm::cross(edge_[0], edge_[1]);
  const double inverse_det = 1.0 / glm::dot(edge_[0], n0);
  gradient_ = {n0 * inverse_det, n1 * inverse_det, n2 * inverse_det};
  const Vec3 v3 = sign * p3.v;
  double row[3];
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) row[i] = glm::dot(gradient_[i], du[j]);
    column_[j] = Pack4{row[0], row[1], row[2], -(row[0] + row[1] + row[2])};
  }
  for (std::size_t i = 0; i < 3; ++i) row[i] = glm::dot(gradient_[i], v3);
  offset_ = Pack4{row[0], row[1], row[2], -(row[0] + row[1] + row[2])};
  Pack4 sum;
  for (const Pack4& c : column_) {
    sum += Pack4{std::abs(c[0]), std::abs(c[1]), std::abs(c[2]), std::abs(c[3])};
  }
  norm_ = max_abs(sum);
  const double longest = std::fmax(glm::dot(edge_[0], edge_[0]),
                                   std::fmax(glm::dot(edge_[1], edge_[1]), glm::dot(edge_[2], edge_[2])));
  size_ = std::sqrt(longest);
  // A sum is finite only if every part of it is.
  return std::isfinite(norm_ + max_abs(offset_));
}

AffineCell::Flow AffineCell::flow(const Pack4& b, const Pack4& w, double h) const noexcept {
  const Pack4 d0 = h * column_[0], d1 = h * column_[1], d2 = h * column_[2];
  const int terms = term_count(std::abs(h) * norm_);
  Flow out{.b = w, .w = w, .inner = {w, w, w}};
  Pack4 u = w;
  for (int k = 1; k <= terms; ++k) {
    const TermWeights& weight = kTerm[static_cast<std::size_t>(k)];
    u = weight.inverse * ((u[0] * d0 + u[1] * d1) + u[2] * d2);
    out.w += u;
    out.b += weight.inverse_next * u;
    for (std::size_t m = 0; m < kNodes; ++m) out.inner[m] += weight.node_power[m] * u;
  }
  out.b = b + h * out.b;
  return out;
}

double AffineCell::arc(double first, const Flow& flow, double h, bool& sound) const noexcept {
  const double last = glm::length(velocity(flow.w));
  const double left = glm::length(velocity(flow.inner[0])), middle = glm::length(velocity(flow.inner[1]));
  const double right = glm::length(velocity(flow.inner[2]));
  const double lobatto = kEndWeight * (first + last) + kOuterWeight * (left + right) + kMiddleWeight * middle;
  const double simpson = (first + 4.0 * middle + last) * (1.0 / 6.0);
  // The error of Simpson's rule falls with the fourth power of the step, that of the longer rule with the
  // eighth: where they differ by 2e-7 the latter is right to some 1e-12.
  constexpr double kConverged = 2e-7;
  sound = std::abs(lobatto - simpson) <= kConverged * lobatto;
  return h * lobatto;
}

}  // namespace palpate
