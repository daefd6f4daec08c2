/// Pictures of lines in their domain, drawn without a display as `flow render` draws them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <palpate/palpate.h>

namespace palpate::api {

struct PictureOptions {
  int width = 1200, height = 800;   ///< pixels
  std::string color = "speed";      ///< speed, time, arc, error, direction, termination, seed, uniform
  std::string camera = {};          ///< "azimuth,elevation,roll,zoom" [degrees]; empty: from the front
  std::string background = "dark";  ///< "dark", "light" or "r,g,b" in [0, 1]
  std::string title = {};
};

class PALPATE_API Picture {
 public:
  [[nodiscard]] int width() const noexcept;
  [[nodiscard]] int height() const noexcept;
  /// Four bytes a pixel, sRGB, rows from the top.
  [[nodiscard]] std::span<const std::uint8_t> rgba() const noexcept;
  [[nodiscard]] const std::string& renderer() const noexcept;  ///< the OpenGL driver
  /// Writes a PNG, whole or not at all. @throws Error where the file exists, unless `overwrite`.
  void save(const std::string& path, bool overwrite = false) const;

 private:
  friend struct PictureAccess;
  std::shared_ptr<const struct PictureData> data_;
};

/// @throws Error (usage) for words that are not known and sizes that cannot be drawn; (work failed) without OpenGL.
[[nodiscard]] PALPATE_API Picture draw(const Field& field, const Lines& lines,
                                       const PictureOptions& options = {});

}  // namespace palpate::api
