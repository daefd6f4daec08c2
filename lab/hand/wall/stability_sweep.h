/// How stiff a wall may be: the largest stiffness that does not go on swinging, against servo rate, damping
/// of the arm, delay and encoder step, beside the theoretical bound; unheld, with the passivity controller,
/// and in hands. And where the energy goes when it does swing.
#pragma once

#include <string>
#include <vector>

#include "common/base/progress.h"
#include "lab/data/stability.h"
#include "lab/hand/wall/wall_run.h"
#include "lab/page/section.h"

namespace palpate {

/// One point of a sweep. Stiffnesses in N/m; kStiffest stands for that and more.
struct StiffnessRow {
  double value = 0.0;       ///< of what is swept, in SI units
  double bound = 0.0;       ///< of passivity, or of stability with delay: coupling.h
  double unheld = 0.0;      ///< found
  double controlled = 0.0;  ///< unheld, with the passivity controller
  double relaxed = 0.0;     ///< in a relaxed hand
  double firm = 0.0;        ///< in a firm one
};

struct StiffnessSweep {
  std::string name;    ///< "servo rate"
  std::string unit;    ///< of the swept value as shown: "Hz"
  double shown = 1.0;  ///< shown value over SI value
  std::vector<StiffnessRow> rows;
};

/// One run with its books.
struct LedgerRow {
  WallCase wall;
  double bound = 0.0;  ///< [N/m]
  WallRun run;
};

/// A device of a class, unheld and in hands.
struct DeviceRow {
  DeviceProfile device;
  StiffnessRow stiffness;
};

struct WallStability {
  DeviceProfile swept;  ///< what the sweeps start from
  std::vector<StiffnessSweep> sweeps;
  std::vector<DeviceRow> devices;
  std::vector<LedgerRow> ledger;
  /// Rows of the stability table: what the bench and the controller promise.
  std::vector<StabilityCase> cases;
};

/// Takes a few seconds, and needs no data: all of it is simulated. The ledger and the cases are those of the
/// ideal device, of which theory knows everything.
/// @param device that the sweeps start from, pushed as those of a class are. @param threads 0: all cores.
/// @throws Cancelled.
[[nodiscard]] WallStability run_wall_stability(int threads, Progress* progress,
                                               const DeviceProfile& device = find_profile("ideal"));

/// The same as parts of a report: the sweeps with their plots, devices and ledger.
[[nodiscard]] std::vector<ReportSection> wall_sections(const WallStability& wall);

}  // namespace palpate
