#include "lab/constraint_studies.h"

#include <utility>

#include "lab/chain_rivals.h"
#include "lab/chain_work.h"
#include "lab/constraint_budget.h"
#include "lab/linear_drift.h"
#include "lab/surface_depth.h"

namespace palpate {

void add_constraint_studies(Report& report, Effort effort, Progress* progress) {
  report.sections.push_back(constraint_budget_section(run_constraint_budget(effort, progress)));
  report.sections.push_back(linear_drift_section(run_linear_drift(progress)));
  report.sections.push_back(surface_depth_section(run_surface_depth(progress)));
  report.sections.push_back(chain_rivals_section(run_chain_rivals(progress)));
  const ChainWork work = run_chain_work(effort, progress);
  report.sections.push_back(chain_work_section(work));
  for (StabilityCase& c : chain_work_cases(work)) report.stability.push_back(std::move(c));
}

}  // namespace palpate
