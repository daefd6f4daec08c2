// The helper program palpate-lab: studies of error and stability for the scene at hand. Programs start it for
// their verb `report`; it writes a folder, and answers with what its user sees.
#include <array>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "common/base/error.h"
#include "common/base/ledger.h"
#include "common/load/helper/serve.h"
#include "common/scene/report_request.h"
#include "lab/study.h"
#ifdef PALPATE_WITH_CALIBRATION
#include "lab/workbench/workbench_studies.h"
#endif

namespace {

using namespace palpate;

struct Subject {
  std::string_view name;
  ReportAnswer (*study)(const Study&);
};
constexpr std::array kSubjects{
    Subject{"vector", study_vectors},
    Subject{"scalar", study_scalars},
    Subject{"tensor", study_tensors},
    Subject{"fibre", study_fibres},
    Subject{"experiment", study_experiment},
#ifdef PALPATE_WITH_CALIBRATION
    Subject{"calibration", study_calibration},
    Subject{"made table", study_made_table},
    Subject{"made calibrations", study_made_calibrations},
    Subject{"head errors", study_head_errors},
    Subject{"walls", study_walls},
#endif
};

std::string answer_to(std::string_view text) {
  const ReportRequest request = decode_report_request(text);
  Progress progress;
  const ProgressReporter reporter(progress);
  for (const Subject& subject : kSubjects) {
    if (subject.name != request.subject) continue;
    ReportAnswer answer = subject.study(Study(request, progress));
    answer.ledger = Ledger::entries();
    return encode(answer);
  }
  throw work_error("there is no study of '" + request.subject + "'");
}

}  // namespace

int main() {
  Service service;
  service.answer = [](std::string_view text, std::span<const std::byte>, MemoryFile&) {
    try {
      return answer_to(text);
    } catch (const Error&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw work_error("not enough memory for this data; give fewer seeds, or a part of the data");
    } catch (const std::exception& error) {
      throw work_error(error.what());
    }
  };
  return serve(service);
}
