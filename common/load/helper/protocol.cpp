#include "common/load/helper/protocol.h"

#include <utility>

#include "common/load/helper/block_json.h"
#include "common/load/helper/message_json.h"

namespace palpate {
namespace {

using namespace message;

/// Beyond it no element is sampled.
constexpr std::uint64_t kMostRefine = 1000;

Json box_corner(const Vec3& corner) { return is_finite(corner) ? vector_json(corner) : Json(nullptr); }

Json encode_raw(const RawLayout& raw) {
  return {{"size", counts_json(raw.size)},     {"type", name_of(raw.type)},
          {"big_endian", raw.big_endian},      {"spacing", vector_json(raw.spacing)},
          {"origin", vector_json(raw.origin)}, {"skip", raw.skip}};
}

RawLayout decode_raw(const Json& object) {
  RawLayout raw;
  raw.size = index_at(object, "size");
  raw.type = scalar_type_at(object);
  raw.big_endian = bool_at(object, "big_endian");
  raw.spacing = vector_at(object, "spacing");
  raw.origin = vector_at(object, "origin");
  raw.skip = count_at(object, "skip");
  return raw;
}

Json encode_diffusion(const DiffusionInfo& diffusion) {
  Json object{{"layout", static_cast<int>(diffusion.layout)},
              {"gradient_frame", static_cast<int>(diffusion.gradient_frame)}};
  if (diffusion.frame) object["frame"] = static_cast<int>(*diffusion.frame);
  if (!diffusion.gradients) return object;
  object["gradients"] = Json::array();
  for (std::size_t i = 0; i < diffusion.gradients->weightings.size(); ++i) {
    const Vec3& g = diffusion.gradients->directions[i];
    object["gradients"].push_back({diffusion.gradients->weightings[i], g.x, g.y, g.z});
  }
  return object;
}

DiffusionInfo decode_diffusion(const Json& object) {
  DiffusionInfo diffusion;
  const std::uint64_t layout = count_at(object, "layout");
  if (layout >= kTensorLayoutCount) malformed("unknown layout of tensors");
  diffusion.layout = static_cast<TensorLayout>(layout);
  const auto frame_at = [&object](const char* key) {
    const std::uint64_t frame = count_at(object, key);
    if (frame >= kVectorFrameCount) malformed("unknown axes of vectors");
    return static_cast<VectorFrame>(frame);
  };
  diffusion.gradient_frame = frame_at("gradient_frame");
  if (object.contains("frame")) diffusion.frame = frame_at("frame");
  if (!object.contains("gradients")) return diffusion;
  const Json& gradients = array_at(object, "gradients");
  if (gradients.size() > kMostGradients) malformed("too many gradients");
  GradientTable table;
  for (const Json& gradient : gradients) {
    if (!gradient.is_array() || gradient.size() != 4) malformed("a gradient has not four numbers");
    table.weightings.push_back(number_of(gradient[0], "gradients"));
    table.directions.emplace_back(number_of(gradient[1], "gradients"), number_of(gradient[2], "gradients"),
                                  number_of(gradient[3], "gradients"));
    if (table.weightings.back() < 0.0) malformed("a negative b-value");
    constexpr double kLongest = 1e9;  // its square is finite, times any weighting
    if (!(glm::length(table.directions.back()) < kLongest)) malformed("a gradient direction is too long");
  }
  diffusion.gradients = std::move(table);
  return diffusion;
}

}  // namespace

std::string encode(const RequestMessage& request) {
  Json message;
  if (const auto* open = std::get_if<OpenMessage>(&request)) {
    message["request"] = "open";
    message["format"] = static_cast<int>(open->format);
    message["files"] = Json::array();
    for (const auto& file : open->request.files) message["files"].push_back(text_from_bytes(file.native()));
    if (!open->request.series.empty()) message["series"] = text_from_bytes(open->request.series);
    if (open->request.allow_gaps) message["allow_gaps"] = true;
    if (open->request.left_handed) message["left_handed"] = true;
    if (open->request.wall) message["wall"] = true;
    if (!open->request.surface_markers.empty())
      message["surface_markers"] = text_from_bytes(open->request.surface_markers);
    if (open->request.solution) message["solution"] = text_from_bytes(open->request.solution->native());
    if (open->request.refine > 0) message["refine"] = open->request.refine;
    if (open->request.raw) message["raw"] = encode_raw(*open->request.raw);
    if (const auto& diffusion = open->request.diffusion) {
      message["diffusion"] = {{"bval", text_from_bytes(diffusion->bval.native())},
                              {"bvec", text_from_bytes(diffusion->bvec.native())}};
    }
  } else {
    const auto& read = std::get<ReadMessage>(request);
    message["request"] = "read";
    message["arrays"] = Json::array();
    for (const std::string& name : read.arrays) message["arrays"].push_back(text_from_bytes(name));
    message["step"] = read.time_step;
  }
  return message.dump();
}

RequestMessage decode_request(std::string_view text) {
  const Json message = parse(text);
  const std::string request = string_at(message, "request");
  if (request == "open") {
    OpenMessage open;
    const std::uint64_t format = count_at(message, "format");
    if (format >= format_rows().size()) malformed("unknown format");
    open.format = static_cast<Format>(format);
    for (std::string& file : strings_at(message, "files")) open.request.files.emplace_back(std::move(file));
    if (message.contains("series")) open.request.series = string_at(message, "series");
    if (message.contains("allow_gaps")) open.request.allow_gaps = bool_at(message, "allow_gaps");
    if (message.contains("left_handed")) open.request.left_handed = bool_at(message, "left_handed");
    if (message.contains("wall")) open.request.wall = bool_at(message, "wall");
    if (message.contains("surface_markers"))
      open.request.surface_markers = string_at(message, "surface_markers");
    if (message.contains("solution")) open.request.solution = string_at(message, "solution");
    if (message.contains("refine")) {
      const std::uint64_t refine = count_at(message, "refine");
      if (refine > kMostRefine) malformed("a sampling too fine");
      open.request.refine = static_cast<int>(refine);
    }
    if (message.contains("raw")) open.request.raw = decode_raw(member(message, "raw"));
    if (message.contains("diffusion")) {
      const Json& diffusion = member(message, "diffusion");
      open.request.diffusion = DiffusionRequest{string_at(diffusion, "bval"), string_at(diffusion, "bvec")};
    }
    return open;
  }
  if (request == "read") return ReadMessage{strings_at(message, "arrays"), count_at(message, "step")};
  malformed("unknown request '" + request + "'");
}

std::string encode_failure(ExitCode code, const std::string& line) {
  return Json{{"failed", static_cast<int>(code)}, {"line", text_from_bytes(line)}}.dump();
}

std::string encode_info(const FileInfo& info) {
  Json blocks = Json::array();
  for (const BlockInfo& block : info.blocks) {
    Json arrays = Json::array();
    for (const ArrayInfo& array : block.arrays) arrays.push_back(encode_array_info(array));
    blocks.push_back({{"name", text_from_bytes(block.name)},
                      {"grid", block.grid},
                      {"points", counts_json(block.points)},
                      {"point_count", block.point_count},
                      {"cell_count", block.cell_count},
                      {"lower", box_corner(block.bounds.lower)},
                      {"upper", box_corner(block.bounds.upper)},
                      {"arrays", std::move(arrays)},
                      {"not_volume", text_from_bytes(block.not_volume)},
                      {"faces", block.faces}});
  }
  Json notes = Json::array();
  for (const std::string& note : info.notes) notes.push_back(text_from_bytes(note));
  return Json{{"format", text_from_bytes(info.format)},
              {"loader", text_from_bytes(info.loader)},
              {"exact_volume", info.exact_volume},
              {"long_axis", info.long_axis ? vector_json(*info.long_axis) : Json(nullptr)},
              {"window", info.window ? Json::array({(*info.window)[0], (*info.window)[1]}) : Json(nullptr)},
              {"times", info.times},
              {"units", text_from_bytes(info.units)},
              {"anatomical", info.anatomical},
              {"diffusion", encode_diffusion(info.diffusion)},
              {"notes", std::move(notes)},
              {"blocks", std::move(blocks)}}
      .dump();
}

std::string encode_blocks(const std::vector<DataSet>& blocks, MemoryFile& memory) {
  Json list = Json::array();
  for (const DataSet& block : blocks) list.push_back(encode_block(block, memory));
  return Json{{"blocks", std::move(list)}}.dump();
}

FileInfo decode_info(std::string_view text) {
  const Json answer = parse(text);
  throw_failure(answer);
  FileInfo info;
  info.format = string_at(answer, "format");
  info.loader = string_at(answer, "loader");
  info.notes = strings_at(answer, "notes");
  info.units = string_at(answer, "units");
  info.anatomical = bool_at(answer, "anatomical");
  info.diffusion = decode_diffusion(member(answer, "diffusion"));
  info.exact_volume = number_of(member(answer, "exact_volume"), "exact_volume");
  if (!member(answer, "long_axis").is_null()) info.long_axis = vector_at(answer, "long_axis");
  if (!member(answer, "window").is_null()) {
    const Json& window = array_at(answer, "window");
    if (window.size() != 2) malformed("'window' has not two numbers");
    info.window = {number_of(window[0], "window"), number_of(window[1], "window")};
  }
  for (const Json& time : array_at(answer, "times")) info.times.push_back(number_of(time, "times"));
  for (const Json& object : array_at(answer, "blocks")) {
    BlockInfo block;
    block.name = string_at(object, "name");
    block.grid = string_at(object, "grid");
    block.points = index_at(object, "points");
    block.point_count = count_at(object, "point_count");
    block.cell_count = count_at(object, "cell_count");
    if (!member(object, "lower").is_null() && !member(object, "upper").is_null()) {
      block.bounds.lower = vector_at(object, "lower");
      block.bounds.upper = vector_at(object, "upper");
    }
    for (const Json& array : array_at(object, "arrays")) block.arrays.push_back(decode_array_info(array));
    block.not_volume = string_at(object, "not_volume");
    block.faces = bool_at(object, "faces");
    info.blocks.push_back(std::move(block));
  }
  return info;
}

std::vector<DataSet> decode_blocks(std::string_view text, std::span<const std::byte> bytes,
                                   const std::shared_ptr<const void>& owner) {
  const Json answer = parse(text);
  throw_failure(answer);
  std::vector<DataSet> blocks;
  for (const Json& object : array_at(answer, "blocks")) blocks.push_back(decode_block(object, bytes, owner));
  return blocks;
}

}  // namespace palpate
