// Shaders of the rasteriser (GLSL 4.50). Private to sim/render.
//
// A frame takes two steps. First the triangles are drawn into a view, a pinhole picture of triangle numbers. Then, for
// each pixel, its exact ray is intersected with the plane of the triangle that the view has there, and shaded by the
// ray tracer's model.
#pragma once

#include <string>

namespace sim {

inline const std::string kGlslVersion = "#version 450 core\n";

// Triangles in a view of a camera or a light. clip_from_world: of positions less `origin`.
inline const std::string kTriangleVertex = kGlslVersion + R"(
layout(location = 0) in vec3 position;
uniform vec3 origin;
uniform mat4 clip_from_world;
void main() { gl_Position = clip_from_world * vec4(position - origin, 1.0); }
)";
inline const std::string kNumberFragment = kGlslVersion + R"(
layout(location = 0) out int number;  // 1 + that of the triangle
void main() { number = gl_PrimitiveID + 1; }
)";
inline const std::string kNothingFragment = kGlslVersion + "void main() {}\n";

// One triangle that covers the viewport.
inline const std::string kScreenVertex = kGlslVersion + R"(
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.5, 1.0); }
)";

// Light: sim/render/ray_tracer.h has the model, raster_scene.h and raster_light.h the tables.
inline const std::string kShadeFragment = kGlslVersion + R"(
// Faces of a cube: sim/render/raster_view.h has the same.
int FaceOf(vec3 d) {
  vec3 s = abs(d);
  if (s.z >= s.x && s.z >= s.y) return d.z >= 0.0 ? 0 : 1;
  if (s.x >= s.y) return d.x >= 0.0 ? 2 : 3;
  return d.y >= 0.0 ? 4 : 5;
}
// d in the face's axes: the third is that which it looks along.
vec3 InFace(vec3 d, int face) {
  vec3 v = face < 2 ? d : (face < 4 ? d.yzx : d.zxy);
  return (face & 1) == 0 ? v : vec3(v.xy, -v.z);
}

// The pixel's ray and the triangle that it meets.
uniform sampler2D rays;        // in C, of the corners of the pixels
uniform isampler2D numbers;    // the view
uniform int view_face;
uniform bool only_own_face;    // other rays belong to other views
uniform bool exact;            // every ray goes through the middle of a texel
uniform vec2 view_low, view_texel;  // tangents: of its corner, and what a texel is wide
uniform ivec2 view_size;
uniform vec2 jitter;           // of the ray, in pixels, from the middle
uniform vec2 lens;             // the point of the lens, in C
uniform float inverse_focus;
uniform mat3 rotation;         // R_WC
uniform vec3 origin;           // of the rays, in W
uniform samplerBuffer triangles;
uniform int texels_per_triangle;

struct PixelRay {
  vec3 ray, du, dv;  // in C; its derivatives by the pixel
};

PixelRay RayOfPixel(ivec2 pixel) {
  vec3 a = texelFetch(rays, pixel, 0).xyz, b = texelFetch(rays, pixel + ivec2(1, 0), 0).xyz;
  vec3 c = texelFetch(rays, pixel + ivec2(0, 1), 0).xyz, d = texelFetch(rays, pixel + ivec2(1, 1), 0).xyz;
  PixelRay r;
  r.du = 0.5 * ((b - a) + (d - c));
  r.dv = 0.5 * ((c - a) + (d - b));
  vec2 at = jitter + 0.5;
  r.ray = mix(mix(a, b, at.x), mix(c, d, at.x), at.y);
  return r;
}

vec3 ThroughLens(vec3 ray) { return vec3(ray.xy - lens * (ray.z * inverse_focus), ray.z); }

// Where a ray from `origin` meets a triangle's plane: u, v of Embree, and how far along d (Moeller and Trumbore 1997).
vec3 Meet(int triangle, vec3 d) {
  int first = triangle * texels_per_triangle;
  vec3 du = texelFetch(triangles, first + 1).xyz, dv = texelFetch(triangles, first + 2).xyz;
  vec3 from = origin - texelFetch(triangles, first).xyz, p = cross(d, dv), q = cross(from, du);
  float determinant = dot(du, p);
  return determinant == 0.0 ? vec3(0.0, 0.0, -1.0) : vec3(dot(from, p), dot(d, q), dot(dv, q)) / determinant;
}

int NumberAt(ivec2 at) { return texelFetch(numbers, clamp(at, ivec2(0), view_size - 1), 0).x - 1; }

// The number of the triangle that a ray meets, d in W; -1: none. A pinhole's rays go through the middles of the texels;
// any other ray meets the nearest of the triangles in the four texels around it.
int TriangleOn(vec3 ray, vec3 d) {
  if (only_own_face && FaceOf(ray) != view_face) discard;
  vec3 v = InFace(ray, view_face);
  vec2 at = (v.xy / v.z - view_low) / view_texel;
  int nearest = NumberAt(ivec2(floor(at)));
  if (exact) return nearest;
  ivec2 corner = ivec2(floor(at - 0.5));
  int around[4] = int[4](NumberAt(corner), NumberAt(corner + ivec2(1, 0)), NumberAt(corner + ivec2(0, 1)),
                         NumberAt(corner + ivec2(1, 1)));
  if (around[0] == nearest && around[1] == nearest && around[2] == nearest && around[3] == nearest) return nearest;
  int found = -1;
  bool is_border = false;  // of all that is
  float distance = 0.0;
  for (int i = 0; i < 4; ++i) {
    if (around[i] < 0) {
      is_border = true;
      continue;
    }
    vec3 meet = Meet(around[i], d);
    bool inside = meet.z > 0.0 && min(meet.x, meet.y) >= -1e-5 && meet.x + meet.y <= 1.0 + 1e-5;
    if (inside && (found < 0 || meet.z < distance)) {
      found = around[i];
      distance = meet.z;
    }
  }
  return found >= 0 ? found : (is_border ? -1 : nearest);
}

uniform float share;  // side of the ray's part of the pixel
uniform samplerBuffer materials, lights;
uniform isamplerBuffer levels;
uniform usamplerBuffer texels;
uniform int first_light, light_count;
uniform vec3 ambient, background;
uniform bool shadows;
uniform sampler2DArrayShadow lasting_shadows, sample_shadows;
layout(location = 0) out vec4 radiance;

vec3 Texel(ivec3 level, ivec2 at) {
  at += ivec2(at.x < 0 ? level.x : (at.x >= level.x ? -level.x : 0),
              at.y < 0 ? level.y : (at.y >= level.y ? -level.y : 0));
  uint bits = texelFetch(texels, level.z + at.y * level.x + at.x).x;
  vec3 root = vec3(bits & 1023u, (bits >> 10) & 1023u, (bits >> 20) & 1023u) / 1023.0;
  return root * root;
}
vec3 Bilinear(int index, vec2 uv) {
  ivec3 level = texelFetch(levels, index).xyz;
  vec2 at = uv * vec2(level.xy) - 0.5, whole = floor(at), part = at - whole;
  ivec2 i = ivec2(whole);
  return mix(mix(Texel(level, i), Texel(level, i + ivec2(1, 0)), part.x),
             mix(Texel(level, i + ivec2(0, 1)), Texel(level, i + ivec2(1, 1)), part.x), part.y);
}
vec3 Trilinear(int first, int count, vec2 uv, float footprint) {
  uv -= floor(uv);
  float level = min(log2(clamp(footprint, 1.0, 65536.0)), float(count - 1));
  int lower = int(level);
  float blend = level - float(lower);
  vec3 color = Bilinear(first + lower, uv);
  return blend > 0.0 ? mix(color, Bilinear(first + lower + 1, uv), blend) : color;
}

// The part of the light that arrives: 0 in a shadow, 1 without. The point is lifted off its surface by as much as the
// depth in the map may differ within the texels that are compared.
float Seen(int light, int layer, int kind, vec3 at, vec3 normal, vec3 towards, float sine) {
  if (kind == 0) {
    vec4 r0 = texelFetch(lights, light + 3), r1 = texelFetch(lights, light + 4), r2 = texelFetch(lights, light + 5);
    float side = 1.0 / (length(r0.xyz) * float(textureSize(lasting_shadows, 0).x));
    vec4 p = vec4(at + normal * (side * (0.2 + 2.2 * sine)), 1.0);
    return texture(lasting_shadows, vec4(dot(r0, p), dot(r1, p), float(layer), dot(r2, p) + 1e-5));
  }
  float pixels = kind == 1 ? float(textureSize(lasting_shadows, 0).x) : float(textureSize(sample_shadows, 0).x);
  int face = FaceOf(-towards);
  vec3 n = abs(InFace(normal, face)), s = abs(towards);
  float side = 2.0 * max(s.x, max(s.y, s.z)) / pixels;
  vec3 v = InFace(normal * (side * (0.2 + 1.5 * (n.x + n.y))) - towards, face);
  vec4 look = vec4(0.5 + 0.5 * v.xy / (v.z * (1.0 + 16.0 / pixels)), float(layer + face), (1.0 + 1e-4) * NEAR / v.z);
  return kind == 1 ? texture(lasting_shadows, look) : texture(sample_shadows, look);
}

vec3 Light(vec3 at, vec3 geometric, vec3 normal) {
  vec3 sum = ambient;
  for (int i = 0; i < light_count; ++i) {
    int light = first_light + 6 * i;
    vec4 place = texelFetch(lights, light), power = texelFetch(lights, light + 1);
    int kind = int(place.w);  // 0: sun, 1: point, 2: one point of a rectangle
    vec3 l = kind == 0 ? place.xyz : place.xyz - at;
    float inverse = kind == 0 ? 1.0 : inversesqrt(dot(l, l));
    float cosine = dot(normal, l) * inverse;
    float emitted = kind == 2 ? -dot(texelFetch(lights, light + 2).xyz, l) * inverse : 1.0;
    float side = dot(geometric, l) * inverse;
    if (!(cosine > 0.0 && emitted > 0.0 && side > 0.0)) continue;
    float strength = cosine * emitted * (kind == 0 ? 1.0 : inverse * inverse) * 0.318309886183790671538;
    if (shadows) strength *= Seen(light, int(power.w), kind, at, geometric, l, sqrt(max(0.0, 1.0 - side * side)));
    sum += strength * power.xyz;
  }
  return sum;
}

void main() {
  PixelRay pixel = RayOfPixel(ivec2(gl_FragCoord.xy));
  vec3 ray = ThroughLens(pixel.ray);
  vec3 d = rotation * ray;
  int number = TriangleOn(ray, d);
  if (number < 0) {
    radiance = vec4(background, 1.0);
    return;
  }
  int first = number * texels_per_triangle;
  vec4 t0 = texelFetch(triangles, first), t1 = texelFetch(triangles, first + 1), t2 = texelFetch(triangles, first + 2);
  vec4 t3 = texelFetch(triangles, first + 3), t4 = texelFetch(triangles, first + 4);
  vec4 t5 = texelFetch(triangles, first + 5);
  vec4 t6 = texelFetch(triangles, first + 6);

  // Or the nearest place of the triangle, where the view and the ray differ by a part of a texel.
  vec2 uv = max(Meet(number, d).xy, 0.0);
  uv /= max(1.0, uv.x + uv.y);
  vec3 offset = uv.x * t1.xyz + uv.y * t2.xyz;
  float distance = dot(t0.xyz + offset - origin, d) / dot(d, d);

  vec3 g = cross(t1.xyz, t2.xyz);
  float g_length = length(g), along = dot(g, d);
  vec3 geometric = g * ((along > 0.0 ? -1.0 : 1.0) / g_length);
  vec3 normal = normalize(t3.xyz + uv.x * t4.xyz + uv.y * t5.xyz);
  if (dot(geometric, normal) < 0.0) normal = -normal;

  int material = floatBitsToInt(t0.w);
  vec4 base = texelFetch(materials, 2 * material), emission = texelFetch(materials, 2 * material + 1);
  vec3 albedo = base.xyz;
  if (texels_per_triangle > 7) {
    albedo *= texelFetch(triangles, first + 7).xyz + uv.x * texelFetch(triangles, first + 8).xyz +
              uv.y * texelFetch(triangles, first + 9).xyz;
  }
  int level_count = floatBitsToInt(emission.w);
  if (level_count > 0) {
    float width = sqrt(abs(dot(pixel.ray, cross(pixel.du, pixel.dv))));
    float slant = max(abs(along) / g_length, 1e-3);
    vec2 place = vec2(t3.w, t4.w) + uv.x * t6.xy + uv.y * t6.zw;
    albedo *= Trilinear(floatBitsToInt(base.w), level_count, place, distance * width * share * t1.w / slant);
  }
  radiance = vec4(emission.xyz + albedo * Light(t0.xyz + offset, geometric, normal), 1.0);
}
)";

}  // namespace sim
