#include "common/load/helper/protocol.h"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/json.h"

namespace palpate {
namespace {

TEST(Protocol, RequestsComeBackWithAnyBytesInTheirNames) {
  OpenMessage open;
  open.format = Format::kExodus;
  open.request.files = {"/a b/\xff\x80\xc3\n\"file\".ex2", "second"};
  open.request.solution = "q\xe4";
  const auto decoded = std::get<OpenMessage>(decode_request(encode(open)));
  EXPECT_EQ(decoded.format, Format::kExodus);
  EXPECT_EQ(decoded.request.files, open.request.files);
  EXPECT_EQ(decoded.request.solution, open.request.solution);
  EXPECT_FALSE(decoded.request.raw);
  const ReadMessage read{{"u", "\xfc"}, 7};
  const auto again = std::get<ReadMessage>(decode_request(encode(read)));
  EXPECT_EQ(again.arrays, read.arrays);
  EXPECT_EQ(again.time_step, 7U);
}

TEST(Protocol, TheLayoutOfVoxelsWithoutAHeaderComesBack) {
  OpenMessage open;
  open.format = Format::kRaw;
  open.request.files = {"a.raw"};
  open.request.raw = RawLayout{.size = Index3(3, 4, 5),
                               .type = ScalarType::kUint16,
                               .big_endian = true,
                               .spacing = {0.1, 0.2, 1e300},
                               .origin = {-1.0, 0.0, 1e-300},
                               .skip = 1024};
  const auto decoded = std::get<OpenMessage>(decode_request(encode(open)));
  ASSERT_TRUE(decoded.request.raw);
  EXPECT_EQ(decoded.request.raw->size, open.request.raw->size);
  EXPECT_EQ(decoded.request.raw->type, open.request.raw->type);
  EXPECT_EQ(decoded.request.raw->big_endian, open.request.raw->big_endian);
  EXPECT_EQ(decoded.request.raw->spacing, open.request.raw->spacing);
  EXPECT_EQ(decoded.request.raw->origin, open.request.raw->origin);
  EXPECT_EQ(decoded.request.raw->skip, open.request.raw->skip);
}

TEST(Protocol, FailuresComeBackAsErrors) {
  try {
    (void)decode_info(encode_failure(ExitCode::kBadInput, "a.vtk: broken"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_STREQ(error.what(), "a.vtk: broken");
  }
}

TEST(Protocol, InfoComesBackAsItWas) {
  FileInfo info;
  info.format = "f";
  info.loader = "l";
  info.times = {0.1, 1e300};
  info.notes = {"n\xe9"};
  info.units = "coordinates in \xb5m";
  info.anatomical = true;
  BlockInfo block;
  block.name = "b";
  block.grid = "curvilinear";
  block.points = Index3(3, 4, 5);
  block.point_count = 60;
  block.cell_count = 24;
  block.bounds.include({1, 2, 3});
  block.bounds.include({-1, 0.1, 1e-300});
  block.arrays.push_back({"v", Association::kCell, 3, ScalarType::kInt16, 24});
  block.not_volume = "is flat";
  block.faces = true;
  info.blocks = {block, {}};
  const FileInfo decoded = decode_info(encode_info(info));
  EXPECT_EQ(decoded.times, info.times);
  EXPECT_EQ(decoded.notes, info.notes);
  EXPECT_EQ(decoded.units, info.units);
  EXPECT_EQ(decoded.anatomical, info.anatomical);
  ASSERT_EQ(decoded.blocks.size(), 2U);
  EXPECT_EQ(decoded.blocks[0].bounds.lower, block.bounds.lower);
  EXPECT_EQ(decoded.blocks[0].bounds.upper, block.bounds.upper);
  EXPECT_TRUE(decoded.blocks[1].bounds.empty());
  EXPECT_EQ(decoded.blocks[0].not_volume, "is flat");
  EXPECT_EQ(decoded.blocks[1].not_volume, "");
  EXPECT_TRUE(decoded.blocks[0].faces);
  EXPECT_FALSE(decoded.blocks[1].faces);
  EXPECT_EQ(decoded.blocks[0].arrays[0].association, Association::kCell);
  EXPECT_EQ(decoded.blocks[0].arrays[0].type, ScalarType::kInt16);
}

/// One block of each kind.
std::vector<DataSet> blocks() {
  const std::vector<double> positions{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0, 1, 0, 1, 0, 1, 1, 1, 1, 1};
  DataSet uniform;
  uniform.name = "u";
  uniform.topology = UniformTopology{Index3(2, 2, 2), Vec3(1, 2, 3), Mat3(0.5)};
  const std::vector<float> values{0, 1, 2, 3, 4, 5, 6, 7};
  uniform.arrays.push_back(make_array("s", Association::kPoint, 1, std::span<const float>(values)));
  uniform.visible = {1, 1, 0, 1, 1, 1, 1, 1};
  DataSet rectilinear;
  rectilinear.topology = RectilinearTopology{{{{0, 1}, {0, 2}, {0, 1, 4}}}};
  DataSet curvilinear;
  curvilinear.topology = StructuredTopology{
      Index3(2, 2, 2), make_array("positions", Association::kPoint, 3, std::span<const double>(positions))};
  DataSet mesh;
  UnstructuredTopology cells;
  cells.positions = make_array("positions", Association::kPoint, 3, std::span<const double>(positions));
  cells.types = {10, 42};
  cells.connectivity = {0, 1, 2, 3, 4, 3, 0, 1, 2, 3, 0, 1, 3, 3, 1, 2, 3, 3, 0, 2, 3};
  cells.offsets = {0, 4, 21};
  mesh.topology = cells;
  return {uniform, rectilinear, curvilinear, mesh};
}

struct Encoded {
  std::string text;
  std::vector<std::byte> memory;
};

Encoded encoded() {
  MemoryFile file;
  Encoded result;
  result.text = encode_blocks(blocks(), file);
  file.seal();
  const UniqueFd copy(::dup(file.fd()));
  const auto mapped = MappedMemory::map(copy);
  result.memory.assign(mapped->bytes().begin(), mapped->bytes().end());
  return result;
}

std::vector<DataSet> decode(const Encoded& e) { return decode_blocks(e.text, e.memory, nullptr); }

TEST(Protocol, BlocksOfEveryKindComeBackAsTheyWere) {
  const Encoded e = encoded();
  const auto decoded = decode(e);
  const auto expected = blocks();
  ASSERT_EQ(decoded.size(), 4U);
  const auto& uniform = std::get<UniformTopology>(decoded[0].topology);
  EXPECT_EQ(uniform.axes, Mat3(0.5));
  EXPECT_EQ(uniform.origin, Vec3(1, 2, 3));
  EXPECT_EQ(decoded[0].visible, expected[0].visible);
  for (std::size_t p = 0; p < 8; ++p) EXPECT_EQ(decoded[0].arrays.at(0).at(p), static_cast<double>(p));
  EXPECT_EQ(std::get<RectilinearTopology>(decoded[1].topology).coordinates,
            std::get<RectilinearTopology>(expected[1].topology).coordinates);
  EXPECT_EQ(std::get<StructuredTopology>(decoded[2].topology).positions.at(7, 2), 1.0);
  const auto& mesh = std::get<UnstructuredTopology>(decoded[3].topology);
  const auto& original = std::get<UnstructuredTopology>(expected[3].topology);
  EXPECT_EQ(mesh.types, original.types);
  EXPECT_EQ(mesh.offsets, original.offsets);
  EXPECT_EQ(mesh.connectivity, original.connectivity);
}

TEST(Protocol, EveryLieInTheJsonIsRefused) {
  const Encoded good = encoded();
  const Json message = parse_json(good.text);
  const auto refused = [&](const char* what, const std::function<void(Json&)>& lie) {
    Encoded bad = good;
    Json changed = message;
    lie(changed["blocks"]);
    bad.text = changed.dump();
    EXPECT_THROW((void)decode(bad), ProtocolError) << what;
  };
  const std::uint64_t huge = std::uint64_t{1} << 40;
  refused("offset past the end", [&](Json& b) { b[0]["arrays"][0]["offset"] = huge; });
  refused("offset at the end",
          [&](Json& b) { b[0]["arrays"][0]["offset"] = (good.memory.size() + 63) / 64 * 64; });
  refused("offset not aligned", [&](Json& b) { b[0]["arrays"][0]["offset"] = 1; });
  refused("offset below zero", [&](Json& b) { b[0]["arrays"][0]["offset"] = -64; });
  refused("offset that wraps", [&](Json& b) { b[0]["arrays"][0]["offset"] = ~std::uint64_t{63}; });
  refused("too many tuples", [&](Json& b) { b[0]["arrays"][0]["tuples"] = huge; });
  refused("tuples that are no number", [&](Json& b) { b[0]["arrays"][0]["tuples"] = 8.5; });
  refused("too few tuples", [&](Json& b) { b[0]["arrays"][0]["tuples"] = 7; });
  refused("no components", [&](Json& b) { b[0]["arrays"][0]["components"] = 0; });
  refused("components without end", [&](Json& b) { b[0]["arrays"][0]["components"] = huge; });
  refused("an unknown type", [&](Json& b) { b[0]["arrays"][0]["type"] = "float128"; });
  refused("a wider type", [&](Json& b) { b[3]["topology"]["positions"]["tuples"] = 1 << 20; });
  refused("an unknown association", [&](Json& b) { b[0]["arrays"][0]["on"] = "edge"; });
  refused("a missing name", [&](Json& b) { b[0]["arrays"][0].erase("name"); });
  refused("dimensions whose product overflows", [&](Json& b) {
    b[0]["topology"]["points"] = {2147483647, 2147483647, 2147483647};
  });
  refused("a dimension of 0", [&](Json& b) { b[0]["topology"]["points"] = {0, 2, 2}; });
  refused("an origin that is no number", [&](Json& b) { b[0]["topology"]["origin"][1] = nullptr; });
  refused("eight axes", [&](Json& b) { b[0]["topology"]["axes"].erase(0); });
  refused("a visibility list outside", [&](Json& b) { b[0]["visible"] = huge; });
  refused("coordinates that do not increase", [&](Json& b) {
    b[1]["topology"]["z"] = b[1]["topology"]["x"];
    b[1]["topology"]["counts"] = {2, 2, 3};
  });
  refused("positions for another block", [&](Json& b) { b[2]["topology"]["points"] = {2, 2, 3}; });
  refused("positions of two components", [&](Json& b) { b[2]["topology"]["positions"]["components"] = 2; });
  refused("whole numbers as positions", [&](Json& b) { b[2]["topology"]["positions"]["type"] = "int64"; });
  refused("more cells", [&](Json& b) { b[3]["topology"]["cells"] = 3; });
  refused("2^46 cells", [&](Json& b) { b[3]["topology"]["cells"] = std::uint64_t{1} << 46; });
  refused("a shorter connectivity", [&](Json& b) { b[3]["topology"]["connectivity_count"] = 20; });
  refused("another list as offsets",
          [&](Json& b) { b[3]["topology"]["offsets"] = b[3]["topology"]["connectivity"]; });
  refused("other numbers as connectivity",
          [&](Json& b) { b[3]["topology"]["connectivity"] = b[3]["topology"]["positions"]["offset"]; });
  refused("an unknown topology", [&](Json& b) { b[0]["topology"]["kind"] = "spherical"; });
  refused("a number instead of a block", [&](Json& b) { b[0] = 5; });
  refused("an object instead of the list", [&](Json& b) { b = Json::object(); });
}

TEST(Protocol, CellsThatNameMissingPointsAreRefused) {
  const Encoded good = encoded();
  const Json message = parse_json(good.text);
  const auto at = message["blocks"][3]["topology"]["connectivity"].get<std::size_t>();
  const auto with = [&](std::size_t index, std::int64_t value) {
    Encoded bad = good;
    std::memcpy(bad.memory.data() + at + 8 * index, &value, 8);
    return bad;
  };
  for (const std::int64_t value :
       {std::int64_t{-1}, std::int64_t{8}, std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_THROW((void)decode(with(2, value)), ProtocolError) << "corner " << value;
    EXPECT_THROW((void)decode(with(4, value)), ProtocolError) << "face count " << value;
    EXPECT_THROW((void)decode(with(5, value)), ProtocolError) << "corner count " << value;
    EXPECT_THROW((void)decode(with(6, value)), ProtocolError) << "face's corner " << value;
  }
}

TEST(Protocol, CutOffMessagesAreRefused) {
  const Encoded good = encoded();
  for (std::size_t size = 0; size < good.text.size(); size += 7) {
    Encoded bad = good;
    bad.text.resize(size);
    EXPECT_THROW((void)decode(bad), ProtocolError) << size;
  }
  Encoded bad = good;
  bad.memory.resize(bad.memory.size() / 2);
  EXPECT_THROW((void)decode(bad), ProtocolError);
  EXPECT_THROW((void)decode_info(std::string(100000, '[')), ProtocolError);
}

TEST(MemoryFile, OnceSealedItCannotBeWrittenOrShrunk) {
  MemoryFile file;
  const std::vector<std::byte> data(100, std::byte{7});
  EXPECT_EQ(file.append(data), 0U);
  EXPECT_EQ(file.append(data), 128U);
  const UniqueFd copy(::dup(file.fd()));
  EXPECT_THROW((void)MappedMemory::map(copy), std::runtime_error) << "not sealed yet";
  file.seal();
  EXPECT_THROW((void)file.append(data), std::exception);
  EXPECT_NE(::ftruncate(copy.get(), 10), 0);
  const auto mapped = MappedMemory::map(copy);
  ASSERT_EQ(mapped->bytes().size(), 228U);
  EXPECT_EQ(mapped->bytes()[227], std::byte{7});
  EXPECT_EQ(mapped->bytes()[110], std::byte{0});
}

}  // namespace
}  // namespace palpate
