// Programs of the WebGL picture (GLSL ES 3.00). A texture of points is `points_wide` texels
// wide; point i of the curves is its texel i. Colours are linear until the last program.
export const points_wide = 1024;

const head = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
ivec2 texel(int i) { return ivec2(i % ${points_wide}, i / ${points_wide}); }
`;

// sRGB [IEC 61966-2-1] of linear colours, and back.
const srgb = `
vec3 to_linear(vec3 c) {
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
}
vec3 to_srgb(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}
`;

// Deep opacity maps [Yuksel 2008], the successors on a graphics processor of the light's own
// grid of [Bertails 2005]: the light's depth map starts the layers, so that what is lit first
// has no shadow of itself. Coordinates of the light: 0 .. 1 over the ball
// that holds the scene.
const light_space = `
uniform vec3 middle, light, light_right, light_up; // light: towards it
uniform float radius;
vec3 in_light(vec3 p) {
  vec3 d = (p - middle) / radius;
  return 0.5 + 0.5 * vec3(dot(d, light_right), dot(d, light_up), -dot(d, light));
}
`;

const transmittance = `
uniform sampler2D first_depth, opacity;
uniform vec4 layers; // ends of the layers below the first hair, parts of the diameter
uniform float shadow; // 0: none
float reaches(vec3 p) {
  vec3 q = in_light(p);
  vec2 texels = vec2(textureSize(first_depth, 0));
  // Less a texel's depth: a slanting hair is no shadow of itself.
  float below = q.z - texelFetch(first_depth, ivec2(q.xy * texels), 0).r - 1.0 / texels.x;
  vec4 ends = texture(opacity, q.xy);
  vec4 starts = vec4(0.0, layers.xyz);
  vec4 step_of = ends - vec4(0.0, ends.xyz);
  float between = dot(step_of, clamp((below - starts) / (layers - starts), 0.0, 1.0));
  return exp(-shadow * between);
}
`;

const whole_picture = `${head}
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); }
`;

// One line for each segment, seen from the light.
const light_vertices = `${head}${light_space}
uniform sampler2D places;
void main() {
  vec3 q = in_light(texelFetch(places, texel(gl_VertexID), 0).xyz);
  gl_Position = vec4(2.0 * q - 1.0, 1.0);
}
`;
const nothing = `${head}
void main() {}
`;
// Every layer holds what lies before its end.
const layered = `${head}
uniform sampler2D first_depth;
uniform vec4 layers;
uniform float covers; // part of a texel that the width of a line covers
out vec4 opacity;
void main() {
  float below = gl_FragCoord.z - texelFetch(first_depth, ivec2(gl_FragCoord.xy), 0).r;
  opacity = covers * step(vec4(below), vec4(layers.xyz, 2.0));
}
`;

// Where each point is seen and how it is lit: once a point, not once a pixel.
const points = `${head}${srgb}${light_space}${transmittance}
uniform sampler2D places, ramp, through, back, along;
uniform highp usampler2D ends; // 1: first of its strand, 2: last
uniform int count;
uniform vec3 eye, forward, right, up, background;
uniform vec2 size;
uniform float scale, distance_m;
uniform bool fibres; // light scattered by hair, else the colours of the ramp
uniform vec3 albedo; // of a hair in light from everywhere
uniform float sun, sky, deep; // as in light.mjs
layout(location = 0) out vec4 seen; // x, y (pixels), depth (m), direction on the picture
layout(location = 1) out vec4 lit;

const float pi = 3.14159265;

// As \`scattered\` in src/hair/fibre.mjs.
vec3 scattered(vec3 to_light, vec3 to_eye, vec3 tangent) {
  vec2 sine = vec2(dot(to_light, tangent), dot(to_eye, tangent));
  vec2 theta = asin(clamp(sine, -1.0, 1.0));
  vec3 a = to_light - sine.x * tangent;
  vec3 b = to_eye - sine.y * tangent;
  float cosine = dot(a, b) * inversesqrt(max(dot(a, a) * dot(b, b), 1e-12));
  float phi = acos(clamp(cosine, -1.0, 1.0));
  vec3 m = texture(along, theta / pi + 0.5).rgb;
  vec2 at = vec2(phi / pi, abs(theta.y - theta.x) / pi);
  vec4 n = texture(through, at);
  return m.r * n.a + m.g * n.rgb + m.b * texture(back, at).rgb;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  int i = at.y * ${points_wide} + at.x;
  if (i >= count) discard;
  uint end = texelFetch(ends, at, 0).r;
  vec4 place = texelFetch(places, at, 0);
  vec3 before = (end & 1u) != 0u ? place.xyz : texelFetch(places, texel(i - 1), 0).xyz;
  vec3 after = (end & 2u) != 0u ? place.xyz : texelFetch(places, texel(i + 1), 0).xyz;
  vec3 tangent = normalize(after - before + vec3(0, 0, 1e-12));

  vec3 d = place.xyz - eye;
  float depth = dot(d, forward);
  vec2 across = vec2(dot(d, right), dot(d, up));
  vec2 along_picture =
      vec2(dot(tangent, right), dot(tangent, up)) * depth - across * dot(tangent, forward);
  seen = vec4(0.5 * size + scale / depth * across, depth,
              atan(along_picture.y, along_picture.x));

  if (fibres) {
    float part = reaches(place.xyz);
    vec3 direct = sun * part * scattered(light, -normalize(d), tangent);
    lit = vec4(direct + sky * mix(deep, 1.0, sqrt(part)) * albedo, 1.0);
    return;
  }
  // Kajiya-Kay's diffuse term and mist, as the picture without WebGL has them.
  float along_light = dot(tangent, light);
  float bright = 0.72 + 0.28 * (1.0 - along_light * along_light);
  float mist = 0.2 * clamp(1.0 + (depth - distance_m) / radius, 0.0, 2.0);
  vec3 colour = texture(ramp, vec2(place.w * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb * bright;
  lit = vec4(to_linear(mix(colour, to_srgb(background), mist)), 1.0);
}
`;

// A ribbon for each segment, wide enough for every pixel that the hair touches.
const ribbon_vertices = `${head}
uniform sampler2D seen, lit;
uniform vec2 size, depths; // depths: gl_Position.z / w = depths.x + depths.y / depth
uniform float width, diameter, scale, distance_m, rim, lift; // lift (m): out of the bodies
out float across, half_width;
out vec3 colour;
void main() { // vertices 2 i and 2 i + 1 lie on the two sides of point i
  ivec2 at = texel(gl_VertexID >> 1);
  vec4 s = texelFetch(seen, at, 0);
  half_width = 0.5 * max(width * min(2.0, distance_m / s.z), diameter * scale / s.z);
  across = ((gl_VertexID & 1) == 0 ? -1.0 : 1.0) * (half_width + rim + 1.0);
  vec2 place = s.xy + across * vec2(-sin(s.w), cos(s.w));
  colour = texelFetch(lit, at, 0).rgb;
  gl_Position = vec4(2.0 * place / size - 1.0, depths.x + depths.y / (s.z - lift), 1.0);
}
`;
// Coverage: the hair seen through a filter of one pixel's hat function, so that lines keep
// their width without beads. Summed over the pixels across it is the hair's width, however
// thin it is. Beyond the hair lies a rim of the background.
const ribbon = `${head}
uniform vec3 background;
uniform float rim;
in float across, half_width;
in vec3 colour;
out vec4 painted; // premultiplied
float up_to(float x) { // the integral of the hat up to x
  x = clamp(x, -1.0, 1.0);
  return 0.5 + x - 0.5 * x * abs(x);
}
float covered(float reach) { return up_to(across + reach) - up_to(across - reach); }
void main() {
  float inner = covered(half_width);
  float all = rim > 0.0 ? covered(half_width + rim) : inner;
  painted = vec4(inner * colour + (all - inner) * background, all);
}
`;

// Balls, ellipsoids and capsules: the unit ball, its halves moved apart along z.
const body_vertices = `${head}
uniform mat3 axes;
uniform vec3 centre, half_axes, eye, forward, right, up;
uniform float apart, scale;
uniform vec2 size, depths;
layout(location = 0) in vec4 ball; // w: -1 or 1, the half that it belongs to
out vec3 on_ball, normal, world;
void main() {
  on_ball = ball.xyz;
  normal = axes * (ball.xyz / half_axes);
  world = centre + axes * (half_axes * ball.xyz + vec3(0, 0, ball.w * apart));
  vec3 d = world - eye;
  float depth = dot(d, forward);
  gl_Position = vec4(2.0 * scale / size * vec2(dot(d, right), dot(d, up)),
                     depths.x * depth + depths.y, depth);
}
`;
const body = `${head}${light_space}${transmittance}
uniform vec3 bright, dark, line;
uniform float line_part;
uniform vec3 shown; // 1: the line where this coordinate is 0
in vec3 on_ball, normal, world;
out vec4 painted;
void main() {
  float facing = 0.5 + 0.5 * dot(normalize(normal), light);
  vec3 colour = mix(dark, bright, facing * facing) * mix(0.35, 1.0, reaches(world));
  vec3 lines = shown * (1.0 - smoothstep(0.3, 1.0, abs(on_ball) / fwidth(on_ball)));
  float most = max(lines.x, max(lines.y, lines.z));
  painted = vec4(mix(colour, line, line_part * most), 1.0);
}
`;

// Planes: a patch with a grid, see-through.
const plane_vertices = `${head}
uniform vec3 corner, along_a, along_b, eye, forward, right, up;
uniform float scale;
uniform vec2 size, depths;
out vec2 grid;
void main() {
  grid = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  vec3 d = corner + grid.x * along_a + grid.y * along_b - eye;
  float depth = dot(d, forward);
  gl_Position = vec4(2.0 * scale / size * vec2(dot(d, right), dot(d, up)),
                     depths.x * depth + depths.y, depth);
}
`;
const plane = `${head}
uniform vec4 floor_colour, line_colour; // not premultiplied
uniform float cells;
in vec2 grid;
out vec4 painted;
void main() {
  vec2 at = cells * grid;
  vec2 from_line = abs(fract(at + 0.5) - 0.5) / fwidth(at);
  float line = 1.0 - smoothstep(0.3, 1.0, min(from_line.x, from_line.y));
  vec4 colour = mix(floor_colour, vec4(line_colour.rgb, 1.0), line_colour.a * line);
  painted = vec4(colour.rgb * colour.a, colour.a);
}
`;

const shown = `${head}${srgb}
uniform sampler2D picture;
out vec4 pixel;
void main() {
  pixel = vec4(to_srgb(texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb), 1.0);
}
`;

export const programs = {
  light_depth: [light_vertices, nothing],
  light_layers: [light_vertices, layered],
  points: [whole_picture, points],
  ribbons: [ribbon_vertices, ribbon],
  bodies: [body_vertices, body],
  planes: [plane_vertices, plane],
  shown: [whole_picture, shown],
};
