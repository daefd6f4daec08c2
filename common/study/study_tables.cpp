#include "common/study/study_tables.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/study/participant_model.h"

namespace palpate {

std::string pretty(const Json& json) { return json_text(json) + "\n"; }

bool is_plain(const std::string& word) {
  return !word.empty() && word.size() <= 32 &&
         std::ranges::all_of(word, [](unsigned char c) { return std::isalnum(c) != 0; });
}

std::string task_dictionary(const StudyTaskInfo& info) {
  return pretty(
      {{"TaskName", info.title},
       {"flat", info.flat},
       {"pair", info.pair},
       {"TaskDescription", info.instruction},
       {"participant", {{"Description", "anonymous code"}}},
       {"run",
        {{"Description",
          "trial of the task, from 1, those for practice first; of a repeat, more by the number of trials of the "
          "task"}}},
       {"attempt", {{"Description", "1, or more for a repeat of a trial that had flaws"}}},
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
       {"lost_steps", {{"Description", "steps that the recording lacks; the trial is left out"}}},
       {"fault_steps", {{"Description", "steps with a fault of device or servo; the trial is left out"}}},
       {"cut_steps",
        {{"Description",
          "steps without force, as the hand was off or out of reach, or the servo stood still; the trial is left "
          "out"}}},
       {"off_steps", {{"Description", "steps with the force switched off; the trial is left out"}}},
       {"most_stiffness",
        {{"Description", "of which the device was found capable; null: not bounded"}, {"Units", "N/m"}}},
       {"end", {{"Levels", {{"space", "the participant ended it"}, {"timeout", "it ended by itself"}}}}},
       {"simulated", {{"Description", "true where the participant is a program"}}},
       {"cutoff_time",
        {{"Description", "slower trials are left out"}, {"Value", info.cutoff_time}, {"Units", "s"}}},
       {"cutoff_error",
        {{"Description", "trials with a larger error are left out"},
         {"Value", info.cutoff_error},
         {"Units", "mm"}}},
       {"first_step", {{"Description", "step of the recording with which the trial begins"}}},
       {"end_step", {{"Description", "the one after its last"}}},
       {"device", {{"Description", "what moved the cursor"}}}});
}

std::string stimulus_dictionary(const StudyTask& task) {
  std::vector<DataColumn> columns{{"stimulus", "number of the stimulus, from 0"}};
  std::ranges::move(task.stimulus_columns(), std::back_inserter(columns));
  return data_dictionary(columns);
}

std::string stimulus_table(const StudyTask& task, const DesignRequest& design) {
  std::vector<DataColumn> columns{{"stimulus", {}}};
  std::ranges::move(task.stimulus_columns(), std::back_inserter(columns));
  std::string table = table_header(columns, '\t');
  for (int s = 0; s < design.practice + design.recorded; ++s) {
    table += std::to_string(s);
    for (const double value : task.stimulus_row(s)) table += "\t" + exact_number(value);
    table += "\n";
  }
  return table;
}

namespace {

const std::vector<DataColumn>& motion_columns() {
  static const std::vector<DataColumn> kColumns{{"time", "since the trial began", "s"},
                                                {"x", "cursor", "m"},
                                                {"y", "cursor", "m"},
                                                {"z", "cursor", "m"},
                                                {"px", "proxy: what holds the cursor", "m"},
                                                {"py", "proxy", "m"},
                                                {"pz", "proxy", "m"},
                                                {"fx", "force on the hand", "N"},
                                                {"fy", "force on the hand", "N"},
                                                {"fz", "force on the hand", "N"},
                                                {"state", "of the constraint: free, held, released, fault"}};
  return kColumns;
}

constexpr std::size_t kEvery = 10;  // steps from one row to the next

}  // namespace

std::string motion_dictionary() {
  Json json = parse_json(data_dictionary(motion_columns()));
  Json columns = Json::array();
  for (const DataColumn& column : motion_columns()) columns.push_back(column.name);
  json["SamplingFrequency"] = 100;
  json["Columns"] = columns;
  return pretty(json);
}

std::string motion_table(const std::vector<HandStep>& steps) {
  std::string text = table_header(motion_columns(), '\t');
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

std::string design_table(const std::vector<PlannedTrial>& design, const std::vector<std::string>& tasks) {
  std::string table = table_header(design_columns(), '\t');
  std::map<int, int> order;  // by participant
  for (const PlannedTrial& t : design) {
    table += std::to_string(t.participant) + "\t" + std::to_string(++order[t.participant]) + "\t" +
             tasks[as_size(t.task)] + "\t" + std::to_string(t.trial + 1) + "\t" +
             (t.practice ? "practice" : "recorded") + "\t" + std::to_string(t.stimulus) + "\t" +
             std::string(condition_name(t.guided)) + "\n";
  }
  return table;
}

const std::vector<DataColumn>& design_columns() {
  static const std::vector<DataColumn> kColumns{
      {"number", "of the participant, from 0: see participants.tsv"},
      {"order", "of the trial in the participant's session, from 1, repeats apart"},
      {"task", "name of the task: see task-NAME_beh.json"},
      {"run", "of the trial in its task, from 1"},
      {"phase", "practice, which is not analysed, or recorded"},
      {"stimulus", "row of the table in stimuli/, from 0"},
      {"condition", "ISO or ANISO: see the dictionaries of the tasks"}};
  return kColumns;
}

std::vector<DataColumn> participant_columns() {
  std::vector<DataColumn> columns{{"participant_id", "sub- and an anonymous code"},
                                  {"number", "of the participant in design.tsv, from 0"},
                                  {"simulated", "true where the participant is a program"}};
  std::ranges::copy(trait_columns(), std::back_inserter(columns));
  return columns;
}

std::string participants_table(const std::vector<StudyParticipant>& people) {
  std::string table = table_header(participant_columns(), '\t');
  for (const StudyParticipant& p : people) {
    table += "sub-" + p.code + "\t" + std::to_string(p.number) + "\t" + (p.simulated ? "true" : "false");
    for (std::size_t i = 0; i < trait_columns().size(); ++i)
      table += "\t" + (p.traits.empty() ? "n/a" : exact_number(p.traits[i]));
    table += "\n";
  }
  return table;
}

std::vector<StudyParticipant> participants_of(const std::string& file, const std::string& table, int most) {
  const auto refuse = [&](std::size_t line, const std::string& found) {
    throw input_error(
        {file, "line " + std::to_string(line), "'" + printable(found) + "'",
         "a line of " + std::to_string(participant_columns().size()) + " columns as participants.json says",
         "restore it from a copy"});
  };
  const std::vector<std::string_view> lines = split(table, '\n');
  if (std::string(lines.front()) + "\n" != table_header(participant_columns(), '\t'))
    refuse(1, std::string(lines.front()));
  std::vector<StudyParticipant> out;
  constexpr std::size_t kOwn = 3;  // columns that are no traits
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].empty()) continue;
    const std::vector<std::string_view> cells = split(lines[i], '\t');
    const std::string line(lines[i]);
    if (cells.size() != participant_columns().size() || !cells[0].starts_with("sub-")) refuse(i + 1, line);
    StudyParticipant p{std::string(cells[0].substr(4)), 0, cells[2] == "true", {}};
    const auto number_in_design = parsed<int>(cells[1]);
    if (!is_plain(p.code) || !number_in_design || *number_in_design < 0 || *number_in_design >= most ||
        (!p.simulated && cells[2] != "false"))
      refuse(i + 1, line);
    p.number = *number_in_design;
    for (std::size_t c = kOwn; c < cells.size() && cells[kOwn] != "n/a"; ++c) {
      const auto value = number(cells[c]);
      if (!value) refuse(i + 1, line);
      p.traits.push_back(value.value_or(0.0));
    }
    out.push_back(std::move(p));
  }
  return out;
}

}  // namespace palpate
