/// The studies of constraints and chains that rest on no data: what chapter 6 of Ikits 2006 argues, measured
/// on features that are known in closed form. Sections for the page, rows for the stability table.
#pragma once

#include "common/base/progress.h"
#include "lab/report.h"
#include "lab/sweep.h"

namespace palpate {

/// Appends them to the report. @throws Cancelled.
void add_constraint_studies(Report& report, Effort effort, Progress* progress);

}  // namespace palpate
