/// The leaves of composite VTK data, and those that are of use (vtk_convert.h).
#include <map>

#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataSet.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkSmartPointer.h>

#include "common/base/error.h"
#include "loaders/vtk/ghost_cells.h"
#include "loaders/vtk/vtk_convert.h"

namespace palpate {
namespace {

std::string name_in(vtkInformation* about) {
  const char* name =
      about->Has(vtkCompositeDataSet::NAME()) != 0 ? about->Get(vtkCompositeDataSet::NAME()) : nullptr;
  return name != nullptr ? name : "";
}

/// The name of the group around each leaf.
void name_parents(vtkMultiBlockDataSet* tree, const std::string& name,
                  std::map<vtkDataSet*, std::string>& parents) {
  for (unsigned b = 0; b < tree->GetNumberOfBlocks(); ++b) {
    vtkDataObject* const child = tree->GetBlock(b);
    if (auto* leaf = vtkDataSet::SafeDownCast(child)) parents[leaf] = name;
    auto* const group = vtkMultiBlockDataSet::SafeDownCast(child);
    if (group == nullptr) continue;
    const std::string own = tree->HasMetaData(b) != 0 ? name_in(tree->GetMetaData(b)) : "";
    name_parents(group, own.empty() ? name : (name.empty() ? own : name + "/" + own), parents);
  }
}

}  // namespace

std::vector<VtkBlock> leaves_of(vtkDataObject* object) {
  std::vector<VtkBlock> blocks;
  if (auto* single = vtkDataSet::SafeDownCast(object)) {
    blocks.push_back({single, ""});
    return blocks;
  }
  auto* composite = vtkCompositeDataSet::SafeDownCast(object);
  if (composite == nullptr) return blocks;
  std::map<vtkDataSet*, std::string> parents;
  if (auto* tree = vtkMultiBlockDataSet::SafeDownCast(object)) name_parents(tree, "", parents);
  const auto it = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
  it->SkipEmptyNodesOn();
  for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem()) {
    auto* leaf = vtkDataSet::SafeDownCast(it->GetCurrentDataObject());
    if (leaf == nullptr) continue;
    blocks.push_back({leaf, it->HasCurrentMetaData() != 0 ? name_in(it->GetCurrentMetaData()) : ""});
  }
  // Leaves of one name, as the mesh inside each region of a case, go by the groups they are in.
  std::map<std::string, int> uses;
  for (const VtkBlock& block : blocks) ++uses[block.name];
  for (std::size_t b = 0; blocks.size() > 1 && b < blocks.size(); ++b) {
    VtkBlock& block = blocks[b];
    const std::string parent = parents[block.data];
    if (!block.name.empty() && uses[block.name] > 1 && !parent.empty())
      block.name = parent + "/" + block.name;
    if (block.name.empty()) block.name = "block " + std::to_string(b + 1);
  }
  return blocks;
}

std::vector<VtkBlock> usable_blocks(const std::vector<VtkBlock>& leaves, const std::string& kind,
                                    const std::string& file, std::vector<std::string>* notes) {
  std::vector<VtkBlock> volumes;
  std::vector<VtkBlock> flats;
  std::vector<std::string> left_out;
  std::vector<std::string> flat_left_out;
  std::string why = "holds no data";
  for (const VtkBlock& block : leaves) {
    if (const std::string reason = why_not_readable(block.data); !reason.empty()) {
      why = kind;
      why.append(" '").append(block.name).append("' ").append(reason);
      left_out.push_back(why + "; left out");
    } else if (const std::string flat = why_not_volume(block.data); !flat.empty()) {
      flats.push_back(block);
      std::string& line = flat_left_out.emplace_back(kind);
      line.append(" '").append(block.name).append("' ").append(flat).append("; left out");
    } else {
      volumes.push_back(block);
    }
  }
  if (volumes.empty() && flats.empty()) throw input_error({file, "", why, "a " + kind + " of volume cells"});
  if (notes != nullptr) {
    std::size_t ghosts = 0;
    for (const VtkBlock& block : volumes) ghosts += ghost_cell_count(block.data);
    if (ghosts > 0) notes->push_back(ghost_cells_note(ghosts));
    notes->insert(notes->end(), left_out.begin(), left_out.end());
    if (!volumes.empty()) notes->insert(notes->end(), flat_left_out.begin(), flat_left_out.end());
  }
  return volumes.empty() ? flats : volumes;
}

}  // namespace palpate
