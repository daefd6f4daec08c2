#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "apps/workbench/workbench_verbs.h"
#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/json.h"
#include "common/base/text.h"
#include "common/base/version.h"
#include "common/device/tracked_hands.h"
#include "common/hand/technique/immersive_technique.h"
#include "common/hand/technique/scene_pick.h"
#include "common/render/label/label_pass.h"
#include "common/render/png.h"
#include "common/render/render_image.h"
#include "common/window/immersive/space_menu.h"

namespace palpate {
namespace {

constexpr double kEntry = 0.02;  // [m] height of an entry
constexpr PictureSize kPicture{800, 600};
constexpr double kAperture = 0.01, kEyeBehind = 0.4;  // [m]

/// One of each kind: what an immersive tool is made of.
std::vector<SpaceItem> sample_items() {
  SpaceItem mode{.label = "Mode"};
  mode.behind = {
      {.label = "streamline", .id = 11}, {.label = "isosurface", .id = 12}, {.label = "grid", .id = 13}};
  return {
      mode,
      {.label = "Undo", .id = 1},
      {.label = "Opacity", .id = 2, .kind = SpaceItem::Kind::kSlider, .range = {0.0, 1.0, 0.1}, .value = 0.5},
      {.label = "Width", .id = 3, .kind = SpaceItem::Kind::kSlider, .range = {0.0, 10.0, 0.0}, .value = 3.0},
      {.label = "Turn", .id = 4, .kind = SpaceItem::Kind::kKnob, .range = {-180.0, 180.0, 15.0}}};
}

/// Balls beside the menu, to be picked by the ray and through an aperture about the tip.
std::vector<PickBall> sample_balls(const Vec3& corner) {
  std::vector<PickBall> balls;
  for (int i = 0; i < 3; ++i)
    balls.push_back({corner + Vec3(0.2 + 0.04 * i, -0.04 - 0.05 * i, -0.05 * i), 0.008});
  return balls;
}

LabelShape disc_of(double radius, const Vec3f& color) {
  constexpr int kCorners = 24;
  LabelShape shape{.corners = {}, .color = color, .opacity = 1.0F};
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    shape.corners.push_back(radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  return shape;
}

/// The menu as it was left, the balls with their names, and the ray.
SceneView picture_of(const SpaceMenu& menu, const std::vector<PickBall>& balls, const std::optional<Ray>& ray,
                     std::optional<std::size_t> picked) {
  SceneView view;
  view.show_axes = view.show_color_bar = view.show_outline = false;
  view.labels.push_back(menu.drawn());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    LabelView ball{.origin = balls[i].center, .unit = 1.0, .faces_viewer = true};
    const Vec3f color = picked == i ? Vec3f(0.98F, 0.80F, 0.30F) : Vec3f(0.55F, 0.60F, 0.66F);
    ball.shapes.push_back(disc_of(balls[i].radius, color));
    ball.texts.push_back(
        {.place = {1.5 * balls[i].radius, 0.0}, .height = 0.012, .words = "ball " + std::to_string(i + 1)});
    view.labels.push_back(std::move(ball));
  }
  include_labels(view.labels, Mat3(1.0), view.bounds);
  view.camera = make_camera(view.bounds, {.azimuth = 10.0, .elevation = 0.0},
                            static_cast<double>(kPicture.width) / kPicture.height);
  // The menu lies in x and y, with y up.
  view.camera.axes = Mat3(1.0);
  turn(view.camera, 0.15, 0.1);
  if (ray) {
    constexpr double kLength = 0.15;  // [m] of it that is drawn
    Line line;
    for (const double along : {0.0, kLength}) {
      LinePoint point;
      point.position = ray->origin + along * ray->direction;
      line.points.push_back(point);
      view.bounds.include(point.position);
    }
    view.lines = std::make_shared<const std::vector<Line>>(std::vector<Line>{line});
    view.style.color_by = ColorBy::kUniform;
  }
  return view;
}

ExitCode run_controls(const Document& options, const VerbContext& context) {
  const std::filesystem::path& path = options.hand.path;
  const std::filesystem::path& out = options.output.file;
  const std::filesystem::path& picture = options.device_outputs.picture;
  if (path.empty()) throw usage_error("controls needs recorded hands: a table t,x,y,z,qw,qx,qy,qz[,b0,...]");
  const std::vector<TrackedHands> hands = read_hands(path.string());
  if (hands.empty()) throw input_error({path.string(), "", "no rows", "a stylus that is tracked", ""});
  WorkbenchGeometry workbench;
  if (!options.hand.workbench.empty()) workbench = read_workbench(options.hand.workbench);
  const Vec3 corner = workbench.interaction.middle;
  workbench.interaction.middle = Vec3{0.0};
  workbench.interaction.rotation = identity_rotation();
  workbench.interaction.gain = 1.0;
  ImmersiveTechnique technique(workbench, Vec3{0.0}, 1.0);
  SpaceMenu menu(sample_items());
  menu.put(corner, Mat3(1.0), kEntry);
  const std::vector<PickBall> balls = sample_balls(corner);

  if (!picture.empty()) check_output(picture, options.common.force);
  std::optional<OutputFile> log;
  if (!out.empty()) {
    log.emplace(out, options.common.force);
    log->write("t,x,y,z,dx,dy,dz,button,pointed,event,id,value,ray_pick,aperture_pick\n");
  }
  Json events = Json::array();
  std::string text;
  std::optional<Ray> ray;
  std::optional<std::size_t> picked;
  for (const TrackedHands& row : hands) {
    context.progress.check();
    (void)technique.take(row, {});
    ray = technique.intent().pointing;
    SpaceEvent event;
    if (ray) {
      event = menu.point(*ray, row.acts);
      picked = pick_by_ray(*ray, balls);
    } else {
      menu.leave();
      picked.reset();
    }
    std::optional<std::size_t> in_aperture;
    if (ray) {
      // The eye looks along the stylus through a ring about its tip.
      in_aperture =
          pick_by_aperture({ray->origin - kEyeBehind * ray->direction, ray->origin, kAperture}, balls);
    }
    const char* const what = event.kind == SpaceEvent::Kind::kChosen ? "chosen"
                             : event.kind == SpaceEvent::Kind::kSet  ? "set"
                                                                     : "";
    if (log) {
      const Vec3 at = technique.intent().probe, along = ray ? ray->direction : Vec3{0.0};
      std::string line = exact_number(row.time);
      for (const double number : {at.x, at.y, at.z, along.x, along.y, along.z})
        line += "," + exact_number(number);
      line += std::string(row.acts ? ",1," : ",0,") + menu.pointed_label() + "," + what + "," +
              (event.kind == SpaceEvent::Kind::kNone ? "," : std::to_string(event.id) + ",");
      if (event.kind == SpaceEvent::Kind::kSet) line += exact_number(event.value);
      line += "," + (picked ? std::to_string(*picked + 1) : "") + "," +
              (in_aperture ? std::to_string(*in_aperture + 1) : "") + "\n";
      log->write(line);
    }
    if (event.kind == SpaceEvent::Kind::kNone) continue;
    Json event_row{{"t", row.time}, {"event", what}, {"id", event.id}, {"label", menu.pointed_label()}};
    text += short_number(row.time) + " s: " + menu.pointed_label() + " " + what;
    if (event.kind == SpaceEvent::Kind::kSet) {
      event_row["value"] = event.value;
      text += " to " + short_number(event.value);
    }
    text += "\n";
    events.push_back(std::move(event_row));
  }
  if (log) log->finish();
  if (!picture.empty()) {
    const RenderedImage drawn =
        render_image(picture_of(menu, balls, ray, picked), kPicture.width, kPicture.height);
    write_png(picture, drawn.image,
              {{"Software", version_text(context.explorer.name)}, {"Command", context.command_line}});
    text += "-> " + picture.string() + "\n";
  }
  context.console.print(text.empty() ? "nothing was chosen or set\n" : text);
  Json json{{"steps", hands.size()},
            {"events", events},
            {"opacity", menu.value(2)},
            {"width", menu.value(3)},
            {"turn", menu.value(4)}};
  context.console.print_json(json_text(json));
  return ExitCode::kDone;
}

}  // namespace

Verb controls_verb(std::vector<UsageExample> examples) {
  return {
      .name = "controls",
      .summary =
          "work a menu in space, its sliders and knobs, with a recorded stylus, and pick by ray and aperture",
      .groups = {Group::kMenu},
      .examples = std::move(examples),
      .run = run_controls};
}

}  // namespace palpate
