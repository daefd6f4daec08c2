#include "common/scene/options.h"

namespace palpate {

InputSpec input_spec(const InputOptions& options, FieldKind kind) {
  return {.files = options.files,
          .solution = options.solution,
          .example = options.example,
          .field = options.field,
          .time = options.time,
          .kind = kind,
          .raw = options.raw,
          .tensor = options.tensor,
          .refine = options.refine,
          .series = options.series,
          .constant_cells = options.cell_directions == "constant",
          .keeping = keeping_from_name(options.cache),
          .surface_markers = options.surface_markers,
          .remesher = options.remesher};
}

}  // namespace palpate
