/// The nodes of a NanoVDB grid of floats; for the sources of this folder alone.
#pragma once

#include <nanovdb/NanoVDB.h>

namespace palpate::nano {

using Leaf = nanovdb::NanoLeaf<float>;
using Lower = nanovdb::NanoLower<float>;
using Upper = nanovdb::NanoUpper<float>;
using LeafData = Leaf::DataType;
using LowerData = Lower::DataType;
using UpperData = Upper::DataType;
using Root = nanovdb::NanoRoot<float>;
using RootData = Root::DataType;
using TreeData = nanovdb::TreeData<3>;

}  // namespace palpate::nano
