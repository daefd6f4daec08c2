/// Blocks of data sets as JSON with their numbers in shared memory: A and T of protocol.h.
///
/// Decoding believes nothing: every array is checked against the memory that it lies in, every cell against
/// the points, every type against the known ones. @throws ProtocolError, all of it.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "common/field/data_set.h"
#include "common/load/helper/memory_file.h"
#include "common/load/helper/message_json.h"
#include "common/load/load.h"

namespace palpate::message {

/// The number type that `object` names at "type".
[[nodiscard]] ScalarType scalar_type_at(const Json& object);

/// An array's description, without the place of its numbers.
[[nodiscard]] Json encode_array_info(const ArrayInfo& info);
[[nodiscard]] ArrayInfo decode_array_info(const Json& object);

/// Appends the block's numbers to `memory` and returns the JSON that describes them.
[[nodiscard]] Json encode_block(const DataSet& block, MemoryFile& memory);
/// The block shares `memory`, which `owner` keeps alive.
[[nodiscard]] DataSet decode_block(const Json& object, std::span<const std::byte> memory,
                                   const std::shared_ptr<const void>& owner);

}  // namespace palpate::message
