#include "sim/render/raster_draw.h"

namespace sim {

glm::mat4 ClipFromView(const glm::vec2& low, const glm::vec2& high) {
  glm::mat4 clip(0.0f);  // by columns
  clip[0][0] = 2.0f / (high.x - low.x);
  clip[1][1] = 2.0f / (high.y - low.y);
  clip[2][0] = -(high.x + low.x) / (high.x - low.x);
  clip[2][1] = -(high.y + low.y) / (high.y - low.y);
  clip[3][2] = kNear;
  clip[2][3] = 1.0f;
  return clip;
}

void DrawDepth(const GlApi& gl, const RasterScene& scene, const Program& triangles, const glm::vec3& origin,
               const glm::mat4& clip, const GlObject& maps, int layer, int side) {
  const GlObject target = MakeFramebuffer(gl);
  gl.NamedFramebufferTextureLayer(target.id(), GL_DEPTH_ATTACHMENT, maps.id(), 0, layer);
  gl.NamedFramebufferDrawBuffer(target.id(), GL_NONE);
  gl.BindFramebuffer(GL_FRAMEBUFFER, target.id());
  gl.Viewport(0, 0, side, side);
  gl.Scissor(0, 0, side, side);
  gl.Enable(GL_DEPTH_TEST);
  const float far = 0.0f;
  gl.ClearNamedFramebufferfv(target.id(), GL_DEPTH, 0, &far);
  triangles.Use();
  triangles.Set("origin", origin);
  triangles.Set("clip_from_world", clip);
  scene.Draw();
  gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace sim
