#include "common/field/tensor/gradient_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "common/base/error.h"
#include "common/base/index.h"
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

/// Makes directions unit, and weightings those of their lengths where `choice` says so.
void scale_weightings(const GradientChoice& choice, const std::string& file, GradientTable& table,
                      std::vector<std::string>& notes) {
  constexpr double kUnit = 0.01;  // of the logarithm of the squared length
  bool unit = true;
  double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
  std::vector<double> lengths;
  for (std::size_t i = 0; i < table.directions.size(); ++i) {
    Vec3& g = table.directions[i];
    double length = is_finite(g) ? glm::length(g) : 0.0;
    if (!std::isfinite(length)) length = 0.0;
    g = length > 0.0 ? g / length : Vec3{0.0};
    lengths.push_back(length);
    if (length == 0.0 || table.weightings[i] == 0.0) continue;
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
    unit = unit && std::abs(2.0 * std::log(length)) <= kUnit;
  }
  if (unit) return;
  const std::string found =
      "gradient directions have lengths from " + short_number(shortest) + " to " + short_number(longest);
  if (!choice.scale_by_length) {
    notes.push_back(found + ": ignored, b-values as stated (--bvec-length)");
    return;
  }
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    if (lengths[i] > 0.0) table.weightings[i] *= lengths[i] * lengths[i];
    if (!std::isfinite(table.weightings[i]))
      throw input_error({file, "gradient " + std::to_string(i + 1),
                         "has a length of " + short_number(lengths[i]) + ": its b-value overflows", "", ""});
  }
  notes.push_back(found +
                  ": b-values scaled by the squared lengths, as MRtrix does (--bvec-length ignore takes them "
                  "as stated)");
}

bool in_shell(double weighting, const std::vector<double>& shells) {
  return std::any_of(shells.begin(), shells.end(),
                     [&](double shell) { return std::abs(weighting - shell) <= kApart * shell; });
}

}  // namespace

ChosenGradients choose_gradients(const GradientTable& stated, const GradientChoice& choice,
                                 const std::string& file) {
  GradientTable table = stated;
  ChosenGradients chosen;
  scale_weightings(choice, file, table, chosen.notes);
  const std::size_t count = table.weightings.size();
  std::vector<bool> kept(count, true);
  for (const std::size_t volume : choice.left_out) {
    if (volume >= count)
      throw usage_error("--leave-out " + std::to_string(volume) + ": " + file + " has the volumes 0 to " +
                        std::to_string(count - 1));
    kept[volume] = false;
  }
  // What counts as unweighted is a share of the largest b that may stay.
  double largest = choice.max_weighting;
  if (!choice.shells.empty()) largest = std::min(largest, *std::ranges::max_element(choice.shells));
  double found = 0.0;
  for (std::size_t i = 0; i < count; ++i)
    if (kept[i]) found = std::max(found, table.weightings[i]);
  largest = std::min(largest, found);
  const auto is_zero = [&](std::size_t i) { return !(table.weightings[i] > kApart * largest); };
  std::vector<std::size_t> undirected;
  bool unweighted = false;
  for (std::size_t i = 0; i < count; ++i) {
    unweighted = unweighted || is_zero(i);  // also one that is left out tells how the file was written
    if (kept[i] && !is_zero(i) && table.directions[i] == Vec3{0.0}) undirected.push_back(i);
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
  std::vector<std::size_t> beyond, off_shell;
  bool on_shell = choice.shells.empty();
  for (std::size_t i = 0; i < count; ++i) {
    if (!kept[i] || is_zero(i)) continue;
    const double b = table.weightings[i];
    const bool wanted = choice.shells.empty() || in_shell(b, choice.shells);
    on_shell = on_shell || wanted;
    if (!wanted) {
      off_shell.push_back(i);
    } else if (b > choice.max_weighting * (1.0 + kApart)) {
      beyond.push_back(i);
    }
  }
  if (!on_shell)
    throw usage_error("--shell: " + file + " has none of these b-values; it has " +
                      shells_text(shells_of(table)));
  const auto leave_out = [&](const std::vector<std::size_t>& volumes, const char* option) {
    for (const std::size_t i : volumes) kept[i] = false;
    if (!volumes.empty())
      chosen.notes.push_back(volumes_text(volumes) + " left out of the fit, as asked for (" + option + ")");
  };
  leave_out(choice.left_out, "--leave-out");
  leave_out(beyond, "--max-b");
  leave_out(off_shell, "--shell");
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
  for (int c = 0; c < 6; ++c) quality.noise_gain[as_size(c)] = std::sqrt(covariance(c, c) / best(c, c));
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
