#include <nlohmann/json.hpp>

#include "apps/workbench/workbench_verbs.h"
#include "common/base/clock.h"
#include "lab/page/html.h"
#include "lab/page/report.h"

namespace palpate {
namespace {

std::string column(const std::string& text) {
  constexpr std::size_t kWidth = 16;
  return std::string(text.size() < kWidth ? kWidth - text.size() : 1, ' ') + text;
}

}  // namespace

void run_screen(const WorkbenchOptions& options, const WorkbenchContext& context) {
  const Stopwatch watch;
  if (!options.out.empty()) check_report_folder(options.out, options.force);
  const HeadErrorSetup& setup = options.screen;
  const std::vector<HeadErrorRow> rows = head_error_rows(setup);
  std::string text = "Displacement of what is seen, in millimetres, by each error alone:\n";
  for (const char* heading : {"x", "z", "by position", "at most", "by turn, x", "by turn, z", "on screen"})
    text += column(heading);
  text += setup.pixel > 0.0 ? column("pixels") + "\n" : "\n";
  nlohmann::ordered_json points = nlohmann::ordered_json::array();
  for (const HeadErrorRow& row : rows) {
    for (const double value : {row.point.x, row.point.y, row.position, row.bound, row.orientation.x,
                               row.orientation.y, row.on_screen})
      text += column(three_digits(1e3 * value + 0.0));
    text += setup.pixel > 0.0 ? column(three_digits(row.on_screen / setup.pixel)) + "\n" : "\n";
    points.push_back({{"x_m", row.point.x},
                      {"z_m", row.point.y},
                      {"position_m", row.position},
                      {"position_bound_m", row.bound},
                      {"orientation_x_m", row.orientation.x},
                      {"orientation_z_m", row.orientation.y},
                      {"on_screen_m", row.on_screen}});
  }
  text +=
      "x runs along the screen from its middle, z from the screen towards the eyes. On the screen: both "
      "errors "
      "together.\n";
  if (!options.out.empty()) {
    write_sections(options, context, options.out, "workbench: screen", {head_error_section(setup)}, {},
                   watch.seconds());
    text += "-> " + (options.out / "index.html").string() + "\n";
  }
  context.console.print(text);
  nlohmann::ordered_json json{
      {"eye_distance_m", setup.eye_distance}, {"separation_m", setup.separation}, {"points", points}};
  if (!options.out.empty()) json["out"] = options.out.string();
  context.console.print_json(json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace palpate
