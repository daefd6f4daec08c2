/// flow: streamlines of CFD data, seen and followed.
#include "apps/flow/flow_verbs.h"
#include "apps/flow/study/path_task.h"
#include "common/cli/verbs.h"
#include "common/experiment/study_verb.h"
#include "common/hand/mode/haptic_mode.h"

int main(int argc, char** argv) {
  using namespace palpate;
  const Explorer flow{
      .name = "flow",
      .summary = "Explore flow fields: streamlines that state their error",
      .examples = {{"flow carotid.vtk", "look at a file in the window"},
                   {"flow info carotid.vtk", "what the file holds"},
                   {"flow trace carotid.vtk --seeds grid:8,8,8 --out lines.vtp", "lines for ParaView"},
                   {"flow render carotid.vtk --out carotid.png", "a picture, with or without a display"},
                   {"flow probe carotid.vtk --path path.csv --out log.csv", "feel along a recorded path"},
                   {"flow report carotid.vtk --out report", "error against run time on this very field"},
                   {"flow --example list", "the built-in data sets"}},
      .verbs = {
          info_verb({{"flow info carotid.vtk", "grids, fields, ranges, orientation, memory"},
                     {"flow info disk_out_ref.ex2 --explain", "and what that took, and what it left out"}}),
          trace_verb({{"flow trace carotid.vtk --seeds grid:8,8,8 --out lines.vtp",
                       "512 lines with time, speed and error at each point, for ParaView"},
                      {"flow trace bluntfinxyz.bin --solution bluntfinq.bin --seeds random:200 --direction "
                       "both --out lines.csv",
                       "PLOT3D grid and solution; two lines a seed"},
                      {"flow trace --example abc --seeds line:1,1,1,5,5,5,20 --tolerance 1e-8 --json --out "
                       "lines.vtp",
                       "a built-in field; the counts as JSON"},
                      {"flow trace carotid.vtk --seeds seeds.csv --stop-plane 0,0,1,20 --out lines.vtp",
                       "seeds from a table; lines end on the plane z = 20"}}),
          probe_verb(modes_of(FieldKind::kVector),
                     {{"flow probe carotid.vtk --path path.csv --out log.csv",
                       "feel along a recorded path: proxies, forces and residuals, a row a step"},
                      {"flow probe --example abc --path path.csv --mode isotropic --json",
                       "another mode; the summary as JSON"},
                      {"flow probe carotid.vtk --path path.csv --ticks auto --stiffness 400 --out log.csv",
                       "with tick marks at equal times, and a stiffer spring"}}),
          render_verb(
              modes_of(FieldKind::kVector),
              {{"flow render carotid.vtk --out carotid.png --size 1920x1080",
                "a picture, with or without a display"},
               {"flow render --example tornado --camera 60,30,0,1.2 --color time --out tornado.png",
                "from another side, coloured by time"},
               {"flow render carotid.vtk --volume scalars --seeds speed:100 --out both.png",
                "lines in a scalar of the same image, drawn as a volume"},
               {"flow render bluntfinxyz.bin --solution bluntfinq.bin --volume Density --resample 160 --lens "
                "sphere:0,0.5,2.6,1.5 --out fin.png",
                "other grids are resampled, and the error is reported; lenses as in grid"},
               {"flow render carotid.vtk --path path.csv --out followed.png",
                "with a hand on that path: the line that holds it, stream balls, the path by force"}}),
          report_verb("measure error against run time and stability on this very data",
                      {Group::kInput, Group::kLines},
                      {{"flow report carotid.vtk --out report", "then open report/index.html"},
                       {"flow report carotid.vtk --quick --seeds grid:3,3,3 --out report --force",
                        "fewer lines, and in place of the last report"}}),
          study_verb(
              [] {
                return StudyTasks{make_advection_2d(), make_tracing_2d(), make_advection_3d(),
                                  make_tracing_3d()};
              },
              {{"flow study make trial-study --participants 20 --seed 7", "stimuli and a balanced design"},
               {"flow study run trial-study --device simulated", "the window of the next participant"},
               {"flow study simulate trial-study", "simulated participants in all places"},
               {"flow study analyse trial-study", "then open trial-study/analysis/index.html"}}),
          open_lines_verb({{"flow carotid.vtk", "a file in the window"},
                           {"flow --example abc", "a built-in data set"},
                           {"flow open --session carotid.palpate.toml", "what Ctrl+S saved"}}),
      }};
  return run_explorer(flow, argc, argv);
}
