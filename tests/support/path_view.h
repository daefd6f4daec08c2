/// The path of a probe from its columns.
#pragma once

#include <span>

#include "common/render/probe_view.h"

namespace palpate::test {

/// A path that is complete. @param forces [N], one a position.
inline PathView make_path_view(std::span<const Vec3> positions, std::span<const double> forces) {
  PathView view;
  view.points = make_probe_path(positions, forces);
  view.count = view.points->size();
  return view;
}

}  // namespace palpate::test
