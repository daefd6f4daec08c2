#include <utility>

#include "common/app/cli/picture.h"
#include "common/app/cli/verbs.h"
#include "common/app/cli/volume_scene.h"
#include "common/base/parallel.h"
#include "common/base/text.h"

namespace palpate {
namespace {

SceneUse use_of(const Options& options, const Input& input) {
  (void)input.scalar_choice();  // an unknown --field is refused before anything is read
  return {.verb = "render", .threads = resolve_threads(options.common.threads), .drawing = true};
}

DrawnScene make_scene(Input& input, const Options& options, const VerbContext& context, double aspect) {
  DrawnScene drawn;
  const auto image = load_volume(input, &context.progress);
  drawn.field = input.field_label();
  drawn.voxels = image->point_count();
  drawn.what = counted(drawn.voxels, "voxel");
  drawn.measured = measured_costs(input, nullptr);
  drawn.view = make_volume_scene(input, image, options, aspect);
  return drawn;
}

}  // namespace

Verb volume_render_verb(std::vector<UsageExample> examples) {
  return {.name = "render",
          .summary = "draw a picture of the volume, with or without a display",
          .groups = {.view = true, .out = true, .picture = true},
          .examples = std::move(examples),
          .run = [](const Options& options, const VerbContext& context) {
            const PictureMaker maker{
                .check = [](const Options& given) { check_volume_options(given.volume); },
                .use = use_of,
                .make = make_scene};
            return draw_picture(maker, options, context);
          }};
}

}  // namespace palpate
