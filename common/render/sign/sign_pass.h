/// Draws signs: shapes as triangles, words as textured ones, from one texture of letters. What is nearer
/// hides them; they hide no more than they cover.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/render/camera.h"
#include "common/render/sign/sign_view.h"

namespace palpate {

class SignPass {
 public:
  SignPass();
  ~SignPass();
  SignPass(const SignPass&) = delete;
  SignPass& operator=(const SignPass&) = delete;

  /// Into the framebuffer that is bound, with the frame's uniforms in place.
  void draw(std::span<const SignView> signs, const SceneFrame& frame, const Mat3& camera_axes);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Grows `box` by all corners of the signs' shapes, and the places of their texts.
void include_signs(std::span<const SignView> signs, const Mat3& camera_axes, Box& box);

}  // namespace palpate
