/// vtkStreamTracer on the same mesh: what a peer makes of the lines of a report.
///
/// The helper program palpate-vtk-tracer is built where VTK's FiltersFlowPaths is. It gets the mesh and the values of
/// frame L once, then a request for each setting; nothing of it is compiled into other programs.
///
/// Requests: {"request": "mesh", "points": offset, "point_count", "values": offset, "cells": offset, "cell_count"} for
/// tetrahedra, with "axes": [{"offset", "count"}, x3] and "uniform" in place of points and cells for boxes; {"request": "trace",
/// "fifth", "step", "backward", "length", "steps", "seeds": offset, "seed_count"}. Answers: {} and {"seconds", "lines",
/// "point_count", "first": offset of lines + 1, "seed": offset, "reason": offset, "points": offset, "vectors": offset}; whole
/// numbers have 64 bits, others are doubles.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/vector_field.h"
#include "common/geometry/line.h"

namespace palpate {

inline constexpr const char* kVtkTracerProgram = "palpate-vtk-tracer";

/// Of vtkStreamTracer, whose steps are lengths along the line.
struct VtkSetting {
  bool fifth = false;  ///< Runge-Kutta 4-5, which goes on by its fifth order; else Runge-Kutta 4
  double step = 0.0;   ///< data units
};

struct VtkLines {
  /// With points at multiples of the spacing. They state no error: it is NaN.
  std::vector<Line> lines;
  double seconds = 0.0;  ///< processor time of the filter; on tetrahedra its search tree is built within it
};

class VtkTracer {
 public:
  /// Why the field's lines cannot be traced by it; empty where they can.
  [[nodiscard]] static std::string hindrance(const VectorField& field);

  /// @pre hindrance() is empty. @throws Error (work failed) where the helper fails.
  VtkTracer(const VectorField& field, double spacing, Progress* progress);
  ~VtkTracer();
  VtkTracer(const VtkTracer&) = delete;
  VtkTracer& operator=(const VtkTracer&) = delete;

  /// @param seeds data coordinates.  @param length that lines may have, data units.
  /// @throws Error (work failed); Cancelled.
  [[nodiscard]] VtkLines trace(std::span<const Vec3> seeds, TraceDirection direction,
                               const VtkSetting& setting, double length, std::int64_t steps);

 private:
  struct Helper;
  const VectorField& field_;
  double spacing_;
  Progress* progress_;
  std::unique_ptr<Helper> helper_;
};

/// A curve through `points` with `tangents` (of any length), cubic between two of them, at the multiples of `spacing` along it and
/// at its end: arc lengths by Gauss' rule of three points. Speeds are the lengths of the tangents.
[[nodiscard]] std::vector<LinePoint> at_equal_arcs(std::span<const Vec3> points,
                                                   std::span<const Vec3> tangents, double spacing);

}  // namespace palpate
