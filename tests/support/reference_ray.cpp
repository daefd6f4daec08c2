#include "tests/support/reference_ray.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>

#include "common/base/parallel.h"
#include "common/math/power_of_two.h"
#include "common/render/volume/volume_block.h"
#include "common/render/volume/voxels/coarse_image.h"

namespace palpate::test {
namespace {

// The light of shaders/include/shade.glsl and shaders/volume/surface.glsl.
constexpr double kAmbient = 0.35, kDiffuse = 0.70, kSpecular = 0.25, kGloss = 24.0, kFaint = 0.005;

// Where the matter lies that `lens` shows at x (shaders/volume/magnify.glsl). How far the lens reaches from
// its middle in the direction of x comes from its intersection with that line.
Vec3 place_seen(const Lens& lens, const Vec3& x) {
  constexpr double kCore = 0.5;
  const Vec3 center = center_of(lens.shape, Vec3(0.0)), away = x - center;
  if (away == Vec3(0.0)) return center;
  const double u = std::min(1.0, 1.0 / clip_line(lens.shape, center, away).last);
  const double outer = std::max(0.0, (u - kCore) / (1.0 - kCore));
  const double f = u / lens.magnification + (1.0 - 1.0 / lens.magnification) * outer * outer;
  return center + f / u * away;
}

}  // namespace

ReferenceRay::ReferenceRay(const VolumeView& view, const Camera& camera, int width, int height,
                           double samples)
    : view_(view), camera_(camera), height_(height), width_(width), samples_(samples) {
  for (std::size_t field = 0; field <= view.fields.size(); ++field) {
    Grid& grid = grids_.emplace_back(make_grid(image_of(view, field)));
    const NumberRange range = table_range(view, field);
    grid.place_scale = (view.table_entries - 1.0) / view.table_entries / (range.upper - range.lower);
  }
  if (draws_context_alone(view) && view.context.level > 0)
    coarse_ = make_grid(coarse_image(*view.image, view.context.level));
}

ReferenceRay::Grid ReferenceRay::make_grid(std::shared_ptr<const VolumeImage> image) {
  Grid grid{.image = std::move(image), .numbers = {}};
  grid.numbers.resize(grid.image->point_count());
  for (std::size_t i = 0; i < grid.numbers.size(); ++i) grid.numbers[i] = grid.image->number(i);
  const double unit = power_of_two(binary_exponent(grid.image->bounds().diagonal()));
  grid.grid_from_data = glm::inverse(grid.image->axes / unit) / unit;
  return grid;
}

double ReferenceRay::coarse_at(const Vec3& g) const {
  const Vec3 fine = glm::max(Vec3(view_.image->points - 1), Vec3(1.0));
  return coarse_->number_at(g * Vec3(coarse_->image->points - 1) / fine);
}

double ReferenceRay::number_in(const Lens& lens, const Vec3& g, const Vec3& x, double at_x,
                               double at_y) const {
  if (!coarse_ || !has_transition(lens)) return grids_[lens.field].number_at(g);
  double u = 0.0;
  if (lens.screen) u = std::hypot(at_x - lens.screen->x, at_y - lens.screen->y) / lens.screen->radius;
  const Vec3 center = center_of(lens.shape, Vec3(0.0));
  if (!lens.screen && x != center) u = 1.0 / clip_line(lens.shape, center, x - center).last;
  const double s = std::clamp((1.0 - u) / lens.transition, 0.0, 1.0);
  return glm::mix(coarse_at(g), grids_[0].number_at(g), s * s * (3.0 - 2.0 * s));
}

double ReferenceRay::Grid::number_at(const Vec3& g) const {
  const Index3 n = image->points;
  const Vec3 bounded = glm::clamp(g, Vec3(0.0), Vec3(n - 1));
  const Index3 cell = glm::min(Index3(glm::floor(bounded)), glm::max(n - 2, Index3(0)));
  const Vec3 u = bounded - Vec3(cell);
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Index3 bit{corner & 1, corner >> 1 & 1, corner >> 2 & 1};
    const Index3 p = glm::min(cell + bit, n - 1);
    double weight = 1.0;
    for (int a = 0; a < 3; ++a) weight *= bit[a] != 0 ? u[a] : 1.0 - u[a];
    sum += weight * numbers[static_cast<std::size_t>(p.x) +
                            static_cast<std::size_t>(n.x) *
                                (static_cast<std::size_t>(p.y) +
                                 static_cast<std::size_t>(n.y) * static_cast<std::size_t>(p.z))];
  }
  return sum;
}

Vec3 ReferenceRay::Grid::slope_at(const Vec3& g) const {
  Vec3 slope{0.0};
  for (int a = 0; a < 3; ++a) {
    Vec3 side{0.0};
    side[a] = 1.0;
    slope[a] = 0.5 * (number_at(g + side) - number_at(g - side));
  }
  return slope;
}

double ReferenceRay::Grid::gradient_at(const Vec3& g) const {
  return image->scale * glm::length(slope_at(g) * grid_from_data);
}

bool ReferenceRay::Grid::holds(const Vec3& g) const {
  const Vec3 lower = image->lower(), upper = image->upper();
  for (int a = 0; a < 3; ++a) {
    if (!(g[a] >= lower[a] && g[a] <= upper[a])) return false;  // NaN, too
  }
  return true;
}

Vec3 ReferenceRay::lit(const Grid& grid, const Vec3& g, const Vec3& color, const Vec3& direction) const {
  const Vec3 slope = grid.place_scale * grid.slope_at(g);
  Vec3 normal = slope * grid.grid_from_data;
  const double size = glm::length(normal);
  if (!(size > 0.0)) return color;
  normal /= size;
  const Vec3 light = glm::normalize(camera_.axes[2] + 0.55 * camera_.axes[1] - 0.45 * camera_.axes[0]);
  const double ln = glm::dot(light, normal);
  const double shine = std::max(glm::dot(2.0 * ln * normal - light, -direction), 0.0);
  const double square = glm::dot(slope, slope);
  const double share = square / (square + kFaint * kFaint);
  const Vec3 shone = color * (kAmbient + kDiffuse * std::abs(ln)) + kSpecular * std::pow(shine, kGloss);
  return glm::min(color + share * (shone - color), Vec3(1.0));
}

Rgba ReferenceRay::cast(double x, double y) const {
  const double pixel = camera_.view_height / height_;
  const Vec3 across =
      (x - 0.5 * width_) * pixel * camera_.axes[0] + (y - 0.5 * height_) * pixel * camera_.axes[1];
  const bool perspective = camera_.projection == Projection::kPerspective;
  const Vec3 origin = perspective ? eye(camera_) : eye(camera_) + across;
  const Vec3 direction =
      perspective ? glm::normalize(camera_.focal_point + across - origin) : -camera_.axes[2];

  const VolumeImage& image = *view_.image;
  const Vec3 g0 = grids_[0].grid_from_data * (origin - image.origin);
  const Vec3 speed = grids_[0].grid_from_data * direction;
  // A lens may show something out of the context's volume.
  const bool reaches_out = field_count(view_) > 1 || has_magnified_parts(view_);
  double first = perspective ? 0.0 : -HUGE_VAL, last = HUGE_VAL;
  for (int a = 0; a < 3; ++a) {
    if (speed[a] == 0.0) {
      if (g0[a] < image.lower()[a] || g0[a] > image.upper()[a]) last = -HUGE_VAL;
      continue;
    }
    const double p = (image.lower()[a] - g0[a]) / speed[a], q = (image.upper()[a] - g0[a]) / speed[a];
    first = std::max(first, std::min(p, q));
    last = std::min(last, std::max(p, q));
  }

  double nearest = perspective ? 0.0 : -HUGE_VAL, farthest = HUGE_VAL;
  for (const CuttingPlane& cut : view_.cuts) {
    if (!cut.on) continue;
    const LineInterval kept = clip_line({.quadric = {}, .half_spaces = {cut.kept}}, origin, direction);
    nearest = std::max(nearest, kept.first);
    farthest = std::min(farthest, kept.last);
    if (!(kept.first < kept.last)) return {};
  }
  first = std::max(first, nearest);
  last = std::min(last, farthest);
  const double at_x = (x - 0.5 * width_) / height_, at_y = (y - 0.5 * height_) / height_;
  const auto in_circle = [&](const Lens& lens) { return !lens.screen || lens.screen->holds(at_x, at_y); };
  std::vector<double> borders;
  if (first < last) borders = {first, last};
  for (const Lens& lens : view_.lenses) {
    const LineInterval inside = clip_line(lens.shape, origin, direction);
    if (!(inside.first < inside.last) || !in_circle(lens)) continue;
    for (double t : {inside.first, inside.last}) {
      // What is enlarged, or of another field, may be seen out of the volume, too.
      const bool far = magnifies(lens) || lens.field > 0;
      if (far) t = std::clamp(t, nearest, std::max(nearest, farthest));
      if (far || (reaches_out && std::isfinite(t)) || (t > first && t < last)) borders.push_back(t);
    }
    if (lens.field == 0 || lens.cut) continue;
    // The faces of the other field's volume.
    const Grid& grid = grids_[lens.field];
    const Vec3 start = grid.grid_from_data * (origin - grid.image->origin),
               pace = grid.grid_from_data * direction;
    for (int a = 0; a < 3; ++a) {
      for (const double face : {grid.image->lower()[a], grid.image->upper()[a]}) {
        const double t = (face - start[a]) / pace[a];
        if (t > inside.first && t < inside.last && t > nearest && t < farthest) borders.push_back(t);
      }
    }
  }
  std::sort(borders.begin(), borders.end());

  const double opacity_length = opacity_length_of(view_);
  double depth = 0.0;
  Vec3 sum{0.0};
  for (std::size_t part = 0; part + 1 < borders.size(); ++part) {
    const double length = borders[part + 1] - borders[part];
    const Vec3 middle = origin + (borders[part] + 0.5 * length) * direction;
    const auto owner = std::find_if(view_.lenses.begin(), view_.lenses.end(), [&](const Lens& lens) {
      return in_circle(lens) && lens.shape.contains(middle);
    });
    const bool focus = owner != view_.lenses.end();
    if (focus && owner->cut) continue;
    const FieldTransfer transfer = transfer_of(view_, focus ? *owner : Lens());
    const Grid& grid = grids_[transfer.field];
    const Vec3 start = grid.grid_from_data * (origin - grid.image->origin),
               pace = grid.grid_from_data * direction;
    const bool shading = focus ? owner->shading : view_.shading;
    const bool bent = focus && magnifies(*owner);
    if (!bent && !grid.holds(start + (borders[part] + 0.5 * length) * pace)) continue;
    if (transfer.field == 0 && !bent && !(borders[part] >= first && borders[part + 1] <= last)) continue;
    constexpr double kSqueezed = 2.0;
    const int steps = std::max(
        1, static_cast<int>(std::ceil(length * glm::length(pace) * samples_ * (bent ? kSqueezed : 1.0))));
    const double step = length / steps;
    for (int i = 0; i < steps; ++i) {
      Vec3 g = start + (borders[part] + (i + 0.5) * step) * pace;
      double h = step;
      if (bent) {
        const auto at = [&](double s) {
          return place_seen(*owner, origin + (borders[part] + s * step) * direction);
        };
        g = grid.grid_from_data * (at(i + 0.5) - grid.image->origin);
        h = glm::distance(at(i), at(i + 1.0));
        if (!grid.holds(g)) continue;
      }
      const double number =
          focus && !bent
              ? number_in(*owner, g, origin + (borders[part] + (i + 0.5) * step) * direction, at_x, at_y)
          : !focus && coarse_ ? coarse_at(g)
                              : grid.number_at(g);
      const double value = grid.image->offset + grid.image->scale * number;
      RegionTransfer::Sample matter;
      if (transfer.regions) {
        matter = transfer.regions->at({value, grid.gradient_at(g)});
      } else {
        const ColorSample sample = transfer.colors.at(value);
        matter = {sample.color, optical_depth(sample.opacity)};
      }
      const double thickness = matter.depth * h / opacity_length;
      if (!(thickness > 0.0)) continue;
      Vec3 color(matter.color);
      if (shading) color = lit(grid, g, color, direction);
      sum += std::exp(-depth) * (1.0 - std::exp(-thickness)) * color;
      depth += thickness;
    }
  }
  return {sum.x, sum.y, sum.z, 1.0 - std::exp(-depth)};
}

Comparison compare(const FloatImage& image, const ReferenceRay& reference, double bound) {
  Comparison result;
  std::mutex mutex;
  const auto off = [](const Rgba& a, const Rgba& b) {
    double most = 0.0;
    for (std::size_t c = 0; c < 4; ++c) {
      const double d = std::abs(a[c] - b[c]);
      if (!(d <= most)) most = d;
    }
    return most;
  };
  parallel_for(static_cast<std::size_t>(image.height), 0, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < image.width; ++x) {
        const Rgba expected = reference.cast(x + 0.5, y + 0.5);
        const double here = off(image.at(x, y), expected);
        constexpr double kShift = 1e-3;
        bool exempt = false;
        if (!(here <= bound)) {
          for (const auto& [dx, dy] :
               {std::pair{kShift, 0.0}, {-kShift, 0.0}, {0.0, kShift}, {0.0, -kShift}}) {
            exempt = exempt || off(reference.cast(x + 0.5 + dx, y + 0.5 + dy), expected) > bound;
          }
        }
        const std::lock_guard lock(mutex);
        if (exempt) {
          ++result.exempt;
          continue;
        }
        result.worst = std::max(result.worst, here);
        if (!(here <= bound)) ++result.beyond_bound;
      }
    }
  });
  if (result.exempt > 0)
    std::printf("[  exempt  ] %d of %d pixels\n", result.exempt, image.width * image.height);
  return result;
}

}  // namespace palpate::test
