#include "common/study/study_folder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/error.h"
#include "common/base/json.h"
#include "common/base/text.h"
#include "common/base/version.h"
#include "common/study/packed_text.h"
#include "common/study/study_disk.h"
#include "common/study/study_tables.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPlanFile = "study.json";
constexpr const char* kPeopleFile = "participants.tsv";
constexpr const char* kDesignFile = "design.tsv";
constexpr const char* kLocks = ".locks";  // beside what BIDS knows

std::string two_digits(int number) {
  std::string text = std::to_string(number);
  return text.size() < 2 ? "0" + text : text;
}

Json plan_json(const StudyPlan& plan) {
  return {{"program", plan.program},
          {"version", plan.version},
          {"seed", plan.design.seed},
          {"tasks", plan.tasks},
          {"participants", plan.design.participants},
          {"practice_trials", plan.design.practice},
          {"recorded_trials", plan.design.recorded},
          {"guidance", plan.guidance}};
}

constexpr int kMostParticipants = 10'000, kMostTrials = 300, kMostTasks = 32, kMostPlanned = 1'000'000;
constexpr double kMostGuidance = 10.0;

StudyPlan plan_of(const fs::path& file, const Json& json) {
  StudyPlan plan;
  plan.program = json.at("program");
  plan.version = json.at("version");
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  plan.design.seed = static_cast<std::uint64_t>(whole_number(file, json, "seed", 0, kMost));
  plan.tasks = json.at("tasks").get<std::vector<std::string>>();
  plan.design.tasks = static_cast<int>(plan.tasks.size());
  plan.design.participants = static_cast<int>(whole_number(file, json, "participants", 1, kMostParticipants));
  plan.design.practice = static_cast<int>(whole_number(file, json, "practice_trials", 0, kMostTrials));
  plan.design.recorded = static_cast<int>(whole_number(file, json, "recorded_trials", 2, kMostTrials));
  plan.guidance = json.at("guidance");
  return plan;
}

void check_code(const std::string& code) {
  if (!is_plain(code)) throw usage_error("--participant: a code is made of letters and digits, such as P03");
}

}  // namespace

const std::vector<StudyQuestion>& study_questions() {
  static const std::vector<std::string> kScale{"1", "2", "3", "4", "5"};
  static const std::vector<StudyQuestion> kQuestions{
      {"harder_3d", "Were 3D trials more difficult than 2D ones? (1 not at all, 5 much more)", kScale},
      {"noticed_guidance", "Did you notice when the force guided you? (1 never, 5 always)", kScale},
      {"helped", "Did the guidance help you? (1 not at all, 5 very much)", kScale},
      {"tired", "Were your eyes or your hand tired? (1 not at all, 5 very)", kScale},
      {"strategy", "Did you use a strategy for the tasks? Which?", {}}};
  return kQuestions;
}

StudyTaskInfo StudyFolder::task(const std::string& name) const {
  return taken(folder_ / ("task-" + name + "_beh.json"), [&](const Json& json) {
    StudyTaskInfo info{.name = name};
    info.title = json.at("TaskName");
    info.pair = json.at("pair");
    info.flat = json.at("flat");
    info.instruction = json.at("TaskDescription");
    info.error = json.at("position_error").at("Description");
    info.cutoff_time = json.at("cutoff_time").at("Value");
    info.cutoff_error = json.at("cutoff_error").at("Value");
    return info;
  });
}

std::string StudyFolder::code_of(int number) { return "P" + two_digits(number + 1); }

StudyFolder::StudyFolder(fs::path folder) : folder_(std::move(folder)) {
  const fs::path file = folder_ / kPlanFile;
  if (!fs::exists(file)) {
    throw input_error({folder_.string(), "", "it holds no experiment (no study.json)", "",
                       "make one: study make " + folder_.string()});
  }
  plan_ = taken(file, [&](const Json& json) { return plan_of(file, json); });
  try {
    check(plan_);
  } catch (const Error& error) {
    throw input_error({file.string(), "", error.what(), "", "restore it from a copy"});
  }
  design_ = make_design(plan_.design);
  if (read_study_text(folder_ / kDesignFile) != design_table(design_, plan_.tasks))
    throw input_error({(folder_ / kDesignFile).string(), "",
                       "the trials that this program plans from the seed are other ones", "",
                       "use the version that made the experiment, " + plan_.version +
                           ", and study.json and design.tsv as they were"});
}

void StudyFolder::check(const StudyPlan& plan) {
  const DesignRequest& d = plan.design;
  std::vector<std::string> names = plan.tasks;
  std::ranges::sort(names);
  if (const auto twice = std::ranges::adjacent_find(names); twice != names.end())
    throw usage_error("--tasks: '" + *twice + "' is there twice; name each task once");
  if (const auto odd = std::ranges::find_if_not(names, is_plain); odd != names.end())
    throw usage_error("--tasks: '" + *odd + "' is no name of a task");
  if (names.empty() || names.size() > as_size(kMostTasks) || as_size(d.tasks) != names.size())
    throw usage_error("an experiment has 1 to " + std::to_string(kMostTasks) + " tasks");
  if (d.participants < 1 || d.participants > kMostParticipants || d.practice < 0 ||
      d.practice > kMostTrials || d.recorded < 2 || d.recorded > kMostTrials || d.recorded % 2 != 0)
    throw usage_error(
        "--recorded, --practice, --participants: an even number of recorded trials is needed, and up to " +
        std::to_string(kMostTrials) + " of each kind for up to " + std::to_string(kMostParticipants) +
        " participants");
  const std::int64_t planned = std::int64_t{d.participants} * d.tasks * (d.practice + d.recorded);
  if (planned > kMostPlanned)
    throw usage_error(std::to_string(planned) + " trials are planned; at most " +
                      std::to_string(kMostPlanned) + " are: fewer --participants, --tasks or trials");
  if (!(plan.guidance >= 0.0 && plan.guidance <= kMostGuidance))
    throw usage_error("--guidance: a factor from 0 to " + short_number(kMostGuidance) + " is needed");
}

void StudyFolder::check_stimuli(const StudyTasks& tasks) const {
  constexpr double kSame = 1e-6;  // rounding of another compiler; what it is measured in is metres
  const auto numbers_of = [](const std::string& text) {
    std::vector<double> out;
    std::string flat = text.substr(std::min(text.size(), text.find('\n')));
    for (const std::string_view word : words(flat)) out.push_back(number(word).value_or(NAN));
    return out;
  };
  for (const auto& task : tasks) {
    const fs::path file = folder_ / "stimuli" / ("task-" + task->info().name + "_stimuli.tsv");
    const std::string kept = read_study_text(file), made = stimulus_table(*task, plan_.design);
    if (kept == made) continue;
    const bool same = std::ranges::equal(numbers_of(kept), numbers_of(made), [](double a, double b) {
      return std::abs(a - b) <= kSame * std::max(1.0, std::abs(b));
    });
    if (!same)
      throw input_error({file.string(), "",
                         "the stimuli that this program makes from the seed are other ones", "",
                         "use the version that made the experiment, " + plan_.version +
                             ", and study.json and stimuli as they were"});
  }
}

StudyLock StudyFolder::hold_place(int number, const std::string& by) const {
  return {folder_ / kLocks / ("place-" + two_digits(number + 1)), StudyLock::Kind::kAlone, by};
}

StudyLock StudyFolder::hold(StudyLock::Kind kind, const std::string& by) const {
  return {folder_ / kLocks / "session", kind, by};
}

StudyFolder StudyFolder::make(const fs::path& folder, const StudyPlan& plan, const StudyTasks& tasks,
                              bool overwrite) {
  check(plan);
  std::error_code ignored;
  if (fs::exists(folder, ignored) && !fs::is_empty(folder, ignored)) {
    if (!overwrite || !fs::exists(folder / kPlanFile, ignored))
      throw usage_error(folder.string() + " is there already; give another name" +
                        (fs::exists(folder / kPlanFile, ignored) ? " or --force" : ""));
    if (fs::exists(folder / kPeopleFile, ignored))
      throw usage_error(folder.string() + " holds an experiment that has begun; it is not replaced");
  }
  make_study_folder(folder / "stimuli");
  StudyFolder out;
  out.folder_ = folder;
  out.plan_ = plan;
  out.design_ = make_design(plan.design);
  const StudyLock alone = out.hold(StudyLock::Kind::kAlone, "study make");
  write_safely(folder / "dataset_description.json",
               pretty({{"Name", "Haptic guidance in " + plan.program},
                       {"BIDSVersion", "1.8.0"},
                       {"DatasetType", "raw"},
                       {"GeneratedBy", {{{"Name", "Palpate"}, {"Version", plan.version}}}}}));
  std::string readme = "An experiment: does guidance of the hand help?\n\nTasks:";
  for (const auto& task : tasks) {
    const StudyTaskInfo& info = task->info();
    readme += "\n  " + info.name + ": " + info.title;
    const std::string start = "task-" + info.name + "_";
    write_safely(folder / (start + "beh.json"), task_dictionary(info));
    write_safely(folder / (start + "motion.json"), motion_dictionary());
    write_safely(folder / "stimuli" / (start + "stimuli.json"), stimulus_dictionary(*task));
    write_safely(folder / "stimuli" / (start + "stimuli.tsv"), stimulus_table(*task, plan.design));
  }
  write_safely(
      folder / "README",
      readme +
          "\n\nAll stimuli are made again from the seed in study.json. Participants are known by codes alone.\n");
  write_safely(folder / "design.json", data_dictionary(design_columns()));
  write_safely(folder / "participants.json", data_dictionary(participant_columns()));
  write_safely(folder / kDesignFile, design_table(out.design_, plan.tasks));
  write_safely(folder / kPlanFile, pretty(plan_json(plan)));
  return out;
}

std::vector<StudyParticipant> StudyFolder::participants() const {
  const fs::path file = folder_ / kPeopleFile;
  if (!fs::exists(file)) return {};
  return participants_of(file.string(), read_study_text(file), plan_.design.participants);
}

void StudyFolder::enter(const StudyParticipant& participant) {
  check_code(participant.code);
  const StudyLock alone(folder_ / kLocks / "participants");
  // Before it is entered: one that is has its folder, whenever the program ends.
  make_study_folder(folder_ / ("sub-" + participant.code) / "beh");
  std::vector<StudyParticipant> all = participants();
  for (const StudyParticipant& other : all) {
    if (other.code == participant.code && other.number == participant.number) return;
    if (other.code == participant.code || other.number == participant.number)
      throw usage_error("--participant " + participant.code + ": that place is taken by " + other.code);
  }
  all.push_back(participant);
  std::ranges::sort(all, {}, &StudyParticipant::number);
  write_safely(folder_ / kPeopleFile, participants_table(all));
}

int StudyFolder::run_of(const PlannedTrial& trial) const noexcept {
  return trial.trial + 1 + trial.attempt * (plan_.design.practice + plan_.design.recorded);
}

fs::path StudyFolder::stem(const std::string& code, const std::string& task, int run) const {
  const std::string sub = "sub-" + code;
  return folder_ / sub / "beh" / (sub + "_task-" + task + "_run-" + two_digits(run) + "_");
}

bool StudyFolder::has(const std::string& code, const std::string& task, int run) const {
  std::error_code ignored;
  return fs::exists(stem(code, task, run).string() + "beh.json", ignored);
}

std::vector<PlannedTrial> StudyFolder::left_for(const StudyParticipant& participant) const {
  std::vector<PlannedTrial> left, repeats;
  const PlannedTrial* before = nullptr;
  for (const PlannedTrial& planned : design_) {
    if (planned.participant != participant.number) continue;
    if (before != nullptr && (before->task != planned.task || before->practice != planned.practice)) {
      left.insert(left.end(), repeats.begin(), repeats.end());
      repeats.clear();
    }
    before = &planned;
    PlannedTrial next = planned;
    while (next.attempt < kMostAttempts &&
           has(participant.code, plan_.tasks[as_size(next.task)], run_of(next)) &&
           read(participant, next).outcome.flaws.any())
      ++next.attempt;
    if (next.attempt == kMostAttempts || has(participant.code, plan_.tasks[as_size(next.task)], run_of(next)))
      continue;
    (next.attempt == 0 ? left : repeats).push_back(next);
  }
  left.insert(left.end(), repeats.begin(), repeats.end());
  return left;
}

void StudyFolder::write(const TrialRecord& record, const std::string& recording,
                        const std::vector<HandStep>& steps) {
  const std::string start = stem(record.participant, record.task, record.run).string();
  if (!std::isfinite(record.outcome.seconds) || !std::isfinite(record.outcome.error) || steps.empty())
    throw work_error(start +
                     "beh.json: the trial has no steps, or its time or error is no number; it is not saved");
  write_safely(start + kRecordingFile, packed(recording));
  write_safely(start + kMotionFile, packed(motion_table(steps)));
  const TrialOutcome& o = record.outcome;
  write_safely(start + "beh.json",
               pretty({{"participant", record.participant},
                       {"task", record.task},
                       {"run", record.run},
                       {"attempt", record.attempt + 1},
                       {"phase", record.practice ? "practice" : "recorded"},
                       {"stimulus", record.stimulus},
                       {"condition", condition_name(record.guided)},
                       {"simulated", record.simulated},
                       {"device", record.device},
                       {"completion_time", o.seconds},
                       {"position_error", o.error},
                       {"reached", o.reached},
                       {"end", o.timed_out ? kTimeEvent : kDoneEvent},
                       {"first_step", o.begin},
                       {"end_step", o.end},
                       {"lost_steps", o.flaws.lost},
                       {"fault_steps", o.flaws.faults},
                       {"cut_steps", o.flaws.cut},
                       {"off_steps", o.flaws.off},
                       {"most_stiffness", std::isfinite(record.most_stiffness) ? Json(record.most_stiffness)
                                                                               : Json(nullptr)}}));
}

TrialRecord StudyFolder::read(const StudyParticipant& who, const PlannedTrial& planned) const {
  const std::string& task = plan_.tasks[as_size(planned.task)];
  const fs::path file = stem(who.code, task, run_of(planned)).string() + "beh.json";
  return taken(file, [&](const Json& json) {
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    const auto count = [&](const char* key) {
      return static_cast<std::uint64_t>(whole_number(file, json, key, 0, kMost));
    };
    TrialRecord r;
    r.participant = json.at("participant");
    r.task = json.at("task");
    r.run = static_cast<int>(whole_number(file, json, "run", 1, 2 * kMostTrials * kMostAttempts));
    r.attempt = static_cast<int>(whole_number(file, json, "attempt", 1, kMostAttempts)) - 1;
    r.practice = is_second(file, json, "phase", "recorded", "practice");
    r.stimulus = static_cast<int>(whole_number(file, json, "stimulus", 0, 2 * kMostTrials));
    r.guided = is_second(file, json, "condition", condition_name(false), condition_name(true));
    r.simulated = json.at("simulated");
    r.device = json.at("device");
    r.outcome.seconds = json.at("completion_time");
    r.outcome.error = json.at("position_error");
    r.outcome.reached = json.at("reached");
    r.outcome.timed_out = is_second(file, json, "end", kDoneEvent, kTimeEvent);
    r.outcome.begin = count("first_step");
    r.outcome.end = count("end_step");
    r.outcome.flaws = {count("lost_steps"), count("fault_steps"), count("cut_steps"), count("off_steps")};
    if (const Json& most = json.at("most_stiffness"); !most.is_null()) r.most_stiffness = most;
    if (r.participant != who.code || r.task != task || r.run != run_of(planned) ||
        r.attempt != planned.attempt || r.stimulus != planned.stimulus || r.practice != planned.practice ||
        r.guided != planned.guided || r.simulated != who.simulated)
      throw input_error({file.string(), "", "it is of another trial than the design has there", "",
                         "restore it, or study.json and participants.tsv, from a copy"});
    if (!(r.outcome.seconds >= 0.0) || !(r.outcome.error >= 0.0) || !(r.most_stiffness >= 0.0))
      throw input_error(
          {file.string(), "", "a negative time, error or stiffness", "", "restore it from a copy"});
    return r;
  });
}

Recording StudyFolder::recording(const std::string& code, const std::string& task, int run) const {
  const std::string file = stem(code, task, run).string() + kRecordingFile;
  return read_packed_recording(file);
}

std::vector<TrialRecord> StudyFolder::trials() const {
  std::vector<TrialRecord> out;
  std::map<int, StudyParticipant> known;
  for (StudyParticipant& p : participants()) known[p.number] = std::move(p);
  for (const PlannedTrial& t : design_) {
    const auto who = known.find(t.participant);
    PlannedTrial one = t;
    while (one.attempt < kMostAttempts && who != known.end() &&
           has(who->second.code, plan_.tasks[as_size(t.task)], run_of(one))) {
      out.push_back(read(who->second, one));
      ++one.attempt;
    }
  }
  return out;
}

void StudyFolder::write_answers(const std::string& code, const std::map<std::string, std::string>& answers) {
  Json json = Json::object();
  for (const StudyQuestion& question : study_questions()) {
    const auto found = answers.find(question.key);
    json[question.key] = {{"question", question.text},
                          {"answer", found == answers.end() ? std::string() : found->second}};
  }
  const std::string sub = "sub-" + code;
  write_safely(folder_ / sub / (sub + "_questionnaire.json"), pretty(json));
}

std::map<std::string, std::string> StudyFolder::answers(const std::string& code) const {
  const std::string sub = "sub-" + code;
  const fs::path file = folder_ / sub / (sub + "_questionnaire.json");
  std::map<std::string, std::string> out;
  if (!fs::exists(file)) return out;
  return taken(file, [&](const Json& json) {
    for (const auto& [key, value] : json.items()) out[key] = value.at("answer");
    return out;
  });
}

}  // namespace palpate
