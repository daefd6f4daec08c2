// How fast values change: differences of one voxel to either side. Needs volume/volume_block.glsl and value_at().
float value_at(vec3 g);

// In table coordinates a voxel.
vec3 slope_at(vec3 g) {
#ifdef UNEVEN
  vec3 before, behind;
  steps_beside(g, before, behind);
  vec2 one = vec2(1.0, 0.0);
  return vec3(value_at(g + one.xyy * behind) - value_at(g - one.xyy * before),
              value_at(g + one.yxy * behind) - value_at(g - one.yxy * before),
              value_at(g + one.yyx * behind) - value_at(g - one.yyx * before)) / (before + behind);
#else
  vec2 step = vec2(1.0, 0.0);
  return 0.5 * vec3(value_at(g + step.xyy) - value_at(g - step.xyy),
                    value_at(g + step.yxy) - value_at(g - step.yxy),
                    value_at(g + step.yyx) - value_at(g - step.yyx));
#endif
}

// In table coordinates per N.
vec3 slope_in_scene(vec3 slope) { return slope * mat3(field.grid_from_scene); }  // gradients: transposed product
