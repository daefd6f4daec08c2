// The slice that is drawn. g: grid coordinates, whole numbers at the centres of voxels.
layout(location = 0) uniform mat4 scene_from_grid;
layout(location = 4) uniform vec3 points;      // voxels along each axis
layout(location = 5) uniform vec3 cross_at;    // g of the point that all slices go through
layout(location = 6) uniform int axis;         // across which the slice lies
layout(location = 7) uniform vec4 cross_line;  // sRGB of the crosshair; w: half its width in pixels, 0: none
layout(location = 8) uniform vec4 border;      // the same for the slice's edges
layout(location = 9) uniform float brightness; // of the voxels
