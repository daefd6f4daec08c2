/// Bundles of tracts as options and sessions have them: fields between '|', each a name, '=' and its value. Steps are
/// done in their order: each source adds tracts, each edit changes those that are there.
///
///   name=TEXT  color=direction|#rrggbb|IMAGE  shown=on|off      IMAGE: a name that slices show, such as fa
///   file=FILE               tracts of a file
///   line=x,y,z,x,y,z,…      one tract, point by point
///   seeds=… cutoff=… trace= options of `trace`, ended by trace=, which traces with them
///   delete=N,N              tracts, counted from 1
///   cut=N,x,y,z             tract N in two, where it is nearest to x, y, z; the second part is the last tract
///   part=nx,ny,nz,d         all tracts where they cross the plane n . x = d
///   join=N,M                tract M goes on from tract N, whichever ends are nearest
///   smooth=MM resample=MM length=LEAST,MOST   tract_edit.h
///   keep=REGION drop=REGION crop=REGION       region_text.h
///   also= … all=            what stands between adds tracts, and edits those alone
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/render/color/color_map.h"
#include "common/scene/document/document.h"

namespace palpate {

struct BundleStep {
  std::string key, value;

  bool operator==(const BundleStep&) const = default;
};

struct BundleText {
  std::string name;
  std::string color = "direction";
  bool shown = true;
  std::vector<BundleStep> steps;
};

/// @throws Error (usage) that names the field which is none.
[[nodiscard]] BundleText parse_bundle(std::string_view text);
/// The inverse. @throws Error (usage) for a value with '|' or ';' in it, which stand between fields and bundles.
[[nodiscard]] std::string bundle_text(const BundleText& bundle);
/// Steps alone, as in a bundle's text.
[[nodiscard]] std::string steps_text(std::span<const BundleStep> steps);

/// The steps that trace as `options` say.
[[nodiscard]] std::vector<BundleStep> steps_of(const TractTracingOptions& options);
/// The inverse, of the steps before a trace=. @pre they are of parse_bundle().
[[nodiscard]] TractTracingOptions tracing_of(std::span<const BundleStep> steps);
/// Whether the step is an option of tracing.
[[nodiscard]] bool is_tracing(const BundleStep& step);

/// Whether a bundle of these texts takes its tracts from `file`.
[[nodiscard]] bool takes_file(const std::vector<std::string>& texts, const std::filesystem::path& file);

/// Of "#rrggbb"; none of another word.
[[nodiscard]] std::optional<Rgb> color_of_text(std::string_view text);
[[nodiscard]] std::string text_of_color(const Rgb& color);

/// The colour that bundle number `i` begins with, from 0.
[[nodiscard]] std::string first_color(std::size_t i);

/// `b` behind `a`: with its tracts and edits, which do not touch those of `a`.
[[nodiscard]] BundleText merged(const BundleText& a, const BundleText& b);

}  // namespace palpate
