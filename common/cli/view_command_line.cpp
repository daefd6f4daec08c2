#include "common/cli/view_command_line.h"

#include <string>
#include <vector>

#include "common/cli/heart_command_line.h"
#include "common/render/volume/volume_view.h"

namespace palpate {
namespace {

constexpr const char* kGroup = "View";

void add_rays(SceneOptions& options, VolumeOptions& volume) {
  options.add("--samples", volume.samples, "samples a voxel along each ray; default 4", "N", kGroup);
  options
      .add("--far-sampling", volume.far_sampling,
           "how many times as far apart samples are where the volume is farthest from the viewer, by powers "
           "of "
           "two; default 1",
           "F", kGroup)
      ->check(CLI::Range(1.0, 16.0));
  options.add("--shading", volume.shading,
              "light surfaces by the gradient of the values: on (default) or off", "on|off", kGroup);
}

void add_lenses(SceneOptions& options, VolumeOptions& volume, const char* focus) {
  options.add_several(
      "--lens", volume.lenses,
      "a region drawn in a way of its own, in data units: sphere:x,y,z,r, box:x,y,z,x,y,z (two corners), "
      "cylinder:x,y,z,x,y,z,r, polyhedron:nx,ny,nz,d,... (where n.x <= d for each), halfspace:nx,ny,nz,d "
      "(where n.x > d) or screen:x,y,r (a circle that stays on the screen, in heights of the picture from "
      "its middle); "
      "behind it ',cut' cuts it away (',off' with it: a half-space does not for now), "
      "',magnify=M' enlarges, ',blend=B' has values go over into those of --context-level along that share "
      "of the "
      "way to its middle, ',samples=N' and ',shading=on' or 'off' are its own, ',field=NAME' shows another "
      "scalar of the file, or "
      "of another one (FILE or FILE:NAME), on its own grid, and last ',tf=' its own transfer function, as "
      "--focus-tf has it; may be repeated, the "
      "first one wins",
      "SHAPE", kGroup);
  options.add(
      "--context-viewport", volume.context_viewport,
      "pixels along either edge of the picture of what lies outside lenses, as a share of all; default 1",
      "SHARE", kGroup);
  options.add("--context-level", volume.context_level,
              "what lies outside lenses from voxels that are means of 2^K an axis; default 0", "K", kGroup);
  options.add("--focus-tf", volume.focus, focus, "NAME|FILE", kGroup);
  options.add_several("--clip,--plane", volume.clips,
                      "cut away what lies where n.x > d, in lenses too; may be repeated", "nx,ny,nz,d",
                      kGroup);
}

void add_plane_images(SceneOptions& options, VolumeOptions& volume) {
  options.add(
      "--plane-image", volume.plane_image,
      "the data on the planes of --clip, in grey and where a lens is in its colours: on or off (default)",
      "on|off", kGroup);
  options.add("--window", volume.window,
              "values from black to white on planes; default: up to all but the brightest two hundredth", "W",
              kGroup);
  options.add("--level", volume.level, "value in the middle of them", "L", kGroup);
  options.add("--contours", volume.contours, "lines of equal value on the planes of --clip", "V,V,...",
              kGroup);
}

void add_stereo(SceneOptions& options, ViewOptions& view) {
  options.add(
      "--stereo", view.stereo,
      "a picture for each eye, shown together: none (default), side-by-side, top-bottom, rows, columns "
      "(interlaced, the left eye first), anaglyph (red-cyan, in colour) or anaglyph-grey",
      "MODE", kGroup);
  options
      .add("--eye-separation", view.eye_separation, "between the eyes, in millimetres; default 63", "MM",
           kGroup)
      ->check(CLI::Range(0.0, 1000.0));
  options
      .add("--eye-distance", view.eye_distance, "from the eyes to the screen, in millimetres; default 600",
           "MM", kGroup)
      ->check(CLI::Range(1.0, 1e5));
  options
      .add("--disparity-limit", view.disparity_limit,
           "degrees of disparity that eyes can fuse: they are brought nearer to each other until the nearest "
           "and the farthest point of the scene keep it; default 1",
           "DEG", kGroup)
      ->check(CLI::Range(1e-3, 90.0));
  options.add("--swap-eyes", view.swap_eyes,
              "on shows each eye the other one's picture, for crossed eyes or such a display; default off",
              "on|off", kGroup);
}

void add_projection(SceneOptions& options, VolumeOptions& volume) {
  options.add("--projection", volume.projection, "perspective (default) or orthographic", "NAME", kGroup)
      ->check(CLI::IsMember({"perspective", "orthographic"}));
}

void add_storage(SceneOptions& options, VolumeOptions& volume) {
  options
      .add("--gpu-memory", volume.gpu_memory,
           "memory of the graphics card that voxels may take: a volume that needs more is stored in bricks, "
           "of "
           "which those are held that the view looks up and that show something, at the finest of its means "
           "of 2^n voxels at which they fit; in the window they come bit by bit, lenses first; default: all "
           "of it",
           "MB", kGroup)
      ->check(CLI::Range(0.001, 1e9));
  options
      .add("--tables", volume.tables,
           "who fills preintegrated tables: processor, gpu (compute shaders; the same numbers) or the faster "
           "one of these, which --explain tells; default faster",
           "NAME", kGroup)
      ->check(CLI::IsMember(std::vector<std::string>(kTableMakerNames.begin(), kTableMakerNames.end())));
}

void add_volume(SceneOptions& options, VolumeOptions& volume) {
  options.add("--transfer-function,--context-tf", volume.transfer,
              "which colour and opacity values have: density, mr, ct, or a file with the header "
              "value,red,green,blue,opacity; or regions of value and gradient magnitude: boundaries, "
              "'regions:SHAPE/SHAPE...' or a file with a shape a row, box,V,M,V,M,R,G,B,A,S, "
              "ellipse,V,M,V,M,R,G,B,A,S or triangle,V,M,V,M,V,M,R,G,B,A,S (corners, colour, opacity, soft "
              "border; after 'fractions' in parts of the data's ranges); without it one is made from the "
              "histogram",
              "NAME|FILE", kGroup);
  add_lenses(options, volume, "the same inside lenses; without it the denser half of what is seen outside");
  add_rays(options, volume);
  add_storage(options, volume);
}

void add_line_look(SceneOptions& options, ViewOptions& view) {
  options
      .add("--line-width", view.line_width, "of lines, in thousandths of the picture's height; default 3",
           "W", kGroup)
      ->check(CLI::Range(0.1, 1000.0));
  options
      .add(
          "--line-opacity", view.line_opacity,
          "of lines; in a volume what lies before them veils them, and they veil what lies behind; default 1",
          "0..1", kGroup)
      ->check(CLI::Range(0.01, 1.0));
}

void add_flow_volume(SceneOptions& options, VolumeOptions& volume) {
  options.add("--volume", volume.scalar,
              "draw a scalar of the flow as a volume around the lines: speed, divergence, vorticity, q, "
              "lambda2, or a "
              "scalar of the file; more of them behind commas are there for lenses, up to four",
              "NAME,...", kGroup);
  options.add(
      "--resample", volume.resample,
      "take it at N points along the longest edge of the data, or so many an axis, and say how far that is "
      "from it; grids that are no images, and formulas, are drawn in no other way",
      "N|N,N,N", kGroup);
  add_volume(options, volume);
}

void add_tensor_volume(SceneOptions& options, TensorOptions& tensors, VolumeOptions& volume) {
  options
      .add("--volume", tensors.volume,
           "fractional anisotropy as a volume: none, fa (grey) or direction (coloured by the main "
           "eigenvector); default auto: fa with --lens or --clip, else none",
           "auto|none|fa|direction", kGroup)
      ->check(CLI::IsMember({"auto", "none", "fa", "direction"}));
  options.add(
      "--transfer-function,--context-tf", volume.transfer,
      "of that volume, as a file with the header value,red,green,blue,opacity, value being FA; default: a "
      "faint veil",
      "FILE", kGroup);
  add_lenses(
      options, volume,
      "inside lenses, where colours are those of directions and it says how opaque FA is; default: solid "
      "from an FA of 0.4 on");
  add_rays(options, volume);
}

void add_tensors(SceneOptions& options, TensorOptions& tensors) {
  options.add(
      "--slices", tensors.slices,
      "slices through the image: all (default: three through its middle), none, or where they lie on the "
      "axes of the data, '-' for one that is left out",
      "X,Y,Z|all|none", kGroup);
  options.add(
      "--color", tensors.color,
      "colours of slices and glyphs: direction (default), that of the main eigenvector with left-right "
      "red, back-front green and feet-head blue; or fa, fractional anisotropy",
      "direction|fa", kGroup);
  options.add("--glyphs", tensors.glyphs, "what stands for tensors on the slices; default none",
              "none|ellipsoid|superquadric", kGroup);
  options
      .add("--voxels", tensors.voxels,
           "colours between the centres of voxels: nearest (default), each voxel has its own; or linear",
           "nearest|linear", kGroup)
      ->check(CLI::IsMember({"nearest", "linear"}));
  options.add(
      "--underlay", tensors.underlay,
      "a scalar image, such as a T1, below the colours of the slices, in its own place and resolution",
      "FILE", kGroup);
  options.add("--blend", tensors.blend,
              "colours over the underlay: anisotropy (default), as opaque as FA says; solid; or none",
              "anisotropy|solid|none", kGroup);
  options.add(
      "--window", tensors.window,
      "values of the underlay from black to white; default: up to all but the brightest two hundredth", "W",
      kGroup);
  options.add("--level", tensors.level, "value in the middle of them", "L", kGroup);
}

void add_tract_look(SceneOptions& options, TractLook& tracts) {
  options.add("--tracts", tracts.file,
              "a tractogram to show: .tck, .trk, .trx, or lines in .vtp; or --seeds traces some", "FILE",
              kGroup);
  options
      .add("--tract-width", tracts.width, "of tracts, in thousandths of the picture's height; default 1.5",
           "W", kGroup)
      ->check(CLI::Range(0.1, 100.0));
  options.add("--tract-opacity", tracts.opacity, "of tracts; default 1", "0..1", kGroup)
      ->check(CLI::Range(0.01, 1.0));
}

}  // namespace

void add_focal_option(SceneOptions& options, ViewOptions& view) {
  options.add(
      "--focal", view.focal,
      "place of the data in the middle of the picture, about which the view turns; default: the middle "
      "of what is shown. On a haptic grid the button takes hold of the view, away from faces of --box",
      "x,y,z", kGroup);
}

void add_view_options(SceneOptions& options, Options& bound, FieldKind kind) {
  options.add("--camera", bound.view.camera, "direction of view in degrees, and zoom",
              "azimuth,elevation,roll,zoom", kGroup);
  add_focal_option(options, bound.view);
  options
      .add("--frame-budget", bound.view.frame_budget,
           "milliseconds that a picture may take while something moves: samples and pixels are given up by "
           "the "
           "errors that this was measured to make, inside lenses last; default 60. A picture in a file is "
           "drawn "
           "as such a one",
           "MS", kGroup)
      ->check(CLI::Range(1.0, 1e5));
  add_stereo(options, bound.view);
  switch (kind) {
    case FieldKind::kScalar:
      add_volume(options, bound.volume);
      add_plane_images(options, bound.volume);
      add_projection(options, bound.volume);
      return;
    case FieldKind::kTensor:
      add_tensors(options, bound.tensors);
      add_tract_look(options, bound.tract_look);
      add_tensor_volume(options, bound.tensors, bound.volume);
      add_projection(options, bound.volume);
      return;
    case FieldKind::kFibre:
      add_layer_look(options, bound.heart);
      add_projection(options, bound.volume);
      return;
    case FieldKind::kVector:
      options.add("--color", bound.view.color,
                  "what colours the lines: speed, time, arc, error, direction, termination, seed, vorticity, "
                  "q, lambda2, divergence, or an array of the file",
                  "NAME", kGroup);
      add_line_look(options, bound.view);
      add_flow_volume(options, bound.volume);
      add_plane_images(options, bound.volume);
      add_projection(options, bound.volume);
      return;
  }
}

}  // namespace palpate
