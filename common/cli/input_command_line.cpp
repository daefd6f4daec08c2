#include "common/cli/input_command_line.h"

namespace palpate {

void add_tensor_input_options(SceneOptions& options, TensorWords& tensor) {
  const char* group = "Tensors";
  options.add("--bval", tensor.bval, "b-values of diffusion-weighted volumes; default: beside FILE", "FILE",
              group);
  options.add("--bvec", tensor.bvec, "their gradient directions, in FSL's image axes; default: beside FILE",
              "FILE", group);
  options.add("--mask", tensor.mask,
              "where tensors are fitted: auto (default, the foreground), none, or an image", "auto|none|FILE",
              group);
  options.add("--fit", tensor.fit,
              "least squares on the log signal: weighted (default, by the squared signal) or "
              "ordinary",
              "WORD", group);
  options.add("--negative", tensor.negative,
              "eigenvalues below zero of fitted tensors: keep (default) or zero", "keep|zero", group);
  options.add("--tensor-order", tensor.order,
              "what six volumes are: fsl, mrtrix, nifti, or auto (default), by what "
              "makes tensors positive and smooth",
              "WORD", group);
  options.add("--permute", tensor.permute,
              "take components along the image's axes from others, jik: i and j swapped", "jik", group);
  options.add("--flip", tensor.flip, "turn around components along these of the image's axes i, j, k", "AXES",
              group);
  options.add("--interpolation", tensor.interpolation,
              "of tensors between voxels: components (default) or "
              "log-euclidean",
              "WORD", group);
}

void add_raw_options(SceneOptions& options, RawWords& raw) {
  const char* group = "Voxels without a header";
  options.add("--raw-size", raw.size, "voxels along each axis, the fastest first", "NXxNYxNZ", group);
  options.add("--raw-type", raw.type, "uint8, int8, uint16, int16, uint32, int32, float32, float64, …",
              "TYPE", group);
  options.add("--raw-endian", raw.endian, "order of the bytes of a number; default little", "little|big",
              group);
  options.add("--raw-spacing", raw.spacing, "steps between voxels in data units; default 1,1,1", "DX,DY,DZ",
              group);
  options.add("--raw-origin", raw.origin, "place of the first voxel in data units; default 0,0,0", "X,Y,Z",
              group);
  options.add("--raw-skip", raw.skip, "bytes before the first voxel; default 0", "BYTES", group);
}

}  // namespace palpate
