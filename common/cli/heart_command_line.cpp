#include "common/cli/heart_command_line.h"

namespace palpate {
namespace {

void add_mesher_options(SceneOptions& options, InputOptions& input) {
  options
      .add("--mesher", input.mesher,
           "what fills the wall with tetrahedra: cells, as they split into them (default but of mesh); "
           "delaunay "
           "(default of mesh) joins their points anew; tetgen keeps the surfaces alone",
           "cells|delaunay|tetgen", "Input")
      ->check(CLI::IsMember({"cells", "delaunay", "tetgen"}));
  options.add("--largest-volume", input.largest_volume,
              "of a tetrahedron, with tetgen; default: twice the mean of the cells that are there", "V",
              "Input");
}

void add_refine_option(SceneOptions& options, InputOptions& input) {
  constexpr int kFinest = 64;
  options
      .add("--refine", input.refine, "cells along each axis of a curved element (EX); default 4, mesh: 8",
           "N", "Input")
      ->check(CLI::Range(1, kFinest));
}

}  // namespace

void add_fibre_options(SceneOptions& options, TracingOptions& tracing, HeartOptions& heart) {
  const char* group = "Fibres";
  options.add(
      "--seeds", tracing.seeds,
      "file.csv | file.vtp (its points) | point:x,y,z | line:x,y,z,x,y,z,n | plane:o,a,b,na,nb (three "
      "corners as x,y,z) | grid:nx,ny,nz | random:n; each goes to the layer first",
      "S", group);
  options
      .add("--direction", tracing.direction, "which way from each seed; fibres have no sign; default both",
           "forward|backward|both", group)
      ->check(CLI::IsMember({"forward", "backward", "both"}));
  options.add("--step", tracing.step, "step length in data units; default 1/1000 of the diagonal", "LENGTH",
              group);
  options.add("--max-length", tracing.max_length, "longest line, in data units; default 10 diagonals",
              "LENGTH", group);
  options
      .add("--least-gap", heart.least_gap,
           "eigen gap below which fibres count as undefined, 0 to 1; default 0.05", "GAP", group)
      ->check(CLI::Range(0.0, 1.0));
}

void add_layer_option(SceneOptions& options, HeartOptions& heart) {
  options.add("--layer", heart.layer, "depth in the wall: 0 is the inner, 1 the outer surface", "DEPTH",
              "Fibres");
}

void add_angle_options(SceneOptions& options, HeartOptions& heart) {
  const char* group = "Angles";
  options.add(
      "--angle", heart.angle,
      "helix, transverse, sheet; gap (how well fibres are defined), depth; or a scalar of the file, such as "
      "a "
      "potential; default helix, in windows and pictures of a time series the first scalar that changes",
      "helix|transverse|sheet|gap|depth|NAME", group);
  options
      .add("--convention", heart.convention,
           "what the angle is measured from: streeter (default), bayer, piersanti or doste", "NAME", group)
      ->check(CLI::IsMember({"streeter", "bayer", "piersanti", "doste"}));
  options.add("--axis", heart.axis,
              "long axis from apex to base; default: that of the file's coordinates, or as the wall opens",
              "X,Y,Z", group);
}

void add_layer_look(SceneOptions& options, HeartOptions& heart) {
  const char* group = "View";
  options.add("--cut", heart.cut, "leave out what lies beyond the plane n.x = d", "nx,ny,nz,d", group);
  add_contour_spacing(options, heart);
  options.add("--range", heart.range,
              "what colours spread over; default: of angles -90,90, of a scalar that changes in time its "
              "usual values at five steps and all that were shown, else those in the picture",
              "LOWER,UPPER", group);
  options.add("--lens", heart.lens, "a ball in which the layer shows another angle or scalar",
              "sphere:x,y,z,r", group);
  options.add("--lens-angle", heart.lens_angle, "which one, as --angle; default helix", "NAME", group);
}

void add_contour_spacing(SceneOptions& options, HeartOptions& heart) {
  options.add(
      "--contour-spacing", heart.contours,
      "lines of equal value on the layer where --angle is a multiple of this: isochrones of a time of "
      "activation",
      "D", "View");
}

void add_contour_options(SceneOptions& options, HeartOptions& heart) {
  options.add("--contours", heart.contour_values,
              "lines of equal value on the layer, written to a .vtp, .tck, .trk or .csv", "V,V,...",
              "Angles");
  add_contour_spacing(options, heart);
}

void add_heart_input_options(SceneOptions& options, InputOptions& input) {
  add_refine_option(options, input);
  add_mesher_options(options, input);
  options
      .add("--cell-directions", input.cell_directions,
           "directions of cells (.lon, .ortho, .bases): recovered (default) brings their outer products to "
           "the "
           "points, constant leaves them as they are all over their cell",
           "recovered|constant", "Input")
      ->check(CLI::IsMember({"recovered", "constant"}));
  options
      .add("--cache", input.cache,
           "keep solved layers and made meshes in NAME.palpate.layers and NAME.palpate.mesh beside the file "
           "for "
           "the next opening: auto (default, where they took more than half a second), always, off",
           "auto|always|off", "Input")
      ->check(CLI::IsMember({"auto", "always", "off"}));
  options.add(
      "--surface-markers", input.surface_markers,
      "markers of a .face file on the inner and on the outer surface, as 1,4/2; default: by the shape of "
      "what has one marker",
      "I,…/O,…", "Input");
}

void add_series_options(SceneOptions& options, SeriesOptions& series) {
  const char* group = "Series";
  options.add("--value", series.value, "the scalar whose time series it is; without it the likeliest one",
              "NAME", group);
  options.add_several("--at", series.places, "a place; may be repeated", "x,y,z", group);
  options.add("--along", series.path,
              "the places of a table with the header x,y,z; those of the proxy in a log of probe", "FILE.csv",
              group);
}

void add_plot_option(SceneOptions& options, SeriesOptions& series) {
  options.add("--plot", series.plot,
              "plot this scalar over time at the probe; 'series --along' writes it for a log of 'probe'",
              "NAME", "View");
}

}  // namespace palpate
