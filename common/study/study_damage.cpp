#include "common/study/study_damage.h"

#include <filesystem>
#include <iterator>
#include <utility>

#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/study/packed_text.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

/// Empty where the file is whole. @param last what its last line begins with.
std::string damage_of(const fs::path& file, const std::string& last) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return "it is not there";
  try {
    std::string text = unpacked_file(file.string());
    if (text.ends_with('\n')) {
      text.pop_back();
      if (text.compare(text.rfind('\n') + 1, last.size(), last) == 0) return {};
    }
  } catch (const Error&) {  // said below
  }
  return "it is damaged or cut off";
}

}  // namespace

std::vector<DamagedFile> damaged_files(const StudyFolder& folder, const std::vector<TrialRecord>& trials,
                                       Progress& progress, int threads) {
  std::vector<std::vector<DamagedFile>> found(trials.size());
  progress.begin("looking into recordings", trials.size());
  parallel_for(trials.size(), threads, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      progress.check();
      const TrialRecord& r = trials[i];
      const std::string stem = folder.stem(r.participant, r.task, r.run).string();
      for (const auto& [name, last] : {std::pair{kRecordingFile, "end "}, std::pair{kMotionFile, ""}}) {
        if (std::string why = damage_of(stem + name, last); !why.empty())
          found[i].push_back({r.participant, r.task, r.run,
                              fs::path(stem + name).lexically_relative(folder.path()).string(),
                              std::move(why)});
      }
      progress.advance();
    }
  });
  std::vector<DamagedFile> out;
  for (std::vector<DamagedFile>& some : found) std::ranges::move(some, std::back_inserter(out));
  return out;
}

}  // namespace palpate
