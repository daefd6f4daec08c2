/// A probe in the whirlwind of sample_scenes.h: everything that a ProbeView can show.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "common/render/scene_view.h"
#include "tests/common/render/sample_scenes.h"
#include "tests/support/path_view.h"

namespace palpate::test {

/// The streamline of `line` with balls at equal times: `count` of them.
inline std::shared_ptr<const FollowedLine> followed_of(const Line& line, int count) {
  auto followed = std::make_shared<FollowedLine>();
  for (const LinePoint& point : line.points) {
    followed->points.push_back(point.position);
    followed->values.push_back(point.speed);
  }
  for (int i = 0; i < count; ++i) {
    const LinePoint& point =
        line.points[line.points.size() * static_cast<std::size_t>(i) / static_cast<std::size_t>(count)];
    followed->balls.push_back(point.position);
    followed->ball_values.push_back(point.speed);
  }
  return followed;
}

/// Follows line 12 of the whirlwind: the hand pulls away from it at point `at`, the path winds along it, a
/// rake crosses the middle and two lines are kept.
inline ProbeView sample_probe(const SceneView& view, std::size_t at = 150) {
  const std::vector<Line>& lines = *view.lines;
  const Line& held = lines.at(12);
  ProbeView probe;
  probe.followed = followed_of(held, 30);
  probe.proxy = held.points.at(at).position;
  probe.probe = probe.proxy + 0.16 * view.bounds.size() * Vec3(0.5, -0.6, 0.35);
  probe.force = 1.3;
  probe.force_cap = 2.0;
  probe.velocity = held.points[at].position - held.points[at - 1].position;
  probe.reference_speed = glm::length(probe.velocity) / 1.2;

  std::vector<Vec3> positions;
  std::vector<double> forces;
  const double shift = 0.015 * view.bounds.size().x;
  for (std::size_t i = 20; i <= at; ++i) {
    const double t = static_cast<double>(i - 20) / static_cast<double>(at - 20);
    positions.push_back(held.points[i].position + shift * (1.0 - t) * Vec3(std::sin(40.0 * t), 1.0, 2.0));
    forces.push_back(probe.force * (0.5 + 0.5 * std::sin(25.0 * t)));
  }
  probe.path = make_path_view(positions, forces);

  auto seeds = std::make_shared<LocalSeeds>();
  seeds->shape = SeedShape::kRake;
  seeds->origin = view.bounds.center() + 0.5 * view.bounds.size() * Vec3(-0.55, -0.5, 0.25);
  seeds->u = 0.5 * view.bounds.size() * Vec3(0.9, 0.0, 0.1);
  auto local = std::make_shared<std::vector<Line>>();
  for (int i = 0; i < 7; ++i) {
    const Vec3 seed = seeds->origin + (i + 0.5) / 7.0 * seeds->u;
    seeds->seeds.push_back(seed);
    Line line;
    for (int k = -12; k <= 12; ++k) {
      const double turn = 0.05 * k;
      const Vec3 r = seed - view.bounds.center();
      const Vec3 x(std::cos(turn) * r.x - std::sin(turn) * r.y, std::sin(turn) * r.x + std::cos(turn) * r.y,
                   r.z + 0.006 * k * view.bounds.size().z);
      line.points.push_back({view.bounds.center() + x, 0.0, 0.0, 0.5 + 0.2 * i, 1e-9});
    }
    local->push_back(std::move(line));
  }
  seeds->lines = local;
  seeds->width = 5.0;
  probe.seeds = seeds;

  auto kept = std::make_shared<std::vector<DrawnLine>>();
  for (const int k : {1, 2}) {
    const auto number = static_cast<std::size_t>(17 * k);
    kept->push_back(
        {.line = std::make_shared<const Line>(lines.at(std::min(number, lines.size() - 1))), .number = k});
  }
  probe.drawn_lines = kept;
  return probe;
}

}  // namespace palpate::test
