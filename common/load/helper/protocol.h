/// Messages between an explorer and a helper program, as JSON. The frames they travel in: channel.h.
///
/// Requests
///   {"request": "open", "format": F, "files": [path…], "solution": path?, "raw": R?, "diffusion": D?,
///   "refine": n?, "series": text?, "allow_gaps": bool?, "left_handed": bool?, "wall": bool?,
///   "surface_markers": text?}
///   {"request": "read", "arrays": [name…], "step": n}
/// Answers
///   {"failed": exit code, "line": text}
///   {"format", "loader", "times": [t…], "notes": [text…], "units": text, "anatomical": bool, "diffusion": G,
///   "exact_volume": v, "long_axis": [x, y, z] or null, "window": [a, b] or null,
///   "blocks": [{"name", "grid", "points": [i, j, k],
///    "point_count", "cell_count", "lower": [x, y, z], "upper", "arrays": [A…], "not_volume": text, "faces": bool}…]}
///                                                                                          to "open"
///   {"blocks": [{"name", "topology": T, "arrays": [A with "offset"…], "visible": offset?,
///   "hidden_cells": offset?}…]}  to "read"
///   A = {"name", "on": "point" or "cell", "components", "type": "float32"…, "tuples", "sparse_bytes"},
///     with its numbers as a NanoVDB grid (sparse_numbers.h) also "tree_bytes", "points", "shift": [i, j, k]
///   T = {"kind": "uniform", "points", "origin", "axes": 9 numbers, column by column}
///     | {"kind": "rectilinear", "counts": [n, n, n], "x": offset, "y": offset, "z": offset}    float64
///     | {"kind": "curvilinear", "points", "positions": A}
///     | {"kind": "unstructured", "positions": A, "cells", "types": offset, "offsets": offset,
///        "connectivity": offset, "connectivity_count"}                                uint8, int64, int64
///   R = {"size": [i, j, k], "type", "big_endian": bool, "spacing", "origin", "skip": bytes}
///   D = {"bval": path, "bvec": path}                                              empty: beside the file
///   G = {"layout": n, "gradient_frame": n, "frame": n?, "gradients": [[b, x, y, z]…]?}
/// Offsets count bytes in the memory file of the answer. Names and paths are bytes, not text: each byte
/// travels as the character of that number, so any of them comes back as it went.
///
/// The explorer believes nothing of what it is told: message_json.h, block_json.h.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/base/error.h"
#include "common/load/format.h"
#include "common/load/helper/memory_file.h"
#include "common/load/load.h"

namespace palpate {

class ProtocolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct OpenMessage {
  Format format = Format::kLegacyVtk;
  LoadRequest request;
};
struct ReadMessage {
  std::vector<std::string> arrays;
  std::size_t time_step = 0;
};
using RequestMessage = std::variant<OpenMessage, ReadMessage>;

[[nodiscard]] std::string encode(const RequestMessage& request);
/// @throws ProtocolError.
[[nodiscard]] RequestMessage decode_request(std::string_view json);

[[nodiscard]] std::string encode_failure(ExitCode code, const std::string& line);
[[nodiscard]] std::string encode_info(const FileInfo& info);
/// Appends all arrays to `memory` and returns the JSON that describes them.
[[nodiscard]] std::string encode_blocks(const std::vector<DataSet>& blocks, MemoryFile& memory);

/// @throws ProtocolError; Error where the answer is a failure.
[[nodiscard]] FileInfo decode_info(std::string_view json);
/// The blocks share `memory`, which `owner` keeps alive. @throws ProtocolError; Error where the answer is
/// a failure.
[[nodiscard]] std::vector<DataSet> decode_blocks(std::string_view json, std::span<const std::byte> memory,
                                                 const std::shared_ptr<const void>& owner);

}  // namespace palpate
