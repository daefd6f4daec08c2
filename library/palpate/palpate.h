/// The library's face: opens data, samples fields, traces lines with their errors.
///
/// Everything here is in standard types; what stands behind it stays within the library. Lengths, times and values
/// are the data's own (SI units where the file is in SI units). Objects are handles of immutable data: copying one is
/// cheap, and any number of threads may use it at once.
///
/// Functions throw `Error`, whose text is one line for the user: the file, the place, what was expected.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#define PALPATE_API __attribute__((visibility("default")))

namespace palpate::api {

using Point = std::array<double, 3>;

/// The version of the library: "0.2.0".
[[nodiscard]] PALPATE_API std::string version();

class PALPATE_API Error : public std::runtime_error {
 public:
  enum class Kind : std::uint8_t {
    kWorkFailed,   ///< the work failed; an output that cannot be written, too
    kUsage,        ///< an argument that makes no sense: an unknown field or method
    kBadInput,     ///< a missing or malformed file or array
    kInterrupted,  ///< the watcher asked for it
  };
  Error(Kind kind, const std::string& line) : std::runtime_error(line), kind_(kind) {}
  [[nodiscard]] Kind kind() const noexcept { return kind_; }

 private:
  Kind kind_;
};

/// Called some ten times a second by the thread that waits for a long job, with what it does ("tracing") and the part
/// done, negative where that is not known. False ends the job with Error::Kind::kInterrupted.
using Watcher = std::function<bool(const std::string& stage, double fraction)>;

/// Whether a sample is a value.
enum class Status : std::uint8_t {
  kOk,
  kOutside,  ///< the point lies in no cell
  kBadData,  ///< the sample rests on a value that is NaN, infinite or blanked
};

/// Numbers that someone else owns: `values` stays alive and unchanged as long as `owner` does.
struct SharedFloats {
  std::span<const float> values;
  std::shared_ptr<const void> owner;
};
struct SharedDoubles {
  std::span<const double> values;
  std::shared_ptr<const void> owner;
};

/// A scalar field: a number at each point of a grid, or a formula.
class PALPATE_API Scalar {
 public:
  /// Points at origin + (i, j, k) * spacing, trilinear between them. The numbers are not copied.
  /// @param values of the points, i fastest. @param spacing not zero.
  /// @throws Error (bad input) where there are more or fewer than points.
  [[nodiscard]] static Scalar uniform(const std::array<std::int64_t, 3>& points, const Point& origin,
                                      const Point& spacing, const SharedDoubles& values);
  [[nodiscard]] static Scalar uniform(const std::array<std::int64_t, 3>& points, const Point& origin,
                                      const Point& spacing, const SharedFloats& values);

  [[nodiscard]] const std::string& name() const noexcept;
  [[nodiscard]] Point lower() const noexcept;  ///< corner of the bounds
  [[nodiscard]] Point upper() const noexcept;
  [[nodiscard]] double lowest()
      const noexcept;  ///< of the finite values; above highest() where there are none
  [[nodiscard]] double highest() const noexcept;
  /// What was found and done while the field was made: sentences.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept;
  /// The interpolant at each of `x`; NaN where the status is not kOk. @pre all of one size.
  void sample(std::span<const Point> x, std::span<double> values, std::span<Status> status) const;
  /// Its gradient, likewise.
  void gradient(std::span<const Point> x, std::span<Point> gradients, std::span<Status> status) const;

 private:
  friend struct Access;
  std::shared_ptr<const struct ScalarData> data_;
};

/// A vector field.
class PALPATE_API Field {
 public:
  /// A built-in formula: "abc", "tornado", … @throws Error (usage) that names the known ones.
  [[nodiscard]] static Field example(const std::string& name);
  /// Points at origin + (i, j, k) * spacing, trilinear between them. The numbers are not copied.
  /// @param values of the points, three each, i fastest. @param spacing not zero.
  /// @throws Error (bad input) where there are more or fewer than 3 * points.
  [[nodiscard]] static Field uniform(const std::array<std::int64_t, 3>& points, const Point& origin,
                                     const Point& spacing, const SharedDoubles& values);
  [[nodiscard]] static Field uniform(const std::array<std::int64_t, 3>& points, const Point& origin,
                                     const Point& spacing, const SharedFloats& values);
  /// Tetrahedra, linear in each. @param points three numbers each. @param cells four points each, in any order.
  /// @throws Error (bad input) for a corner that is no point.
  [[nodiscard]] static Field tetrahedra(const SharedDoubles& points, std::span<const std::int64_t> cells,
                                        const SharedDoubles& values);

  [[nodiscard]] const std::string& name() const noexcept;
  [[nodiscard]] Point lower() const noexcept;
  [[nodiscard]] Point upper() const noexcept;
  [[nodiscard]] double diagonal() const noexcept;  ///< length of the diagonal of the bounds
  [[nodiscard]] double max_speed() const noexcept;
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept;
  /// The interpolant at each of `x`; NaN where the status is not kOk. @pre all of one size.
  void sample(std::span<const Point> x, std::span<Point> values, std::span<Status> status) const;
  /// dv_i/dx_j of the interpolant as [i][j], likewise.
  void jacobian(std::span<const Point> x, std::span<std::array<Point, 3>> jacobians,
                std::span<Status> status) const;
  /// Places to start lines from, in the grammar of `--seeds`: "random:100", "grid:8,8,8", "line:0,0,0,1,0,0,20",
  /// "seeds.csv". Random ones depend on `random_seed` and the field alone.
  [[nodiscard]] std::vector<Point> seeds(const std::string& text, std::uint64_t random_seed = 1) const;

 private:
  friend struct Access;
  std::shared_ptr<const struct FieldData> data_;
};

/// An array of the data, known before its values are read.
struct ArrayInfo {
  std::string name;
  std::string type;  ///< "float32"
  int components = 1;
  std::uint64_t tuples = 0;
  bool on_points = true;  ///< false: on cells
};

/// What is said of a file when it is opened.
struct OpenOptions {
  std::string solution;                   ///< PLOT3D: the file of the solution
  std::string cell_values = "recovered";  ///< cell values: brought to the points, or "constant" in each cell
};

/// An open data set. Its helper program lives as long as a copy of it. Its functions wait for one another.
class PALPATE_API Data {
 public:
  /// @param files one; or several that are blocks or a numbered series. @throws Error.
  [[nodiscard]] static Data open(const std::vector<std::string>& files, const OpenOptions& options = {},
                                 const Watcher& watch = {});

  [[nodiscard]] std::string format() const;
  [[nodiscard]] std::vector<ArrayInfo> arrays() const;
  [[nodiscard]] std::vector<double> times() const;  ///< none for a single state
  [[nodiscard]] std::vector<std::string> notes() const;
  [[nodiscard]] std::vector<std::string> vectors() const;  ///< names that vector() takes, the default first
  /// @param name empty: the likeliest velocity. @param time "first", "last", or a time: the nearest step.
  [[nodiscard]] Field vector(const std::string& name = {}, const std::string& time = "first", int threads = 0,
                             const Watcher& watch = {}) const;
  /// @param name of an array; of several components "velocity:0" or "velocity:magnitude", which the bare name means.
  [[nodiscard]] Scalar scalar(const std::string& name, const std::string& time = "first", int threads = 0,
                              const Watcher& watch = {}) const;

 private:
  friend struct Access;
  std::shared_ptr<struct OpenData> data_;
};

enum class Direction : std::uint8_t { kForward, kBackward, kBoth };

/// Defaults as of `flow trace`.
struct TraceOptions {
  std::string method = {};  ///< "exact", "dp54", …; empty: exact on tetrahedra, dp54 elsewhere
  Direction direction = Direction::kForward;
  double tolerance = 1e-6;  ///< position error per diagonal travelled, relative to the diagonal
  double step = 0.0;        ///< fixed-step methods: its length; others: between points; 0: by the cells
  double max_length = 0.0;  ///< 0: ten diagonals
  double max_time = 0.0;    ///< 0: no limit
  std::int64_t max_steps = 1'000'000;
  int threads = 0;  ///< 0: all cores; the lines do not depend on it
};

/// Traced lines. Line l has the points offsets()[l] to offsets()[l + 1] - 1.
class PALPATE_API Lines {
 public:
  [[nodiscard]] std::size_t count() const noexcept;
  [[nodiscard]] std::span<const std::int64_t> offsets() const noexcept;  ///< count() + 1
  /// @name By line
  /// @{
  [[nodiscard]] std::span<const std::uint32_t> seed() const noexcept;     ///< which of the seeds
  [[nodiscard]] std::span<const std::uint8_t> end() const noexcept;       ///< why it ends, of end_names()
  [[nodiscard]] std::span<const std::uint8_t> backward() const noexcept;  ///< 1 where traced against the flow
  /// @}
  /// @name By point
  /// @{
  [[nodiscard]] std::span<const Point> points() const noexcept;
  [[nodiscard]] std::span<const double> time() const noexcept;  ///< from the seed on
  [[nodiscard]] std::span<const double> arc() const noexcept;   ///< length from the seed on
  [[nodiscard]] std::span<const double> speed() const noexcept;
  [[nodiscard]] std::span<const double> error() const noexcept;  ///< estimated distance from the true curve
  /// @}
  [[nodiscard]] const std::vector<std::uint32_t>& outside_seeds() const noexcept;  ///< they give no line
  [[nodiscard]] const std::string& method() const noexcept;
  /// Writes .vtp, .tck, .trk or .csv, whole or not at all. @throws Error where the file exists, unless `overwrite`.
  void save(const std::string& path, bool overwrite = false) const;

 private:
  friend struct Access;
  std::shared_ptr<const struct LineData> data_;
};

/// "left_domain", "stagnation", …, by the number in Lines::end().
[[nodiscard]] PALPATE_API const std::vector<std::string>& end_names();

/// Lines from every seed, by seed, forward before backward. The same lines as `flow trace`.
[[nodiscard]] PALPATE_API Lines trace(const Field& field, std::span<const Point> seeds,
                                      const TraceOptions& options = {}, const Watcher& watch = {});

}  // namespace palpate::api
