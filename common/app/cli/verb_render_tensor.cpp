#include <utility>

#include "common/app/cli/picture.h"
#include "common/app/cli/tensor_scene.h"
#include "common/app/cli/verbs.h"
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
  drawn.view =
      make_tensor_scene(input, make_tensor_view(std::move(voxels), options.tensors), options, aspect);
  return drawn;
}

}  // namespace

Verb tensor_render_verb(std::vector<UsageExample> examples) {
  return {.name = "render",
          .summary = "draw a picture of the tensors, with or without a display",
          .groups = {.view = true, .out = true, .picture = true},
          .examples = std::move(examples),
          .run = [](const Options& options, const VerbContext& context) {
            const PictureMaker maker{.check = [](const Options& given) { check_tensor_options(given); },
                                     .use = use_of,
                                     .make = make_scene};
            return draw_picture(maker, options, context);
          }};
}

}  // namespace palpate
