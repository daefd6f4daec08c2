// Lenses whose values go over into those of the coarser voxels outside, before they have a colour: with u the place
// between middle (0) and border (1) of the lens and b its transition, the number is
//   outside + s^2 (3 - 2 s) (own - outside),   s = clamp((1 - u) / b, 0, 1)
// Needs volume/volume_block.glsl and volume/lens_segments.glsl.
layout(binding = 10) uniform sampler3D coarse_voxels;  // between the same ends as the fine ones, in the same numbers

int blended = -1;      // the lens that is being marched through; none: -1
mat3 scene_from_grid;  // set with it

void begin_blending(int lens) {
  blended = lens >= 0 && shapes.circles[lens].w > 0.0 ? lens : -1;
  if (blended >= 0) scene_from_grid = inverse(mat3(field.grid_from_scene));
}

float blended_number(float own, vec3 g) {
  if (blended < 0) return own;
  vec3 x = scene_from_grid * (g - field.grid_from_scene[3].xyz);
  float s = (1.0 - border_place(blended, x)) / shapes.circles[blended].w;
  vec3 points = vec3(textureSize(coarse_voxels, 0));
  vec3 coarse = lattice(g) * (points - 1.0) / max(field.points - 1.0, 1.0);
  float outside = texture(coarse_voxels, (coarse + 0.5) / points).x;
  // Not by the sum where either has no share: it may be NaN.
  return s >= 1.0 ? own : s <= 0.0 ? outside : mix(outside, own, s * s * (3.0 - 2.0 * s));
}
