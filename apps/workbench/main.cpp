/// workbench: calibrates devices and displays, judges what their errors do, and looks after what is plugged in.
#include "apps/workbench/workbench_verbs.h"

int main(int argc, char** argv) {
  using namespace palpate;
  const Explorer workbench{
      .name = "workbench",
      .summary =
          "Calibrate devices and displays, judge what their errors do, and look after what is plugged in",
      .kind = FieldKind::kNone,
      .examples = {{"workbench", "a report of made calibrations, in workbench-report"},
                   {"workbench calibrate tracker poses.csv --out workbench.toml --report report",
                    "a tracker's distortion, from measurements"},
                   {"workbench calibrate arm grid.csv --out workbench.toml", "an arm's joints and links"},
                   {"workbench calibrate pivot --example", "what a calibration says, on made measurements"},
                   {"workbench example arm --out grid.csv", "how a table of measurements looks"},
                   {"workbench screen --distance 0.7 --position-error 5,5 --orientation-error 1",
                    "what a wrong head does to the picture"},
                   {"workbench stability --out stability", "how stiff walls may be"},
                   {"workbench devices", "what is plugged in"},
                   {"workbench doctor --device falcon", "whether it works, and what to do if not"},
                   {"workbench feel --device simulated:falcon --effect groove",
                    "how truly it shows a groove"},
                   {"workbench tune --device falcon:enable=pedal --out workbench.toml",
                    "how stiff it may be"}},
      .verbs =
          {calibrate_verb(
               {{"workbench calibrate tracker poses.csv --degree 4 --method combined --out workbench.toml",
                 "a polynomial, and a table of what it leaves"},
                {"workbench calibrate tracker poses.csv --pictures pictures", "the distortion, drawn"},
                {"workbench calibrate arm grid.csv --nominal workbench.toml --out workbench.toml --force",
                 "again, from the last calibration"},
                {"workbench calibrate coregister --example --json",
                 "made measurements; the result as JSON"}}),
           example_verb({{"workbench example tracker --out poses.csv", "a tracker among metal"}}),
           made_report_verb({{"workbench report --out made", "in a folder of your own"}}),
           screen_verb({{"workbench screen --distance 0.5 --width 0.6 --pixel 0.00025", "in pixels, too"},
                        {"workbench screen --position-error 5,5 --orientation-error 1 --out screen-report",
                         "with pictures of the space that is seen"}}),
           stability_verb(
               {{"workbench stability --out stability", "for an ideal device, next to known classes"},
                {"workbench stability --model arm.toml --out stability",
                 "for a device that a file describes"}}),
           devices_verb(
               {{"workbench devices", "devices and drivers"}, {"workbench devices --json", "as JSON"}}),
           doctor_verb({{"workbench doctor", "all that are plugged in"},
                        {"workbench doctor --device falcon:firmware=firmware.bin,enable=pedal",
                         "one of them, with its options"}}),
           monitor_verb(
               {{"workbench monitor --device spacemouse --seconds 60", "for a minute"},
                {"workbench monitor --device falcon --rate 100 --json", "a hundred samples a second"},
                {"workbench monitor --device vrpn:Tracker0@lab,sensor=1", "of a VRPN server"},
                {"workbench monitor --device polhemus --workbench workbench.toml",
                 "poses without the tracker's distortion"}}),
           controls_verb({{"workbench controls hands.csv --out controls.csv --picture controls.png",
                           "what was chosen and set, and the menu as it was left"},
                          {"workbench controls hands.csv --workbench workbench.toml --json",
                           "with the tip of a calibrated stylus"}}),
           feel_verb(
               {{"workbench feel --device simulated:falcon --effect groove --seconds 20",
                 "a simulated arm that strokes along a groove"},
                {"workbench feel --device falcon:enable=pedal --stiffness 800 --workbench workbench.toml",
                 "with force while the pedal is down"},
                {"workbench feel --device simulated:falcon --path hand.csv --out log.csv",
                 "a recorded hand, and a log of every step"}}),
           tune_verb({{"workbench tune --device simulated:falcon --json", "a simulated arm"},
                      {"workbench tune --device falcon:enable=pedal --out workbench.toml",
                       "into a workbench file, for the explorers"}})},
      .default_verb = "report"};
  return run_explorer(workbench, argc, argv);
}
