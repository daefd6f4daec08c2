/// Small pictures of built-in examples, drawn by the program itself.
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>

namespace palpate {

/// Draws `example` into `to`, `width` x `height` pixels, as the verb `render` of the running program does: in a
/// process of its own, on one thread and with low priority, which ends when stop is asked for.
/// @throws Error (work failed) where that draws nothing.
void draw_example(const std::string& example, const std::filesystem::path& to, int width, int height,
                  const std::stop_token& stop);

}  // namespace palpate
