// How much light reaches a place through the matter of its own part: T = prod (1 - A_k)^(l_k / l) over kSteps stretches
// toward the light, each longer than the one before it by kGrowth, of opacity A_k along the length l, each asked once in its
// middle. What is cut away casts no shadow; lenses are not told apart, transfer functions of regions cast none.
// Needs volume/volume_block.glsl, include/shade.glsl and value_at().
float light_at(vec3 g, Part part) {
  Transfer transfer = volume.transfers[part.transfer];
  if ((part.looks & kShadows) == 0 || transfer.by_regions == 1) return 1.0;
  const int kSteps = 14;
  const float kFirst = 1.5, kGrowth = 1.28;  // voxels
  vec3 light = light_direction();
  float unit = 1.0 / length(mat3(field.grid_from_scene) * light);  // N a voxel along it
  float layer = volume.layer_count - 1.0, longest = layer * volume.layer_length;
  vec3 from = (inverse(field.grid_from_scene) * vec4(g, 1.0)).xyz;
  float t = kFirst * unit, stretch = unit, through = 1.0;
  for (int k = 0; k < kSteps && through > 0.02; ++k) {
    vec3 x = from + (t + 0.5 * stretch) * light;
    vec3 at = (field.grid_from_scene * vec4(x, 1.0)).xyz;
    if (any(lessThan(at, field.lower)) || any(greaterThan(at, field.upper))) break;
    bool there = true;
    for (int i = 0; i < volume.cut_count; ++i) there = there && dot(shapes.cuts[i].xyz, x) <= shapes.cuts[i].w;
    float value = value_at(at);
    float opacity = texture(tables, vec3(value, value, float(transfer.first_layer) + layer)).a;
    if (there && !isnan(value)) through *= pow(1.0 - min(opacity, 0.9999), stretch / longest);
    t += stretch;
    stretch *= kGrowth;
  }
  return through;
}
