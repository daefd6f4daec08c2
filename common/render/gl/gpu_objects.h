/// What an OpenGL context holds, as it tells itself: `--explain` prints it.
///
/// Programs and textures bear labels (glObjectLabel), which debuggers of graphics show, too. Whatever is
/// there is listed, with or without a label, so nothing can be compiled or allocated unseen.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

struct GpuObject {
  enum class Kind : std::uint8_t { kProgram, kTexture, kRenderbuffer };
  Kind kind = Kind::kProgram;
  /// Its label; empty: it has none. Of a program its fragment or compute shader below shaders/, and how that
  /// was compiled (ShaderVariant).
  std::string what;
  std::uint64_t bytes = 0;  ///< texels, all levels and samples; 0 of a program

  bool operator==(const GpuObject&) const = default;
};

/// Gives the object `name` of the context that is current a label. @pre it has been created or bound.
void label_object(GpuObject::Kind kind, std::uint32_t name, std::string_view what);

/// Programs, then textures, then renderbuffers of the context that is current, each in the order of names.
/// Objects that another library made after the last one with a label may be missing.
[[nodiscard]] std::vector<GpuObject> gpu_objects();

/// "program", "texture", "renderbuffer".
[[nodiscard]] std::string_view name_of(GpuObject::Kind kind) noexcept;
/// Enters them in the Ledger, and offers the shaders that are not among them.
/// @param tables_by who filled the tables of volumes (SceneRenderer::tables_by()); empty: there are none.
void enter_gpu_objects(const std::vector<GpuObject>& objects, const std::string& tables_by);

}  // namespace palpate
