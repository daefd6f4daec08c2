/// Writers of annotations, chosen by the file's ending: .csv and .vtp.
///
///   .csv   annotation,kind,label,value,point,x,y,z        a row a point; value as measure_of()
///   .vtp   a vertex, line or polygon each, with the cell arrays kind, label and value
#pragma once

#include <filesystem>
#include <span>

#include "common/geometry/annotation.h"

namespace palpate {

/// @throws Error (usage) for other endings, and where the file exists unless `overwrite`.
void check_annotation_output(const std::filesystem::path& path, bool overwrite);
/// @throws Error as check_annotation_output(); (work failed) where the disk refuses.
void write_annotations(const std::filesystem::path& path, std::span<const Annotation> annotations,
                       bool overwrite);

}  // namespace palpate
