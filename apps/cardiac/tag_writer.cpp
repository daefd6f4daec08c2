#include "apps/cardiac/tag_writer.h"

#include <exception>
#include <utility>

#include "common/base/error.h"
#include "common/cli/wall_surfaces_report.h"
#include "common/scene/input.h"

namespace palpate {

TagWriter::~TagWriter() {
  if (job_) job_->progress.cancel();
}

void TagWriter::start(const Document& document, const std::filesystem::path& file) {
  if (thread_.joinable()) thread_.join();
  job_ = std::make_unique<Job>();
  Document options = document;
  options.heart.surfaces = file;
  options.common.force = false;  // the name was free
  thread_ = std::jthread([&job = *job_, options = std::move(options)] {
    const std::string file = options.heart.surfaces.string();
    try {
      Input input = Input::open(options.input, &job.progress);
      const WallSurfacesSummary summary = report_wall_surfaces(input, options, job.progress);
      job.news.words = "saved " + summary.output + ": a mesh whose points have the surfaces as tags";
    } catch (const std::exception& error) {
      job.news = {file + " was not saved: " + error.what(), true};
    }
    job.ended = true;
  });
}

TagWriter::News TagWriter::news() { return running() || !job_ ? News() : std::exchange(job_->news, {}); }

}  // namespace palpate
