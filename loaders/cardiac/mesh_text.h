/// What the readers of meshes in text share.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/math/vec.h"
#include "loaders/cardiac/text_lines.h"

namespace palpate {

/// @name Cell types of the VTK file format
/// @{
inline constexpr std::uint8_t kVtkLine = 3;
inline constexpr std::uint8_t kVtkTriangle = 5;
inline constexpr std::uint8_t kVtkQuad = 9;
inline constexpr std::uint8_t kVtkTetrahedron = 10;
inline constexpr std::uint8_t kVtkHexahedron = 12;
inline constexpr std::uint8_t kVtkWedge = 13;
inline constexpr std::uint8_t kVtkPyramid = 14;
inline constexpr std::uint8_t kVtkQuadraticTetrahedron = 24;
/// @}

/// A count at the start of a text file, believed as far as the file could hold that many.
/// @param least_bytes that each of the counted things takes at least, packed as it may be.
/// @throws Error (bad input) where it is no whole number, below zero or more than the file can hold.
[[nodiscard]] std::size_t believed_count(TextLines& lines, const char* what, std::size_t least_bytes);

/// Fibre directions of elements; one that is zero or missing (zeros or "nan") is NaN.
struct Directions {
  std::vector<double> fibre, sheet, normal;  ///< the latter two empty where a row has three numbers only
  std::vector<double> lengths;               ///< of the fibres as they stand
  std::size_t missing = 0;                   ///< rows whose fibre is zero, next to it, or NaN
  std::vector<double> further;  ///< the numbers of all places of a row but the first, as they stand
};
/// Adds those of an element: its fibre, or fibre and sheet, or all three.
void append_directions(std::span<const Vec3> vectors, Directions& directions);

/// What a row of directions holds.
struct DirectionRows {
  int numbers = 9;        ///< 3, 6 or 9 of them; with 6 the normal is the cross product of both
  int places = 1;         ///< of an element, each with as many numbers; the first one is the row's direction
  bool numbered = false;  ///< the element's number stands first: 0 or 1, then the next one
};
/// Reads `count` rows.
/// @throws Error (bad input) naming the line where a row has other numbers or the file ends.
[[nodiscard]] Directions read_directions(TextLines& lines, std::size_t count, const DirectionRows& rows);

/// Takes fibres that are a million times shorter than the others for what they stand for, none, and says how many have
/// none.
void leave_out_missing(Directions& directions, std::vector<std::string>& notes);
/// Adds them as cell arrays "fibre", "sheet", "normal", normalised.
void add_directions(const Directions& directions, DataSet& mesh);

/// A file with the same stem and another ending beside `file`, packed or not (".pts", ".pts.gz"); empty where
/// there is none.
[[nodiscard]] std::string sibling(const std::string& file, const std::string& ending);

/// `file` without its ending, and without ".gz" before that.
[[nodiscard]] std::string stem_of(const std::string& file);
/// The ending of `file`, lower case with its dot; that before ".gz" where it is packed.
[[nodiscard]] std::string ending_of(const std::string& file);

}  // namespace palpate
