#include "common/field/tensor/gradient_choice.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "common/base/text.h"

namespace palpate {
namespace {

/// Of the largest weighting: weightings that differ by less belong together, and those below it are zero.
constexpr double kApart = 0.05;

/// "3, 7 and 12 to 15"
std::string numbers_text(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += (i == 0 ? "" : ", ") + std::to_string(numbers[i]);
    if (last > i) text += (last == i + 1 ? ", " : " to ") + std::to_string(numbers[last]);
    i = last + 1;
  }
  return text;
}

std::string volumes_text(const std::vector<std::size_t>& volumes) {
  return (volumes.size() == 1 ? "volume " : "volumes ") + numbers_text(volumes) + " (counted from 0)";
}

}  // namespace

ChosenGradients choose_gradients(const GradientTable& stated) {
  GradientTable table = stated;
  ChosenGradients chosen;
  const std::size_t count = table.weightings.size();
  const double largest = table.largest_weighting();
  const auto is_zero = [&](std::size_t i) { return !(table.weightings[i] > kApart * largest); };
  std::vector<bool> kept(count, true);
  std::vector<std::size_t> undirected;
  bool unweighted = false;
  for (std::size_t i = 0; i < count; ++i) {
    unweighted = unweighted || is_zero(i);
    if (!is_zero(i) && table.directions[i] == Vec3{0.0}) undirected.push_back(i);
  }
  if (!undirected.empty() && unweighted) {
    for (const std::size_t i : undirected) kept[i] = false;
    chosen.notes.push_back(
        "WARNING: " + volumes_text(undirected) +
        " weighted, but without a gradient direction (trace images?): left out of the fit");
  } else if (!undirected.empty()) {
    for (const std::size_t i : undirected) table.weightings[i] = 0.0;
    chosen.notes.push_back(
        volumes_text(undirected) +
        " weighted, but without a gradient direction, and no other is unweighted: taken as "
        "b = 0, as GE writes them and MRtrix reads them");
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!kept[i]) continue;
    chosen.table.weightings.push_back(table.weightings[i]);
    chosen.table.directions.push_back(table.directions[i]);
    chosen.volumes.push_back(i);
  }
  return chosen;
}

TableQuality quality_of(const GradientTable& table) {
  using Seven = Eigen::Matrix<double, 7, 7>;
  using Six = Eigen::Matrix<double, 6, 6>;
  const double largest = table.largest_weighting();
  Seven normal = Seven::Zero(), even = Seven::Zero();
  Six directions = Six::Zero();
  // Means over the sphere: of g_a^2 g_b^2 1/5 where a = b, else 1/15; of g_a^2 1/3; of odd powers 0.
  constexpr double kFour = 1.0 / 5.0, kTwoTwo = 1.0 / 15.0, kTwo = 1.0 / 3.0;
  Seven spread = Seven::Zero();
  for (const int a : {0, 3, 5}) {
    for (const int b : {0, 3, 5}) spread(a, b) = a == b ? kFour : kTwoTwo;
    spread(a, 6) = spread(6, a) = -kTwo;
  }
  for (const int mixed : {1, 2, 4}) spread(mixed, mixed) = 4.0 * kTwoTwo;
  for (std::size_t i = 0; i < table.weightings.size(); ++i) {
    const bool zero = table.unweighted(i);
    const double b = table.directions[i] == Vec3{0.0} ? 0.0 : table.weightings[i] / largest;
    const Vec3& g = table.directions[i];
    Eigen::Matrix<double, 7, 1> row;
    row << g.x * g.x, 2.0 * g.x * g.y, 2.0 * g.x * g.z, g.y * g.y, 2.0 * g.y * g.z, g.z * g.z, 1.0;
    if (!zero) directions += row.head<6>() * row.head<6>().transpose();
    row.head<6>() *= -b;
    normal += row * row.transpose();
    Seven ideal = spread;
    ideal.topLeftCorner<6, 6>() *= b * b;
    ideal.col(6) *= b;
    ideal.row(6) *= b;
    ideal(6, 6) = 1.0;
    even += ideal;
  }
  TableQuality quality;
  const Eigen::SelfAdjointEigenSolver<Six> eigen(directions, Eigen::EigenvaluesOnly);
  quality.condition = std::sqrt(eigen.eigenvalues()(5) / std::max(0.0, eigen.eigenvalues()(0)));
  const Seven covariance = normal.ldlt().solve(Seven::Identity());
  const Seven best = even.ldlt().solve(Seven::Identity());
  for (int c = 0; c < 6; ++c)
    quality.noise_gain[static_cast<std::size_t>(c)] = std::sqrt(covariance(c, c) / best(c, c));
  return quality;
}

std::vector<Shell> shells_of(const GradientTable& table) {
  std::vector<std::size_t> order(table.weightings.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return table.weightings[a] < table.weightings[b]; });
  const double apart = kApart * table.largest_weighting();
  std::vector<Shell> shells;
  std::vector<Vec3> seen;
  for (const std::size_t i : order) {
    const double b = table.weightings[i];
    if (shells.empty() || b - shells.back().most > apart) {
      shells.push_back({.least = b, .most = b});
      seen.clear();
    }
    Shell& shell = shells.back();
    shell.most = b;
    ++shell.volumes;
    constexpr double kSame = 0.9998;  // cosine of a degree
    const Vec3& g = table.directions[i];
    if (b <= apart || g == Vec3{0.0} || std::any_of(seen.begin(), seen.end(), [&g](const Vec3& other) {
          return std::abs(glm::dot(g, other)) > kSame;
        })) {
      continue;
    }
    seen.push_back(g);
    shell.directions = seen.size();
  }
  return shells;
}

std::string shells_text(const std::vector<Shell>& shells) {
  std::string text;
  const auto rounded = [](double b) { return short_number(std::round(10.0 * b) / 10.0); };
  for (const Shell& shell : shells) {
    text += (text.empty() ? "b " : "; b ") + rounded(shell.least);
    if (rounded(shell.most) != rounded(shell.least)) text += " to " + rounded(shell.most);
    text += ": " + counted(shell.volumes, "volume");
    if (shell.directions > 0) text += " in " + counted(shell.directions, "direction");
  }
  return text;
}

}  // namespace palpate
