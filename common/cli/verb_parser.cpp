#include "common/cli/verb_parser.h"

#include <string>
#include <vector>

#include "common/cli/heart_command_line.h"
#include "common/cli/input_command_line.h"
#include "common/cli/touch_command_line.h"
#include "common/cli/tract_command_line.h"
#include "common/cli/view_command_line.h"

namespace palpate {

std::string examples_text(const std::vector<UsageExample>& examples) {
  if (examples.empty()) return {};
  std::string text = "Examples:";
  for (const UsageExample& example : examples) text += "\n  " + example.command + "\n      " + example.what;
  return text;
}

VerbParser::VerbParser(CLI::App& app, const Explorer& explorer, const Verb& verb, Options& options)
    : app_(app), options_(options), scene_options_(app) {
  app_.footer(examples_text(verb.examples));
  add_common();
  if (verb.groups.input) add_input(explorer.kind);
  if (verb.groups.tracing) add_tracing();
  if (verb.groups.tracts) add_tract_options(scene_options_, options_.tracts);
  if (verb.groups.fibres) add_fibre_options(scene_options_, options_.tracing, options_.heart);
  if (verb.groups.layer) add_layer_option(scene_options_, options_.heart);
  if (verb.groups.angle) add_angle_options(scene_options_, options_.heart);
  if (verb.groups.contours) add_contour_options(scene_options_, options_.heart);
  if (verb.groups.series) add_series_options(scene_options_, options_.series);
  if (verb.groups.plot) add_plot_option(scene_options_, options_.series);
  if (verb.groups.view) add_view_options(scene_options_, options_, explorer.kind);
  if (verb.groups.touch) add_touch_options(scene_options_, options_.touch, explorer.kind);
  if (verb.groups.notes) add_notes();
  if (verb.groups.path) add_path();
  if (verb.groups.path && explorer.kind == FieldKind::kTensor) add_tract();
  if (verb.groups.hand) add_operator();
  if (verb.groups.record) add_record();
  if (verb.groups.replay) add_replay();
  if (verb.groups.out) add_out(verb);
  if (verb.groups.mesh_picture) add_mesh_picture();
  if (verb.groups.picture) add_picture();
  if (verb.groups.picture && !verb.groups.path) add_workbench();
  if (verb.groups.effort) add_effort();
  if (verb.groups.image) add_image();
  if (verb.groups.measure) add_measure();
  if (verb.groups.slice) add_slice();
  if (verb.groups.part) add_part();
  if (verb.groups.focal) add_focal_option(scene_options_, options_.view);
  if (verb.groups.turn) add_turn();
}

void VerbParser::check() const {
  check_not_negative(options_.tracing.tolerance, "--tolerance");
  check_not_negative(options_.tracing.step, "--step");
  check_not_negative(options_.tracing.max_length, "--max-length");
  check_not_negative(options_.tracing.max_time, "--max-time");
  check_not_negative(options_.input.largest_volume, "--largest-volume");
  check_not_negative(options_.heart.contours, "--contour-spacing");
  check_touch_options(options_.touch);
  if (options_.tracing.tolerance == 0.0)
    throw usage_error("--tolerance: a number above zero is expected, such as 1e-6");
}

void VerbParser::add_common() {
  const char* group = "Common";
  CommonOptions& common = options_.common;
  app_.add_flag("--json", common.json, "print one JSON object on stdout and nothing else there")
      ->group(group);
  app_.add_flag("--quiet,-q", common.quiet, "print nothing on stderr but errors")->group(group);
  app_.add_flag("--explain", common.explain, "print what is used, why, what it costs, and what is left out")
      ->group(group);
  app_.add_flag("--force,-f", common.force, "overwrite existing outputs")->group(group);
  app_.add_option("--threads", common.threads, "threads to use (0: all cores); results do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(0, 4096))
      ->group(group);
  scene("--seed", common.seed, "start of the random numbers (random:n seeds)", "N", group);
}

void VerbParser::add_input(FieldKind kind) {
  const char* group = "Input";
  InputOptions& input = options_.input;
  app_.add_option("FILE", input.files, "data file; several are joined as blocks or taken as a time series")
      ->type_name("");
  app_.add_option("--solution", input.solution, "PLOT3D solution file that goes with the grid FILE")
      ->type_name("FILE")
      ->group(group);
  scene("--example", input.example, "a built-in data set in place of FILE; 'list' lists them", "NAME", group);
  scene("--field", input.field,
        "the " + std::string(name_of(kind)) + " field; without it the likeliest one is taken and named" +
            (kind == FieldKind::kScalar
                 ? "; more of them behind commas, or files, are there for lenses and the probe, up to four"
                 : ""),
        kind == FieldKind::kScalar ? "NAME,..." : "NAME", group);
  if (kind == FieldKind::kScalar) add_raw_options(scene_options_, input.raw);
  if (kind == FieldKind::kFibre) add_heart_input_options(scene_options_, input);
  if (kind == FieldKind::kTensor) add_tensor_input_options(scene_options_, input.tensor);
  if (kind == FieldKind::kScalar || kind == FieldKind::kTensor) {
    scene("--series", input.series,
          "DICOM: which series of the folder, by its number in the list or its UID; default: that of FILE",
          "N|UID", group);
  }
  scene(
      "--time", input.time,
      std::string("time step: first, last, or a time (the nearest step is taken and named); default first") +
          (kind == FieldKind::kFibre ? ", in windows and pictures one at which its scalar has spread" : ""),
      "first|last|T", group);
  app_.add_option("--session", options_.session,
                  "take files and options from a saved session; typed options win")
      ->type_name("FILE.toml")
      ->group(group);
}

void VerbParser::add_tracing() {
  const char* group = "Lines";
  TracingOptions& tracing = options_.tracing;
  scene("--seeds", tracing.seeds,
        "file.csv | file.vtp (its points) | point:x,y,z | line:x,y,z,x,y,z,n | plane:o,a,b,na,nb (three "
        "corners as x,y,z) | "
        "grid:nx,ny,nz | random:n | speed:n (random, denser where the speed is high)",
        "S", group);
  scene("--direction", tracing.direction, "which way from each seed", "forward|backward|both", group)
      ->check(CLI::IsMember({"forward", "backward", "both"}));
  scene("--integrator", tracing.integrator,
        "exact (tetrahedra), euler, rk4, bs32, rk34, dp54 or rodas4; default: exact on tetrahedra, dp54 "
        "elsewhere",
        "NAME", group);
  scene("--tolerance", tracing.tolerance,
        "position error accumulated per diagonal travelled, relative to the diagonal; default 1e-6", "T",
        group);
  scene("--step", tracing.step, "step length of euler and rk4; spacing of output points of the others",
        "LENGTH", group);
  scene("--max-length", tracing.max_length, "longest line, in data units; default 10 diagonals", "LENGTH",
        group);
  scene("--max-time", tracing.max_time, "longest time along a line, in data units", "TIME", group);
  scene("--max-steps", tracing.max_steps, "most steps of a line; default 1000000", "N", group)
      ->check(CLI::PositiveNumber);
  scene_options_.add_several("--stop-plane", tracing.stop_planes,
                             "end lines on the plane n.x = d; may be repeated", "nx,ny,nz,d", group);
}

void VerbParser::add_notes() {
  scene_options_.add_several("--annotation", options_.touch.annotations,
                             "a place, length, angle (at the second place), curve or area in the data, "
                             "with '=WORDS' behind it for a "
                             "label; may be repeated",
                             "point|length|angle|curve|area:x,y,z,...", "Annotations");
}

void VerbParser::add_path() {
  app_.add_option("--path", options_.path, "table of the probe's path, header t,x,y,z[,b0]: one step a row")
      ->type_name("FILE.csv")
      ->group("Touch");
  add_workbench();
}

void VerbParser::add_workbench() {
  app_.add_option("--workbench", options_.workbench,
                  "calibrations of a workbench, its screens for --head, and how hands work there: "
                  "[interaction] technique = "
                  "\"immersive\" takes tracked hands, with the header t,x,y,z,qw,qx,qy,qz[,b0,b1,hx,hy,hz,"
                  "hqw,hqx,hqy,hqz,h0], in place of a mouse or a path")
      ->type_name("W.toml")
      ->group("Touch");
}

void VerbParser::add_tract() {
  app_.add_option(
          "--tract", options_.tract,
          "write the way of the proxy as a tract: .tck, .trk, or .vtp and .csv, which hold force, cl, "
          "cp and fa as well")
      ->type_name("FILE")
      ->group("Output");
}

void VerbParser::add_operator() {
  app_.add_option("--device", options_.device,
                  "simulated[:DEVICE][,hand=relaxed|firm][,button=N]: an arm and a hand that follow the path")
      ->type_name("D")
      ->group("Touch");
  add_rate();
}

void VerbParser::add_rate() {
  app_.add_option("--rate", options_.rate, "updates of the hand a second, 100 to 10000; default 1000")
      ->type_name("HZ")
      ->group("Touch");
}

void VerbParser::add_record() {
  app_.add_option(
          "--device", options_.device,
          "what moves the probe: mouse (default), replay:FILE.csv, a path with the header t,x,y,z, "
          "hands:FILE.csv, tracked hands at an immersive --workbench, "
          "simulated[:DEVICE][,hand=relaxed|firm][,button=N], an arm and a hand that follow the mouse or "
          "wander, or a real device by its driver: "
          "falcon[:firmware=FILE][,button=N|none][,enable=pedal], spacemouse, "
          "vrpn:NAME@HOST[:PORT][,cap=N], "
          "inverse3[:host=NAME], dhd[:library=FILE] (Force Dimension), openhaptics[:library=FILE], or, at "
          "an "
          "immersive --workbench, the tracker polhemus[:port=FILE][,hemisphere=+x]; an arm shows force "
          "only "
          "while its button, its button=N, or the pedal is held")
      ->type_name("D")
      ->group("Touch");
  add_rate();
  add_workbench();
  add_head(
      "show the data as the first screen of --workbench does to a head before it, which is there, is "
      "replayed, with 'hands' is that of --device hands:FILE.csv, or is seen by a tracker, named as for "
      "--device, at "
      "the head_station of the workbench; --screen all opens a window for each "
      "screen, beside that of the desktop; default: the [head] of the workbench, or none");
  scene("--play-rate", options_.view.play_rate, "time steps a second while they play; default 5", "N", "View")
      ->check(CLI::Range(0.2, 60.0));
  app_.add_option("--record", options_.record, "write all input and every servo step to this file")
      ->type_name("FILE")
      ->group("Touch");
}

void VerbParser::add_replay() {
  app_.add_option("--replay", options_.replay,
                  "play a recording back, with the same proxies and forces to the bit")
      ->type_name("FILE")
      ->group("Touch");
}

void VerbParser::add_out(const Verb& verb) {
  app_.add_option("--out,-o", options_.out, verb.groups.effort ? "folder to be made" : "file to be written")
      ->type_name(verb.groups.effort ? "DIR" : "FILE")
      ->group("Output");
}

void VerbParser::add_mesh_picture() {
  app_.add_option("--picture", options_.heart.mesh_picture,
                  "the mesh cut open, its cells coloured by their smallest angle between faces")
      ->type_name("FILE.png")
      ->group("Output");
}

void VerbParser::add_picture() {
  app_.add_option("--size", options_.size,
                  "size of the picture in pixels; default 1280x960, or the pixels of the screen")
      ->type_name("WxH")
      ->group("View");
  add_head(
      "the picture as a screen of --workbench shows it to this head: where its sensor is in the "
      "tracker's frame, in metres, and how it is turned, or a recording of that with the header "
      "t,x,y,z,qw,qx,qy,qz; --camera says nothing then");
  app_.add_option("--head-time", options_.view.head_time,
                  "time of that recording, in seconds, at which the picture is shown; default: its end")
      ->type_name("T")
      ->group("View");
  app_.add_option(
          "--pick", options_.view.pick,
          "mark what a hand picks that points there: the first handle, lens or line along a ray from a "
          "place in a direction, or what is nearest to the middle of an aperture of radius s about a "
          "that an eye at e looks through; else a cutting plane")
      ->type_name("ray:x,y,z,dx,dy,dz|aperture:ex,ey,ez,ax,ay,az,s")
      ->group("View");
  app_.add_flag(
          "--converged", options_.view.converged,
          "of a volume: with so many samples that more change nothing that is seen, as windows refine a "
          "picture that stands still")
      ->group("View");
  app_.add_option("--repeat", options_.repeat, "frames to time after the first one")
      ->type_name("N")
      ->check(CLI::Range(0, 100000))
      ->group("View");
}

void VerbParser::add_head(const char* what) {
  app_.add_option("--head", options_.view.head, what)
      ->type_name("x,y,z[,qw,qx,qy,qz]|replay:FILE.csv")
      ->group("View");
  app_.add_option("--screen", options_.view.screen,
                  "which screen of --workbench, or all of them, each with a picture of its own; default: "
                  "its first")
      ->type_name("NAME|all")
      ->group("View");
}

void VerbParser::add_image() {
  app_.add_option(
          "--convention", options_.convention,
          "order and axes of tensors and directions in NIfTI: mrtrix (default: xx yy zz xy xz yz along "
          "RAS) or fsl (xx xy xz yy yz zz along FSL's image axes)")
      ->type_name("mrtrix|fsl")
      ->group("Output");
}

void VerbParser::add_measure() {
  app_.add_option("--measure", options_.measure,
                  "fa (default), md, cl, cp, cs, mode, v1 (main direction) or color (of it, times fa)")
      ->type_name("NAME")
      ->group("Output");
}

void VerbParser::add_slice() {
  const char* group = "Slice";
  SliceOptions& slice = options_.slice;
  app_.add_option("--plane", slice.plane,
                  "axial (default), coronal or sagittal through the middle, or with a place on z, y or x "
                  "behind it, as in axial:20; or nx,ny,nz,d for n.x = d, with n to the viewer")
      ->type_name("PLANE")
      ->group(group);
  app_.add_option("--spacing", slice.spacing, "of pixels in data units; default: that of the voxels")
      ->type_name("D")
      ->group(group);
  app_.add_option("--window", slice.window,
                  "values from black to white in a .png; default: up to all but the brightest two hundredth")
      ->type_name("W")
      ->group(group);
  app_.add_option("--level", slice.level, "value in the middle of them")->type_name("L")->group(group);
  app_.add_option("--contours", slice.contours,
                  "lines of equal value on the slice, written to a .vtp, .tck, .trk or .csv")
      ->type_name("V,V,...")
      ->group(group);
}

void VerbParser::add_part() {
  scene_options_.add(
      "--box", options_.slice.box,
      "a box of interest, in data units: two opposite corners; `clip` keeps what lies in it, a "
      "window shows it, to be dragged and cropped to; on a haptic grid the button takes hold of its faces",
      "x,y,z,x,y,z", "Part");
}

void VerbParser::add_turn() {
  app_.add_option("--tracts", options_.tract_file, "lines in .tck, .trk, .trx or .vtp")
      ->type_name("FILE")
      ->group("Input");
  app_.add_option("--turn", options_.tract_turn,
                  "turn the tracts before they are written: --turn=-i,j,k along the image's axes about its "
                  "centre, --turn=-x,-y,z along those of the coordinates about the origin")
      ->type_name("AXES")
      ->group("Output");
}

void VerbParser::add_effort() {
  app_.add_flag_callback(
          "--quick", [this] { options_.effort = "quick"; }, "fewer seeds and settings")
      ->group("Effort");
  app_.add_flag_callback(
          "--thorough", [this] { options_.effort = "thorough"; }, "more seeds and settings")
      ->group("Effort");
}

}  // namespace palpate
