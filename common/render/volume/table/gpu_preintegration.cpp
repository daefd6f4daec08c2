#include "common/render/volume/table/gpu_preintegration.h"

#include <string>
#include <vector>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/render/gl/program.h"

namespace palpate {
namespace {

// Bindings and locations of the shader.
constexpr GLuint kEntries = 0, kCellLengths = 1, kTable = 0;
constexpr GLint kFirstLayer = 0, kGroupLengths = 1, kChanged = 2;

// The length of k cells' segments divided by k, as preintegrate() divides it; of k = 0 the length itself.
std::vector<float> cell_lengths(std::size_t entries, std::size_t lengths) {
  std::vector<float> result;
  result.reserve(entries * lengths);
  for (std::size_t l = 0; l < lengths; ++l) {
    const float length = segment_length(l, lengths);
    for (std::size_t k = 0; k < entries; ++k)
      result.push_back(length / static_cast<float>(k == 0 ? std::size_t{1} : k));
  }
  return result;
}

}  // namespace

bool GpuPreintegration::possible(std::size_t entries) {
  constexpr int kComputeVersion = 43;
  return entries <= kMostEntries && epoxy_gl_version() >= kComputeVersion;
}

void GpuPreintegration::fill(std::span<const OpticalEntry> entries, std::size_t lengths,
                             const GlTexture& table, int first_layer, const EntryRange& changed) {
  PALPATE_CHECK(entries.size() >= 2 && possible(entries.size()));
  PALPATE_CHECK(changed.first <= changed.last && changed.last < entries.size());
  PALPATE_CHECK(lengths >= kLengthGroup && lengths % kLengthGroup == 0);
  if (entries_ != entries.size()) {
    const std::vector<std::string> defines{"ENTRIES " + std::to_string(entries.size())};
    program_ = compile_compute("volume/preintegrate.comp", shader_files(), defines);
  }
  if (entries_ != entries.size() || lengths_ != lengths)
    cell_lengths_ = make_buffer(std::span<const float>(cell_lengths(entries.size(), lengths)));
  entries_ = entries.size();
  lengths_ = lengths;

  static_assert(sizeof(OpticalEntry) == 4 * sizeof(float), "the shader reads entries as vec4");
  const GlBuffer told = make_buffer(entries);
  glUseProgram(program_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kEntries, told.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kCellLengths, cell_lengths_.name());
  // As integers: how a driver rounds numbers of [0, 1] to 16 bits is its own affair.
  glBindImageTexture(kTable, table.name(), 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA16UI);
  glUniform1i(kFirstLayer, first_layer);
  glUniform1i(kGroupLengths, static_cast<GLint>(kLengthGroup));
  glUniform2i(kChanged, static_cast<GLint>(changed.first), static_cast<GLint>(changed.last));
  glDispatchCompute(static_cast<GLuint>(entries.size()), static_cast<GLuint>(lengths), 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
  glBindImageTexture(kTable, 0, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16UI);
}

}  // namespace palpate
