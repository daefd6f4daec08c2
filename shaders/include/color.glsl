// Linear light from sRGB and back (IEC 61966-2-1).
vec3 decode_srgb(vec3 c) {
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

vec3 encode_srgb(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

// The same within 0.7 of 255 steps, without a power: for fragments of which there are many. A quotient of polynomials of
// the square root, fitted by least of the largest difference.
vec3 encode_srgb_fast(vec3 c) {
  vec3 s = sqrt(clamp(c, 0.0, 1.0));
  return s * (-0.05599260 + s * (20.6210278 + s * 75.0264849)) / (1.0 + s * (9.85826655 + s * 84.4869488));
}
