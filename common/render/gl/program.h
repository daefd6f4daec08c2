/// Shader programs from the sources embedded at build time.
///
/// A source may say `#include "include/color.glsl"` (paths from shaders/); each file is taken once.
/// Programs are compiled when a pass first needs them.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/render/gl/object.h"

namespace palpate {

/// One file below shaders/.
struct ShaderFile {
  std::string_view path;  ///< "line/line.vert"
  std::string_view text;
};

/// All files embedded at build time, by path.
[[nodiscard]] std::span<const ShaderFile> shader_files() noexcept;

/// A source with its includes put in.
struct ShaderSource {
  /// Where a line of the text comes from. Not told through `#line`: drivers drop its file number.
  struct Origin {
    std::string file;
    int line = 1;
  };
  std::string text;
  std::vector<Origin> lines;  ///< one a line of the text
};

/// Puts in the includes of `path`, looked up in `files`.
/// @throws Error (work failed) naming a file that is not there, and who includes it.
/// @param defines what follows `#define` in lines behind the first one, which states the version.
[[nodiscard]] ShaderSource assemble_shader(std::string_view path, std::span<const ShaderFile> files,
                                           std::span<const std::string> defines = {});

/// Compiles and links `vertex` and `fragment` (paths below shaders/), both with `defines`.
/// @throws Error (work failed) with the file, line and message of the first error of the driver.
[[nodiscard]] GlProgram compile_program(std::string_view vertex, std::string_view fragment,
                                        std::span<const ShaderFile> files = shader_files(),
                                        std::span<const std::string> defines = {});

/// How many programs this thread has compiled so far.
[[nodiscard]] int compiled_programs() noexcept;

/// One of the ways in which a fragment shader is compiled.
struct ShaderVariant {
  std::string_view fragment;         ///< path below shaders/
  std::vector<std::string> defines;  ///< of this way

  /// "volume/lenses.frag CONTEXT MAGNIFIED": how the program is labelled (gpu_objects.h).
  [[nodiscard]] std::string label() const;
};

/// Compiles and links the embedded `vertex` and `variant`, both with the defines of the variant and `defines`.
/// @throws Error as above.
[[nodiscard]] GlProgram compile_program(std::string_view vertex, const ShaderVariant& variant,
                                        std::span<const std::string> defines);

/// Compiles and links a compute shader.
/// @throws Error as above.
[[nodiscard]] GlProgram compile_compute(std::string_view path,
                                        std::span<const ShaderFile> files = shader_files(),
                                        std::span<const std::string> defines = {});

}  // namespace palpate
