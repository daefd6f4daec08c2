/// Followed lines and drawn tracts that the user has kept: a list, with the force that was felt along each.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/line.h"
#include "common/hand/drawn/drawn_tract.h"
#include "common/render/probe_view.h"

namespace palpate {

/// What the hand felt at a place of a line, data units.
struct HapticForce {
  Vec3 position{0.0};
  double force = 0.0;  ///< [N]
};

/// The force felt last at each point of `line`; NaN at points that the hand did not pass. The places lie on
/// the line, in the order of time.
[[nodiscard]] std::vector<double> forces_along(const Line& line, std::span<const HapticForce> haptic);

class DrawnLines {
 public:
  struct Entry {
    int number = 1;  ///< counts all that were ever kept
    std::shared_ptr<const Line> line;
    std::vector<double> forces;            ///< [N], one a point; NaN where none was felt
    std::vector<TensorMeasures> measures;  ///< one a point of a tract; none of a streamline
    std::optional<TractogramImage> image;  ///< as DrawnTract::image
    double largest_force = 0.0;
  };

  using Entries = std::vector<Entry>;

  void keep(Line line, std::vector<double> forces) { keep({{std::move(line), std::move(forces), {}, {}}}); }
  void keep(std::vector<DrawnTract> lines);
  /// Whether the last one has been kept with these points and forces.
  [[nodiscard]] bool ends_with(const Line& line, const std::vector<double>& forces) const;
  /// Takes out the one at `index`. @pre index < entries().size().
  void remove(std::size_t index);
  /// Keeps these in place of all others; numbers go on after the largest that was ever given.
  /// @param entries not null.
  void put(std::shared_ptr<const Entries> entries);
  /// Forgets numbers, too.
  void clear();

  [[nodiscard]] const Entries& entries() const noexcept { return *entries_; }
  /// Never null; another object whenever the list has changed.
  [[nodiscard]] const std::shared_ptr<const Entries>& all() const noexcept { return entries_; }
  /// For the picture; another object whenever the list has changed.
  [[nodiscard]] const std::shared_ptr<const std::vector<DrawnLine>>& drawn() const noexcept { return drawn_; }

  /// Writes all lines as write_drawn().
  /// @throws Error.
  void save(const std::filesystem::path& path, bool overwrite) const;

 private:
  std::shared_ptr<const Entries> entries_ = std::make_shared<const Entries>();
  std::shared_ptr<const std::vector<DrawnLine>> drawn_;
  int next_number_ = 1;
};

/// Reads what DrawnLines::save() has written as .csv, with its numbers, forces and measures; such a table of
/// another origin needs the columns line, seed, x, y and z.
/// @throws Error (bad input) that names the file and the line.
[[nodiscard]] std::shared_ptr<const DrawnLines::Entries> read_drawn_lines(const std::filesystem::path& path);

}  // namespace palpate
