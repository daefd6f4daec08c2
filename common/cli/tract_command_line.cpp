#include "common/cli/tract_command_line.h"

#include <string>
#include <vector>

namespace palpate {

void add_tract_options(SceneOptions& options, TractTracingOptions& tracts) {
  const char* group = "Tracts";
  options.add(
      "--seeds", tracts.seeds,
      "file.csv | file.vtp (its points) | point:x,y,z | line:x,y,z,x,y,z,n | plane:… | voxels: fa:T or cl:T "
      "(where the measure is above T), mask:FILE (where it is above 0.5), sphere:x,y,z,r",
      "S", group);
  options
      .add("--seeds-per-voxel", tracts.seeds_per_voxel,
           "of fa:, cl:, mask: and sphere: 1 (default): at the centre of each voxel; more: at random in it",
           "N", group)
      ->check(CLI::Range(1, 1'000'000));
  options.add("--integrator", tracts.integrator,
              "dp54 (default): steps that keep the error; euler, rk4: one fixed step a point", "NAME", group);
  options.add("--tolerance", tracts.tolerance, "dp54: error in position per length; default 1e-4", "T",
              group);
  options.add("--step", tracts.step, "between points in mm; default a quarter of the shortest voxel edge",
              "MM", group);
  options.add("--measure", tracts.measure, "of anisotropy that ends lines: fa (default) or cl", "NAME",
              group);
  options.add("--cutoff", tracts.cutoff, "lines end where the measure falls below it; default 0.2", "0..1",
              group);
  options.add("--max-angle", tracts.max_angle,
              "largest turn from point to point in degrees; default: by --min-radius", "DEG", group);
  options.add("--min-radius", tracts.min_radius,
              "smallest radius of curvature in mm; default the shortest voxel edge", "MM", group);
  options.add("--min-length", tracts.min_length, "drop shorter lines; default 0", "MM", group);
  options.add("--max-length", tracts.max_length, "longest line, both sides together; default one diagonal",
              "MM", group);
  const auto regions = [&](const char* name, std::vector<std::string>& list, const char* text) {
    options.add(name, list, std::string(text) + "; may be repeated", "mask:FILE|sphere:x,y,z,r", group)
        ->delimiter(';')
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false);  // or it would swallow the FILE behind it
  };
  regions("--include", tracts.include, "keep lines that enter this region");
  regions("--exclude", tracts.exclude, "drop lines that enter this region");
  regions("--stop", tracts.stop, "end lines where they enter this region");
}

}  // namespace palpate
