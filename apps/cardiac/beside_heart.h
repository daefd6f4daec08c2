/// Another heart, or another result of one, beside the heart that is open: seen from the same side, cut alike, at the same
/// depth and time, in the same range of colours.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/cardiac/heart_scene.h"
#include "common/base/progress.h"
#include "common/render/scene_view.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"

namespace palpate {

/// What is seen of it.
struct BesidePicture {
  std::shared_ptr<const SceneView> view;  ///< null: nothing is asked for
  std::vector<std::string> notes;         ///< on it, a sentence each
};

/// Keeps the heart that it opened last.
class BesideHeart {
 public:
  /// @param open the heart of `input`, which is taken where no other file is named.
  /// @param array what colours that heart; takes a range that holds for both where both show the same.
  /// @throws Error, Cancelled.
  [[nodiscard]] BesidePicture draw(const Input& input, const OpenHeart& open, const Document& document,
                                   std::shared_ptr<const LineArray>& array, Progress* progress);

 private:
  void find(const Input& input, const OpenHeart& open, const Document& document, Progress* progress);

  std::string key_;  ///< of what `input_` and `heart_` are
  std::optional<Input> input_;
  OpenHeart heart_;
  std::uint64_t print_ = 0;  ///< of what `heart_` was made from; 0: not taken
};

}  // namespace palpate
