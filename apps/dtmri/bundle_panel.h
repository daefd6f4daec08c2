/// The part of the panel for bundles of tracts: list, edits, picks, profile and files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "common/window/panels/panel.h"

namespace palpate {

/// A tract that was picked.
struct PickedTract {
  std::size_t bundle = 0;  ///< of the list
  std::size_t line = 0;    ///< of the bundle, from 0
  Vec3 place{0.0};         ///< on it
  std::string text;        ///< of the bundle, when it was picked: of another one it is none

  bool operator==(const PickedTract&) const = default;
};

/// What the part remembers between frames.
struct BundlePanel {
  std::size_t chosen = 0;                     ///< which bundle edits are of
  std::optional<std::size_t> named;           ///< whose name is being typed
  std::string name;                           ///< so far
  std::optional<double> smooth, resample;     ///< [mm]; none: by the voxels
  std::optional<double> shortest, longest;    ///< [mm]; none: of the bundle
  int axis = 2;                               ///< that the plane of the crosshair lies across
  std::size_t with = 0;                       ///< which bundle another is joined with
  std::string file = "bundle.trx";            ///< edited
  std::optional<PickedTract> picked, before;  ///< and the one that was picked before it
};

/// Every edit changes the document's text of a bundle: it is undone, saved and made anew like all of the document.
/// @pre on.view.tensors.
void draw_bundles(BundlePanel& panel, PanelContext& on);

}  // namespace palpate
