/// Virtual fixtures in a picture: curves as thin tubes, shapes and surfaces as triangles.
#pragma once

#include <vector>

#include "common/hand/mode/fixture.h"
#include "common/haptics/workspace.h"
#include "common/math/vec.h"
#include "common/render/surface/surface_view.h"

namespace palpate {

/// What is drawn of `fixtures`. Planes are cut by the bounds of the data, landmarks are three rings of their reach.
[[nodiscard]] std::vector<SurfaceView> show_fixtures(const FixtureList& fixtures, const Workspace& workspace,
                                                     const Box& bounds);

}  // namespace palpate
