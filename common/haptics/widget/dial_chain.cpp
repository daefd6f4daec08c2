#include "common/haptics/widget/dial_chain.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "common/haptics/constraint/circle.h"
#include "common/haptics/constraint/detent_marks.h"
#include "common/haptics/constraint/polyline.h"

namespace palpate {
namespace {

std::unique_ptr<ProxyChain> chain_of(std::unique_ptr<Constraint> way, const std::vector<Vec3>& marks,
                                     const ChainSettings& settings) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::move(way));
  if (marks.size() > 1) {
    constexpr double kPart = 0.5;  // of the distance between neighbours: one ends where the next begins
    links.push_back(std::make_unique<DetentMarks>(marks, kPart * glm::distance(marks[0], marks[1])));
  }
  return std::make_unique<ProxyChain>(std::move(links), settings);
}

}  // namespace

std::unique_ptr<ProxyChain> make_slider_chain(const Vec3& a, const Vec3& b, int detents,
                                              const ChainSettings& settings) {
  std::vector<Vec3> marks;
  for (int i = 0; detents > 1 && i < detents; ++i)
    marks.push_back(a + (static_cast<double>(i) / (detents - 1)) * (b - a));
  return chain_of(std::make_unique<PolylineConstraint>(a, b), marks, settings);
}

std::unique_ptr<ProxyChain> make_knob_chain(const Vec3& center, const Vec3& normal, const Vec3& start,
                                            double radius, int detents, const ChainSettings& settings) {
  const Vec3 n = glm::normalize(normal), away = start - center;
  const Vec3 u = glm::normalize(away - glm::dot(away, n) * n), t = glm::cross(n, u);
  std::vector<Vec3> marks;
  for (int i = 0; detents > 1 && i < detents; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / detents;
    marks.push_back(center + radius * (std::cos(angle) * u + std::sin(angle) * t));
  }
  return chain_of(std::make_unique<CircleConstraint>(center, n, radius), marks, settings);
}

}  // namespace palpate
