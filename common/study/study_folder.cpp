#include "common/study/study_folder.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/base/unique_fd.h"
#include "common/base/version.h"
#include "common/study/packed_text.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kPlanFile = "study.json";

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw input_error({path.string(), "", "cannot be read (" + errno_text() + ")", "", ""});
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

Json read_json(const fs::path& path) {
  Json json = Json::parse(read_text(path), nullptr, false);
  if (!json.is_object())
    throw input_error({path.string(), "", "it holds no JSON object", "", "restore it from a copy"});
  return json;
}

/// `take`, with what it misses as an error of that file.
template <typename Take>
auto taken(const fs::path& path, const Take& take) {
  try {
    return take(read_json(path));
  } catch (const nlohmann::json::exception& error) {
    throw input_error({path.string(), "", error.what(), "", "restore it from a copy"});
  }
}

std::string pretty(const Json& json) {
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

/// The whole of it is on the disk, under its name, when this returns.
void write_safely(const fs::path& path, const std::string& text) {
  const fs::path temporary = path.string() + ".part";
  const auto refuse = [&] { throw work_error(path.string() + ": cannot be written (" + errno_text() + ")"); };
  UniqueFd file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  if (file.get() < 0) refuse();
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t got = ::write(file.get(), text.data() + at, text.size() - at);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) refuse();
    at += static_cast<std::size_t>(got);
  }
  if (::fsync(file.get()) != 0) refuse();
  if (std::rename(temporary.c_str(), path.c_str()) != 0) refuse();
  const UniqueFd folder(::open(path.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.get() < 0 || ::fsync(folder.get()) != 0) refuse();
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw work_error(path.string() + ": cannot be made (" + error.message() + ")");
}

/// Letters and digits alone: what becomes part of a file's name.
bool is_plain(const std::string& word) {
  return !word.empty() && word.size() <= 32 &&
         std::ranges::all_of(word, [](unsigned char c) { return std::isalnum(c) != 0; });
}

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

StudyPlan plan_of(const Json& json) {
  StudyPlan plan;
  plan.program = json.at("program");
  plan.version = json.at("version");
  plan.design.seed = json.at("seed");
  plan.tasks = json.at("tasks").get<std::vector<std::string>>();
  plan.design.tasks = static_cast<int>(plan.tasks.size());
  plan.design.participants = json.at("participants");
  plan.design.practice = json.at("practice_trials");
  plan.design.recorded = json.at("recorded_trials");
  plan.guidance = json.at("guidance");
  return plan;
}

Json dictionary_of(const StudyTaskInfo& info) {
  return {{"TaskName", info.title},
          {"flat", info.flat},
          {"pair", info.pair},
          {"TaskDescription", info.instruction},
          {"participant", {{"Description", "anonymous code"}}},
          {"run", {{"Description", "trial of the task, from 1; those for practice first"}}},
          {"phase", {{"Levels", {{"practice", "not analysed"}, {"recorded", "analysed"}}}}},
          {"stimulus", {{"Description", "row of the table in stimuli/, from 0"}}},
          {"condition",
           {{"Levels",
             {{"ISO", "slight drag, the same in all directions"},
              {"ANISO", "guided along what is to be followed"}}}}},
          {"completion_time",
           {{"Description", "from the space bar that begins to the one that ends"}, {"Units", "s"}}},
          {"position_error", {{"Description", info.error}, {"Units", "mm"}}},
          {"reached", {{"Description", "whether the goal was met"}}},
          {"end", {{"Levels", {{"space", "the participant ended it"}, {"timeout", "it ended by itself"}}}}},
          {"simulated", {{"Description", "true where the participant is a program"}}},
          {"cutoff_time",
           {{"Description", "slower trials are left out"}, {"Value", info.cutoff_time}, {"Units", "s"}}},
          {"cutoff_error",
           {{"Description", "trials with a larger error are left out"},
            {"Value", info.cutoff_error},
            {"Units", "mm"}}},
          {"motion.tsv.gz",
           {{"SamplingFrequency", 100},
            {"Columns",
             {"time [s]", "x", "y", "z (cursor [m])", "px", "py", "pz (proxy [m])", "fx", "fy",
              "fz (force [N])", "state"}}}}};
}

std::string motion_table(const std::vector<HandStep>& steps) {
  constexpr std::size_t kEvery = 10;
  std::string text = "time\tx\ty\tz\tpx\tpy\tpz\tfx\tfy\tfz\tstate\n";
  for (std::size_t i = 0; i < steps.size(); i += kEvery) {
    const HandStep& step = steps[i];
    text += short_number(step.time - steps.front().time);
    for (const Vec3& v : {step.probe, step.chain.proxy(step.probe), step.force}) {
      for (int axis = 0; axis < 3; ++axis) text += "\t" + short_number(v[axis]);
    }
    text += "\t" + std::string(name_of(step.state)) + "\n";
  }
  return text;
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
  plan_ = taken(file, plan_of);
  const DesignRequest& d = plan_.design;
  constexpr int kMostParticipants = 10'000, kMostTrials = 200, kMostTasks = 32;
  const bool sound = d.participants > 0 && d.participants <= kMostParticipants && d.practice >= 0 &&
                     d.practice <= kMostTrials && d.recorded > 0 && d.recorded <= kMostTrials &&
                     d.recorded % 2 == 0 && d.tasks > 0 && d.tasks <= kMostTasks && plan_.guidance >= 0.0 &&
                     std::ranges::all_of(plan_.tasks, is_plain);
  if (!sound)
    throw input_error(
        {file.string(), "", "its numbers or names of tasks make no sense", "", "restore it from a copy"});
  design_ = make_design(plan_.design);
}

StudyFolder StudyFolder::make(const fs::path& folder, const StudyPlan& plan, const StudyTasks& tasks,
                              bool overwrite) {
  std::error_code ignored;
  if (fs::exists(folder, ignored) && !fs::is_empty(folder, ignored)) {
    if (!overwrite || !fs::exists(folder / kPlanFile, ignored))
      throw usage_error(folder.string() + " is there already; give another name" +
                        (fs::exists(folder / kPlanFile, ignored) ? " or --force" : ""));
    if (fs::exists(folder / "participants.tsv", ignored))
      throw usage_error(folder.string() + " holds an experiment that has begun; it is not replaced");
  }
  make_folder(folder / "stimuli");
  StudyFolder out;
  out.folder_ = folder;
  out.plan_ = plan;
  out.design_ = make_design(plan.design);
  write_safely(folder / "dataset_description.json",
               pretty({{"Name", "Haptic guidance in " + plan.program},
                       {"BIDSVersion", "1.8.0"},
                       {"DatasetType", "raw"},
                       {"GeneratedBy", {{{"Name", "Palpate"}, {"Version", plan.version}}}}}));
  std::string readme = "An experiment: does guidance of the hand help?\n\nTasks:";
  std::string design = "participant\torder\ttask\trun\tphase\tstimulus\tcondition\n";
  std::map<std::pair<int, int>, int> place;
  for (const PlannedTrial& t : out.design_) {
    design += code_of(t.participant) + "\t" + std::to_string(++place[{t.participant, 0}]) + "\t" +
              plan.tasks[as_size(t.task)] + "\t" + std::to_string(t.trial + 1) + "\t" +
              (t.practice ? "practice" : "recorded") + "\t" + std::to_string(t.stimulus) + "\t" +
              std::string(condition_name(t.guided)) + "\n";
  }
  for (const auto& task : tasks) {
    const StudyTaskInfo& info = task->info();
    readme += "\n  " + info.name + ": " + info.title;
    write_safely(folder / ("task-" + info.name + "_beh.json"), pretty(dictionary_of(info)));
    std::string table = "stimulus";
    for (const std::string& column : task->stimulus_columns()) table += "\t" + column;
    table += "\n";
    for (int s = 0; s < plan.design.practice + plan.design.recorded; ++s) {
      table += std::to_string(s);
      for (const double value : task->stimulus_row(s)) table += "\t" + exact_number(value);
      table += "\n";
    }
    write_safely(folder / "stimuli" / ("task-" + info.name + "_stimuli.tsv"), table);
  }
  write_safely(
      folder / "README",
      readme +
          "\n\nAll stimuli are made again from the seed in study.json. Participants are known by codes alone.\n");
  write_safely(folder / "design.tsv", design);
  write_safely(folder / "design.json",
               pretty({{"order", {{"Description", "of the trial in the participant's session, from 1"}}},
                       {"run", {{"Description", "of the trial in its task, from 1"}}},
                       {"condition", {{"Description", "ISO or ANISO: see the dictionaries of the tasks"}}}}));
  write_safely(folder / kPlanFile, pretty(plan_json(plan)));
  return out;
}

std::vector<StudyParticipant> StudyFolder::participants() const {
  std::vector<StudyParticipant> out;
  const fs::path file = folder_ / "participants.json";
  if (!fs::exists(file)) return out;
  return taken(file, [&](const Json& json) {
    for (const Json& one : json.at("participants")) {
      StudyParticipant p{one.at("code"), one.at("number"), one.at("simulated"), {}};
      if (!is_plain(p.code)) throw input_error({file.string(), "", "'" + p.code + "'", "a code", ""});
      for (const auto& [name, value] : one.at("traits").items())
        p.traits.emplace_back(name, value.get<double>());
      out.push_back(std::move(p));
    }
    return out;
  });
}

void StudyFolder::enter(const StudyParticipant& participant) {
  check_code(participant.code);
  std::vector<StudyParticipant> all = participants();
  for (const StudyParticipant& other : all) {
    if (other.code == participant.code && other.number == participant.number) return;
    if (other.code == participant.code || other.number == participant.number)
      throw usage_error("--participant " + participant.code + ": that place is taken by " + other.code);
  }
  all.push_back(participant);
  std::ranges::sort(all, {}, &StudyParticipant::number);
  Json list = Json::array();
  std::string table = "participant_id\tnumber\tsimulated\n";
  for (const StudyParticipant& p : all) {
    Json traits = Json::object();
    for (const auto& [name, value] : p.traits) traits[name] = value;
    list.push_back({{"code", p.code}, {"number", p.number}, {"simulated", p.simulated}, {"traits", traits}});
    table +=
        "sub-" + p.code + "\t" + std::to_string(p.number) + "\t" + (p.simulated ? "true" : "false") + "\n";
  }
  write_safely(folder_ / "participants.tsv", table);
  write_safely(folder_ / "participants.json",
               pretty({{"number", {{"Description", "row of the design, from 0"}}},
                       {"simulated", {{"Description", "true where the participant is a program"}}},
                       {"participants", list}}));
  make_folder(folder_ / ("sub-" + participant.code) / "beh");
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
  std::vector<PlannedTrial> left;
  for (const PlannedTrial& t : design_) {
    if (t.participant == participant.number &&
        !has(participant.code, plan_.tasks[as_size(t.task)], t.trial + 1))
      left.push_back(t);
  }
  return left;
}

void StudyFolder::write(const TrialRecord& record, const std::string& recording,
                        const std::vector<HandStep>& steps) {
  const std::string start = stem(record.participant, record.task, record.run).string();
  write_safely(start + "recording.txt.gz", packed(recording));
  write_safely(start + "motion.tsv.gz", packed(motion_table(steps)));
  const TrialOutcome& o = record.outcome;
  write_safely(start + "beh.json", pretty({{"participant", record.participant},
                                           {"task", record.task},
                                           {"run", record.run},
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
                                           {"end_step", o.end}}));
}

TrialRecord StudyFolder::read(const std::string& code, const std::string& task, int run) const {
  const fs::path file = stem(code, task, run).string() + "beh.json";
  return taken(file, [&](const Json& json) {
    TrialRecord r;
    r.participant = json.at("participant");
    r.task = json.at("task");
    r.run = json.at("run");
    r.practice = json.at("phase") == "practice";
    r.stimulus = json.at("stimulus");
    r.guided = json.at("condition") == condition_name(true);
    r.simulated = json.at("simulated");
    r.device = json.at("device");
    r.outcome.seconds = json.at("completion_time");
    r.outcome.error = json.at("position_error");
    r.outcome.reached = json.at("reached");
    r.outcome.timed_out = json.at("end") == kTimeEvent;
    r.outcome.begin = json.at("first_step");
    r.outcome.end = json.at("end_step");
    const bool known = r.stimulus >= 0 && r.stimulus < plan_.design.practice + plan_.design.recorded;
    if (!known || r.participant != code || r.task != task || r.run != run)
      throw input_error({file.string(), "", "it is of another trial", "", "restore it from a copy"});
    return r;
  });
}

Recording StudyFolder::recording(const std::string& code, const std::string& task, int run) const {
  const std::string file = stem(code, task, run).string() + "recording.txt.gz";
  return read_packed_recording(file);
}

std::vector<TrialRecord> StudyFolder::trials() const {
  std::vector<TrialRecord> out;
  std::map<int, std::string> codes;
  for (const StudyParticipant& p : participants()) codes[p.number] = p.code;
  for (const PlannedTrial& t : design_) {
    const auto code = codes.find(t.participant);
    if (code == codes.end()) continue;
    const std::string& task = plan_.tasks[as_size(t.task)];
    if (has(code->second, task, t.trial + 1)) out.push_back(read(code->second, task, t.trial + 1));
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
