#include "common/render/volume/table/gpu_preintegration.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/render/gl/context.h"
#include "common/render/gl/program.h"
#include "common/render/volume/voxels/voxel_texture.h"

namespace palpate {
namespace {

constexpr int kTries = 3;

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

TableMaker TableChoice::next(TableMaker asked, bool possible, bool software) noexcept {
  maker_ = TableMaker::kProcessor;
  if (!possible) {
    reason_ = Reason::kNoCompute;
  } else if (asked != TableMaker::kFaster) {
    reason_ = Reason::kAsked;
    maker_ = asked;
  } else if (software) {
    reason_ = Reason::kSoftware;
  } else if (tries_ < kTries) {
    reason_ = Reason::kTrial;
    maker_ = tries_ == 0 ? TableMaker::kProcessor : TableMaker::kGpu;
  } else {
    reason_ = Reason::kFaster;
    maker_ = gpu_ < processor_ ? TableMaker::kGpu : TableMaker::kProcessor;
  }
  return maker_;
}

void TableChoice::filled(double milliseconds) noexcept {
  if (reason_ != Reason::kTrial) return;
  (maker_ == TableMaker::kGpu ? gpu_ : processor_) = milliseconds;
  ++tries_;
}

std::string TableChoice::text() const {
  const std::string maker = maker_ == TableMaker::kGpu ? "GPU" : "processor";
  switch (reason_) {
    case Reason::kNone:
      return "nobody: there is none";
    case Reason::kAsked:
      return maker + ", as asked for";
    case Reason::kNoCompute:
      return maker + ": the driver has no compute shaders for tables of this size";
    case Reason::kSoftware:
      return maker + ": compute shaders of a software rasteriser are slower";
    case Reason::kTrial:
      return maker + ": both are being timed";
    case Reason::kFaster:
      break;
  }
  std::array<char, 64> times{};
  std::snprintf(times.data(), times.size(), ": the GPU takes %.1f ms, the processor %.1f ms", gpu_,
                processor_);
  return maker + times.data();
}

std::optional<double> compute_table_ms(std::span<const OpticalEntry> entries, std::size_t lengths,
                                       int repeats) {
  if (is_software_rasteriser() || !GpuPreintegration::possible(entries.size())) return std::nullopt;
  const auto side = static_cast<GLsizei>(entries.size());
  const GlTexture table = make_texture(GL_TEXTURE_2D_ARRAY, "table to be timed");
  glTextureStorage3D(table.name(), 1, GL_RGBA16, side, side, static_cast<GLsizei>(lengths));
  GpuPreintegration gpu;
  std::vector<double> times;
  for (int i = 0; i <= repeats; ++i) {
    const Stopwatch clock;
    gpu.fill(entries, lengths, table, 0, {0, entries.size() - 1});
    glFinish();
    if (i > 0 || repeats == 0) times.push_back(1e3 * clock.seconds());
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

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
  const GlBuffer entry_buffer = make_buffer(entries);
  glUseProgram(program_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kEntries, entry_buffer.name());
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
