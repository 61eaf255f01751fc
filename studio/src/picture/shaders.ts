// What the graphics processor does to a picture: exposure, curve, false colour, comparison. One triangle covers the canvas.

export const vertexShader = `#version 300 es
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
}`;

export const fragmentShader = `#version 300 es
precision highp float;
precision highp int;
uniform sampler2D picture;    // linear sRGB
uniform sampler2D pinned;     // what it is compared with
uniform sampler2D toned;      // display values of the program's own tone map
uniform vec2 pictureSize;     // pixels
uniform vec2 canvasSize;
uniform vec3 view;            // zoom, x, y
uniform float exposure;       // a factor
uniform vec2 scales;          // of what the textures hold: values are texels times these
uniform int curve;            // 0 linear, 1 filmic, 2 Reinhard, 3 the program's
uniform int falseColor;       // 0 or 1
uniform vec2 falseRange;      // powers of two at its ends
uniform int compare;          // 0 none, 1 split, 2 pinned alone, 3 difference
uniform float split;          // x on the canvas
uniform int markBad;
uniform vec3 surround;
uniform float seconds;
out vec4 result;

vec3 encode(vec3 c) { // IEC 61966-2-1
  c = clamp(c, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(vec3(0.0031308), c));
}

// Narkowicz 2015, "ACES filmic tone mapping curve"
vec3 filmic(vec3 x) {
  x *= 0.6;
  return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
}

// Mikhailov 2019, "Turbo, an improved rainbow colormap", as a polynomial
vec3 turbo(float x) {
  x = clamp(x, 0.0, 1.0);
  vec4 v4 = vec4(1.0, x, x * x, x * x * x);
  vec2 v2 = v4.zw * v4.z;
  return clamp(vec3(dot(v4, vec4(0.13572138, 4.61539260, -42.66032258, 132.13108234)) + dot(v2, vec2(-152.94239396, 59.28637943)),
                    dot(v4, vec4(0.09140261, 2.19418839, 4.84296658, -14.18503333)) + dot(v2, vec2(4.27729857, 2.82956604)),
                    dot(v4, vec4(0.10667330, 12.64194608, -60.58204836, 110.36276771)) + dot(v2, vec2(-89.90310912, 27.34824973))), 0.0, 1.0);
}

bool bad(vec3 c) {
  return any(isnan(c)) || any(isinf(c)) || all(lessThan(c, vec3(0.0)));
}

vec3 shown(vec3 c, vec2 at, bool isPinned) {
  if (falseColor == 1) {
    float y = dot(c, vec3(0.2126, 0.7152, 0.0722));
    return turbo((log2(max(y, 1e-30)) - falseRange.x) / (falseRange.y - falseRange.x));
  }
  if (curve == 3 && !isPinned) return texture(toned, at).rgb;
  c *= exposure;
  if (curve == 1 || curve == 3) c = filmic(max(c, 0.0));
  if (curve == 2) c = c / (1.0 + max(dot(c, vec3(0.2126, 0.7152, 0.0722)), 0.0));
  return encode(c);
}

void main() {
  vec2 canvas = vec2(gl_FragCoord.x, canvasSize.y - gl_FragCoord.y);
  vec2 place = (canvas - view.yz) / view.x;
  if (any(lessThan(place, vec2(0.0))) || any(greaterThanEqual(place, pictureSize))) {
    result = vec4(surround, 1.0);
    return;
  }
  vec2 at = place / pictureSize;
  bool earlier = compare == 2 || (compare == 1 && canvas.x < split);
  vec3 here = texture(picture, at).rgb * scales.x;
  vec3 before = texture(pinned, at).rgb * scales.y;
  vec3 value = earlier ? before : here;
  if (markBad == 1 && bad(texelFetch(picture, ivec2(at * vec2(textureSize(picture, 0))), 0).rgb)) {
    result = vec4(mix(vec3(1.0, 0.0, 0.8), vec3(1.0, 1.0, 0.0), step(0.5, fract(seconds * 2.0))), 1.0);
    return;
  }
  vec3 color;
  if (compare == 3) { // relative to the mean of the two: blue where it has become darker, red where brighter
    float a = dot(here, vec3(0.2126, 0.7152, 0.0722));
    float b = dot(before, vec3(0.2126, 0.7152, 0.0722));
    float d = clamp((a - b) / max(0.5 * (a + b), 1e-6) * exposure, -1.0, 1.0);
    color = d > 0.0 ? mix(vec3(0.93), vec3(0.79, 0.11, 0.12), d) : mix(vec3(0.93), vec3(0.10, 0.33, 0.70), -d);
  } else {
    color = shown(value, at, earlier);
  }
  if (view.x >= 24.0) { // a grid between large pixels
    vec2 edge = fract(place) * view.x;
    if (min(edge.x, edge.y) < 1.0) color = mix(color, vec3(0.5), 0.25);
  }
  if (compare == 1 && abs(canvas.x - split) < 1.0) color = vec3(1.0);
  result = vec4(color, 1.0);
}`;
