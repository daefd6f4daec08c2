/// cardiac: layers and fibres of a heart's wall, seen and felt.
#include "apps/cardiac/cardiac_verbs.h"
#include "apps/cardiac/study/fibre_task.h"
#include "common/cli/verbs.h"
#include "common/experiment/study_verb.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/scene/wall/remesh.h"

int main(int argc, char** argv) {
  using namespace palpate;
  const Explorer cardiac{
      .name = "cardiac",
      .summary = "Explore hearts: the layers of the wall and the fibres on them",
      .kind = FieldKind::kFibre,
      .examples = {{"cardiac heart.exelem.gz", "look at a file in the window"},
                   {"cardiac info heart.exelem.gz", "what the file holds"},
                   {"cardiac render heart.exelem.gz --layer 0.5 --out heart.png",
                    "a picture, with or without a display"},
                   {"cardiac trace heart.exelem.gz --layer 0.5 --seeds random:200 --out fibres.vtp",
                    "fibres of one layer, for ParaView"},
                   {"cardiac map heart.exelem.gz --angle helix --out helix.vtu",
                    "how fibres turn through the wall"},
                   {"cardiac fibers mesh.pts --endo 60 --epi -60 --out with_fibres.pts",
                    "fibres by a rule, for a mesh that has none"},
                   {"cardiac mesh heart.exelem.gz --out heart.vtu", "tetrahedra, and how good they are"},
                   {"cardiac probe heart.exelem.gz --path path.csv --out log.csv",
                    "feel along a recorded path"},
                   {"cardiac report heart.exelem.gz --out report", "error against run time, on this heart"},
                   {"cardiac --example list", "the built-in hearts"}},
      .verbs =
          {
              info_verb({{"cardiac info heart.exelem.gz", "mesh, fibres, where layers come from, memory"},
                         {"cardiac info mesh.pts --surfaces surfaces.vtp",
                          "and the surfaces of the wall that were found, with areas and thickness"},
                         {"cardiac info mesh.pts --explain", "and what that took, and what it left out"}}),
              trace_fibres_verb(
                  {{"cardiac trace heart.exelem.gz --layer 0.5 --seeds random:200 --out fibres.vtp",
                    "on the layer half way through the wall; with depth, gap and helix angle at each point"},
                   {"cardiac trace mesh.ele --seeds line:0,0,-5,0,8,-5,20 --max-length 10 --out fibres.csv",
                    "through the wall, as the fibres go; 10 data units each way"},
                   {"cardiac trace --example ventricle --layer 0.9 --seeds grid:8,8,8 --json --out outer.vtp",
                    "a built-in heart; the counts as JSON"}}),
              probe_verb(modes_of(FieldKind::kFibre),
                         {{"cardiac probe heart.exelem.gz --path path.csv --out log.csv",
                           "held to layers, and on them to fibres as in grooves"},
                          {"cardiac probe --example ventricle --path path.csv --mode friction --json",
                           "dragged the harder, the more fibres leave the layer; the summary as JSON"}}),
              map_angles_verb(
                  {{"cardiac map heart.exelem.gz --angle helix --out helix.vtu", "as a mesh for ParaView"},
                   {"cardiac map mesh.pts --angle sheet --convention bayer --axis 0,0,1 --out sheet.csv",
                    "by another convention, with the long axis stated"},
                   {"cardiac map mesh.pts activation.dat --angle activation --layer 0.9 --contour-spacing 5 "
                    "--out "
                    "isochrones.vtp",
                    "isochrones, 5 ms apart; --contours 10,20,30 names them"},
                   {"cardiac map heart.exelem.gz --angle gap --json",
                    "where fibres are undefined, in numbers"},
                   {"cardiac map mesh.pts --coordinates --out coordinates.vtu",
                    "where in the wall each point lies: transmural, apicobasal, rotational"}}),
              series_verb({{"cardiac series mesh.pts vm.igb --value vm --at 1.5,0,4 --out vm.csv",
                            "a potential over time at a place; --at again for another one"},
                           {"cardiac series heart.pvd --at 0,0,10 --json", "the likeliest scalar, as JSON"}}),
              convert_verb({{"cardiac convert --example wave --out wave.pts",
                             "for openCARP: mesh, fibres, wave.potential.igb, wave.activation.dat"},
                            {"cardiac convert mesh.pts vm.igb --out heart.pvd", "a time series for ParaView"},
                            {"cardiac convert mesh.pts --out heart.ele",
                             "heart.node, heart.ele and fibres for Chaste"}}),
              fibers_verb(
                  {{"cardiac fibers mesh.pts --rule bayer --endo 60 --epi -60 --out with_fibres.pts",
                    "for openCARP: mesh.pts needs no .lon"},
                   {"cardiac fibers wall.vtu --endo 70 --epi -50 --sheet-endo -65 --sheet-epi 25 --out "
                    "fibres.vtu",
                    "other angles, for ParaView"},
                   {"cardiac fibers --example ventricle --out ruled.vtu --json",
                    "on a built-in heart, in place of its own; what was done as JSON"}}),
              mesh_verb({{"cardiac mesh heart.exelem.gz --refine 8 --out heart.vtu --picture heart.png",
                          "eight cells along each axis of an element"},
                         {"cardiac mesh heart.exelem.gz --mesher tetgen --json",
                          "fill the surfaces anew; the report alone, as JSON"}}),
              render_layers_verb(
                  {{"cardiac render heart.exelem.gz --layer 0.5 --out heart.png", "helix angle on a layer"},
                   {"cardiac render --example ventricle --cut 0,1,0,0 --camera 0,20,0,1 --out half.png",
                    "cut open"},
                   {"cardiac render heart.exelem.gz --path path.csv --mode fibre --out touched.png",
                    "with the forces on a hand along that path"}}),
              report_verb("measure what mesh and step cost in volume, layers, angles, fibres and touch",
                          {Group::kInput, Group::kLayer},
                          {{"cardiac report heart.exelem.gz --out report",
                            "errors of volume, layers, angles, fibres and friction beside run time"},
                           {"cardiac report --example ventricle --quick --out report",
                            "the built-in ventricle, in a few seconds"}}),
              study_verb([] { return StudyTasks{make_fibre_task()}; },
                         {{"cardiac study make trial-study",
                           "an experiment in which people follow fibres, with guidance and without"},
                          {"cardiac study simulate trial-study", "simulated participants in all places"}}),
              open_heart_verb({{"cardiac heart.exelem.gz", "a file in the window"},
                               {"cardiac --example ventricle", "a built-in heart"},
                               {"cardiac heart.exelem.gz --refine 8 --mesher delaunay",
                                "on the tetrahedra of 'mesh', which are cached for the next opening"},
                               {"cardiac open --session heart.palpate.toml", "what Ctrl+S saved"}}),
          },
      .complete = [](Document& options) { options.input.remesher = remesher_of(options); }};
  return run_explorer(cardiac, argc, argv);
}
