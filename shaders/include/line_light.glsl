// Light on a line (Zoeckler, Stalling, Hege 1996; Banks 1994). A line has no normal of its own; of all
// normals across it the one is taken that gives the most light (maximum principle). With unit vectors
// T along the line, L to the light and V to the eye:
//   diffuse   L.N = sqrt(1 - (L.T)^2)                                                    (1)
//   specular  V.R = sqrt(1 - (L.T)^2) sqrt(1 - (V.T)^2) - (L.T)(V.T)                     (2)
// Returns (diffuse, specular), before any exponent.
// @param lt,vt L.T and V.T
vec2 line_light(float lt, float vt) {
  float ln = sqrt(max(0.0, 1.0 - lt * lt));
  float vn = sqrt(max(0.0, 1.0 - vt * vt));
  return vec2(ln, max(0.0, ln * vn - lt * vt));
}
