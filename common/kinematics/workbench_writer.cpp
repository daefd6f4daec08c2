#include "common/kinematics/workbench_writer.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/kinematics/workbench_section.h"

namespace palpate {
namespace {

/// A section's name in its parts: "tuned.falcon" is the table `falcon` of `tuned`; none of both has a dot
/// before that.
struct SectionName {
  explicit SectionName(const std::string& name)
      : outer(name.substr(0, name.find('.'))),
        inner(outer.size() < name.size() ? name.substr(outer.size() + 1) : "") {}

  /// Null where there is none. Throws nothing: an outer part that is no table holds none.
  [[nodiscard]] const toml::node* in(const toml::table& root) const {
    const toml::node* node = root.get(outer);
    if (inner.empty() || !node) return node;
    const toml::table* table = node->as_table();
    return table ? table->get(inner) : nullptr;
  }
  void erase_from(toml::table& root) const {
    if (inner.empty()) {
      root.erase(outer);
    } else if (toml::table* table = root[outer].as_table()) {
      table->erase(inner);
      if (table->empty()) root.erase(outer);
    }
  }

  std::string outer, inner;
};

std::string row_text(std::initializer_list<double> values) {
  std::string out;
  for (const double value : values) out += (out.empty() ? "[" : ", ") + exact_number(value);
  return out + "]";
}
std::string row_text(const Vec3& x) { return row_text({x.x, x.y, x.z}); }

std::string list_text(const char* key, const std::vector<std::string>& rows) {
  std::string out = std::string(key) + " = [\n";
  for (const std::string& row : rows) out += "  " + row + ",\n";
  return out + "]\n";
}

std::string vectors_text(const char* key, const std::vector<Vec3>& all) {
  std::vector<std::string> rows;
  for (const Vec3& x : all) rows.push_back(row_text(x));
  return list_text(key, rows);
}

std::string motion_text(const Rigid& motion) {
  const Quat& q = motion.rotation;
  return "rotation = " + row_text({q.w, q.x, q.y, q.z}) + "\ntranslation = " + row_text(motion.translation) +
         "\n";
}

/// First lines of all tables that stand outside `skip`, from 1.
void collect_headers(const toml::table& table, const toml::node* skip, std::vector<std::size_t>& lines) {
  for (const auto& [key, node] : table) {
    if (&node == skip) continue;
    if (const toml::table* inner = node.as_table(); inner && !inner->is_inline()) {
      lines.push_back(inner->source().begin.line);
      collect_headers(*inner, skip, lines);
    } else if (const toml::array* array = node.as_array(); array && array->is_array_of_tables()) {
      for (const toml::node& element : *array) {
        lines.push_back(element.source().begin.line);
        collect_headers(*element.as_table(), skip, lines);
      }
    }
  }
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    const std::size_t next = end == std::string::npos ? text.size() : end + 1;
    out.push_back(text.substr(begin, next - begin));
    begin = next;
  }
  return out;
}

bool is_remark_or_blank(const std::string& line) {
  const std::string_view text = trimmed(line);
  return text.empty() || text.front() == '#';
}

}  // namespace

std::string section_text(const TrackerCorrection& tracker) {
  PALPATE_CHECK(tracker.spline.centers.empty());
  std::string out = "[tracker]\n";
  if (tracker.position.degree >= 0) {
    out += "degree = " + std::to_string(tracker.position.degree) +
           "\ncenter = " + row_text(tracker.position.center) +
           "\nscale = " + exact_number(tracker.position.scale) + "\n" +
           vectors_text("position", tracker.position.coefficients) +
           vectors_text("orientation", tracker.orientation.coefficients);
  }
  if (!tracker.table.values.empty()) {
    const ErrorTable& table = tracker.table;
    std::vector<Vec3> position, orientation;
    for (const PoseError& e : table.values) {
      position.push_back(e.position);
      orientation.push_back(e.orientation);
    }
    out += "table_count = " + row_text(Vec3(table.count)) + "\ntable_lower = " + row_text(table.lower) +
           "\ntable_spacing = " + row_text(table.spacing) + "\n" + vectors_text("table_position", position) +
           vectors_text("table_orientation", orientation);
  }
  return out;
}

std::string section_text(const ApparatusGeometry& apparatus) {
  return "[apparatus]\n" + motion_text(apparatus.optical_from_tracker) +
         vectors_text("markers", apparatus.markers);
}

std::string section_text(const DhhChain& arm) {
  std::vector<std::string> rows, free;
  for (const DhhRow& row : arm.rows) {
    const auto& [d, a, alpha, beta, gamma] = row.values;
    rows.push_back(row_text({d, a, alpha, beta, gamma, static_cast<double>(row.joint + 1)}));
    std::string words;
    for (int q = 0; q < kDhhQuantities; ++q) {
      if (!row.free[as_size(q)]) continue;
      const std::string name = dhh_name(0, static_cast<DhhQuantity>(q));
      words += (words.empty() ? "" : " ") + name.substr(0, name.size() - 1);
    }
    free.push_back("\"" + words + "\"");
  }
  return "[arm]\n" + list_text("rows", rows) + list_text("free", free);
}

std::string section_text(const CoregistrationGeometry& coregistration) {
  return "[coregistration]\n" + motion_text(coregistration.tracker_from_arm) +
         "sensor = " + row_text(coregistration.sensor) + "\n";
}

std::string stylus_section_text(const Vec3& tip) { return "[stylus]\ntip = " + row_text(tip) + "\n"; }

std::string section_text(const EyesGeometry& eyes) {
  return std::string("[eyes]\n") + (eyes.left ? "left = " + row_text(*eyes.left) + "\n" : "") +
         (eyes.right ? "right = " + row_text(*eyes.right) + "\n" : "");
}

bool has_section(const std::filesystem::path& path, const std::string& name) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) &&
         SectionName(name).in(parsed_workbench(workbench_text(path), path)) != nullptr;
}

void write_section(const std::filesystem::path& path, const std::string& name, const std::string& text,
                   bool replace) {
  std::error_code ignored;
  const bool exists = std::filesystem::exists(path, ignored);
  const std::string before = exists ? workbench_text(path) : "";
  const toml::table old = parsed_workbench(before, path);
  const SectionName section(name);
  std::string after;
  if (const toml::node* node = section.in(old)) {
    if (!replace)
      throw usage_error(path.string() + " has a section [" + name + "] already; use --force to replace it");
    const toml::table* table = node->as_table();
    if (!table || table->is_inline())
      throw usage_error(path.string() + ": " + line_of(*node) + ": '" + name +
                        "' is not written as a section; remove it by hand");
    std::vector<std::size_t> headers;
    collect_headers(old, node, headers);
    const std::vector<std::string> lines = lines_of(before);
    const std::size_t first = table->source().begin.line - 1;
    std::size_t last = lines.size();
    for (const std::size_t header : headers) {
      if (header > first + 1) last = std::min(last, header - 1);
    }
    // Remarks above the next section are its own.
    while (last > first + 1 && is_remark_or_blank(lines[last - 1])) --last;
    for (std::size_t i = 0; i < first; ++i) after += lines[i];
    after += text;
    for (std::size_t i = last; i < lines.size(); ++i) after += lines[i];
  } else {
    after = before;
    if (!after.empty() && after.back() != '\n') after += '\n';
    after += (after.empty() ? "" : "\n") + text;
  }
  // Whatever a file may look like: nothing of it is lost, or nothing is written.
  toml::table rest = parsed_workbench(after, path), was = old;
  toml::table given = parsed_workbench(text, path);
  const toml::node *put = section.in(rest), *asked = section.in(given);
  const toml::table* there = put ? put->as_table() : nullptr;
  const toml::table* wanted = asked ? asked->as_table() : nullptr;
  const bool as_given = there && wanted && *there == *wanted;
  section.erase_from(rest);
  section.erase_from(was);
  if (rest != was || !as_given)
    throw usage_error(path.string() + ": [" + name + "] cannot be replaced alone; remove it by hand");
  OutputFile file(path, true);
  file.write(after);
  file.finish();
}

}  // namespace palpate
