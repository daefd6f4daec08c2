/// Lines to draw, made by formula: a bundle that winds up like a whirlwind, and single straight lines.
#pragma once

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/render/png.h"
#include "common/render/scene_view.h"

namespace palpate::test {

/// Helices that widen as they rise in the box [-1, 1]^3 * scale + shift; speed falls with the radius.
inline SceneView whirlwind(double aspect, int line_count = 60, double scale = 1.0, Vec3 shift = Vec3{0.0}) {
  auto lines = std::make_shared<std::vector<Line>>();
  for (int k = 0; k < line_count; ++k) {
    Line line;
    line.seed = static_cast<std::uint32_t>(k);
    line.end = static_cast<End>(k % 3);
    const double phase = 2.399963 * k, base = 0.08 + 0.5 * k / line_count;  // golden angle: spread evenly
    double arc = 0.0;
    for (int i = 0; i <= 240; ++i) {
      const double z = -0.95 + 1.9 * i / 240.0;
      const double radius = base * (0.45 + 0.25 * (z + 1.0) * (z + 1.0) * 0.9);
      const double angle = phase + 4.0 * (z + 1.0) / (0.25 + base);
      const Vec3 x = scale * Vec3(radius * std::cos(angle), radius * std::sin(angle), z) + shift;
      if (!line.points.empty()) arc += glm::distance(x, line.points.back().position);
      line.points.push_back(
          {x, i / 240.0, arc, scale * 0.2 / (0.1 + radius), scale * 1e-9 * std::pow(10.0, i / 40.0)});
    }
    lines->push_back(std::move(line));
  }
  SceneView view;
  view.bounds = {Vec3(-scale) + shift, Vec3(scale) + shift};
  view.lines = lines;
  view.camera = make_camera(view.bounds, {}, aspect);
  return view;
}

/// One straight line through the points.
inline Line polyline(const std::vector<Vec3>& points, double value = 0.0) {
  Line line;
  for (const Vec3& x : points) line.points.push_back({x, value, value, value, value});
  return line;
}

/// Keeps a picture for the eye where PALPATE_PICTURES names a folder.
inline void cache_picture(const Image& image, const std::string& name) {
  const char* folder = std::getenv("PALPATE_PICTURES");
  if (folder == nullptr) return;
  std::filesystem::create_directories(folder);
  write_png(std::filesystem::path(folder) / (name + ".png"), image, {});
}

}  // namespace palpate::test
