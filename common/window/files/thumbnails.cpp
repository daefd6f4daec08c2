#include "common/window/files/thumbnails.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <system_error>
#include <utility>

#include <epoxy/gl.h>
#include <stb_image.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/version.h"
#include "common/render/png.h"
#include "common/scene/sha256.h"

namespace palpate {

Image small_picture(const Image& image, int width, int height) {
  if (image.width < 1 || image.height < 1) return {};
  // As much of the middle as has this shape.
  const double scale =
      std::min(static_cast<double>(image.width) / width, static_cast<double>(image.height) / height);
  const double left = 0.5 * (image.width - scale * width), top = 0.5 * (image.height - scale * height);
  Image small{.width = width, .height = height, .rgba = {}};
  small.rgba.reserve(as_size(width) * as_size(height) * 4);
  const auto range = [&](double first, int i, int most) {
    const int begin = std::clamp(static_cast<int>(first + scale * i), 0, most - 1);
    return std::pair(begin, std::clamp(static_cast<int>(first + scale * (i + 1)), begin + 1, most));
  };
  for (int y = 0; y < height; ++y) {
    const auto rows = range(top, y, image.height);
    for (int x = 0; x < width; ++x) {
      const auto columns = range(left, x, image.width);
      int sum[3]{}, count = 0;
      for (int j = rows.first; j < rows.second; ++j) {
        for (int i = columns.first; i < columns.second; ++i, ++count) {
          const std::array<int, 4> pixel = image.pixel(i, j);
          for (std::size_t c = 0; c < 3; ++c) sum[c] += pixel[c];
        }
      }
      for (const int part : sum) small.rgba.push_back(static_cast<std::uint8_t>(part / count));
      small.rgba.push_back(255);
    }
  }
  return small;
}

Thumbnails::Thumbnails(std::filesystem::path folder, std::string program, DrawExample draw)
    : folder_(std::move(folder)), program_(std::move(program)), draw_(std::move(draw)) {}

Thumbnails::~Thumbnails() {
  for (const auto& [file, texture] : textures_) glDeleteTextures(1, &texture);
}

std::filesystem::path Thumbnails::file_of(const InputFiles& input) const {
  // An example looks as this version draws it.
  std::string key = version_text(program_) + "\n" + input.example;
  const auto add = [&](const std::filesystem::path& file) {
    std::error_code unknown;
    const auto written = std::filesystem::last_write_time(file, unknown).time_since_epoch().count();
    key += "\n" + file.string() + "\n" + (unknown ? "missing" : std::to_string(written));
  };
  for (const std::filesystem::path& file : input.files) add(file);
  if (input.solution) add(*input.solution);
  constexpr std::size_t kDigits = 32;
  return folder_ / (program_ + "-" + sha256_of(key).substr(0, kDigits) + ".png");
}

unsigned Thumbnails::texture_of(const std::filesystem::path& file) {
  if (const auto known = textures_.find(file); known != textures_.end()) return known->second;
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(file, unknown)) return 0;
  int width = 0, height = 0, channels = 0;
  unsigned char* const pixels = stbi_load(file.c_str(), &width, &height, &channels, 4);
  if (pixels == nullptr) {
    std::filesystem::remove(file, unknown);
    return 0;
  }
  unsigned texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glBindTexture(GL_TEXTURE_2D, 0);
  stbi_image_free(pixels);
  textures_.emplace(file, texture);
  return texture;
}

SmallPicture Thumbnails::of(const InputFiles& input) {
  if (folder_.empty()) return {0, "no picture"};
  if (const unsigned texture = texture_of(file_of(input)); texture != 0) return {texture, {}};
  if (input.example.empty()) return {0, "no picture yet"};
  const std::scoped_lock lock(mutex_);
  return {0, !draw_ || failed_.contains(input.example) ? "cannot be drawn" : "being drawn…"};
}

void Thumbnails::keep(const InputFiles& input, const Image& picture) {
  const Image small = small_picture(picture, StartPage::kPictureWidth, StartPage::kPictureHeight);
  if (folder_.empty() || small.rgba.empty()) return;
  const std::filesystem::path file = file_of(input);
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  try {
    write_png(file, small, {});
  } catch (const Error&) {
    return;
  }
  if (const auto old = textures_.find(file); old != textures_.end()) {
    glDeleteTextures(1, &old->second);
    textures_.erase(old);
  }
  remove_oldest();
}

void Thumbnails::remove_oldest() const {
  constexpr std::size_t kMost = 80;  // more than ten recent inputs and all examples of four programs
  using Aged = std::pair<std::filesystem::file_time_type, std::filesystem::path>;
  std::vector<Aged> all;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
    if (entry.path().extension() == ".png") all.emplace_back(entry.last_write_time(error), entry.path());
  }
  std::ranges::sort(all);
  for (std::size_t i = 0; i + kMost < all.size(); ++i) std::filesystem::remove(all[i].second, error);
}

void Thumbnails::draw_missing(const std::vector<InputFiles>& examples, std::function<void()> drawn) {
  if (folder_.empty() || !draw_ || std::exchange(drawing_, true)) return;
  std::vector<std::pair<std::string, std::filesystem::path>> missing;
  std::error_code error;
  for (const InputFiles& example : examples) {
    const std::filesystem::path file = file_of(example);
    if (!std::filesystem::exists(file, error)) missing.emplace_back(example.example, file);
  }
  if (missing.empty()) return;
  thread_ = std::jthread([this, missing, drawn = std::move(drawn)](const std::stop_token& stop) {
    std::error_code unwritable;
    std::filesystem::create_directories(folder_, unwritable);
    for (const auto& [example, file] : missing) {
      if (stop.stop_requested()) return;
      try {
        draw_(example, file, StartPage::kPictureWidth, StartPage::kPictureHeight, stop);
      } catch (const std::exception&) {
        const std::scoped_lock lock(mutex_);
        failed_.insert(example);
      }
      drawn();
    }
  });
}

}  // namespace palpate
