/// A chain that follows the streamlines of a linear flow on tetrahedra, for tests.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/haptics/constraint/detent_marks.h"
#include "common/haptics/constraint/streamline.h"
#include "common/haptics/proxy_chain.h"
#include "tests/common/trace/linear_fields.h"

namespace palpate::test {

/// The workspace shows the cube [-1, 1]^3 of linear_fields.h at one metre a unit: `release` and all positions
/// of a test are then in data units.
struct FollowedFlow {
  explicit FollowedFlow(std::shared_ptr<const VectorField> flow, double release = 0.1,
                        double tick_interval = 0.0, double metres_per_unit = 1.0)
      : field(std::move(flow)),
        workspace(metres_per_unit, field->frame()),
        line(std::make_shared<LiveLine>(field, 1e-7, 1)) {
    auto streamline = std::make_unique<StreamlineConstraint>(line, workspace);
    constraint = streamline.get();
    std::vector<std::unique_ptr<Constraint>> links;
    links.push_back(std::move(streamline));
    ChainSettings settings;
    settings.streamline.release_distance = release;
    if (tick_interval > 0.0) {
      settings.ticks.interval = tick_interval;
      links.push_back(std::make_unique<TickMarks>(*constraint));
    }
    chain = std::make_unique<ProxyChain>(std::move(links), settings);
  }

  std::shared_ptr<const VectorField> field;
  Workspace workspace;
  std::shared_ptr<LiveLine> line;
  StreamlineConstraint* constraint = nullptr;
  std::unique_ptr<ProxyChain> chain;
};

}  // namespace palpate::test
