/// Draws labels: shapes as triangles, words as textured ones, from one texture of letters. What is nearer
/// hides them; they hide no more than they cover.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/render/camera.h"
#include "common/render/label/label_view.h"

namespace palpate {

class LabelPass {
 public:
  LabelPass();
  ~LabelPass();
  LabelPass(const LabelPass&) = delete;
  LabelPass& operator=(const LabelPass&) = delete;

  /// Into the framebuffer that is bound, with the frame's uniforms in place.
  void draw(std::span<const LabelView> labels, const SceneFrame& frame, const Mat3& camera_axes);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Grows `box` by all corners of the labels' shapes, and the places of their texts.
void include_labels(std::span<const LabelView> labels, const Mat3& camera_axes, Box& box);

}  // namespace palpate
