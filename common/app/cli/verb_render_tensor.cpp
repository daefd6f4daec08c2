#include <utility>

#include "common/app/cli/picture.h"
#include "common/app/cli/tensor_scene.h"
#include "common/app/cli/verbs.h"
#include "common/app/cli/view_tracts.h"
#include "common/base/parallel.h"
#include "common/base/text.h"

namespace palpate {
namespace {

SceneUse use_of(const Options& options, const Input& input) {
  (void)input.tensor_source();  // an unknown --field is refused before anything is read
  return {.verb = "render", .threads = resolve_threads(options.common.threads), .drawing = true};
}

DrawnScene make_scene(Input& input, const Options& options, const VerbContext& context, double aspect) {
  auto field = input.load_tensor(options.common.threads, &context.progress);
  for (const std::string& line : field->notes().lines) context.console.note(line);
  auto voxels = make_tensor_voxels(std::move(field), input.title(), options.common.threads);
  DrawnScene drawn;
  drawn.field = input.field_label();
  drawn.voxels = voxels->directions.size();
  drawn.what = counted(drawn.voxels, "voxel");
  drawn.measured = measured_costs(input, nullptr);
  drawn.view = make_tensor_scene(input, make_tensor_view(voxels, options.tensors), options, aspect);
  const bool read = !options.tract_look.file.empty();
  if (!read && options.tracts.seeds.empty()) return drawn;
  const ViewTracts tracts =
      read ? read_view_tracts(options.tract_look, &context.progress)
           : trace_view_tracts(options.tracts, options.common, *voxels, &context.progress);
  if (tracts.bundle->order.empty()) throw work_error("no tract to draw: " + tracts.why_none);
  if (!tracts.left_out.empty()) context.console.note(tracts.left_out);
  drawn.lines = tracts.bundle->order.size();
  drawn.points = tracts.bundle->lines->points.size();
  drawn.seconds_trace = tracts.seconds;
  drawn.what += ", " + counted(drawn.lines, "tract");
  drawn.view.tracts = TractView{
      .bundle = tracts.bundle, .width = options.tract_look.width, .opacity = options.tract_look.opacity};
  return drawn;
}

}  // namespace

Verb tensor_render_verb(std::vector<UsageExample> examples) {
  return {.name = "render",
          .summary = "draw a picture of the tensors, with or without a display",
          .groups = {.tracts = true, .view = true, .out = true, .picture = true},
          .examples = std::move(examples),
          .run = [](const Options& options, const VerbContext& context) {
            const PictureMaker maker{.check =
                                         [](const Options& given) {
                                           check_tensor_options(given);
                                           check_view_tracts(given.tracts, given.tract_look);
                                         },
                                     .use = use_of,
                                     .make = make_scene};
            return draw_picture(maker, options, context);
          }};
}

}  // namespace palpate
