#include "apps/dtmri/view_tracts.h"

#include <utility>
#include <vector>

#include "apps/dtmri/tract_request.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/load/read_tractogram.h"
#include "common/render/tract/tract_bundle.h"

namespace palpate {

void check_view_tracts(const TractTracingOptions& options, const TractAppearance& look) {
  if (!look.file.empty() && !options.seeds.empty())
    throw usage_error("give either --tracts, a file, or --seeds, to trace some; not both");
  TractTracingOptions numbers = options;
  // Regions name files, which are read when they are needed.
  numbers.include.clear();
  numbers.exclude.clear();
  numbers.stop.clear();
  (void)tract_options(numbers, 1);
}

ViewTracts read_view_tracts(const TractAppearance& look, Progress* progress) {
  TractogramFile file = read_tractogram(look.file, progress);
  ViewTracts tracts;
  tracts.bundle = make_tract_bundle(std::make_shared<const Tractogram>(std::move(file.lines)));
  if (tracts.bundle->order.empty())
    throw input_error({look.file, "", "holds no line of two points and more", "tracts", ""});
  tracts.left_out = tracts_left_out(*tracts.bundle);
  return tracts;
}

ViewTracts trace_view_tracts(const TractTracingOptions& options, const CommonOptions& common,
                             const TensorVoxels& voxels, Progress* progress) {
  const TractOptions how = tract_options(options, common.threads, progress);
  // Seeds are laid over the voxels; what these hold is asked of the field.
  DataSet lattice;
  lattice.topology = UniformTopology{voxels.points, voxels.origin, voxels.axes};
  const std::vector<Vec3> seeds =
      tract_seeds(options, common.seed, *voxels.field, lattice, common.threads, progress);
  TractResult result = trace_tracts(*voxels.field, seeds, how, progress);
  ViewTracts tracts{
      .bundle = nullptr, .seeds = seeds.size(), .seconds = result.seconds, .why_none = {}, .left_out = {}};
  if (result.lines.line_count() == 0) tracts.why_none = why_no_tract(result, how);
  tracts.bundle = make_tract_bundle(std::make_shared<const Tractogram>(std::move(result.lines)));
  tracts.left_out = tracts_left_out(*tracts.bundle);
  return tracts;
}

}  // namespace palpate
