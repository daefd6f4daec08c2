/// The folder of an experiment, laid out after BIDS (Gorgolewski et al. 2016), so that others can read it:
///
///   dataset_description.json  study.json  README  participants.tsv  design.tsv
///   task-NAME_beh.json        data dictionary of the trials of a task
///   stimuli/task-NAME_stimuli.tsv
///   sub-CODE/beh/sub-CODE_task-NAME_run-NN_beh.json           what came of a trial
///   sub-CODE/beh/sub-CODE_task-NAME_run-NN_recording.txt.gz   all input of the hand, to play it back
///   sub-CODE/beh/sub-CODE_task-NAME_run-NN_motion.tsv.gz      cursor, proxy, force, each hundredth of a second
///   sub-CODE/sub-CODE_questionnaire.json
///   .locks/  who has the folder in use
///
/// Each table has its dictionary beside it, under its name and .json; that of all _motion.tsv.gz of a task is
/// task-NAME_motion.json.
///
/// A trial is there once its _beh.json is: that file is written last, and each of them under another name first,
/// is forced to the disk and then renamed. Nothing but the code tells who a participant was.
///
/// A trial with flaws (TrialFlaws) is kept as it was, and repeated at the end of its block, up to kMostAttempts times in
/// all. The block is what a participant does of a task, practice and recorded trials apart. NN counts trials of the task
/// in the design, from 1; a repeat has the next number that is as far on as the task has trials: 7, 37, 67 of 30.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/study/design.h"
#include "common/study/study_lock.h"
#include "common/study/study_participant.h"
#include "common/study/task.h"
#include "common/study/trial_run.h"

namespace palpate {

/// What study.json says.
struct StudyPlan {
  std::string program;             ///< the name of the one whose tasks they are
  std::string version;             ///< that made the folder
  std::vector<std::string> tasks;  ///< names, in the order that the design counts them
  DesignRequest design;
  double guidance = 1.0;
};

/// A trial that was done.
struct TrialRecord {
  std::string participant;
  std::string task;
  int run = 1;  ///< of the task, from 1, practice first; a repeat as StudyFolder::run_of() counts it
  int stimulus = 0;
  bool practice = false;
  bool guided = false;
  bool simulated = false;
  std::string device;  ///< what moved the cursor
  TrialOutcome outcome;
  double most_stiffness = HUGE_VAL;  ///< [N/m] of the chain, as the device bears it
  int attempt = 0;                   ///< 0, or which repeat it is
};

inline constexpr const char* kRecordingFile = "recording.txt.gz";
inline constexpr const char* kMotionFile = "motion.tsv.gz";

class StudyFolder {
 public:
  /// Opens one that is there. @throws Error (bad input) where it is none.
  explicit StudyFolder(std::filesystem::path folder);
  /// @throws Error (usage) where a task is named twice, or a number is beyond its limits.
  static void check(const StudyPlan& plan);
  /// Makes one. @param overwrite an experiment there without any trial is replaced.
  /// @throws Error (usage) where the folder holds something else, or trials; (work failed).
  static StudyFolder make(const std::filesystem::path& folder, const StudyPlan& plan, const StudyTasks& tasks,
                          bool overwrite);

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return folder_; }
  [[nodiscard]] const StudyPlan& plan() const noexcept { return plan_; }
  [[nodiscard]] const std::vector<PlannedTrial>& design() const noexcept { return design_; }
  /// What the dictionary of a task says of it. @throws Error (bad input).
  [[nodiscard]] StudyTaskInfo task(const std::string& name) const;
  /// Repeats of a trial included.
  static constexpr int kMostAttempts = 3;
  /// The number of a trial in its files, from 1.
  [[nodiscard]] int run_of(const PlannedTrial& trial) const noexcept;
  /// What the files of a trial begin with, folders included; then kRecordingFile or kMotionFile.
  [[nodiscard]] std::filesystem::path stem(const std::string& code, const std::string& task, int run) const;
  /// Whether the stimuli that the tasks have prepared are those of the folder, to 1e-6. @throws Error (bad input).
  void check_stimuli(const StudyTasks& tasks) const;
  /// Takes a place of the design, or the whole folder, for a session: `kShared` where others may sit at other places.
  /// @throws Error (usage) that says who has it.
  [[nodiscard]] StudyLock hold_place(int number, const std::string& by) const;
  [[nodiscard]] StudyLock hold(StudyLock::Kind kind, const std::string& by) const;
  /// "P01": of that number in the design.
  [[nodiscard]] static std::string code_of(int number);

  /// Those that have begun, by number.
  [[nodiscard]] std::vector<StudyParticipant> participants() const;
  /// Enters one. @throws Error (usage) where the code is of somebody else or is no code; (work failed).
  void enter(const StudyParticipant& participant);

  [[nodiscard]] bool has(const std::string& code, const std::string& task, int run) const;
  /// Trials of a participant that are to be done, in their order: those that are not there, and repeats at the end of
  /// their blocks. @throws Error (bad input) for a trial that is damaged.
  [[nodiscard]] std::vector<PlannedTrial> left_for(const StudyParticipant& participant) const;
  /// Writes a trial: it is on the disk when this returns.
  /// @param recording its text. @throws Error (work failed), also for a trial without steps, or a time or an error that
  /// is not finite.
  void write(const TrialRecord& record, const std::string& recording, const std::vector<HandStep>& steps);
  /// @throws Error (bad input) where it is damaged, or no trial of the design.
  [[nodiscard]] TrialRecord read(const StudyParticipant& who, const PlannedTrial& planned) const;
  [[nodiscard]] Recording recording(const std::string& code, const std::string& task, int run) const;
  /// All trials that are there, each with its repeats, in the order of the design.
  [[nodiscard]] std::vector<TrialRecord> trials() const;

  /// Answers by question; empty where the form was not filled in.
  void write_answers(const std::string& code, const std::map<std::string, std::string>& answers);
  [[nodiscard]] std::map<std::string, std::string> answers(const std::string& code) const;

 private:
  StudyFolder() = default;

  std::filesystem::path folder_;
  StudyPlan plan_;
  std::vector<PlannedTrial> design_;
};

/// What the form asks after the last trial.
struct StudyQuestion {
  std::string key;  ///< in the file
  std::string text;
  std::vector<std::string> choices;  ///< empty: any text
};
[[nodiscard]] const std::vector<StudyQuestion>& study_questions();

}  // namespace palpate
