/// Preintegrated transfer functions: colour and opacity of ray segments of any length.
///
/// Symbols. Along a segment of length d the value runs linearly from that of entry f (front, toward the
/// viewer) to that of entry b (back). tau(s) extinction and c(s) colour, both linear between entries; T(f, s)
/// share of light that gets from s to the front; k = |b - f| cells between the two, a = d / k.
///
///   T(f, b) = exp(-int_f^b a tau ds)
///   C(f, b) = int_f^b a tau c T(f, s) ds = c_f - c_b T(f, b) + int_f^b (dc/ds) T(f, s) ds        (1)
///
/// The table holds the associated colour C and the opacity 1 - T (Engel, Kraus and Ertl 2001; Ikits 2006,
/// sec. 5.4 and 5.5), with self-attenuation: (1) is exact, by parts from its definition, and dc/ds is
/// constant in a cell. With E_i = T(i, i + 1) and W_i the mean of T(i, s) over cell i, the last term of (1)
/// is
///
///   S(f, b) = sum_{i = f}^{b - 1} (c_{i+1} - c_i) W_i T(f, i)                                    (2)
///
/// Pairs (T, S) of neighbouring stretches join as (T1 T2, S1 + T1 S2). All segments of one k share a, so
/// their sums (2) are those of a window of k cells that slides along the entries: three joins a segment,
/// whatever k (van Herk 1992), where Ikits interpolates in the slice before and so adds up errors. W_i is
/// integrated by Simpson's rule in parts of optical depth below 1/4: its error is below 7e-5, most of it
/// where tau is steep.
///
/// A step of the transfer function between two entries is drawn as a ramp over its cell. A segment spends 1/k
/// of its length there, so that no component is off by more than 2 tau_max d / k.
///
/// While a point of a transfer function is dragged, entries change between its neighbours alone. Segments
/// that run beside these keep their numbers: only those that meet them are made anew.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/field/transfer/color_transfer.h"
#include "common/math/vec.h"

namespace palpate {

/// A transfer function at one of the equally spaced values of a table.
struct OpticalEntry {
  Vec3f color{0.0F};   ///< c, sRGB
  float depth = 0.0F;  ///< tau times the longest segment

  bool operator==(const OpticalEntry&) const = default;
};

/// `transfer` at `count` >= 2 values from `lower` to `upper`.
/// @param lengths longest segment in units of the transfer function's reference length.
[[nodiscard]] std::vector<OpticalEntry> optical_entries(const ColorTransfer& transfer, double lower,
                                                        double upper, std::size_t count, double lengths);

/// Lengths of a table come in groups of this many.
inline constexpr std::size_t kLengthGroup = 8;

/// The length of layer `l` of `lengths`, in units of the longest one.
[[nodiscard]] inline float segment_length(std::size_t l, std::size_t lengths) {
  return static_cast<float>(l) / static_cast<float>(lengths - 1);
}

/// A stretch of entries, both ends included.
struct EntryRange {
  std::size_t first = 0, last = 0;

  /// Whether the segment between two entries meets it.
  [[nodiscard]] bool meets(std::size_t front, std::size_t back) const noexcept {
    return (front < back ? front : back) <= last && (front < back ? back : front) >= first;
  }
  bool operator==(const EntryRange&) const = default;
};
/// From the first to the last entry that differs; nothing where none does. @pre both are as long.
[[nodiscard]] std::optional<EntryRange> changed_entries(std::span<const OpticalEntry> before,
                                                        std::span<const OpticalEntry> now) noexcept;
/// The part of all pairs of `count` entries that meets `range`.
[[nodiscard]] double share_of_segments(const EntryRange& range, std::size_t count) noexcept;

/// Fills the table of all pairs of entries and `lengths` equally spaced lengths, from zero to the longest.
/// @param rgba 4 * n * n * lengths numbers for n entries: red, green, blue, opacity as parts of 65535; the
/// front entry varies fastest, then the back one, then the length.
/// @pre lengths is a positive multiple of kLengthGroup; depths are finite and not negative.
/// The result does not depend on the number of threads (0: as many as there are cores).
void preintegrate(std::span<const OpticalEntry> entries, std::size_t lengths, int threads,
                  std::span<std::uint16_t> rgba);
/// The same of the segments that meet `changed` alone, to the bit; the numbers of others stay.
/// @pre changed.first <= changed.last < entries.size().
void preintegrate(std::span<const OpticalEntry> entries, std::size_t lengths, int threads,
                  std::span<std::uint16_t> rgba, const EntryRange& changed);

/// What a table shows that is not preintegrated, for reports of what that is worth: the matter of the front
/// entry all along each segment. Same layout and conditions.
void classify_fronts(std::span<const OpticalEntry> entries, std::size_t lengths,
                     std::span<std::uint16_t> rgba);

}  // namespace palpate
