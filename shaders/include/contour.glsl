// Lines of equal value over a colour: `away` pixels from the nearest one, with a dark rim that shows them on white, too.
const vec3 kContourRim = vec3(0.03, 0.08, 0.12);

float contour_line(float away, float width) { return clamp(0.5 * width + 0.5 - away, 0.0, 1.0); }
float contour_rim(float away, float width) { return 0.6 * clamp(0.5 * width + 1.5 - away, 0.0, 1.0); }

vec3 with_contour(vec3 color, vec3 line, float away, float width) {
  return mix(mix(color, kContourRim, contour_rim(away, width)), line, contour_line(away, width));
}
