/// The header of a TrackVis file, version 2: http://trackvis.org/docs/?subsect=fileformat. 1000 bytes, little
/// endian.
#pragma once

#include <array>
#include <cstdint>

namespace palpate {

#pragma pack(push, 1)
struct TrkHeader {
  std::array<char, 6> id_string{'T', 'R', 'A', 'C', 'K', '\0'};
  std::array<std::int16_t, 3> dim{};
  std::array<float, 3> voxel_size{};
  std::array<float, 3> origin{};
  std::int16_t n_scalars = 0;
  std::array<std::array<char, 20>, 10> scalar_name{};
  std::int16_t n_properties = 0;
  std::array<std::array<char, 20>, 10> property_name{};
  std::array<std::array<float, 4>, 4> vox_to_ras{};  ///< rows; of the centres of voxels
  std::array<char, 444> reserved{};
  std::array<char, 4> voxel_order{'R', 'A', 'S', '\0'};
  std::array<char, 4> pad2{'R', 'A', 'S', '\0'};
  std::array<float, 6> image_orientation_patient{1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F};
  std::array<char, 2> pad1{};
  std::array<std::uint8_t, 6> invert_and_swap{};
  std::int32_t n_count = 0;
  std::int32_t version = 2;
  std::int32_t hdr_size = 1000;
};
#pragma pack(pop)
static_assert(sizeof(TrkHeader) == 1000);

}  // namespace palpate
