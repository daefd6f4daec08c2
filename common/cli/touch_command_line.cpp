#include "common/cli/touch_command_line.h"

#include <cmath>
#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "common/base/number_text.h"

namespace palpate {
namespace {

constexpr const char* kGroup = "Touch";

/// A check for one of the words of `type`, as the help shows them. CLI11 matches whole words.
CLI::IsMember one_of(const std::string& type) {
  std::vector<std::string> words;
  for (const std::string_view word : split(type, '|')) words.emplace_back(word);
  return CLI::IsMember(words);
}

void add_hold(SceneOptions& options, TouchOptions& touch) {
  options.add("--mode", touch.mode, "what the hand feels; an unknown word lists the modes", "NAME", kGroup);
  options.add("--workspace-scale", touch.workspace_scale,
              "metres per data unit; 0, the default: the diagonal of the data is 0.25 m", "M", kGroup);
  options.add("--stiffness", touch.stiffness, "of the spring between probe and proxy, in N/m; default 200",
              "K", kGroup);
  options.add("--damping", touch.damping,
              "of the motion that a constraint holds back, in N s/m; default 0: none", "B", kGroup);
  options.add("--passivity", touch.passivity,
              "watch the energy that the hand gets back, and damp it: on, off, or auto (default): for chains "
              "of two links and more",
              "auto|on|off", kGroup);
  options.add("--force-cap", touch.force_cap, "largest force in N; default 4", "N", kGroup);
  options.add("--slew-cap", touch.slew_cap, "fastest change of the force in N/s; default 200", "N/s", kGroup);
}

void add_lines(SceneOptions& options, TouchOptions& touch) {
  options.add("--release", touch.release, "stretch in mm at which a line lets go; default 10", "MM", kGroup);
  options.add("--drag", touch.drag, "distance in mm at which an isotropic drag follows; default 4", "MM",
              kGroup);
  options.add("--ticks", touch.ticks,
              "tick marks felt at equal times along the line: 'auto', or the time between them in data units",
              "auto|T", kGroup);
  options
      .add("--tick-stiffness", touch.tick_stiffness, "of the tick marks, relative; default 0.25", "0..1",
           kGroup)
      ->check(CLI::Range(0.0, 1.0));
  options.add("--speed-force", touch.speed_force,
              "force in N along the line where the flow is fastest; negative: against it", "N", kGroup);
}

void add_isosurface(SceneOptions& options, TouchOptions& touch, FieldKind kind) {
  if (kind == FieldKind::kVector) {
    options.add("--scalar", touch.scalar,
                "what modes of a scalar feel: speed (default), or an array of the file", "NAME", kGroup);
    options.add_flag("--along-streamline", touch.along_streamline,
                     "isosurface: follow a streamline until it meets the surface, and into it", kGroup);
  }
  options.add("--isovalue", touch.isovalues,
              "isovalues of surfaces that are felt, up to eight; default: the one that parts the values best "
              "(Otsu)",
              "V[,V...]", kGroup);
  options.add("--surface", touch.surface,
              "what isosurfaces do: stop the probe (wall) or only one that comes from below or above, or "
              "hold on to it (layer)",
              "wall|below|above|layer", kGroup);
  options.add("--depth", touch.depth,
              "pop-through distance: stretch in mm at which an isosurface lets the probe through; default 10",
              "MM", kGroup);
  options.add(
      "--snap", touch.snap,
      "snap-in distance in mm, within which a layer takes hold of the probe; default 0: by crossing it", "MM",
      kGroup);
}

void add_force_fields(SceneOptions& options, TouchOptions& touch) {
  options.add("--field-force", touch.field_force,
              "direct: force in N where the flow is fastest; vortex: that of a strong vortex; default 1", "N",
              kGroup);
  options.add("--field-damping", touch.field_damping,
              "transverse, density: drag in N s/m, where it is full; default 5", "B", kGroup);
  options.add("--density-curve", touch.density_curve,
              "density: part of the drag by value, both from 0 to 1, as R:PART,R:PART[,…][,smooth]; default "
              "0:0,1:1",
              "CURVE", kGroup);
}

void add_linear(SceneOptions& options, TouchOptions& touch, FieldKind kind) {
  LinearWords& linear = touch.linear;
  const bool flow = kind == FieldKind::kVector;
  // A volume alone has no flow: what would need one is not offered.
  const std::string references = flow ? "auto|flow|gradient|curvature|axes" : "auto|gradient|curvature|axes";
  options
      .add("--reference", linear.reference,
           std::string("linear: whose directions the axes are: ") +
               (flow ? "the flow (auto), the gradient of the scalar" : "the gradient (auto), downwards") +
               ", with the larger and smaller curvature of its isosurface, or the axes of the grid",
           references, kGroup)
      ->check(one_of(references));
  options.add(
      "--axes", linear.axes,
      "linear: what each axis does: free, drag, unilateral (free outwards, dragged inwards), snap (in "
      "steps) or fixed; default free,drag,drag",
      "RULE,RULE,RULE", kGroup);
  options.add("--tau", linear.tau,
              "linear: distance in mm at which an axis gives, or the step of a snap: a number or a curve "
              "M:MM,M:MM[,…][,smooth] of --measure, for all axes or three with '/' between; default 4",
              "MM|CURVE", kGroup);
  options.add("--kappa", linear.kappa,
              "linear: part of --stiffness from 0 to 1, a number or a curve M:PART,…, as --tau; default 1",
              "0..1|CURVE", kGroup);
  const std::string measures = flow ? "value|gradient|speed" : "value|gradient";
  options
      .add("--measure", linear.measure,
           std::string("what curves take, in data units: the value of the scalar (default), the size of its "
                       "gradient") +
               (flow ? ", or the speed" : ""),
           measures, kGroup)
      ->check(one_of(measures));
  options.add("--friction", linear.friction,
              "linear: how much --tau grows with what presses on fixed and unilateral axes; default 0", "X",
              kGroup);
}

void add_grid(SceneOptions& options, GridWords& grid) {
  options.add(
      "--grid-frame", grid.frame,
      "grid: how its axes run: as those of the data (default), as x, y and z (world), the third across a "
      "plane, or the first along one vector and the second towards another",
      "data|world|plane:nx,ny,nz,d|axes:x,y,z,x,y,z", kGroup);
  options.add("--grid-spacing", grid.spacing, "grid: of its nodes in data units; default: that of the data",
              "H[,H,H]", kGroup);
  options.add("--grid-marks", grid.marks,
              "grid: landmarks, felt as notches where an axis crosses them, with '/' between",
              "x:AT|plane:nx,ny,nz,d", kGroup);
  options.add("--grid-peaks", grid.peaks,
              "grid: landmarks where the values along each axis pile up, so many at most; default 0", "N",
              kGroup);
  options.add(
      "--grid-switch", grid.switch_at,
      "grid: another axis may take over at nodes and landmarks (nodes, default), or at landmarks alone",
      "nodes|marks", kGroup);
  options.add("--grid-pull", grid.pull, "grid: pull in mm by which another axis takes over; default 6", "MM",
              kGroup);
  options.add("--grid-notch", grid.notch, "grid: reach of a landmark in mm; default 3; 0: not felt", "MM",
              kGroup);
  options.add("--grid-teeth", grid.teeth,
              "grid: part of --stiffness with which nodes hold along the axis; default 0: none", "0..1",
              kGroup);
}

void add_texture_option(SceneOptions& options, TouchOptions& touch) {
  options.add(
      "--noise-texture", touch.noise_texture,
      "isosurface, density, linear: noise of the data felt as a grain: off (default), on, or its size in "
      "mm by the noise as a part of the range of the values; on: 0.001:0,0.02:2",
      "off|on|NOISE:MM,NOISE:MM[,...][,smooth]", kGroup);
}

void add_planes(SceneOptions& options, PlaneWords& planes) {
  options.add("--planes", planes.planes,
              "plane-widget: up to four planes to begin with: nx,ny,nz,d each, or three points, or centre "
              "and unit quaternion, with "
              "'/' between; default: across the third axis through the middle",
              "nx,ny,nz,d|through:x,y,z,x,y,z,x,y,z|x,y,z,qx,qy,qz,qw", kGroup);
  options.add(
      "--detent", planes.detent,
      "plane-widget: step in degrees at which turning is felt, and at the axes of the data; default 15; 0: "
      "none",
      "DEG", kGroup);
  options.add("--plane-sphere", planes.sphere,
              "plane-widget: radius in mm of the sphere that turns; default 25", "MM", kGroup);
  options.add("--plane-reach", planes.reach,
              "plane-widget: stretch in mm at which planes and sphere catch and let go; default 8", "MM",
              kGroup);
}

void add_anisotropy(SceneOptions& options, TouchOptions& touch) {
  options.add(
      "--anisotropy-curve", touch.anisotropy_curve,
      "distance in mm at which the proxy follows across the main direction, by anisotropy from 0 to 1, "
      "as A:MM,A:MM[,...][,smooth], from 0:0 on and never falling; default 0:0,1:8",
      "CURVE", kGroup);
  const std::string uses = "append|replace";
  options
      .add("--stroke", touch.stroke,
           "window: a stroke goes on from the end of a tract that it begins at (append, default), or takes "
           "the "
           "place of what was drawn",
           uses, kGroup)
      ->check(one_of(uses));
}

void add_fibres(SceneOptions& options, TouchOptions& touch) {
  options.add("--isovalue", touch.isovalues,
              "depths of layers that are felt, up to eight; default: seven through the wall", "V[,V...]",
              kGroup);
  options.add("--depth", touch.depth,
              "pop-through distance: stretch in mm at which a layer lets the probe through; default 10", "MM",
              kGroup);
  options.add(
      "--snap", touch.snap,
      "snap-in distance in mm, within which a layer takes hold of the probe; default 0: by crossing it", "MM",
      kGroup);
  options.add("--fibre-spacing", touch.fibre_spacing,
              "fiber, friction: stretch across a fibre in mm at which the next one catches; default 4", "MM",
              kGroup);
  options.add("--least-friction", touch.least_friction,
              "friction: distance in mm at which the proxy is dragged where fibres lie in the layer; default "
              "0.5",
              "MM", kGroup);
  options.add("--most-friction", touch.most_friction,
              "friction: the same where fibres stand on the layer; default 6", "MM", kGroup);
}

}  // namespace

void add_touch_options(SceneOptions& options, TouchOptions& touch, FieldKind kind) {
  add_hold(options, touch);
  if (kind == FieldKind::kTensor) {
    add_anisotropy(options, touch);
    return;
  }
  if (kind == FieldKind::kFibre) {
    add_fibres(options, touch);
    return;
  }
  add_lines(options, touch);
  add_isosurface(options, touch, kind);
  add_linear(options, touch, kind);
  add_force_fields(options, touch);
  if (kind != FieldKind::kScalar) return;
  add_texture_option(options, touch);
  add_grid(options, touch.grid);
  add_planes(options, touch.planes);
}

void check_not_negative(double value, const std::string& option) {
  if (std::isfinite(value) && value >= 0.0) return;
  throw usage_error(option + ": a finite number, not below zero, is expected");
}

void check_touch_options(const TouchOptions& touch) {
  check_not_negative(touch.workspace_scale, "--workspace-scale");
  check_not_negative(touch.stiffness, "--stiffness");
  check_not_negative(touch.release, "--release");
  check_not_negative(touch.drag, "--drag");
  check_not_negative(touch.depth, "--depth");
  check_not_negative(touch.snap, "--snap");
  check_not_negative(touch.fibre_spacing, "--fibre-spacing");
  check_not_negative(touch.least_friction, "--least-friction");
  check_not_negative(touch.most_friction, "--most-friction");
  check_not_negative(touch.field_damping, "--field-damping");
  check_not_negative(touch.force_cap, "--force-cap");
  check_not_negative(touch.slew_cap, "--slew-cap");
}

}  // namespace palpate
