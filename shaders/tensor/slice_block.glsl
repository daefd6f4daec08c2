// The slice that is drawn. g: grid coordinates, whole numbers at the centres of voxels.
layout(location = 0) uniform mat4 scene_from_grid;
layout(location = 4) uniform vec3 points;      // voxels along each axis
layout(location = 5) uniform vec3 cross_at;    // g of the point that all slices go through
layout(location = 6) uniform int axis;         // across which the slice lies
layout(location = 7) uniform vec4 cross_line;  // sRGB of the crosshair; w: half its width in pixels, 0: none
layout(location = 8) uniform vec4 border;      // the same for the slice's edges
layout(location = 9) uniform float brightness; // of the voxels
layout(location = 10) uniform mat4 under_from_grid;  // grid coordinates of the image below
layout(location = 14) uniform vec3 under_points;     // its voxels along each axis
layout(location = 15) uniform vec2 under_grey;       // grey = x number + y
layout(location = 16) uniform int under_blend;       // 0: there is none; 1 + UnderlayBlend
layout(location = 17) uniform bool anisotropy_grey;  // the voxels' colours are FA as grey
