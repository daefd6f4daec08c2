#include "common/hand/drawn/tract_drawing.h"

#include <cmath>
#include <utility>

namespace palpate {
namespace {

/// As near as that to the end of a tract, a stroke goes on from it [diagonals].
constexpr double kTractReach = 0.01;

}  // namespace

TractDrawing::TractDrawing(const std::shared_ptr<const TensorField>& field)
    : spacing_(kTractSpacing * field->bounds().diagonal()),
      pen_(field, spacing_, kTractReach * field->bounds().diagonal()) {}

void TractDrawing::draw(const HandStep& step, const Vec3& proxy, double force, StrokeUse use) {
  const bool held = step.state == HoldState::kHeld || step.state == HoldState::kFellBack;
  if (!held || step.chain.jumped) pen_.lift();
  if (!held) return;
  pen_.use(use);
  pen_.add(step.time, proxy, force);
}

std::shared_ptr<ProbePath> TractDrawing::path() {
  shown_edits_ = pen_.edits();
  auto path = std::make_shared<ProbePath>(spacing_);
  for (const DrawnTract& tract : pen_.tracts()) {
    path->append(Vec3{NAN}, 0.0);
    for (std::size_t i = 0; i < tract.forces.size(); ++i)
      path->append(tract.line.points[i].position, tract.forces[i]);
  }
  return path;
}

void TractDrawing::note() {
  noted_.reset();
  if (!pen_.tracts().empty()) noted_ = Note{pen_.edits(), pen_.tracts().back().line.points.size()};
}

void TractDrawing::cut_to_note() {
  if (noted_ && noted_->edits == pen_.edits()) pen_.cut(noted_->points);
}

bool TractDrawing::keep(DrawnLines& kept) {
  std::vector<DrawnTract> tracts = pen_.take();
  if (tracts.empty()) return false;
  kept.keep(std::move(tracts));
  return true;
}

}  // namespace palpate
