#include "apps/dtmri/region_text.h"

#include <algorithm>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/write/write_image.h"
#include "common/load/write/write_tractogram.h"
#include "common/math/vec_text.h"
#include "common/render/lens/lens.h"
#include "common/scene/tensor/read_mask.h"

namespace palpate {
namespace {

constexpr std::string_view kEveryPeak = "peaks:";
constexpr std::array<std::string_view, 5> kKinds{"sphere:", "box:", "beyond:", "brush:", "mask:"};

template <typename... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
// Clang 14 deduces none for what has no constructor.
template <typename... Of>
Overloaded(Of...) -> Overloaded<Of...>;

std::vector<std::string>& list_of(RegionRole role, TractTracingOptions& options) {
  return role == RegionRole::kExclude ? options.exclude
         : role == RegionRole::kStop  ? options.stop
                                      : options.include;
}

BrushStroke parse_stroke(std::string_view numbers, const std::string& refusal) {
  const std::size_t count = split(numbers, ',').size();
  if (count < 4 || count % 3 != 1) throw usage_error(refusal);
  const std::vector<double> v = parse_numbers(numbers, count, refusal);
  BrushStroke stroke{.radius = v[0], .centers = {}};
  for (std::size_t i = 1; i < count; i += 3) stroke.centers.push_back(vec_at(v, i));
  return stroke;
}

Rgb color_of(RegionRole role) {
  constexpr std::array<Rgb, 4> kColors{
      {{0.98F, 0.85F, 0.25F}, {0.35F, 0.85F, 0.40F}, {0.95F, 0.30F, 0.25F}, {0.35F, 0.60F, 0.98F}}};
  return kColors[as_size(role)];
}

}  // namespace

bool is_region(std::string_view text) noexcept {
  return std::ranges::any_of(kKinds, [text](std::string_view kind) { return text.starts_with(kind); });
}

RegionShape parse_region(std::string_view text, const std::string& refusal) {
  const std::size_t colon = text.find(':');
  if (!is_region(text) || colon + 1 == text.size()) throw usage_error(refusal);
  const std::string_view kind = text.substr(0, colon), rest = text.substr(colon + 1);
  if (kind == "mask") return std::string(rest);
  const auto above_zero = [&](double radius) {
    if (!(radius > 0.0)) throw usage_error(std::string(text) + ": the radius must be above zero");
    return radius;
  };
  if (kind == "sphere") {
    const auto v = parse_numbers(rest, 4, refusal);
    return Sphere{.center = vec_at(v, 0), .radius = above_zero(v[3])};
  }
  if (kind == "box") {
    const auto v = parse_numbers(rest, 6, refusal);
    Box box;
    box.include(vec_at(v, 0));
    box.include(vec_at(v, 3));
    return box;
  }
  if (kind == "beyond") {
    const auto v = parse_numbers(rest, 4, refusal);
    const double length = glm::length(vec_at(v, 0));
    if (!(length > 0.0)) throw usage_error(refusal);
    return HalfSpace{.normal = vec_at(v, 0) / length, .offset = v[3] / length};
  }
  BrushStroke stroke = parse_stroke(rest, refusal);
  (void)above_zero(stroke.radius);
  return stroke;
}

std::string region_text(const RegionShape& shape) {
  return std::visit(
      Overloaded{[](const Sphere& ball) {
                   return "sphere:" + exact_text(ball.center) + "," + exact_number(ball.radius);
                 },
                 [](const Box& box) { return "box:" + exact_text(box.lower) + "," + exact_text(box.upper); },
                 [](const HalfSpace& beyond) {
                   return "beyond:" + exact_text(beyond.normal) + "," + exact_number(beyond.offset);
                 },
                 [](const BrushStroke& stroke) {
                   std::string text = "brush:" + exact_number(stroke.radius);
                   for (const Vec3& center : stroke.centers) text += "," + exact_text(center);
                   return text;
                 },
                 [](const std::string& file) { return "mask:" + file; }},
      shape);
}

TractRegion tract_region(const RegionShape& shape) {
  return std::visit(Overloaded{[](const std::string& file) -> TractRegion {
                                 throw work_error(file + ": a mask is no shape");
                               },
                               [](const auto& known) { return TractRegion(known); }},
                    shape);
}

bool from_every_peak(std::string_view seeds) noexcept { return seeds.starts_with(kEveryPeak); }

std::string_view seed_places(std::string_view seeds) noexcept {
  return from_every_peak(seeds) ? seeds.substr(kEveryPeak.size()) : seeds;
}

std::string seeds_text(std::string_view places, bool every_peak) {
  return (every_peak ? std::string(kEveryPeak) : std::string()).append(places);
}

std::vector<RegionEntry> regions_of(const TractTracingOptions& options) {
  std::vector<RegionEntry> all;
  if (const std::string_view places = seed_places(options.seeds); is_region(places))
    all.push_back({RegionRole::kSeed, std::string(places)});
  const auto add = [&all](RegionRole role, const std::vector<std::string>& texts) {
    for (const std::string& text : texts) all.push_back({role, text});
  };
  add(RegionRole::kInclude, options.include);
  add(RegionRole::kExclude, options.exclude);
  add(RegionRole::kStop, options.stop);
  return all;
}

void set_regions(const std::vector<RegionEntry>& regions, TractTracingOptions& options) {
  const bool every_peak = from_every_peak(options.seeds);
  if (is_region(seed_places(options.seeds))) options.seeds.clear();
  options.include.clear();
  options.exclude.clear();
  options.stop.clear();
  for (const RegionEntry& region : regions) {
    if (region.role == RegionRole::kSeed) {
      options.seeds = seeds_text(region.text, every_peak);
    } else {
      list_of(region.role, options).push_back(region.text);
    }
  }
}

RegionView region_view(RegionRole role, const RegionShape& shape) {
  RegionView view{.shapes = {}, .color = color_of(role)};
  std::visit(
      Overloaded{[&](const Sphere& ball) { view.shapes.push_back(make_sphere(ball.center, ball.radius)); },
                 [&](const Box& box) {
                   const Vec3 half = 0.5 * box.size();
                   view.shapes.push_back(
                       make_box(box.center(), Mat3{half.x, 0.0, 0.0, 0.0, half.y, 0.0, 0.0, 0.0, half.z}));
                 },
                 [&](const HalfSpace& beyond) {
                   const ConvexShape::HalfSpace face{.outward = -beyond.normal, .offset = -beyond.offset};
                   view.shapes.push_back({.quadric = {}, .half_spaces = {face}});
                 },
                 [&](const BrushStroke& stroke) {
                   for (const Vec3& center : stroke.centers)
                     view.shapes.push_back(make_sphere(center, stroke.radius));
                 },
                 [](const std::string&) {}},
      shape);
  return view;
}

std::vector<RegionView> region_views(const TractTracingOptions& options) {
  std::vector<RegionView> views;
  for (const RegionEntry& region : regions_of(options)) {
    RegionView view =
        region_view(region.role, parse_region(region.text, region.text + ": no region of tracts"));
    if (!view.shapes.empty()) views.push_back(std::move(view));
  }
  return views;
}

std::vector<std::string> write_regions(const std::filesystem::path& file, const TractTracingOptions& options,
                                       bool left_handed, const UniformTopology& image,
                                       const ImageOrigin& origin, bool overwrite) {
  const std::vector<RegionEntry> regions = regions_of(options);
  if (regions.empty())
    throw usage_error("there is no region to write: --seeds, --include, --exclude, --stop");
  if (lower_ending(file) == ".csv") {
    OutputFile table(file, overwrite);
    table.write("role,region\n");
    for (const RegionEntry& region : regions)
      table.write(std::string(kRegionRoleNames[as_size(region.role)]) + ",\"" + region.text + "\"\n");
    table.finish();
    return {};
  }
  std::vector<std::string> notes;
  std::vector<float> values(count_of(image.points), 0.0F);
  for (int role = 0; role < static_cast<int>(kRegionRoleNames.size()); ++role) {
    std::vector<TractRegion> these;
    for (const RegionEntry& region : regions) {
      if (static_cast<int>(region.role) != role) continue;
      std::visit(Overloaded{[&](const std::string& mask) {
                              these.emplace_back(read_mask(mask, nullptr, left_handed).mask);
                            },
                            [&](const auto& shape) { these.push_back(tract_region(shape)); }},
                 parse_region(region.text, region.text + ": no region of tracts"));
    }
    std::size_t at = 0, held = 0;
    for (int k = 0; k < image.points.z; ++k) {
      for (int j = 0; j < image.points.y; ++j) {
        for (int i = 0; i < image.points.x; ++i, ++at) {
          const Vec3 x = image.origin + image.axes * Vec3(i, j, k);
          if (std::ranges::none_of(these, [&](const TractRegion& one) { return one.contains(x); })) continue;
          values[at] += static_cast<float>(1 << role);
          ++held;
        }
      }
    }
    if (!these.empty() && held == 0)
      notes.push_back(std::string("WARNING: the ") + kRegionRoleNames[as_size(role)] +
                      " regions hold the centre of no voxel: the image shows nothing of them");
  }
  for (std::string& line :
       write_image(file, image, ImageContent::kScalar, values, ImageConvention::kMrtrix, overwrite, origin))
    notes.push_back(std::move(line));
  return notes;
}

}  // namespace palpate
