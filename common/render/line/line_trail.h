/// The path of the proxy on the GPU: an append buffer. What is there already is not uploaded again while
/// the path grows, and may be drawn part by part.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "common/render/camera.h"
#include "common/render/gl/object.h"
#include "common/render/line/line_pass.h"
#include "common/render/line_style.h"
#include "common/render/probe_path.h"

namespace palpate {

class LineTrail {
 public:
  /// Uploads what the first `count` points of `path` have beyond those that are there; all of them where
  /// the path, frame or range is another one, or there are fewer.
  /// @return whether everything was uploaded anew.
  bool extend(const std::shared_ptr<const ProbePath>& path, std::size_t count, const SceneFrame& frame,
              const ValueRange& range);

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// The first so many points stay as they are however the path grows: the direction of the last one
  /// depends on the next.
  [[nodiscard]] std::size_t settled() const noexcept { return size_ == 0 ? 0 : size_ - 1; }

  /// Whether some force lies above the range.
  [[nodiscard]] bool above_range() const noexcept { return above_range_; }

  /// Draws the path between the points `first` and `last` (included; both < size()).
  /// @pre LineProgram::use().
  void draw(const LineDraw& how, std::size_t first, std::size_t last) const;

 private:
  void reserve(std::size_t count);

  std::shared_ptr<const ProbePath> path_;
  SceneFrame frame_;
  ValueRange range_;
  std::size_t size_ = 0, capacity_ = 0;
  bool above_range_ = false;
  GlVertexArray vertex_array_;
  GlBuffer points_, values_;
};

}  // namespace palpate
